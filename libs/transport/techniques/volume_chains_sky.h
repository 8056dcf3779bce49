// Definitions of techniques/volume_chains.h: the light of the air's sky, and which paths chance may bring it to.
#pragma once
#include <algorithm>

#include "transport/techniques/volume_chains.h"

namespace suite {

template <class Wave>
uint32_t VolumeChains<Wave>::draw_sky(Wave& wave, Manifold<Wave>& manifold, const PathNode& node, uint32_t& first) {
  first = held_;
  const SkyThroughWater* const sky = on_ ? wave.space.hidden_sky() : nullptr;
  const Path& path = wave.paths[node.path];
  if (!sky || !manifold.asks_through(wave, node) || !wave.space.even_around(node.path)) return held_;
  if (path.claims.stands(Technique::volume_chains)) return held_;
  const Vec3 place = manifold.from_node(wave, node).place;
  const double deep = manifold.sight().below_sheet(place);
  if (!(deep > 0)) return held_;
  const Dir up = manifold.sight().sheet_axis();
  const uint32_t mean = mean_toward(wave, node, up, deep);
  if (mean == kNone) return held_;
  claims_[wave.number_of(node)].add(Claim::chains_of_sky(kMostLinks), ClaimCone{!node.event, path.direction, up},
                                    kReach * deep);
  if constexpr (Wave::kWatched)
    for (size_t k = 0; k < wave.knots(); ++k)
      wave.throughputs.ask(node.path, Technique::volume_chains, ClaimedLight::sky(), k, &claims_[wave.number_of(node)]);
  const std::array<double, 4> u = chain_numbers(path, node, ClaimedLight::Kind::sky, dimensions::kOfChainsSky);
  const DirectionSample sample = sky->draw(static_cast<size_t>(path.knot), {u[2], u[3]});
  if (!(sample.density > 0)) return held_;
  for (size_t k = 0; k < wave.knots(); ++k) {
    if (manifold.is_alive(wave, path, k)) draw_sky(wave, manifold, node, k, *sky, sample.direction, deep, mean);
  }
  return held_;
}

template <class Wave>
void VolumeChains<Wave>::draw_sky(Wave& wave, Manifold<Wave>& manifold, const PathNode& node, size_t knot,
                                  const SkyThroughWater& sky, Dir to, double deep, uint32_t mean) {
  const RefractedQuestion q{
      static_cast<uint32_t>(wave.number_of(node)), Wave::Space::kEmitter, false, {to, {}}, 1, nullptr, 0, true};
  const auto toward = manifold.sight().sheet_guess(to, knot);
  if (!toward) return;
  if (!draw_chain(wave, node, *toward, deep / manifold.sight().steepness(*toward), mean, ClaimedLight::Kind::sky))
    return;
  double density[kMaxKnots];
  sky.densities(to, {density, wave.knots()});
  chain_.share.take(wave.knots(), density, 1);
  const NodeClaims& claims = claims_[q.node];
  if (chain_.links > 0) {
    if (claims.are_for(chain_.toward[0])) follow_chain(wave, manifold, q, knot);
    return;
  }
  hold(q, knot).question.scale /= chain_.share.mean(wave.P());
  ++held_;
}

template <class Wave>
bool VolumeChains<Wave>::passes_into_claimed_sky(const Wave& wave, const Manifold<Wave>& manifold, size_t i,
                                                 const Continuation& on) const {
  const PathNode& node = wave.nodes[i];
  const Path& path = wave.paths[node.path];
  return !path.claims.empty() && on.dirac && !node.event && wave.passes(node, on) &&
         owner(path.claims.all(), path.claims.behind_interface(false), ClaimedLight::sky(), manifold.hero_of(path)) !=
             Technique::chance;
}

template <class Wave>
bool VolumeChains<Wave>::settle(const Wave& wave, Manifold<Wave>& manifold, size_t i, const Continuation& on) {
  if (!passes_into_claimed_sky(wave, manifold, i, on)) return false;
  settling_.push_back({i, on}), settling_searches_.add();
  return true;
}

template <class Wave>
bool VolumeChains<Wave>::begin_settling(const Wave& wave, Manifold<Wave>& manifold, const Settling& of,
                                        RefractedSearch& s) const {
  const Path& path = wave.paths[wave.nodes[of.node].path];
  s.ways = 0;
  double density[kMaxKnots], any = 0;  // below the horizon it is never drawn
  wave.space.hidden_sky()->densities(of.on.in, {density, wave.knots()});
  for (size_t k = 0; k < wave.knots(); ++k) any += path.relative[k] * density[k];
  if (!(any > 0)) return false;
  WayStart from;
  from.place = path.origin - path.direction * path.claims.suffix().flown_m;
  from.time = path.time, from.draw = path.draw;
  return manifold.sight().begin_first(s, from, of.on.in, manifold.hero_of(path));
}

template <class Wave>
bool VolumeChains<Wave>::next_settled(Wave& wave, Manifold<Wave>& manifold, TraceRequest& request) {
  if (settling_.empty()) return false;
  const auto on = [&](uint32_t i, RefractedSearch& s, Hit* hit) {
    const Settling& of = settling_[i];
    if (hit ? manifold.sight().step(s, *hit) : begin_settling(wave, manifold, of, s)) return true;
    Path& path = wave.paths[wave.nodes[of.node].path];
    if (RefractedSight::leaves_along(s, path.direction)) return false;
    path.claims.give_up_sky();
    if constexpr (Wave::kWatched) wave.throughputs.take_other_way(wave.nodes[of.node].path);
    return false;
  };
  return settling_searches_.next(request, on);
}

}  // namespace suite
