// Definitions of kernel.h: what a path tells the claims on its light (path/claims.h).
#pragma once
#include "transport/kernel.h"

namespace suite {

// The claims on the light that the path may meet behind the node.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::leave_claims(const NodeAt& node, const Continuation& on) {
  constexpr Claim kManifold = Claim::manifold(RefractedWay::kMostEvents);
  PathClaims& claims = paths_[node.path].claims;
  const Guide* const guide = guide_of(node);
  const NodeClaims* const made = guide ? &guide->claims : nullptr;
  if (node.event) {
    if (Space::kGoesBack) return claims.clear();  // it asks for nothing through interfaces
    return claims.leave_scattering(made, kManifold, on.in);
  }
  if (is_interface(node)) return claims.meet_interface(!passes(node, on));
  // Nodes ask for what comes by other than Dirac lobes.
  if (!on.dirac) claims.leave_surface(made, kManifold, on.in);
}

// Whether the path goes through the smooth interface of node i to light of the air's sky that chains may bring.
template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::passes_into_claimed_sky(size_t i,
                                                                                  const Continuation& on) const {
  if constexpr (kGuides) {
    const NodeAt& node = nodes_[i];
    const Path& path = paths_[node.path];
    return !path.claims.empty() && on.dirac && !node.event && passes(node, on) &&
           owner(path.claims.all(), path.claims.behind_interface(false), ClaimedLight::sky(), hero_of(path)) !=
               Technique::chance;
  }
  return false;
}

// Gives up the claim on such light where chains look for another way through the interface than the path's, or for
// none.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::settle_sky(size_t i, const Continuation& on) {
  if constexpr (kGuides) {
    if (!passes_into_claimed_sky(i, on)) return;
    Path& path = paths_[nodes_[i].path];
    double density[kMaxKnots], any = 0;  // below the horizon it is never drawn
    space_.hidden_sky()->densities(on.in, {density, knots()});
    for (size_t k = 0; k < knots(); ++k) any += path.relative[k] * density[k];
    RefractedSight::Node from;
    from.place = path.origin - path.direction * path.claims.suffix().flown_m;
    from.time = path.time, from.draw = path.draw;
    if (!(any > 0 && refracted_->is_first_through_sheet(from, path.direction, on.in, hero_of(path))))
      path.claims.give_up_sky();
  }
}

}  // namespace suite
