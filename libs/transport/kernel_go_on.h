// Definitions of kernel.h: continuations.
#pragma once
#include <algorithm>
#include <cmath>
#include <utility>

#include "transport/kernel_end.h"

namespace suite {

// Draws where all paths of the stage go on.
template <class Wave>
void PathKernel<Wave>::go_on() {
  for (size_t i = 0; i < wave_.nodes.size(); ++i) {
    const auto& u = wave_.paths[wave_.nodes[i].path].u;
    wave_.surfaces.prepare(i, {u[0], u[1]});
  }
  wave_.surfaces.prepare_all(wave_.nodes.size());
  if (Space::kGoesBack || techniques_.splitting.on()) in_stage_ = active_;
  active_.resize(onward_.size() + wave_.nodes.size());
  size_t n = std::copy(onward_.begin(), onward_.end(), active_.begin()) - active_.begin();
  for (size_t i = 0; i < wave_.nodes.size(); ++i)
    if (go_on(i)) active_[n++] = wave_.nodes[i].path;
  active_.resize(n);
}

// Those that had to wait go on, and ended ones are taken up again.
template <class Wave>
void PathKernel<Wave>::end_stage() {
  techniques_.chains.go_on_settled([&](size_t i, const Continuation& on) {
    if (!go_on(i, on)) std::erase(active_, wave_.nodes[i].path);
  });
  if (techniques_.splitting.on()) techniques_.splitting.take_up_ended(wave_, in_stage_, active_);
  techniques_.residual.go_back(wave_, in_stage_, active_);
  first_stage_ = false;
}

// One path; false when it ends here. One that has to wait goes on when the stage ends.
template <class Wave>
bool PathKernel<Wave>::go_on(size_t i) {
  wave_.records[wave_.nodes[i].path].end = PathEnd::absorbed;
  if (techniques_.splitting.on()) branch(i);
  Continuation on;
  if (!draw(i, on)) return false;
  return techniques_.chains.settle(wave_, techniques_.manifold, i, on) || go_on(i, on);
}

template <class Wave>
bool PathKernel<Wave>::go_on(size_t i, const Continuation& on) {
  const uint32_t p = wave_.nodes[i].path;
  Path& path = wave_.paths[p];
  const double own = on.density[path.knot];
  if (own <= 0) return false;
  double brightest = 0;
  const double shares = weigh(p, on, own, brightest);
  if (std::isnan(own) || std::isnan(brightest)) return fail(p);
  if (brightest <= 0 && wave_.bins == 1) return false;  // nothing more can arrive
  const double alive = survives(p, brightest * on.bright * ahead(i, on));
  if (alive == 0 || cut(i, on)) return false;
  path.before = 1 / shares;
  path.last_density = on.dirac ? 0 : own;
  const bool medium = wave_.nodes[i].event;
  Event event{-path.direction, on.in, medium ? kNone : wave_.surfaces.material(p), medium, on.dirac};
  if constexpr (Wave::kStokes) event.polarised = wave_.polarise(wave_.nodes[i], on.in, on.dirac ? &on : nullptr);
  wave_.throughputs.turn(p, event);
  wave_.throughputs.scatter(p, {static_cast<float>(on.weight.scale / (own * shares * alive)), on.weight.spectrum},
                            event);
  const bool passed = leave(i, on);
  if (passed && techniques_.splitting.on() && techniques_.manifold.on() && path.order() == 1)
    techniques_.splitting.part(wave_, p);
  return true;
}

// Brings r_k and the throughputs at the knots behind the event, divided by A; returns A.
template <class Wave>
double PathKernel<Wave>::weigh(uint32_t p, const Continuation& on, double own, double& brightest) {
  Path& path = wave_.paths[p];
  const auto scatter = [&](size_t k) {
    const float w = on.weight.spectrum ? on.weight.spectrum[wave_.heroes.bins[k]] : 1;
    path.throughput[k] *= double{on.weight.scale} * w / own;
  };
  if constexpr (Surfaces::kKnots == 1) {
    scatter(0);
    brightest = path.throughput[0];
    return 1;
  }
  const bool two_ways = Space::kMedia && (on.branch != Branch::none || on.sided);
  if (two_ways) path.other.set(wave_.knots(), path.relative, on.other, own);
  const double shares = path.relative.take_mean(wave_.P(), on.density, own);
  path.relative.divide(wave_.knots(), shares);
  if (two_ways) path.other.divide(wave_.knots(), shares);
  for (size_t k = 0; k < wave_.knots(); ++k) {
    scatter(k);
    path.throughput[k] /= shares;
    if (!(path.throughput[k] <= brightest)) brightest = path.throughput[k];
    if (std::isnan(brightest)) return shares;
  }
  return shares;
}

template <class Wave>
bool PathKernel<Wave>::draw(size_t i, Continuation& on) {
  const PathNode& node = wave_.nodes[i];
  constexpr bool kDraws = Surfaces::kDense > 0 || Space::kScatters;
  const std::span<float> memory = kDraws ? wave_.dense(node.path) : std::span<float>{};
  if (!draw(i, memory, on)) return false;
  if (kDraws && on.weight.spectrum != memory.data()) wave_.throughputs.give_back(node.path);
  auto& guide = techniques_.guide;
  using Guide = std::remove_reference_t<decltype(guide)>;
  if (guide.guides(wave_, node) && on.branch == Branch::none) guide.share(wave_, node, Guide::Way::own, on);
  if (goes_to_end(node)) techniques_.ends.share(wave_, node, on);
  return true;
}

template <class Wave>
bool PathKernel<Wave>::draw(size_t i, std::span<float> memory, Continuation& on) {
  const PathNode& node = wave_.nodes[i];
  const Path& path = wave_.paths[node.path];
  const Vec2 u{path.u[0], path.u[1]};
  if constexpr (Space::kScatters) {
    if (node.event) {
      const double who = dimensions::of_flight(path.stream, path.sample, path.flights)[2];
      if (!wave_.space.sample(node.path, path, u, who, memory, on)) return false;
      techniques_.side.share(wave_, node, on);
      return true;
    }
  }
  const double lobe_u = wave_.surfaces.needs_lobe(node.path) ? wave_.numbers(node, dimensions::kOfSecond)[0] : 0;
  if constexpr (Surfaces::kDense > 0)
    if (techniques_.manifold.on() && wave_.is_first(node) && techniques_.manifold.is_interface(wave_, node))
      if (const auto drawn = draw_at_interface(node, lobe_u, memory, on)) return *drawn;
  if constexpr (Surfaces::kDense > 0)
    if (techniques_.caustics.guides(wave_, node)) return techniques_.caustics.draw(wave_, i, u, lobe_u, memory, on);
  return wave_.surfaces.sample(i, node.path, wave_.hits[node.slot], -path.direction, u, lobe_u, path.knot, memory, on);
}

template <class Wave>
bool PathKernel<Wave>::leave(size_t i, const Continuation& on) {
  const PathNode& node = wave_.nodes[i];
  const uint32_t p = node.path;
  Path& path = wave_.paths[p];
  path.branch = on.branch, path.sided = on.sided;
  if (techniques_.manifold.on()) leave_claims(node, on);
  if (wave_.waters.any()) path.water = wave_.water_behind(node, on.in);
  if constexpr (Space::kScatters) {
    ++path.flights;
    if (node.event) {
      path.points_apart = false;
      path.origin = wave_.space.place(p);
      path.direction = on.in;
      return false;
    }
  }
  const Hit& hit = wave_.hits[node.slot];
  path.events |= on.dirac ? by_surface | by_dirac : by_surface;
  path.smooth += on.dirac;
  const bool passed = wave_.passes(node, on);
  if (path.points_apart) path.points_apart = mirrors_ && mirrors_->follow(path, hit, passed, on.dirac);
  if (passed) wave_.space.cross(p, hit, wave_.surfaces.material(p), on.in);
  path.origin = wave_.surface.tracer().leave(hit, on.in);
  path.arrival += wave_.space.delay(p) * step_along(hit, on.in);
  path.direction = on.in;
  return passed;
}

}  // namespace suite
