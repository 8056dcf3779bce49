// Definitions of kernel.h: multi-vertex (joint) volumetric next-event estimation (NEE): light that comes to a surface
// through water that scatters it on its way.
// Water scatters forwards, several times on a way of some metres, and what comes to a place from a small sun is as
// likely to have been scattered 0, 1, 2 or n times. A path that looks for it from the place draws directions without
// knowing whether they will end near the sun's. So they are drawn from its end: where a node has found a way to the
// light (kernel_refract.h), of direction s and length L in the matter beside the node, it also draws a chain of
//   n scatterings, 1 <= n <= kMostLinks, with probability P_k(n), most of it ~ t^n / n!, t = L times the scattering
//     coefficient (chain_laws.h),
//   directions d_n as matter scatters what comes along s, d_(n-1) what comes along d_n, ..., d_1 from the node, and
//   places: the next scattering is put at a share x of the way up to the next surface, or to kReach L, with a density
//     that makes n places even on a way as steep as the light's, and that falls as light does on flatter ones.
// From the last place the light is asked for as from a node. The phase functions are those of the densities but for the
// last one, of which the way may come from another direction than s; in the mean Poisson's law, places and
// transmittance make one another's factors up as well, if matter scatters forwards. What is left varies little. Such
// chains take all light of its kind: up to kMostLinks scatterings on flights of kReach L at most that meet no surface.
// They claim it (path/claims.h). Matter must let some light through unscattered
// (kDeepest) and be the same everywhere beside the node, or in layers: boundaries that bend nothing are passed, chains
// are drawn from the mean of what lies on the light's way, and count with what is there.
//
// The sky of the air is asked for in the same way, 0 <= n, towards a direction above the water that the path's knot has
// drawn (sky_through_water.h), where the scene's only refractor is a sheet. Light from there may come through waves in
// several ways; the one that Newton's method finds first is asked for, unless it is much focused, and chance keeps the
// others (settle_sky). Both lights are asked for by scatterings as well, for what comes from more than half
// way round towards the light: a path that runs away from it would have to turn round by chance, which forward
// scattering does rarely. What comes from further ahead (ClaimCone) is left to where the path goes on. Based on: paths
// drawn from the light's end on a given number of scatterings: I. Georgiev et al., "Joint importance sampling of
// low-order volumetric scattering", ACM TOG 32(6), 2013; order statistics of Poisson's process: L. Devroye,
// "Non-uniform random variate generation", 1986, chapter VI.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "light/sky_through_water.h"
#include "transport/kernel.h"

