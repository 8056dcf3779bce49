// Tracers by time window; see tracer.h.
#include <algorithm>

#include "trace/embree_internal.h"

namespace suite {

struct TracerCache::Kept {
  TimeSpan window;
  std::shared_ptr<const Tracer> tracer;
};

namespace {
constexpr size_t kKept = 4;

// Nothing moves, comes or goes within the window: one pose each, or none.
bool at_rest(const MovingPart& part) {
  return std::all_of(part.nodes.begin(), part.nodes.end(),
                     [](const MovingPart::Keys& k) { return k.at_rest() && !k.partly; });
}
}  // namespace

TracerCache::TracerCache(std::shared_ptr<const Scene> scene, std::optional<Periodic> periodic,
                         std::shared_ptr<const HitFilter> filter, const TileLimit& limit)
    : world_(std::make_shared<const World>(std::move(scene), periodic, std::move(filter), limit, kUnfoldedAtMost)) {}
TracerCache::~TracerCache() = default;
TileUse TracerCache::tile_use() const { return world_->memory ? world_->memory->use() : TileUse{}; }

std::shared_ptr<const Tracer> TracerCache::get(TimeSpan window) {
  const auto recent = [&](size_t k) {
    std::rotate(kept_.begin() + static_cast<long>(k), kept_.begin() + static_cast<long>(k) + 1, kept_.end());
    return kept_.back()->tracer;
  };
  const bool moves = world_->flat.fixed != world_->flat.objects.size();
  if (moves) check_motion(*world_->scene, window.begin, window.end, {});
  for (size_t k = 0; k < kept_.size(); ++k) {
    const Kept& kept = *kept_[k];
    if (!moves || (kept.window.begin == window.begin && kept.window.end == window.end)) return recent(k);
    // Two windows are alike when everything rests in both, in the same places, and the same things are absent.
    const MovingPart& part = *kept.tracer->moving_;
    if (!at_rest(part)) continue;
    bool same = true;
    for (uint32_t n = 0; n < part.nodes.size() && same; ++n) {
      const MovingPart::Keys& there = part.nodes[n];
      if (!there.used) continue;
      const Presence now = world_->presence_of(n, window);
      if (now.any != now.all || now.any == there.absent())
        same = false;
      else if (now.any)
        same = world_->pose(n, window.begin) == there.poses.front() &&
               MovingPart::keys_of(*world_, window, n, there.radius).at_rest();
    }
    if (same) return recent(k);
  }
  if (kept_.size() >= kKept) kept_.erase(kept_.begin());
  ++builds_;
  kept_.push_back(std::make_unique<Kept>(Kept{window, std::shared_ptr<const Tracer>(new Tracer(world_, window))}));
  return kept_.back()->tracer;
}

}  // namespace suite
