#include "transport/media/clear_matter.h"

#include <algorithm>
#include <cmath>

namespace suite {

std::unique_ptr<ClearMatter> ClearMatter::of(const Surface& surface, const Optics& optics, size_t width) {
  return optics.clear().empty() ? nullptr : std::make_unique<ClearMatter>(surface, optics, width);
}

ClearMatter::ClearMatter(const Surface& surface, const Optics& optics, size_t width)
    : optics_(optics), bodies_(surface), stacks_(width), remembered_(width) {
  for (const BakedMedium& m : optics.clear()) {
    index_.push_back(std::sqrt(double{m.index_squared[optics.state().knots[0]]}));
    delay_.push_back(m.group_index);
  }
}

void ClearMatter::start(uint32_t p, Vec3 origin, double time) {
  stacks_[p] = bodies_.around(origin, time, statistics_);
}

void ClearMatter::emit_within(uint32_t p, std::span<float> emission) const {
  const uint32_t medium = stacks_[p].medium(kNone);
  if (medium == kNone) return;
  const std::vector<float>& squared = optics_.clear()[medium].index_squared;
  for (size_t i = 0; i < emission.size(); ++i) emission[i] *= squared[i];
}

void ClearMatter::begin_way(uint32_t p, bool passes, const Hit& hit, uint32_t material, Dir in) {
  way_ = stacks_[p];
  if (passes) cross_way(hit, material, in);
}

}  // namespace suite