namespace suite {

// Whether the light has been asked for so.
template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::ask_along_chain(const RefractedQuestion& q, Dir toward,
                                                                          double length, size_t knot) {
  if constexpr (kGuides && Surfaces::kDense > 0) {
    const NodeAt& node = nodes_[q.node];
    const Path& path = paths_[node.path];
    if (!options_.volume_chains || branches_.empty() || !q.end.far || !space_.even_around(node.path)) return false;
    if (path.claims.stands(Technique::volume_chains)) return false;
    const Dir normal = hits_[node.slot].normal;
    if (!node.event && dot(toward, normal) * dot(path.direction, normal) > 0) return false;  // other matter is there
    NodeClaims& claims = guides_[q.node].claims;
    constexpr auto kSmall = ClaimedLight::Kind::small;
    if (const Claim* const claim = claims.of(kSmall); claim && claim->light != q.light) return false;
    const uint32_t mean = mean_toward(node, toward, length);
    if (mean == kNone) return false;
    if (!claims.of(kSmall))
      claims.add(Claim::chains(q.light, kMostLinks, RefractedWay::kMostEvents), cone_of(node, q.light, knot),
                 kReach * length);
    claims.add_hero(kSmall, knot);
    if (draw_chain(node, toward, length, mean, false) && claims.are_for(chain_.toward[0])) follow_chain(q, knot);
    return true;
  }
  return false;
}

// The mean of the matter on `length` m towards the light as an event; kNone where it is of no use for chains.
template <class Surfaces, class Space, class Throughputs, class Estimator>
uint32_t PathKernel<Surfaces, Space, Throughputs, Estimator>::mean_toward(const NodeAt& node, Dir toward,
                                                                          double length) {
  if constexpr (kGuides) {
    space_.begin_way(node.path, true, {}, kNone, {}, {});
    const uint32_t mean = space_.mean_of_way(ray_from(node, toward), length);
    if (!(space_.asymmetry(mean) > kForwards)) return kNone;
    for (size_t k = 0; k < knots(); ++k) {
      const double depth = space_.scattering(mean, k) * length;
      if (!(depth > 0 && depth < kDeepest)) return kNone;
    }
    return mean;
  }
  return kNone;
}

// Number and directions of scatterings.
template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::draw_chain(const NodeAt& node, Dir toward, double length,
                                                                     uint32_t mean, bool sky) {
  if constexpr (kGuides) {
    const Path& path = paths_[node.path];
    Chain& chain = chain_;
    chain.mean = mean;
    const auto own = static_cast<size_t>(path.knot);
    const std::array<double, 4> u = chain_numbers(path, node.event, sky, dimensions::of_link(0, sky));
    const int least = sky ? 0 : 1;
    const auto count = [&](size_t k) {
      return LinkCount(space_.scattering(mean, k) * length, space_.albedo(mean, k), least, kMostLinks);
    };
    chain.links = count(own).draw(u[3]);
    double of_count[kMaxKnots];
    for (size_t k = 0; k < knots(); ++k) of_count[k] = count(k).probability(chain.links);
    chain.share.set(knots(), path.relative, of_count, 1);
    const auto n = static_cast<size_t>(chain.links);
    chain.toward[n] = toward;
    for (size_t i = n; i-- > 0;) {
      const std::array<double, 4> v =
          i + 1 == n ? u : chain_numbers(path, node.event, sky, dimensions::of_link(n - 1 - i, sky));
      if (!space_.scatter(mean, -chain.toward[i + 1], path.knot, {v[0], v[1]}, v[2], chain.toward[i])) return false;
      float density[kMaxKnots];
      space_.densities(mean, -chain.toward[i + 1], chain.toward[i], {density, knots()});
      chain.density[i] = density[own];
      if (!(density[own] > 0)) return false;
      chain.share.take(knots(), density, double{density[own]});
    }
    return true;
  }
  return false;
}

// A set of numbers of the chain that the path draws at its last surface.
template <class Surfaces, class Space, class Throughputs, class Estimator>
std::array<double, 4> PathKernel<Surfaces, Space, Throughputs, Estimator>::chain_numbers(const Path& path, bool event,
                                                                                         bool sky, uint32_t set) const {
  const uint32_t at = event ? dimensions::kNodes + path.flights : path.surfaces - 1;
  return dimensions::of_chain(path.stream, path.sample, at, sky, set);
}

// To its places; false where it meets what it cannot pass.
template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::follow_chain(const RefractedQuestion& q, size_t knot) {
  if constexpr (kGuides && Surfaces::kDense > 0) {
    const NodeAt& node = nodes_[q.node];
    const uint32_t p = node.path;
    const Path& path = paths_[p];
    Chain& chain = chain_;
    if (options_.max_scatterings > 0 &&
        path.scatterings + static_cast<uint32_t>(chain.links) > options_.max_scatterings)
      return false;
    const Hit& hit = hits_[node.slot];
    if (!node.event && !surfaces_.takes(p, hit, -path.direction, chain.toward[0])) return false;
    chain_through_.resize(bins_);
    const std::span<float> through = chain_through_, memory = dense(p);
    const Factor factor = evaluate(node, chain.toward[0], memory);
    for (size_t i = 0; i < bins_; ++i) through[i] = factor.scale * (factor.spectrum ? factor.spectrum[i] : 1.0f);
    keep_bins_of(knot, through);
    space_.begin_way(p, node.event, hit, node.event ? kNone : surfaces_.material(p), -path.direction, chain.toward[0]);
    double arrival = 0;
    Ray ray = ray_from(node, chain.toward[0]);
    for (size_t i = 0; i < static_cast<size_t>(chain.links); ++i) {
      ray.direction = chain.toward[i];
      const double most = std::min(free_way(ray), guides_[q.node].claims.reach());
      if (!(most > 0)) return throughputs_.give_back(p), false;
      const std::array<double, 4> u =
          chain_numbers(path, node.event, q.sky, dimensions::of_link_place(i, kMostLinks, q.sky));
      const auto own = static_cast<size_t>(path.knot);
      const double x = space_.share_of_way(link_place(q, i, most, own).draw({u[0], u[1]}), most, own);
      const auto density_at = [&](size_t k) {
        const auto at = space_.share_of_depth(x, most, k);
        return link_place(q, i, most, k).density(at.share) * at.change;
      };
      const double density = density_at(own);
      if (!(density > 0)) return throughputs_.give_back(p), false;
      double of_place[kMaxKnots];
      for (size_t k = 0; k < knots(); ++k) of_place[k] = density_at(k);
      chain.share.take(knots(), of_place, density);
      // At once: 24 ways of 100 m each, and as many coefficients of 0.01 1/m, do not fit into floats.
      for (size_t b = 0; b < bins_; ++b) through[b] *= static_cast<float>(most / density);
      arrival += x * most * space_.follow_way(ray, x * most, through, transmission_);
      ray.origin += ray.direction * (x * most);
      if (i + 1 < static_cast<size_t>(chain.links)) scatter_along(i, chain.toward[i + 1], through, memory);
    }
    throughputs_.give_back(p);
    space_.hold_way();
    return shine_behind_chain(q, knot, ray.origin, 1 / chain.share.mean(P()), arrival);
  }
  return false;
}

// By what scattering i of the chain is put on its way of `most` m, at knot k.
template <class Surfaces, class Space, class Throughputs, class Estimator>
LinkPlace PathKernel<Surfaces, Space, Throughputs, Estimator>::link_place(const RefractedQuestion& q, size_t i,
                                                                          double most, size_t k) const {
  if constexpr (kGuides) {
    constexpr double kFlattest = 0.05, kSteep = 2;
    const auto n = static_cast<size_t>(chain_.links);
    const Dir light = chain_.toward[n], up = refracted_->has_sheet() ? refracted_->sheet_axis() : light;
    const double steep = dot(light, up), rise = std::copysign(std::max(kFlattest, std::fabs(steep)), steep),
                 albedo = space_.albedo(chain_.mean, k), extinction = space_.scattering(chain_.mean, k) / albedo,
                 height = guides_[q.node].claims.reach() / kReach;
    const auto more = [&](size_t j) { return extinction * (1 - dot(chain_.toward[j], up) / rise); };  // 1/m
    int others = 0;
    for (size_t j = i + 1; j < n; ++j) others += std::fabs(more(j)) * height < kSteep;
    const double depth = space_.depth_of_way(most, k) / albedo;
    return {depth - extinction * dot(chain_.toward[i], up) / rise * most, others};
  }
  return {0, 0};
}

// Asks for the light from the last place.
template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::shine_behind_chain(const RefractedQuestion& q, size_t knot,
                                                                             Vec3 place, double scale, double arrival) {
  if constexpr (kGuides && Surfaces::kDense > 0) {
    constexpr uint64_t kPurpose = 0x636861696e;
    const NodeAt& node = nodes_[q.node];
    const uint32_t p = node.path;
    const Path& path = paths_[p];
    const auto links = static_cast<uint32_t>(chain_.links);
    RefractedSight::Node from;
    from.place = place, from.time = path.time, from.draw = path.draw;
    const uint64_t seed = hash_of(hash_of(path.stream.key(), kPurpose, path.sample), path.order(), q.light, knot);
    const auto ways = q.sky ? refracted_->first_through_sheet(from, q.end.direction, knot)
                            : refracted_->find(from, q.end, knot, seed);
    for (const RefractedWay& way : ways) {
      const std::span<float> through = dense(p, 3), memory = throughputs_.take(p);
      std::copy(chain_through_.begin(), chain_through_.end(), through.begin());
      space_.resume_way();
      scatter_along(links - 1, way.direction, through, memory);
      shine_behind(way, q, knot, {through, arrival, scale, links, chain_.toward[0]});
    }
    return true;
  }
  return false;
}

// How far along a ray a flight of the chain may reach, m: to the next surface, or to where a path that meets none has
// left the body around it, which has a hole.
template <class Surfaces, class Space, class Throughputs, class Estimator>
double PathKernel<Surfaces, Space, Throughputs, Estimator>::free_way(const Ray& ray) {
  const double way = space_.free_way(ray);
  if (way < std::numeric_limits<double>::infinity() || !environment_.earth) return way;
  const auto met = environment_.earth->meet(ray.origin, ray.direction, way);
  return met ? met->distance : way;
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
Ray PathKernel<Surfaces, Space, Throughputs, Estimator>::ray_from(const NodeAt& node, Dir toward) const {
  const Path& path = paths_[node.path];
  return {node.event ? space_.place(node.path) : surface_.tracer().leave(hits_[node.slot], toward), toward, path.time,
          path.draw};
}

// By the middle of the light, as flat water would have its way leave the node: a cone that followed the sample of the
// light that chains bring would take it for where it brings most, and what it leaves out would be less than that.
template <class Surfaces, class Space, class Throughputs, class Estimator>
ClaimCone PathKernel<Surfaces, Space, Throughputs, Estimator>::cone_of(const NodeAt& node, uint16_t light,
                                                                       size_t knot) const {
  if (!node.event) return {};
  const auto beam = environment_.lights[light]->beam();
  Dir toward = beam ? beam->direction : Dir{0, 0, 1};
  if (refracted_->has_sheet()) toward = refracted_->sheet_guess(toward, knot).value_or(toward);
  return {false, paths_[node.path].direction, toward};
}

// What link i of the chain, where its way has come to, makes of light that comes from a direction.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::scatter_along(size_t i, Dir from, std::span<float> through,
                                                                        std::span<float> memory) {
  if constexpr (kGuides) {
    const Factor w = space_.evaluate(space_.stand_on_way(), dot(chain_.toward[i], from), memory);
    const auto scale = static_cast<float>(double{w.scale} / chain_.density[i]);
    for (size_t b = 0; b < bins_; ++b) through[b] *= scale * (w.spectrum ? w.spectrum[b] : 1.0f);
  }
}

// Asks for the light of the air's sky, which otherwise only chance would find, in one direction: unscattered and along
// a chain.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::ask_sky(const NodeAt& node) {
  if constexpr (kGuides && Surfaces::kDense > 0) {
    const bool asks = options_.explicit_sources && options_.volume_chains;
    const SkyThroughWater* const sky = asks ? space_.hidden_sky() : nullptr;
    const Path& path = paths_[node.path];
    if (!sky || branches_.empty() || !asks_through(node) || !space_.even_around(node.path)) return;
    if (path.claims.stands(Technique::volume_chains)) return;
    const Vec3 place = from_node(node).place;
    const double deep = refracted_->below_sheet(place);
    if (!(deep > 0)) return;
    const Dir up = refracted_->sheet_axis();
    const uint32_t mean = mean_toward(node, up, deep);
    if (mean == kNone) return;
    guides_[static_cast<size_t>(&node - nodes_.data())].claims.add(
        Claim::chains_of_sky(kMostLinks), ClaimCone{!node.event, path.direction, up}, kReach * deep);
    const std::array<double, 4> u = chain_numbers(path, node.event, true, dimensions::kOfChainsSky);
    const DirectionSample sample = sky->draw(static_cast<size_t>(path.knot), {u[2], u[3]});
    if (!(sample.density > 0)) return;
    const std::vector<size_t>& set = refracted_->interfaces().set_of();
    for (size_t k = 0; k < knots(); ++k) {
      bool alive = false;
      for (size_t other = k; other < knots(); ++other) alive = alive || (set[other] == k && path.relative[other] > 0);
      if (set[k] == k && alive) ask_sky(node, k, *sky, sample.direction, deep, mean);
    }
  }
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::ask_sky(const NodeAt& node, size_t knot,
                                                                  const SkyThroughWater& sky, Dir to, double deep,
                                                                  uint32_t mean) {
  if constexpr (kGuides && Surfaces::kDense > 0) {
    const RefractedQuestion q{
        static_cast<uint32_t>(&node - nodes_.data()), Space::kEmitter, false, {to, {}}, 1, nullptr, 0, true};
    const auto toward = refracted_->sheet_guess(to, knot);
    if (!toward) return;
    if (!draw_chain(node, *toward, deep / refracted_->steepness(*toward), mean, true)) return;
    double density[kMaxKnots];
    sky.densities(to, {density, knots()});
    chain_.share.take(knots(), density, 1);
    const NodeClaims& claims = guides_[q.node].claims;
    if (chain_.links > 0) {
      if (claims.are_for(chain_.toward[0])) follow_chain(q, knot);
      return;
    }
    RefractedQuestion alone = q;
    alone.scale /= chain_.share.mean(P());
    for (const RefractedWay& way : refracted_->first_through_sheet(from_node(node), to, knot))
      if (claims.are_for(way.direction)) shine_along(way, alone, knot);
  }
}

}  // namespace suite
