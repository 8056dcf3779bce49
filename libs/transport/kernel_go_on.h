// Definitions of kernel.h: continuations, roulette, and how paths end.
#pragma once
#include <cmath>
#include <limits>
#include <utility>

#include "transport/kernel.h"

namespace suite {

template <class Surfaces, class Space, class Throughputs, class Estimator>
TraceStatistics PathKernel<Surfaces, Space, Throughputs, Estimator>::take_statistics() {
  TraceStatistics all = space_.take_statistics();
  const TraceStatistics touching = std::exchange(touching_, {});
  all.rays += touching.rays, all.cycles += touching.cycles;
  if (refracted_) {
    const TraceStatistics ways = refracted_->take_statistics();
    all.rays += ways.rays, all.cycles += ways.cycles;
  }
  return all;
}

// Draws where all paths of the stage go on.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::go_on() {
  for (size_t i = 0; i < nodes_.size(); ++i) {
    const auto& u = paths_[nodes_[i].path].u;
    surfaces_.prepare(i, {u[0], u[1]});
  }
  surfaces_.prepare_all(nodes_.size());
  if (Space::kGoesBack || !branches_.empty()) in_stage_ = active_;
  active_.assign(onward_.begin(), onward_.end());
  for (size_t i = 0; i < nodes_.size(); ++i)
    if (go_on(i)) active_.push_back(nodes_[i].path);
  if constexpr (Space::kGoesBack) go_back(in_stage_);
  if (!branches_.empty()) take_up_ended();
}

