// Visibility through media: what is left, at every wavelength, of light that comes straight from a source.
//
// Index-matched boundaries let light pass; all other surfaces stop it, refracting ones too: light through them is met
// by chance, after the refraction has been drawn, or lost (lost_light.h).
#pragma once
#include <utility>
#include <vector>

#include "transport/media/bodies.h"
#include "transport/media/flight.h"
#include "transport/sight.h"

namespace suite {

class MediaSight {
 public:
  // Keeps references. lost: null where no light can be lost.
  MediaSight(const Surface& surface, Bodies& bodies, Flights& flights, size_t media, LostLight* lost);

  // The bodies that a ray starts in; call once for each ray of the list that begin() will get, in its order.
  void clear() { added_ = 0; }
  MediumStack& add(const MediumStack& stack) {
    if (added_ == bodies_at_.size()) bodies_at_.emplace_back();
    return bodies_at_[added_++] = stack;
  }
  // As PlainSight; when all is known, depths(i) holds the integrated densities on the way of every ray that is not
  // blocked or whose light is lost: blocked by nothing but smooth surfaces, which pass passes(i) of it.
  void begin(SightRays& rays);
  bool next(TraceRequest& request);
  std::span<const double> depths(size_t ray) const { return {&depths_[ray * media_], media_}; }
  // What a ray starts in; where nothing bends it, what lies on its way has one index.
  uint32_t start(size_t ray) const { return start_[ray]; }
  double passes(size_t ray) const { return lost_ && bent_[ray] ? passes_[ray] : 0; }
  TraceStatistics take_statistics() { return std::exchange(statistics_, {}); }

 private:
  void add_depths();
  void take();
  bool pass(size_t i);
  bool bends(uint32_t ray, const Hit& hit, const Ray& from);
  bool go_behind(size_t i, const Hit& hit);
  void count(size_t ray, const Ray& from, double way);

  const Surface& surface_;
  Bodies& body_rules_;
  Flights& flights_;
  size_t media_;
  LostLight* lost_;
  uint32_t ambient_;
  SightRays* asked_ = nullptr;
  int round_ = 0;
  std::vector<MediumStack> bodies_at_;  // the first added_ of them; the others keep their memory
  size_t added_ = 0;
  std::vector<double> depths_, travelled_, gap_, passes_;
  std::vector<uint8_t> bent_;
  std::vector<uint32_t> start_;  // media
  // Rays that are still on their way.
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
  std::vector<uint32_t> owner_;
  TraceStatistics statistics_;  // of short rays at boundaries
};

}  // namespace suite
