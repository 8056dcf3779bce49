// Definitions of kernel.h: caustics by photon guiding (gloss_guide.h). A surface in such light draws a share of its
// continuations where photons came from, the others as it draws itself; both have the density of the mixture.
#pragma once
#include <algorithm>
#include <cmath>

#include "transport/kernel.h"

namespace suite {

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::find_gloss() {
  gloss_of_node_.resize(nodes_.size());
  for (size_t i = 0; i < nodes_.size(); ++i) gloss_of_node_[i] = gloss_at(nodes_[i]);
}

// Surfaces that draw hardly any directions there by themselves have little use for what they find there.
template <class Surfaces, class Space, class Throughputs, class Estimator>
auto PathKernel<Surfaces, Space, Throughputs, Estimator>::gloss_at(const NodeAt& node) const -> GlossShare {
  if (node.event || surfaces_.is_sharp(node.path)) return {};
  const Hit& hit = hits_[node.slot];
  const GlossGuide::Cell* cell = gloss_->at(hit.position);
  if (!cell) return {};
  const Vec3 way = cell->middle(hit.position);
  const double distance = length(way);
  if (!(distance > 0)) return {};
  const Dir in = way / distance, out = -paths_[node.path].direction;
  float density[kMaxKnots] = {};
  surfaces_.densities(node.path, out, in, {density, knots()});
  const double matte = std::fabs(dot(in, hit.normal)) / kPi;
  const double uses = matte > 0 ? std::min(1.0, double{density[0]} / matte) : 0;
  constexpr double kLeast = 0.01;
  const double share = cell->share() * uses;
  return share > kLeast ? GlossShare{cell, share} : GlossShare{};
}

// density: as the surface draws; becomes that of both.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::share_with_gloss(const NodeAt& node, Dir in,
                                                                           std::span<float> density) const {
  const GlossShare gloss = gloss_of(node);
  if (!gloss.cell) return;
  const auto share = static_cast<float>(gloss.share);
  const float there = share * gloss.cell->density(hits_[node.slot].position, in);
  for (float& p : density) p = (1 - share) * p + there;
}

// Draws by either.
template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::draw_with_gloss(size_t i, Vec2 u, double lobe_u,
                                                                          std::span<float> memory, Continuation& on) {
  const NodeAt& node = nodes_[i];
  const Path& path = paths_[node.path];
  const auto [cell, share] = gloss_of(node);
  const Hit& hit = hits_[node.slot];
  const Dir out = -path.direction;
  if (u.x < share) {
    on.in = cell->draw(hit.position, {u.x / share, u.y});
    if (!surfaces_.takes(node.path, hit, out, on.in)) return false;
    on.dirac = false;
    surfaces_.densities(node.path, out, on.in, {on.density, knots()});
    on.weight = evaluate(node, on.in, memory);
  } else if (!surfaces_.sample(i, node.path, hit, out, {(u.x - share) / (1 - share), u.y}, lobe_u, path.knot, memory,
                               on)) {
    return false;
  }
  const double own = double{on.density[path.knot]};
  share_with_gloss(node, on.in, {on.density, knots()});
  // Roulette looks at the light that a path may find, not at how often it is sent there.
  if (own > 0) on.bright = double{on.density[path.knot]} / own;
  return true;
}

}  // namespace suite
