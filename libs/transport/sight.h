// Which lights are visible, where nothing fills space: what stands on straight lines towards them stops their light.
#pragma once
#include <span>

#include "transport/lost_light.h"
#include "transport/trace_request.h"

namespace suite {

// What a node asks by one of them.
struct SightQuestion {
  uint32_t node;  // of the stage
  uint16_t light;
  bool disk, wide, beam;
  Dir direction;
  double density;
  float scale;
  const float* spectrum;
  uint32_t source;  // of the light (LightSample)
};

// Rays towards lights, as a stage of the kernel has asked for them.
class SightRays {
 public:
  void clear() { size_ = parallel = 0; }
  // Room for n more; then add() may be called as often.
  void expect(size_t n) {
    if (size_ + n <= rays_.size()) return;
    rays_.resize(2 * (size_ + n)), distance_.resize(rays_.size());
    blocked_.resize(rays_.size()), losable_.resize(rays_.size());
  }
  // distance: m. losable: of a light that smooth surfaces may have bent (lost_light.h).
  Ray& add(double distance, bool losable) {
    distance_[size_] = distance;
    losable_[size_] = losable;
    return rays_[size_++];
  }
  size_t size() const { return size_; }
  std::span<const Ray> rays() const { return {rays_.data(), size_}; }
  std::span<const double> distance() const { return {distance_.data(), size_}; }
  std::span<uint8_t> blocked() { return {blocked_.data(), size_}; }  // the answer
  std::span<const uint8_t> losable() const { return {losable_.data(), size_}; }

  size_t parallel = 0;  // the first ones run alongside each other
  bool first = false;   // paths have just started

 private:
  size_t size_ = 0;
  std::vector<Ray> rays_;
  std::vector<double> distance_;
  std::vector<uint8_t> blocked_, losable_;
};

class PlainSight {
 public:
  // lost: null where no light can be lost.
  explicit PlainSight(LostLight* lost) : lost_(lost) {}
  void begin(SightRays& rays) { rays_ = &rays, part_ = 0; }
  // The next request, to be served before the next call; false when all is known.
  bool next(TraceRequest& request);
  // Of ray i, which is blocked: the share of its light that smooth surfaces pass, if nothing else blocks it.
  double passes(size_t ray) const { return lost_ ? lost_->passes(ray) : 0; }

 private:
  bool look(size_t begin, size_t end, bool coherent, TraceRequest& request) const;
  LostLight* lost_;
  SightRays* rays_ = nullptr;
  int part_ = 0;
  std::vector<uint8_t> wanted_;
};

}  // namespace suite
