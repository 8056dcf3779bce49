// Definitions of kernel.h: continuations in media towards where light comes from that interfaces bend.
//
// Water scatters forwards: what comes to a place from a small sun is a disk and a bright surround, the shape of the
// phase function about the direction of the way to the sun (kernel_refract.h). Surfaces draw directions without knowing
// of it, and would meet it seldom. So where one has found such a way, it is left twice (kernel_branch.h): as it draws
// itself (density p), and as the medium scatters what comes along the way (density g). Roulette takes light from such a
// direction for as much brighter as g is than even light, 1 / 4 pi: else it would end these paths for having a large
// density. Scatterings are not guided: mixing p and g there was 0.4 % too bright under waves in real air, and no less
// noisy. Based on: J. Vorba et al., "Path guiding in production", SIGGRAPH 2019 courses.
#pragma once
#include <algorithm>
#include <cmath>

#include "transport/kernel.h"

namespace suite {

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::guide(const RefractedQuestion& q, const RefractedWay& way) {
  if constexpr (kGuides) {
    const NodeAt& node = nodes_[q.node];
    Guide& guide = guides_[q.node];
    if (node.event || !q.end.far || guide.branch) return;
    const Dir normal = hits_[node.slot].normal;
    if (dot(way.direction, normal) * dot(paths_[node.path].direction, normal) > 0) return;  // other matter is there
    space_.stand(node.path);
    if (space_.scattering(node.path) * way.at[0].length > 0 && space_.asymmetry(node.path) > 0)
      guide.branch = true, guide.toward = way.direction;
  }
}

// Shares what the surface draws itself (on.density: p) with what is guided. forced: it was.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::share_with_guide(const NodeAt& node, bool forced,
                                                                           Continuation& on) const {
  if constexpr (kGuides) {
    const Guide& guide = *guide_of(node);
    float forward[kMaxKnots] = {};
    if (!on.dirac) space_.densities(node.path, -guide.toward, on.in, {forward, knots()});
    for (size_t k = 0; k < knots(); ++k) {
      const float p = on.density[k], g = forward[k];
      on.density[k] = forced ? g : p;
      on.other[k] = forced ? p : g;
    }
    on.branch = forced ? Branch::forced : on.dirac ? Branch::none : Branch::open;
    on.bright = 1 + 4 * kPi * double{forward[0]};
  }
}

// Draws a direction about that of the light.
template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::draw_guided(const NodeAt& node, Vec2 u, double who,
                                                                      std::span<float> memory, Continuation& on) {
  if constexpr (kGuides) {
    const Path& path = paths_[node.path];
    if (!space_.scatter(node.path, -guide_of(node)->toward, path.knot, u, who, on.in)) return false;
    if (!surfaces_.takes(node.path, hits_[node.slot], -path.direction, on.in)) return false;
    on.dirac = false;
    surfaces_.densities(node.path, -path.direction, on.in, {on.density, knots()});
    on.weight = evaluate(node, on.in, memory);
    return true;
  }
  return false;
}

}  // namespace suite
