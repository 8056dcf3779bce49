// Which lights are visible, where nothing fills space: what stands on straight lines towards them stops their light.
#pragma once
#include <span>

#include "transport/lost_light.h"
#include "transport/trace_request.h"

namespace suite {

// Rays towards lights, as a stage of the kernel has asked for them.
struct SightRays {
  std::vector<Ray> rays;
  std::vector<double> distance;  // m
  std::vector<uint8_t> blocked;  // the answer
  std::vector<uint8_t> losable;  // of a light that smooth surfaces may have bent (lost_light.h)
  size_t parallel = 0;           // the first ones run alongside each other
  bool first = false;            // paths have just started
  void clear() { rays.clear(), distance.clear(), losable.clear(), parallel = 0; }
  size_t size() const { return rays.size(); }
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
