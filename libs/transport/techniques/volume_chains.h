// Multi-vertex (joint) volumetric next-event estimation (NEE): light that comes to a surface
// through water that scatters it on its way.
// Water scatters forwards, several times on a way of some metres, and what comes to a place from a small sun is as
// likely to have been scattered 0, 1, 2 or n times. A path that looks for it from the place draws directions without
// knowing whether they will end near the sun's. So they are drawn from its end: where a node has found a way to the
// light (manifold.h), of direction s and length L in the matter beside the node, it also draws a chain of
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
// others (settle). Both lights are asked for by scatterings as well, for what comes from more than half
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
#include "transport/chain_laws.h"
#include "transport/media/medium_stack.h"
#include "transport/techniques/manifold.h"

namespace suite {

template <class Wave>
class VolumeChains {
 public:
  using Path = typename Wave::Path;
  // splits: whether paths are split, without which chains have no use.
  void prepare(const Wave& wave, bool splits) {
    on_ = splits && wave.options.volume_chains && wave.options.explicit_sources;
  }
  void begin(const Wave& wave) { claims_.assign(wave.nodes.size(), {}), held_ = 0; }
  // What chains of a node claim; null: there are none.
  const NodeClaims* claims(const Wave& wave, const PathNode& node) const {
    return claims_.empty() ? nullptr : &claims_[wave.number_of(node)];
  }
  // A chain to the light of the question, to which a way has been found `toward` a direction, of `length` m in the
  // matter beside the node. Where it looks for the light, its number is returned, too.
  ChainLook sample(Wave& wave, Manifold<Wave>& manifold, const RefractedQuestion& q, Dir toward, double length,
                   size_t knot, uint32_t& chain);
  // The light of the air's sky, which otherwise only chance would find, in one direction: unscattered and along a
  // chain. Numbers from `first` on to what is returned.
  uint32_t draw_sky(Wave& wave, Manifold<Wave>& manifold, const PathNode& node, uint32_t& first);
  // Begins the search for the light of a chain from its last place (RefractedSight::begin); and takes what it has
  // found.
  bool look(const Wave& wave, Manifold<Wave>& manifold, uint32_t chain, RefractedSearch& s) const;
  void shine(Wave& wave, Manifold<Wave>& manifold, uint32_t chain, std::span<const RefractedWay> ways);
  // Whether a continuation goes through the smooth interface of node i to light of the air's sky that chains may bring;
  bool passes_into_claimed_sky(const Wave& wave, const Manifold<Wave>& manifold, size_t i,
                               const Continuation& on) const;
  // if it does, it waits, and true is returned: the claim on such light is given up where chains look for another way
  // through the interface than the path's, or for none. next_settled(): the next request, to be served before the next
  // call; false when all of them are settled, which then go on.
  bool settle(const Wave& wave, Manifold<Wave>& manifold, size_t i, const Continuation& on);
  bool next_settled(Wave& wave, Manifold<Wave>& manifold, TraceRequest& request);
  template <class GoOn>
  void go_on_settled(const GoOn& go_on) {
    for (const Settling& s : settling_) go_on(s.node, s.on);
    settling_.clear(), settling_searches_.clear();
  }

