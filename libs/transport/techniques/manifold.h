// Manifold next-event estimation (MNEE): lights behind smooth interfaces (refracted_sight.h).
//
// Every node asks far lights that are small, and a place on one of the lamps, for all ways through such interfaces,
// whatever the straight line towards the light meets, and claims their light (path/claims.h). The light comes
// along a way with
//   w(out, direction) x transmittances and reflectances of interfaces, squared indices, and of what fills space
//     x |d(direction) / d(direction at a far light)|  x  radiance over its density, or irradiance;
//     x |d(direction) / d(m2 across the way at a lamp)|  x  radiance x cosine over the density of places, or intensity.
// That a point's light spreads so follows from its radiance being that of a small surface.
#pragma once
#include <algorithm>
#include <cmath>

#include "transport/refracted_sight.h"
#include "transport/techniques/suffix_throughput.h"

namespace suite {

// A light that a node looks for through smooth interfaces.
struct RefractedQuestion {
  uint32_t node;  // of the stage
  uint16_t light;
  bool beam;
  WayEnd end;
  double scale;           // far: times spectrum, over the density; else 1 / the density or probability of the place
  const float* spectrum;  // far
  size_t member;          // a point
  bool sky = false;       // the air's
};

template <class Wave>
class Manifold {
 public:
  using Path = typename Wave::Path;
  static constexpr bool kRefracts = true;
  void prepare(const KernelContext& context) {
    if (refracts(context)) sight_ = std::make_unique<RefractedSight>(context.surface, context.optics);
  }
  bool on() const { return sight_ != nullptr; }
  RefractedSight& sight() { return *sight_; }
  const RefractedSight& sight() const { return *sight_; }
  const SmoothInterfaces& interfaces() const { return sight_->interfaces(); }

  // Of nodes at surfaces: smooth interfaces, through which others look.
  bool is_interface(const Wave& wave, const PathNode& node) const {
    return interfaces().has(wave.surfaces.material(node.path));
  }
  // Whether a node looks for light through interfaces.
  bool asks_through(const Wave& wave, const PathNode& node) const;
  // The hero wavelength that stands for those that smooth interfaces bend like the path's own.
  size_t hero_of(const Path& path) const { return interfaces().set_of()[static_cast<size_t>(path.knot)]; }
  // Whether a technique brings a light that the path has met.
  bool is_claimed(const Path& path, ClaimedLight light) const {
    return on() && owner(path.claims, light, hero_of(path)) != Technique::chance;
  }
  // Whether ways of a hero wavelength stand for some that an interface on the path has not parted it from.
  bool is_alive(const Wave& wave, const Path& path, size_t knot) const;

  void begin() { questions_.clear(); }
  // A sample of a far light; and a place on a lamp for every node.
  void want(const Wave& wave, const PathNode& node, const SampledLight& light, const LightSample& sample);
  void want_places(const Wave& wave);
  // Makes the contributions of the stage. Chains and guides begin where a way has been found.
  template <class Chains, class Guide, class Ends>
  void answer(Wave& wave, Chains& chains, Guide& guide, Ends& ends);
  // Of light that smooth surfaces stop on its straight way: the share that is lost there, having not been looked for
  // through them. passes: what they pass.
  double lost(const Wave& wave, const SightQuestion& q, size_t ray, double passes);

  // For chains.
  RefractedSight::Node from_node(const Wave& wave, const PathNode& node) const;
  struct Reached {   // the beginning of a way
    double arrival;  // m, optical, from the node
    double scale;
    uint32_t scatterings;  // since the node
    Dir first;             // from it
  };
  bool shine_along(Wave& wave, const RefractedWay& way, const RefractedQuestion& q, size_t knot);
  // What comes along a way to where its beginning has been reached. suffix: of what lies before, the node included.
  bool shine_behind(Wave& wave, const RefractedWay& way, const RefractedQuestion& q, size_t knot,
                    const Reached& reached, SuffixThroughput<Wave>& suffix);
  // Leaves the bins whose light takes the ways of a knot's.
  void keep_bins_of(const Wave& wave, size_t knot, SuffixThroughput<Wave>& suffix) const;

