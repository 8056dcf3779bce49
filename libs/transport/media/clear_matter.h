// Clear matter around paths where no medium is named: what interfaces given by an index alone enclose
// (Optics::medium_behind). It weakens no light, but holds none of the air, and what shines in it shines by its squared
// index.
#pragma once
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "surface/surface.h"
#include "transport/media/bodies.h"

namespace suite {

class ClearMatter {
 public:
  // Null where there is none. width: of paths.
  static std::unique_ptr<ClearMatter> of(const Surface& surface, const Optics& optics, size_t width);
  ClearMatter(const Surface& surface, const Optics& optics, size_t width);

  // Puts a new path into the bodies around its origin.
  void start(uint32_t p, Vec3 origin, double time);
  void cross(uint32_t p, const Hit& hit, uint32_t material, Dir in) {
    bodies_.transmit(stacks_[p], hit, material, in, statistics_);
  }
  bool around(uint32_t p) const { return stacks_[p].medium(kNone) != kNone; }
  double index(uint32_t p) const { return of(index_, stacks_[p]); }
  double delay(uint32_t p) const { return of(delay_, stacks_[p]); }  // group index
  void emit_within(uint32_t p, std::span<float> emission) const;

  // Keeps what is around path p, and puts it there again.
  void remember(uint32_t p) { remembered_[p] = stacks_[p]; }
  void resume(uint32_t p) { stacks_[p] = remembered_[p]; }

  // Along a way from where path p stands, which goes through the surface at `hit` if it passes it.
  void begin_way(uint32_t p, bool passes, const Hit& hit, uint32_t material, Dir in);
  void cross_way(const Hit& hit, uint32_t material, Dir in) { bodies_.transmit(way_, hit, material, in, statistics_); }
  bool on_way() const { return way_.medium(kNone) != kNone; }
  double delay_on_way() const { return of(delay_, way_); }
  TraceStatistics take_statistics() { return std::exchange(statistics_, {}); }

 private:
  static double of(const std::vector<double>& values, const MediumStack& stack) {
    const uint32_t medium = stack.medium(kNone);
    return medium == kNone ? 1 : values[medium];
  }
  const Optics& optics_;
  Bodies bodies_;
  std::vector<double> index_, delay_;  // at the reference
  std::vector<MediumStack> stacks_, remembered_;
  MediumStack way_;
  TraceStatistics statistics_;
};

}  // namespace suite