 private:
  static constexpr int kMostLinks = 24;
  static_assert(dimensions::of_link(kMostLinks - 1, true) < dimensions::of_link_place(1, kMostLinks, true) &&
                dimensions::of_link_place(kMostLinks, kMostLinks, true) < dimensions::kMostPerChain);
  static constexpr double kReach = 2, kDeepest = 8;
  struct Chain {
    int links;                                    // scatterings
    Dir toward[kMostLinks + 1];                   // from the node, and from each of them
    double density[kMostLinks];                   // of each direction but the last one, at the path's knot
    uint32_t mean;                                // the event that stands for all matter up to the light's interface
    HeroDensities<Wave::Surfaces::kKnots> share;  // r_k of it all, over the density that drew it
  };
  // The mean of the matter on `length` m towards the light as an event; kNone where it is of no use for chains.
  uint32_t mean_toward(Wave& wave, const PathNode& node, Dir toward, double length);
  // Draws number and directions of scatterings.
  bool draw_chain(Wave& wave, const PathNode& node, Dir toward, double length, uint32_t mean, ClaimedLight::Kind light);
  // A set of numbers of the chain that the path draws at its last surface.
  std::array<double, 4> chain_numbers(const Path& path, const PathNode& node, ClaimedLight::Kind light,
                                      uint32_t set) const;
  ClaimCone cone_of(const Wave& wave, const Manifold<Wave>& manifold, const PathNode& node, uint16_t light,
                    size_t knot) const;
  Ray ray_from(const Wave& wave, const PathNode& node, Dir toward) const;
  // What remains of a chain of a question that has come to its last place, or of the sky seen from the node itself.
  struct Held {
    RefractedQuestion question;
    size_t knot;
    uint32_t links;             // 0: from the node
    Vec3 place;                 // the last one
    Dir first, last;            // from the node; to the last place
    double density;             // of that direction
    double scale, arrival;      // Manifold::Reached
    MediumStack way;            // of the space, there
    std::vector<float> suffix;  // what the node and all links but the last make of the light
    typename Wave::Matrices matrices;
  };
  Held& hold(const RefractedQuestion& q, size_t knot);
  // Goes to its places and holds it; false where it meets what it cannot pass.
  bool follow_chain(Wave& wave, Manifold<Wave>& manifold, const RefractedQuestion& q, size_t knot);
  // By what scattering i of the chain is put on its way of `most` m, at knot k.
  LinkPlace link_place(const Wave& wave, const Manifold<Wave>& manifold, const RefractedQuestion& q, size_t i,
                       double most, size_t k) const;
  // How far along a ray a flight of the chain may reach, m: to the next surface, or to where a path that meets none has
  // left the body around it, which has a hole.
  double free_way(Wave& wave, const Ray& ray);
  void draw_sky(Wave& wave, Manifold<Wave>& manifold, const PathNode& node, size_t knot, const SkyThroughWater& sky,
                Dir to, double deep, uint32_t mean);
  struct Settling {  // a continuation that waits
    size_t node;
    Continuation on;
  };
  bool begin_settling(const Wave& wave, Manifold<Wave>& manifold, const Settling& of, RefractedSearch& s) const;