 private:
  struct Sent {  // towards the last interface
    double scale;
    const float* spectrum;
  };
  template <class Chains, class Guide, class Ends>
  void answer(Wave& wave, const RefractedQuestion& q, size_t knot, Chains& chains, Guide& guide, Ends& ends);
  // Follows a way that has been begun; arrival: its optical length is added. False: nothing is left of its light.
  bool follow(Wave& wave, const Path& path, const RefractedWay& way, size_t knot, bool sky,
              SuffixThroughput<Wave>& suffix, double& arrival);
  std::optional<Sent> sent(Wave& wave, const RefractedQuestion& q, const RefractedWay& way);

  std::unique_ptr<RefractedSight> sight_;  // null where nothing refracts
  std::vector<RefractedQuestion> questions_;
};

// Where no surface refracts without roughness.
template <class Wave>
class NoManifold {
 public:
  static constexpr bool kRefracts = false;
  void prepare(const KernelContext&) {}
  static constexpr bool on() { return false; }
  static constexpr bool is_interface(const Wave&, const PathNode&) { return false; }
  static constexpr bool is_claimed(const typename Wave::Path&, ClaimedLight) { return false; }
  void begin() {}
  void want(const Wave&, const PathNode&, const SampledLight&, const LightSample&) {}
  void want_places(const Wave&) {}
  template <class Chains, class Guide, class Ends>
  void answer(Wave&, Chains&, Guide&, Ends&) {}
  double lost(const Wave&, const SightQuestion&, size_t, double passes) { return passes; }
};

template <class Wave>
void Manifold<Wave>::want(const Wave& wave, const PathNode& node, const SampledLight& light,
                          const LightSample& sample) {
  if (!asks_through(wave, node)) return;
  questions_.push_back({static_cast<uint32_t>(wave.number_of(node)),
                        light.index,
                        light.beam,
                        {sample.direction, {}},
                        sample.scale / (sample.density > 0 ? sample.density : 1),
                        sample.spectrum,
                        0});
}

template <class Wave>
bool Manifold<Wave>::asks_through(const Wave& wave, const PathNode& node) const {
  if (node.event) return !wave.in_air(node);  // the even field that it stands for knows no interfaces
  return !is_interface(wave, node);           // Dirac lobes only
}

template <class Wave>
void Manifold<Wave>::want_places(const Wave& wave) {
  for (const SampledLight& light : wave.lights.sampled) {
    if (!light.nature.placed) continue;
    for (const PathNode& node : wave.nodes) {
      if (!asks_through(wave, node)) continue;
      if constexpr (Wave::kWatched)
        for (size_t k = 0; k < wave.knots(); ++k)
          wave.throughputs.ask(node.path, Technique::manifold, {ClaimedLight::Kind::small, light.index}, k);
      const auto drawn = light.light->draw_place(wave.receiver(node), wave.numbers(node, light.use), wave.time(node));
      if (!drawn) continue;
      questions_.push_back({static_cast<uint32_t>(wave.number_of(node)),
                            light.index,
                            light.beam,
                            {{}, drawn->place, false, !drawn->point},
                            1 / drawn->density,
                            nullptr,
                            drawn->member});
    }
  }
}

template <class Wave>
double Manifold<Wave>::lost(const Wave& wave, const SightQuestion& q, size_t ray, double passes) {
  if (!sight_ || q.light == kFromAir || !is_refracted(wave.environment.lights[q.light]->nature())) return passes;
  if (wave.in_air(wave.nodes[q.node])) return passes;
  return sight_->unfound(wave.sight_rays.rays()[ray], wave.sight_rays.distance()[ray]).value_or(passes);
}

template <class Wave>
template <class Chains, class Guide, class Ends>
void Manifold<Wave>::answer(Wave& wave, Chains& chains, Guide& guide, Ends& ends) {
  if (!sight_) return;
  chains.begin(wave), guide.begin(wave);
  for (const RefractedQuestion& q : questions_) {
    const Path& path = wave.paths[wave.nodes[q.node].path];
    const Suffix behind = path.claims.behind_interface(false);
    for (size_t k = 0; k < wave.knots(); ++k) {
      if (!is_alive(wave, path, k)) continue;
      const ClaimedLight light{ClaimedLight::Kind::small, q.light};
      // Chains that began before this scattering bring it.
      if (owner(path.claims.all(), behind, light, k) == Technique::volume_chains) continue;
      if constexpr (Wave::kWatched) wave.throughputs.ask(wave.nodes[q.node].path, Technique::manifold, light, k);
      answer(wave, q, k, chains, guide, ends);
    }
  }
  for (const PathNode& node : wave.nodes) chains.sample_sky(wave, *this, node);
}

template <class Wave>
void Manifold<Wave>::keep_bins_of(const Wave& wave, size_t knot, SuffixThroughput<Wave>& suffix) const {
  const std::vector<size_t>& set = sight_->interfaces().set_of();
  for (size_t i = 0; i < wave.bins; ++i)
    suffix.spectrum()[i] *= set[static_cast<size_t>(wave.heroes.of_bin[i])] == knot ? 1.0f : 0.0f;
}

template <class Wave>
bool Manifold<Wave>::follow(Wave& wave, const Path& path, const RefractedWay& way, size_t knot, bool sky,
                            SuffixThroughput<Wave>& suffix, double& arrival) {
  Ray ray{way.origin, way.direction, path.time, path.draw};
  for (int i = 0; i < way.events; ++i) {
    const RefractedEvent& at = way.at[i];
    if (wave.contacts.covers(ray, at.hit, wave.touching)) return false;
    arrival += at.length * suffix.follow(ray, at.length);
    suffix.meet(at, sight_->interfaces().lobe(at.material, at.reflected), knot, path.time);
    if (!at.reflected) wave.space.cross_way(at.hit, at.material, at.in);
    ray.origin = wave.surface.tracer().leave(at.hit, at.in);
    ray.direction = at.in;
  }
  if (wave.is_behind_earth(ray, way.length)) return false;
  if (sky) return true;
  const double delay = suffix.follow(ray, way.length);
  if (std::isfinite(way.length)) arrival += way.length * delay;  // far lights shine evenly in time
  return std::ranges::any_of(suffix.spectrum(), [](float t) { return t != 0; });
}

template <class Wave>
RefractedSight::Node Manifold<Wave>::from_node(const Wave& wave, const PathNode& node) const {
  const uint32_t p = node.path;
  const Path& path = wave.paths[p];
  RefractedSight::Node from;
  from.time = path.time, from.draw = path.draw;
  if (node.event) {
    if constexpr (Wave::Space::kScatters) from.place = wave.space.place(p);
  } else {
    const Hit& hit = wave.hits[node.slot];
    const LightReceiver at = wave.surfaces.receiver(p, hit, -path.direction);
    from.place = hit.position;
    from.hit = &hit;
    if (!at.two_sided) from.side = dot(path.direction, hit.normal) < 0 ? hit.normal : -hit.normal;
  }
  return from;
}

template <class Wave>
template <class Chains, class Guide, class Ends>
void Manifold<Wave>::answer(Wave& wave, const RefractedQuestion& q, size_t knot, Chains& chains, Guide& guide,
                            Ends& ends) {
  const PathNode& node = wave.nodes[q.node];
  const Path& path = wave.paths[node.path];
  constexpr uint64_t kPurpose = 0x62656e74;
  const uint64_t seed = hash_of(hash_of(path.stream.key(), kPurpose, path.sample), path.order(), q.light, knot);
  std::optional<RefractedWay> first;
  const auto ways = sight_->find(from_node(wave, node), q.end, knot, seed);
  if (!std::empty(ways)) ends.find(wave, q.node, q.light, std::begin(ways)->direction);
  for (const RefractedWay& way : ways)
    if (shine_along(wave, way, q, knot) && !first) first = way;
  if (first && !chains.sample(wave, *this, q, first->direction, first->at[0].length, knot)) guide.find(wave, q, *first);
}

template <class Wave>
bool Manifold<Wave>::shine_along(Wave& wave, const RefractedWay& way, const RefractedQuestion& q, size_t knot) {
  const PathNode& node = wave.nodes[q.node];
  const uint32_t p = node.path;
  const Path& path = wave.paths[p];
  if (!node.event && !wave.surfaces.takes(p, wave.hits[node.slot], -path.direction, way.direction)) return false;
  SuffixThroughput<Wave> suffix(wave, wave.dense(p, 2));
  suffix.leave(node, way.direction);
  keep_bins_of(wave, knot, suffix);
  wave.space.begin_way(p, node.event, wave.hits[node.slot], node.event ? kNone : wave.surfaces.material(p),
                       -path.direction, way.direction);
  return shine_behind(wave, way, q, knot, {0, 1, 0, way.direction}, suffix);
}

template <class Wave>
bool Manifold<Wave>::shine_behind(Wave& wave, const RefractedWay& way, const RefractedQuestion& q, size_t knot,
                                  const Reached& reached, SuffixThroughput<Wave>& suffix) {
  const PathNode& node = wave.nodes[q.node];
  const uint32_t p = node.path;
  const Path& path = wave.paths[p];
  const auto most = static_cast<uint32_t>(wave.options.max_nodes);
  if (most > 0 && path.surfaces + static_cast<uint32_t>(way.events) >= most) return false;
  double arrival = reached.arrival;
  if (!follow(wave, path, way, knot, q.sky, suffix, arrival)) return false;
  const auto from_light = sent(wave, q, way);
  if (!from_light) return false;
  WaterSeen water = WaterSeen::nothing;
  if (wave.waters.any()) {
    water = wave.water_behind(node, reached.first);
    if (reached.scatterings > 0) water = Waters::behind_scattering(water);
    for (int i = 0; i < way.events; ++i)
      water = wave.waters.behind_surface(water, way.at[i].material, way.at[i].hit.normal, way.at[i].out, way.at[i].in);
    if (water == WaterSeen::mirrored && !q.end.far) water = WaterSeen::other;
  }
  for (const bool doubtful : {false, true}) {
    if (doubtful && !way.doubtful) break;
    Contribution& c = wave.contribution(p, q.light);
    c.events |= by_surface | by_dirac;
    if (node.event || reached.scatterings > 0) c.events |= by_medium;
    c.asked = !q.sky;
    c.beam = q.beam;
    c.water = water;
    c.order += static_cast<uint32_t>(way.events) + reached.scatterings;
    c.smooth += static_cast<uint32_t>(way.events);
    c.scale = static_cast<float>(from_light->scale * way.spreading * way.trials * reached.scale);
    c.radiance = from_light->spectrum;
    c.arrival += arrival;
    if (doubtful) c.missed = 0;  // there may be as much again
    suffix.contribute(c);
  }
  return true;
}

// What a light sends along a way, per solid angle there; of a lamp per m2 across the way, over the density of the
// place.
template <class Wave>
auto Manifold<Wave>::sent(Wave& wave, const RefractedQuestion& q, const RefractedWay& way) -> std::optional<Sent> {
  const PathNode& node = wave.nodes[q.node];
  if (q.sky) {
    const std::span<float> own = wave.throughputs.take(node.path);
    return Sent{q.scale, wave.space.sky_behind({way.last, way.to, 0}, wave.transmission, own)};
  }
  const Light& light = *wave.environment.lights[q.light];
  const double when = wave.time(node);
  if (q.end.far) {
    if (q.spectrum) return Sent{q.scale, q.spectrum};
    const std::span<float> own = wave.throughputs.take(node.path);  // its shape changes with direction
    std::fill(own.begin(), own.end(), 0.0f);
    light.add(q.end.direction, when, 1, own);
    return Sent{q.scale, own.data()};
  }
  if (q.end.surface) {
    if (!light.draws(way.lamp)) return std::nullopt;
    const double cosine = -dot(way.to, way.lamp.normal);
    const auto met = light.met_surface(wave.receiver(node), way.lamp, wave.surface.material(way.lamp), way.to,
                                       way.length, cosine, when);
    if (!met) return std::nullopt;
    return Sent{q.scale * met->scale * std::fabs(cosine), met->spectrum};
  }
  const auto sample = light.sample_member(q.member, 1, {way.last, {}, true}, {}, when);
  if (!sample) return std::nullopt;
  return Sent{q.scale * sample->scale * sample->distance * sample->distance, sample->spectrum};
}

template <class Wave>
bool Manifold<Wave>::is_alive(const Wave& wave, const Path& path, size_t knot) const {
  const std::vector<size_t>& set = interfaces().set_of();
  if (set[knot] != knot) return false;
  for (size_t other = knot; other < wave.knots(); ++other)
    if (set[other] == knot && path.relative[other] > 0) return true;
  return false;
}

}  // namespace suite
