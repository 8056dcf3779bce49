// Definitions of kernel.h: continuations in media towards where light comes from that interfaces bend.
//
// Water scatters forwards: what comes to a place from a small sun is a disk and a bright surround, the shape of the
// phase function about the direction of the way to the sun (kernel_refract.h). Surfaces draw directions without knowing
// of it, and would meet it seldom. So where a node has found such a way, a share s of its continuations is drawn as the
// medium scatters what comes along the way (density g), the others as the node does (density p): the density of all is
//   (1 - s) p + s g
// for continuations and for all that is shared with them. s follows from how much of the light is scattered before it
// has come to the interface, and how much of that forwards: from the mean cosine. Roulette takes light from such a
// direction for as much brighter as g is than even light, 1 / 4 pi: else it would end these paths for having a large
// density. Based on: the one-sample model of Veach & Guibas, "Optimally combining sampling techniques for Monte Carlo
// rendering", 1995; directions by incident light: J. Vorba et al., "Path guiding in production", SIGGRAPH 2019 courses.
#pragma once
#include <algorithm>
#include <cmath>

#include "transport/kernel.h"

namespace suite {

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::guide(const RefractedQuestion& q, const RefractedWay& way) {
  if constexpr (kGuides) {
    // A path across to that light has many places to be scattered back from: each takes a little of it. What is not
    // scattered on its way is worth kElse of what is.
    constexpr double kAlong = 0.8, kAcross = 0.1, kElse = 0.1;
    const NodeAt& node = nodes_[q.node];
    Guide& guide = guides_[q.node];
    if (!q.end.far || guide.share > 0) return;
    if (!node.event) {
      const Dir normal = hits_[node.slot].normal;
      if (dot(way.direction, normal) * dot(paths_[node.path].direction, normal) > 0) return;  // other matter is there
      space_.stand(node.path);
    }
    const double depth = space_.scattering(node.path) * way.at[0].length;
    const double forward = std::max(0.0, space_.asymmetry(node.path)), scattered = -std::expm1(-depth);
    if (!(scattered * forward > 0)) return;
    guide = {1, way.direction, !node.event};
    if (guide.branch) return;
    const double along = std::max(0.0, dot(paths_[node.path].direction, way.direction));
    guide.share = (kAcross + (kAlong - kAcross) * along) * forward * scattered / (scattered + kElse * (1 - scattered));
  }
}

// Shares what the node draws itself (on.density: p) with what is guided. forced: it was.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::share_with_guide(const NodeAt& node, bool forced,
                                                                           Continuation& on) const {
  if constexpr (kGuides) {
    const Guide& guide = *guide_of(node);
    const auto open = static_cast<float>(own_share(node)), guided = static_cast<float>(guide.share);
    float forward[kMaxKnots] = {};
    if (!on.dirac) space_.densities(node.path, -guide.toward, on.in, {forward, knots()});
    for (size_t k = 0; k < knots(); ++k) {
      const float p = open * on.density[k], g = guided * forward[k];
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
    if (!node.event && !surfaces_.takes(node.path, hits_[node.slot], -path.direction, on.in)) return false;
    on.dirac = false;
    if (node.event)
      space_.densities(node.path, -path.direction, on.in, {on.density, knots()});
    else
      surfaces_.densities(node.path, -path.direction, on.in, {on.density, knots()});
    on.weight = evaluate(node, on.in, memory);
    return true;
  }
  return false;
}

}  // namespace suite
