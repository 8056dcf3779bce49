// Which surfaces are of water, for the parts of the light that have to do with it (contribution.h).
#pragma once
#include <vector>

#include "transport/path_tracing.h"

namespace suite {

class Waters {
 public:
  // Of nothing where nobody asks.
  explicit Waters(const KernelContext& context);
  bool any() const { return !kind_.empty(); }
  // What has come to `seen` has come to when a surface of `material` sends it on from `out` towards `in`; normal: the
  // front side's.
  WaterSeen behind_surface(WaterSeen seen, uint32_t material, Dir normal, Dir out, Dir in) const;
  // The same when a medium scatters it.
  static WaterSeen behind_scattering(WaterSeen seen);

 private:
  enum class Kind : uint8_t { none, body, opaque };
  std::vector<Kind> kind_;  // [material]
};

}  // namespace suite
