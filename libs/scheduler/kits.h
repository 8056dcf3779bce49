// What captures are primed with: the optics and lights of a spectral state at a moment, and the bands of a sensor. Each
// is made when a capture first asks for it, shared by all captures of an equal state, and given up when none is left.
#pragma once
#include <map>
#include <memory>

#include "transport/pipeline.h"
#include "scheduler/moments.h"

namespace suite {

// One capture's view; valid until the next get() or done().
struct Kit {
  const Optics& optics;
  const Environment& environment;
  const BandProjection& projection;
  size_t reference_band = 0;  // the band nearest to the reference wavelength
};

class Kits {
 public:
  // Keeps references. window: of all captures, for temperatures that are solved once.
  Kits(const Scene& scene, const SourceSpecs& sources, bool periodic, TimeSpan window)
      : scene_(scene), sources_(sources, scene), periodic_(periodic), window_(window) {}
  // One more capture will ask for the state of this number.
  void expect(size_t state) { ++states_[state].users; }
  // The kit of a capture of a sensor; state: the number of its spectral state, equal for equal states.
  Kit get(size_t state, const Sensor& sensor, const Capture& capture, const std::shared_ptr<const Tracer>& tracer);
  // The capture that asked for the state is done. With the last one goes all that belongs to the state.
  void done(size_t state);
  size_t optics_bakes() const { return optics_bakes_; }
  size_t light_bakes() const { return light_bakes_; }
  size_t held() const;  // states whose optics are in memory

 private:
  struct Bands {
    BandProjection projection;
    size_t reference = 0;
  };
  struct Held {
    size_t users = 0;
    std::unique_ptr<const Optics> optics;
    Environment environment;
    double moment = 0;                       // that the environment was baked for
    std::shared_ptr<const Tracer> lamps_of;  // whose geometry it was made for
    std::map<std::pair<const Sensor*, size_t>, Bands> bands;
  };
  void light(Held& held, const std::shared_ptr<const Tracer>& tracer, double moment);

  const Scene& scene_;
  SourcesInTime sources_;
  bool periodic_;
  TimeSpan window_;
  std::map<size_t, Held> states_;
  size_t optics_bakes_ = 0, light_bakes_ = 0;
};

}  // namespace suite