  bool on_ = false;
  std::vector<NodeClaims> claims_;  // of nodes; empty where nothing refracts
  Chain chain_;
  std::vector<Held> chains_;  // the first held_ of them; the others keep their memory
  uint32_t held_ = 0;
  std::vector<Settling> settling_;
  RefractedSearches settling_searches_;
};

// Where media do not scatter paths.
template <class Wave>
class NoVolumeChains {
 public:
  void prepare(const Wave&, bool) {}
  void begin(const Wave&) {}
  const NodeClaims* claims(const Wave&, const PathNode&) const { return nullptr; }
  template <class M>
  ChainLook sample(Wave&, M&, const RefractedQuestion&, Dir, double, size_t, uint32_t&) {
    return ChainLook::none;
  }
  template <class M>
  uint32_t draw_sky(Wave&, M&, const PathNode&, uint32_t& first) {
    return first;
  }
  template <class M>
  bool look(const Wave&, M&, uint32_t, RefractedSearch&) const {
    return false;
  }
  template <class M>
  void shine(Wave&, M&, uint32_t, std::span<const RefractedWay>) {}
  template <class M>
  bool passes_into_claimed_sky(const Wave&, const M&, size_t, const Continuation&) const {
    return false;
  }
  template <class M>
  bool settle(const Wave&, M&, size_t, const Continuation&) {
    return false;
  }
  template <class M>
  bool next_settled(Wave&, M&, TraceRequest&) {
    return false;
  }
  template <class GoOn>
  void go_on_settled(const GoOn&) {}
};

template <class Wave>
ChainLook VolumeChains<Wave>::sample(Wave& wave, Manifold<Wave>& manifold, const RefractedQuestion& q, Dir toward,
                                     double length, size_t knot, uint32_t& number) {
  const PathNode& node = wave.nodes[q.node];
  const Path& path = wave.paths[node.path];
  if (!on_ || !q.end.far || !wave.space.even_around(node.path)) return ChainLook::none;
  if (path.claims.stands(Technique::volume_chains)) return ChainLook::none;
  const Dir normal = wave.hits[node.slot].normal;
  if (!node.event && dot(toward, normal) * dot(path.direction, normal) > 0)
    return ChainLook::none;  // other matter is there
  NodeClaims& claims = claims_[q.node];
  constexpr auto kSmall = ClaimedLight::Kind::small;
  if (const Claim* const claim = claims.of(kSmall); claim && claim->light != q.light) return ChainLook::none;
  const uint32_t mean = mean_toward(wave, node, toward, length);
  if (mean == kNone) return ChainLook::none;
  if (!claims.of(kSmall))
    claims.add(Claim::chains(q.light, kMostLinks, RefractedWay::kMostEvents),
               cone_of(wave, manifold, node, q.light, knot), kReach * length);
  claims.add_hero(kSmall, knot);
  if constexpr (Wave::kWatched)
    wave.throughputs.ask(node.path, Technique::volume_chains, {kSmall, q.light}, knot, &claims);
  number = held_;
  return draw_chain(wave, node, toward, length, mean, kSmall) && claims.are_for(chain_.toward[0]) &&
                 follow_chain(wave, manifold, q, knot)
             ? ChainLook::looks
             : ChainLook::ends;
}

template <class Wave>
uint32_t VolumeChains<Wave>::mean_toward(Wave& wave, const PathNode& node, Dir toward, double length) {
  wave.space.begin_way(node.path, true, {}, kNone, {}, {});
  const uint32_t mean = wave.space.mean_of_way(ray_from(wave, node, toward), length);
  if (!(wave.space.asymmetry(mean) > kForwardScattering)) return kNone;
  for (size_t k = 0; k < wave.knots(); ++k) {
    const double depth = wave.space.scattering(mean, k) * length;
    if (!(depth > 0 && depth < kDeepest)) return kNone;
  }
  return mean;
}

template <class Wave>
bool VolumeChains<Wave>::draw_chain(Wave& wave, const PathNode& node, Dir toward, double length, uint32_t mean,
                                    ClaimedLight::Kind light) {
  const Path& path = wave.paths[node.path];
  Chain& chain = chain_;
  chain.mean = mean;
  const auto own = static_cast<size_t>(path.knot);
  const bool sky = light == ClaimedLight::Kind::sky;
  const std::array<double, 4> u = chain_numbers(path, node, light, dimensions::of_link(0, sky));
  const int least = sky ? 0 : 1;
  const auto count = [&](size_t k) {
    return LinkCount(wave.space.scattering(mean, k) * length, wave.space.albedo(mean, k), least, kMostLinks);
  };
  chain.links = count(own).draw(u[3]);
  double of_count[kMaxKnots];
  for (size_t k = 0; k < wave.knots(); ++k) of_count[k] = count(k).probability(chain.links);
  chain.share.set(wave.knots(), path.relative, of_count, 1);
  const auto n = static_cast<size_t>(chain.links);
  chain.toward[n] = toward;
  for (size_t i = n; i-- > 0;) {
    const std::array<double, 4> v =
        i + 1 == n ? u : chain_numbers(path, node, light, dimensions::of_link(n - 1 - i, sky));
    if (!wave.space.scatter(mean, -chain.toward[i + 1], path.knot, {v[0], v[1]}, v[2], chain.toward[i])) return false;
    float density[kMaxKnots];
    wave.space.densities(mean, -chain.toward[i + 1], chain.toward[i], {density, wave.knots()});
    chain.density[i] = density[own];
    if (!(density[own] > 0)) return false;
    chain.share.take(wave.knots(), density, double{density[own]});
  }
  return true;
}

template <class Wave>
std::array<double, 4> VolumeChains<Wave>::chain_numbers(const Path& path, const PathNode& node,
                                                        ClaimedLight::Kind light, uint32_t set) const {
  const uint32_t at = node.event ? dimensions::kNodes + path.flights : path.surfaces - 1;
  return dimensions::of_chain(path.stream, path.sample, at, light == ClaimedLight::Kind::sky, set);
}

template <class Wave>
bool VolumeChains<Wave>::follow_chain(Wave& wave, Manifold<Wave>& manifold, const RefractedQuestion& q, size_t knot) {
  const PathNode& node = wave.nodes[q.node];
  const uint32_t p = node.path;
  const Path& path = wave.paths[p];
  Chain& chain = chain_;
  if (wave.options.max_scatterings > 0 &&
      path.scatterings + static_cast<uint32_t>(chain.links) > wave.options.max_scatterings)
    return false;
  const Hit& hit = wave.hits[node.slot];
  if (!node.event && !wave.surfaces.takes(p, hit, -path.direction, chain.toward[0])) return false;
  Held& held = hold(q, knot);
  held.suffix.resize(wave.bins);
  SuffixThroughput<Wave> suffix(wave, held.suffix);
  suffix.leave(node, chain.toward[0]);
  manifold.keep_bins_of(wave, knot, suffix);
  wave.space.begin_way(p, node.event, hit, node.event ? kNone : wave.surfaces.material(p), -path.direction,
                       chain.toward[0]);
  double arrival = 0;
  Ray ray = ray_from(wave, node, chain.toward[0]);
  for (size_t i = 0; i < static_cast<size_t>(chain.links); ++i) {
    ray.direction = chain.toward[i];
    const double most = std::min(free_way(wave, ray), claims_[q.node].reach());
    if (!(most > 0)) return false;
    const std::array<double, 4> u =
        chain_numbers(path, node, q.sky ? ClaimedLight::Kind::sky : ClaimedLight::Kind::small,
                      dimensions::of_link_place(i, kMostLinks, q.sky));
    const auto own = static_cast<size_t>(path.knot);
    const double x = wave.space.share_of_way(link_place(wave, manifold, q, i, most, own).draw({u[0], u[1]}), most, own);
    const auto density_at = [&](size_t k) {
      const auto at = wave.space.share_of_depth(x, most, k);
      return link_place(wave, manifold, q, i, most, k).density(at.share) * at.change;
    };
    const double density = density_at(own);
    if (!(density > 0)) return false;
    double of_place[kMaxKnots];
    for (size_t k = 0; k < wave.knots(); ++k) of_place[k] = density_at(k);
    chain.share.take(wave.knots(), of_place, density);
    // At once: 24 ways of 100 m each, and as many coefficients of 0.01 1/m, do not fit into floats.
    suffix.weaken(static_cast<float>(most / density));
    arrival += x * most * suffix.follow(ray, x * most);
    ray.origin += ray.direction * (x * most);
    if (i + 1 < static_cast<size_t>(chain.links))
      suffix.scatter(wave.space.stand_on_way(), -chain.toward[i], chain.toward[i + 1], chain.density[i]);
  }
  const auto last = static_cast<size_t>(chain.links - 1);
  held.links = static_cast<uint32_t>(chain.links), held.place = ray.origin;
  held.first = chain.toward[0], held.last = chain.toward[last], held.density = chain.density[last];
  held.scale = 1 / chain.share.mean(wave.P()), held.arrival = arrival;
  held.matrices.begin(suffix.matrices());
  held.way = wave.space.way();
  ++held_;
  return true;
}

template <class Wave>
LinkPlace VolumeChains<Wave>::link_place(const Wave& wave, const Manifold<Wave>& manifold, const RefractedQuestion& q,
                                         size_t i, double most, size_t k) const {
  constexpr double kFlattest = 0.05, kSteep = 2;
  const auto n = static_cast<size_t>(chain_.links);
  const Dir light = chain_.toward[n], up = manifold.sight().has_sheet() ? manifold.sight().sheet_axis() : light;
  const double steep = dot(light, up), rise = std::copysign(std::max(kFlattest, std::fabs(steep)), steep),
               albedo = wave.space.albedo(chain_.mean, k), extinction = wave.space.scattering(chain_.mean, k) / albedo,
               height = claims_[q.node].reach() / kReach;
  const auto more = [&](size_t j) { return extinction * (1 - dot(chain_.toward[j], up) / rise); };  // 1/m
  int others = 0;
  for (size_t j = i + 1; j < n; ++j) others += std::fabs(more(j)) * height < kSteep;
  const double depth = wave.space.depth_of_way(most, k) / albedo;
  return {depth - extinction * dot(chain_.toward[i], up) / rise * most, others};
}

// What is held counts from when it is complete.
template <class Wave>
auto VolumeChains<Wave>::hold(const RefractedQuestion& q, size_t knot) -> Held& {
  if (held_ == chains_.size()) chains_.emplace_back();
  Held& held = chains_[held_];
  held.question = q, held.knot = knot, held.links = 0;
  return held;
}

template <class Wave>
bool VolumeChains<Wave>::look(const Wave& wave, Manifold<Wave>& manifold, uint32_t chain, RefractedSearch& s) const {
  constexpr uint64_t kPurpose = 0x636861696e;
  const Held& held = chains_[chain];
  const RefractedQuestion& q = held.question;
  const PathNode& node = wave.nodes[q.node];
  const Path& path = wave.paths[node.path];
  WayStart from;
  from.place = held.place, from.time = path.time, from.draw = path.draw;
  if (q.sky)
    return manifold.sight().begin_first(s, held.links > 0 ? from : manifold.from_node(wave, node), q.end.direction,
                                        held.knot);
  const uint64_t seed = hash_of(hash_of(path.stream.key(), kPurpose, path.sample), path.order(), q.light, held.knot);
  return manifold.sight().begin(s, from, q.end, held.knot, seed);
}

template <class Wave>
void VolumeChains<Wave>::shine(Wave& wave, Manifold<Wave>& manifold, uint32_t chain,
                               std::span<const RefractedWay> ways) {
  const Held& held = chains_[chain];
  const RefractedQuestion& q = held.question;
  for (const RefractedWay& way : ways) {
    if (held.links == 0) {
      if (claims_[q.node].are_for(way.direction)) manifold.shine_along(wave, way, q, held.knot);
      continue;
    }
    SuffixThroughput<Wave> suffix(wave, wave.dense(wave.nodes[q.node].path, 2));
    suffix.resume(held.suffix, held.matrices);
    wave.space.resume_way(held.way);
    suffix.scatter(wave.space.stand_on_way(), -held.last, way.direction, held.density);
    manifold.shine_behind(wave, way, q, held.knot, {held.arrival, held.scale, held.links, held.first}, suffix);
  }
}

template <class Wave>
double VolumeChains<Wave>::free_way(Wave& wave, const Ray& ray) {
  const double way = wave.space.free_way(ray);
  if (way < std::numeric_limits<double>::infinity() || !wave.environment.earth) return way;
  const auto met = wave.environment.earth->meet(ray.origin, ray.direction, way);
  return met ? met->distance : way;
}

template <class Wave>
Ray VolumeChains<Wave>::ray_from(const Wave& wave, const PathNode& node, Dir toward) const {
  const Path& path = wave.paths[node.path];
  return {node.event ? wave.space.place(node.path) : wave.surface.tracer().leave(wave.hits[node.slot], toward), toward,
          path.time, path.draw};
}

// By the middle of the light, as flat water would have its way leave the node: a cone that followed the sample of the
// light that chains bring would take it for where it brings most, and what it leaves out would be less than that.
template <class Wave>
ClaimCone VolumeChains<Wave>::cone_of(const Wave& wave, const Manifold<Wave>& manifold, const PathNode& node,
                                      uint16_t light, size_t knot) const {
  if (!node.event) return {};
  const auto beam = wave.environment.lights[light]->beam();
  Dir toward = beam ? beam->direction : Dir{0, 0, 1};
  if (manifold.sight().has_sheet()) toward = manifold.sight().sheet_guess(toward, knot).value_or(toward);
  return {false, wave.paths[node.path].direction, toward};
}

}  // namespace suite
