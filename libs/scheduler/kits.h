// What captures are primed with: the optics and lights of a spectral state at a moment, and the bands of a sensor. Each
// is made when a capture first asks for it, shared by all captures for which its values are equal (of whatever sensor),
// kept within a budget of bytes (kit_cache.h), and given up when no capture of its state is left.
#pragma once
#include <map>
#include <memory>

#include "scheduler/kit_cache.h"
#include "scheduler/moments.h"
#include "transport/pipeline.h"

namespace suite {

inline constexpr size_t kDefaultKitBytes = size_t{1} << 30;

// One capture's view; what it points to stays for as long as it does.
struct Kit {
  struct Bands {
    BandProjection projection;
    size_t reference = 0;  // the band nearest to the reference wavelength
  };
  std::shared_ptr<const Optics> optics;
  std::shared_ptr<const Environment> environment;
  std::shared_ptr<const Bands> bands;
};

class Kits {
 public:
  // Keeps references. window: of all captures, for temperatures that are solved once. budget: bytes. heating: of the
  // surfaces that ask for it.
  Kits(const Scene& scene, const SourceSpecs& sources, bool periodic, TimeSpan window, size_t budget = kDefaultKitBytes,
       Heating heating = {})
      : scene_(scene),
        sources_(sources, scene),
        periodic_(periodic),
        window_(window),
        heating_(std::move(heating)),
        cache_(budget) {}
  // One more capture will ask for the state of this number.
  void expect(size_t state) { ++users_[state]; }
  // The kit of a capture of a sensor; state: the number of its spectral state, equal for states of equal value. Lights
  // are those of the capture's moment on the grid of moments.h.
  Kit get(size_t state, const Sensor& sensor, const Capture& capture, const std::shared_ptr<const Tracer>& tracer);
  // A capture that asked for the state is done. With the last one goes all that belongs to the state.
  void done(size_t state);
  size_t optics_bakes() const { return optics_bakes_; }
  size_t light_bakes() const { return light_bakes_; }
  size_t held() const { return cache_.held(KitCache::Kind::optics); }  // states whose optics are in memory
  double bytes() const { return cache_.bytes(); }

 private:
  // Lights, and the tracer whose geometry they were made for, if they were.
  struct Lit {
    Environment environment;
    std::shared_ptr<const Tracer> tracer;
    double moment;
  };
  // The sources at a moment; the ground under real air is the scene's where it is asked for.
  SourceSpecs sources_over(size_t state, const Optics& optics, const Tracer& tracer, double moment);
  std::shared_ptr<const Lit> lights(size_t state, const Optics& optics, const std::shared_ptr<const Tracer>& tracer,
                                    double moment);

  const Scene& scene_;
  SourcesInTime sources_;
  bool periodic_;
  TimeSpan window_;
  Heating heating_;
  KitCache cache_;
  std::map<size_t, size_t> users_;                         // captures that are still to come, by state
  std::map<size_t, std::shared_ptr<const AirSpec>> airs_;  // over the scene's ground, by state
  size_t optics_bakes_ = 0, light_bakes_ = 0;
};

}  // namespace suite