// One path; false when it ends here.
template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::go_on(size_t i) {
  records_[nodes_[i].path].end = PathEnd::absorbed;
  if (is_guided(nodes_[i])) branch_guided(i);
  if (at_first_interface(nodes_[i])) branch_mirrored(i);
  Continuation on;
  return draw(i, on) && go_on(i, on);
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::go_on(size_t i, const Continuation& on) {
  const uint32_t p = nodes_[i].path;
  Path& path = paths_[p];
  const double own = on.density[path.knot];
  if (own <= 0) return false;
  double brightest = 0;
  const double shares = weigh(p, on, own, brightest);
  if (std::isnan(own) || std::isnan(brightest)) return fail(p);
  if (brightest <= 0 && bins_ == 1) return false;  // nothing more can arrive
  const double alive = survives(p, brightest * on.bright * ahead(i, on));
  if (alive == 0 || cut(i, on)) return false;
  path.before = 1 / shares;
  path.last_density = on.dirac ? 0 : own;
  const bool medium = nodes_[i].event;
  const Event event{-path.direction, on.in, medium ? kNone : surfaces_.material(p), medium, on.dirac};
  throughputs_.turn(p, event);
  throughputs_.scatter(p, {static_cast<float>(on.weight.scale / (own * shares * alive)), on.weight.spectrum}, event);
  const bool passed = leave(i, on);
  if (passed && !branches_.empty() && path.order() == 1) part(p);
  return true;
}

// Brings r_k and the throughputs at the knots behind the event, divided by A; returns A.
template <class Surfaces, class Space, class Throughputs, class Estimator>
double PathKernel<Surfaces, Space, Throughputs, Estimator>::weigh(uint32_t p, const Continuation& on, double own,
                                                                  double& brightest) {
  Path& path = paths_[p];
  for (size_t k = 0; k < knots(); ++k) {
    const float w = on.weight.spectrum ? on.weight.spectrum[knot_bins_[k]] : 1;
    path.throughput[k] *= double{on.weight.scale} * w / own;
  }
  if constexpr (Surfaces::kKnots == 1) {
    brightest = path.throughput[0];
    return 1;
  }
  const bool two_ways = kGuides && (on.branch != Branch::none || on.sided);
  if (two_ways) path.other.set(knots(), path.relative, on.other, own);
  path.relative.take(knots(), on.density, own);
  const double shares = path.relative.mean(P());
  path.relative.divide(knots(), shares);
  if (two_ways) path.other.divide(knots(), shares);
  for (size_t k = 0; k < knots(); ++k) {
    path.throughput[k] /= shares;
    if (!(path.throughput[k] <= brightest)) brightest = path.throughput[k];
    if (std::isnan(brightest)) return shares;
  }
  return shares;
}

// A path that cannot go on because a model gave what is no number: its sample is rejected and counted.
template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::fail(uint32_t p) {
  contribution(p, kFromMatter).scale = std::numeric_limits<float>::quiet_NaN();
  contribute();
  hand_over();
  return false;
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::draw(size_t i, Continuation& on) {
  const NodeAt& node = nodes_[i];
  constexpr bool kDraws = Surfaces::kDense > 0 || Space::kScatters;
  const std::span<float> memory = kDraws ? dense(node.path) : std::span<float>{};
  if (!draw(i, memory, on)) return false;
  if (kDraws && on.weight.spectrum != memory.data()) throughputs_.give_back(node.path);
  if (kGuides && is_guided(node) && on.branch == Branch::none) share_with_guide(node, false, on);
  settle_sky(i, on);
  return true;
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::draw(size_t i, std::span<float> memory, Continuation& on) {
  const NodeAt& node = nodes_[i];
  const Path& path = paths_[node.path];
  const Vec2 u{path.u[0], path.u[1]};
  if constexpr (Space::kScatters) {
    if (node.event) {
      const double who = dimensions::of_flight(path.stream, path.sample, path.flights)[2];
      return space_.sample(node.path, path, u, who, memory, on) && share_with_side(node, on);
    }
  }
  const double lobe_u = surfaces_.needs_lobe(node.path) ? numbers(node, dimensions::kOfSecond)[0] : 0;
  if constexpr (Surfaces::kDense > 0)
    if (refracted_ && is_first(node) && refracted_->interfaces().has(surfaces_.material(node.path))) {
      // What water mirrors is weak, but in dark bands all there is. A power of 1/2: counts of strata have no rest.
      constexpr double kLeast = 0.125;
      const Dir out = -path.direction;
      const int mirror = refracted_->interfaces().lobe(surfaces_.material(node.path), true);
      if (mirror != SmoothInterfaces::kNoLobe && branches_.empty())
        return surfaces_.sample_either(node.path, out, mirror, kLeast, lobe_u, path.knot, memory, on);
      if (mirror != SmoothInterfaces::kNoLobe) {  // beside what branch_mirrored() has kept
        const bool all = surfaces_.mirrors(node.path, out, mirror, path.knot) >= 1;
        return surfaces_.sample_way(node.path, out, mirror, all, path.knot, memory, on);
      }
    }
  if constexpr (Surfaces::kDense > 0)
    if (gloss_of(node).cell) return draw_with_gloss(i, u, lobe_u, memory, on);
  return surfaces_.sample(i, node.path, hits_[node.slot], -path.direction, u, lobe_u, path.knot, memory, on);
}

// How much more of its light a path is worth to roulette that comes to a smooth surface from within water: most leave
// there, with the light of a sky that nobody asks for through the surface, and end; to end them first saves next to
// nothing. A value of 6 takes 0.5 to 0.7 of the work to an error in the bay of sample_scenes, coastal to red.
template <class Surfaces, class Space, class Throughputs, class Estimator>
double PathKernel<Surfaces, Space, Throughputs, Estimator>::ahead(size_t i, const Continuation& on) const {
  if constexpr (kGuides) {
    constexpr double kLeaves = 6, kClaimed = 0.1;
    const double index = space_.index(nodes_[i].path);
    if (passes_into_claimed_sky(i, on)) return kClaimed;  // what others bring is not worth while
    if (!branches_.empty() && on.dirac && index > 1) return kLeaves * index * index;
  }
  return 1;
}

// The probability with which the path has survived; 0 when roulette ends it.
template <class Surfaces, class Space, class Throughputs, class Estimator>
double PathKernel<Surfaces, Space, Throughputs, Estimator>::survives(uint32_t p, double brightest) {
  Path& path = paths_[p];
  const double alive = Estimator::survival(brightest, path.order(), options_.roulette_after);
  if (alive == 1) return 1;
  if (path.stream.hashed(path.sample, dimensions::roulette(path.order() - 1)) >= alive) {
    records_[p].end = PathEnd::roulette;
    return 0;
  }
  for (size_t k = 0; k < knots(); ++k) path.throughput[k] /= alive;
  return alive;
}

// Whether the path has as many nodes as it may have. Of two branches to the next scattering the open one would bring
// all light by itself.
template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::cut(size_t i, const Continuation& on) {
  const bool event = nodes_[i].event;
  const uint32_t p = nodes_[i].path;
  const Path& path = paths_[p];
  const uint32_t most = event ? options_.max_scatterings : static_cast<uint32_t>(options_.max_nodes);
  if (most == 0 || (event ? path.scatterings : path.surfaces) < most) return false;
  records_[p].end = PathEnd::max_nodes;
  leave(i, on);
  const double index = space_.index(p);
  if (on.branch != Branch::forced) records_[p].truncated += path.throughput[0] * path.share * index * index;
  return true;
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::leave(size_t i, const Continuation& on) {
  const NodeAt& node = nodes_[i];
  const uint32_t p = node.path;
  Path& path = paths_[p];
  path.branch = on.branch, path.sided = on.sided;
  if (refracted_) leave_claims(node, on);
  if (waters_.any()) path.water = water_behind(node, on.in);
  if constexpr (Space::kScatters) {
    ++path.flights;
    if (node.event) {
      path.origin = space_.place(p);
      path.direction = on.in;
      return false;
    }
  }
  const Hit& hit = hits_[node.slot];
  path.events |= on.dirac ? by_surface | by_dirac : by_surface;
  path.smooth += on.dirac;
  const bool passed = passes(node, on);
  if (passed) space_.cross(p, hit, surfaces_.material(p), on.in);
  path.origin = surface_.tracer().leave(hit, on.in);
  path.arrival += space_.delay(p) * step_along(hit, on.in);
  path.direction = on.in;
  return passed;
}

}  // namespace suite
