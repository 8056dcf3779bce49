// Manifold next-event estimation (MNEE): lights behind smooth interfaces (refracted/sight.h).
//
// Every node asks far lights that are small, and a place on one of the lamps, for all ways through such interfaces,
// whatever the straight line towards the light meets, and claims their light (path/claims.h). The light comes
// along a way with
//   w(out, direction) x transmittances and reflectances of interfaces, squared indices, and of what fills space
//     x |d(direction) / d(direction at a far light)|  x  radiance over its density, or irradiance;
//     x |d(direction) / d(m2 across the way at a lamp)|  x  radiance x cosine over the density of places, or intensity.
// That a point's light spreads so follows from its radiance being that of a small surface.
// All nodes of a stage look beside each other, each for one light after the other: their searches ask for rays
// together (refracted/searches.h), and what a path is given comes in the same order as if it were alone.
#pragma once
#include <algorithm>
#include <cmath>

#include "transport/refracted/searches.h"
#include "transport/refracted/unfound.h"
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
  uint32_t next = kNone;  // of the node
};

// What becomes of a chain of scatterings that was to begin where a way has been found (techniques/volume_chains.h).
enum class ChainLook : uint8_t {
  none,   // chains do not bring the light of the node
  ends,   // they do, but this one leads nowhere
  looks,  // the light is to be looked for from its end
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

  void begin() { questions_.clear(), unfound_.clear(); }
  // A sample of a far light; and a place on a lamp for every node.
  void want(const Wave& wave, const PathNode& node, const SampledLight& light, const LightSample& sample);
  void want_places(const Wave& wave);
  // Of ray i of the stage's shadow rays, which smooth surfaces stop: the share of its light that is not found through
  // them is to be known.
  void want_lost(const Wave& wave, const SightQuestion& q, size_t ray);
  // All has been wanted. Chains and guides begin where a way is found; ends learn it.
  template <class Chains, class Guide>
  void look(Wave& wave, Chains& chains, Guide& guide);
  // The next request, to be served before the next call; false when all contributions have been made.
  template <class Chains, class Guide, class Ends>
  bool next(Wave& wave, Chains& chains, Guide& guide, Ends& ends, TraceRequest& request);
  // The share of the light of such a ray that is lost. passes: what smooth surfaces on its straight way pass.
  double lost(const Wave& wave, const SightQuestion& q, size_t ray, double passes);

  // For chains.
  WayStart from_node(const Wave& wave, const PathNode& node) const;
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
    uint32_t source = kUnpolarised;
  };
  // What a node looks for: its questions at one knot after the other, then the sky through chains.
  struct Asking {
    enum class For : uint8_t { next, light, chain, sky, nothing } what = For::next;
    uint32_t node;
    uint32_t question;             // that is next or under way; kNone: there are no more
    size_t knot = 0;               // that is next
    uint32_t chain = 0, last = 0;  // that is under way; the end of those of the sky
  };
  bool loses(const Wave& wave, const SightQuestion& q) const;
  template <class Chains, class Guide, class Ends>
  bool advance(Wave& wave, Chains& chains, Guide& guide, Ends& ends, Asking& a, RefractedSearch& s, Hit* hit);
  template <class Chains>
  bool look_for_next(Wave& wave, Chains& chains, Asking& a, RefractedSearch& s);
  bool looks_for(Wave& wave, const RefractedQuestion& q, size_t knot);
  bool look_for(const Wave& wave, const RefractedQuestion& q, size_t knot, RefractedSearch& s);
  template <class Chains, class Guide, class Ends>
  bool shine(Wave& wave, Chains& chains, Guide& guide, Ends& ends, Asking& a, RefractedSearch& s);
  // Follows a way that has been begun; arrival: its optical length is added. False: nothing is left of its light.
  bool follow(Wave& wave, const Path& path, const RefractedWay& way, size_t knot, bool sky,
              SuffixThroughput<Wave>& suffix, double& arrival);
  std::optional<Sent> sent(Wave& wave, const RefractedQuestion& q, const RefractedWay& way);

  std::unique_ptr<RefractedSight> sight_;  // null where nothing refracts
  std::vector<RefractedQuestion> questions_;
  std::vector<Asking> askings_;  // of the stage's nodes
  RefractedSearches searches_;   // theirs
  UnfoundLight unfound_;
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
  void want_lost(const Wave&, const SightQuestion&, size_t) {}
  template <class Chains, class Guide>
  void look(Wave&, Chains&, Guide&) {}
  template <class Chains, class Guide, class Ends>
  bool next(Wave&, Chains&, Guide&, Ends&, TraceRequest&) {
    return false;
  }
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
bool Manifold<Wave>::loses(const Wave& wave, const SightQuestion& q) const {
  return sight_ && q.light != kFromAir && is_refracted(wave.environment.lights[q.light]->nature()) &&
         !wave.in_air(wave.nodes[q.node]);
}

template <class Wave>
void Manifold<Wave>::want_lost(const Wave& wave, const SightQuestion& q, size_t ray) {
  if (loses(wave, q)) unfound_.want(ray, wave.sight_rays.rays()[ray], wave.sight_rays.distance()[ray]);
}

template <class Wave>
double Manifold<Wave>::lost(const Wave& wave, const SightQuestion& q, size_t ray, double passes) {
  return loses(wave, q) ? unfound_.share(ray).value_or(passes) : passes;
}

template <class Wave>
template <class Chains, class Guide>
void Manifold<Wave>::look(Wave& wave, Chains& chains, Guide& guide) {
  if (!sight_) return;
  chains.begin(wave), guide.begin(wave);
  askings_.resize(wave.nodes.size());
  searches_.clear();
  for (uint32_t i = 0; i < askings_.size(); ++i) askings_[i] = {.node = i, .question = kNone}, searches_.add();
  for (uint32_t i = static_cast<uint32_t>(questions_.size()); i-- > 0;)
    questions_[i].next = std::exchange(askings_[questions_[i].node].question, i);
}

template <class Wave>
template <class Chains, class Guide, class Ends>
bool Manifold<Wave>::next(Wave& wave, Chains& chains, Guide& guide, Ends& ends, TraceRequest& request) {
  if (!sight_) return false;
  const auto on = [&](uint32_t i, RefractedSearch& s, Hit* hit) {
    return advance(wave, chains, guide, ends, askings_[i], s, hit);
  };
  return searches_.next(request, on) || unfound_.next(*sight_, request);
}

// Takes a node on until it waits for a ray, or looks for nothing any more: false.
template <class Wave>
template <class Chains, class Guide, class Ends>
bool Manifold<Wave>::advance(Wave& wave, Chains& chains, Guide& guide, Ends& ends, Asking& a, RefractedSearch& s,
                             Hit* hit) {
  using For = typename Asking::For;
  bool waits = hit && sight_->step(s, *hit);
  while (!waits) {
    switch (a.what) {
      case For::next:
        waits = look_for_next(wave, chains, a, s);
        break;
      case For::light:
        waits = shine(wave, chains, guide, ends, a, s);
        break;
      case For::chain:
        chains.shine(wave, *this, a.chain, s.all());
        a.what = For::next;
        break;
      case For::sky:
        chains.shine(wave, *this, a.chain, s.all());
        a.what = ++a.chain < a.last ? For::sky : For::nothing;
        if (a.what == For::sky) waits = chains.look(wave, *this, a.chain, s);
        break;
      case For::nothing:
        return false;
    }
  }
  return true;
}

// Begins the next search of a node.
template <class Wave>
template <class Chains>
bool Manifold<Wave>::look_for_next(Wave& wave, Chains& chains, Asking& a, RefractedSearch& s) {
  using For = typename Asking::For;
  while (a.question != kNone) {
    const RefractedQuestion& q = questions_[a.question];
    for (; a.knot < wave.knots(); ++a.knot) {
      if (!looks_for(wave, q, a.knot)) continue;
      a.what = For::light;
      return look_for(wave, q, a.knot++, s);
    }
    a.question = q.next, a.knot = 0;
  }
  a.last = chains.draw_sky(wave, *this, wave.nodes[a.node], a.chain);
  a.what = a.chain < a.last ? For::sky : For::nothing;
  return a.what == For::sky && chains.look(wave, *this, a.chain, s);
}

// Whether a question is the manifold's at a knot.
template <class Wave>
bool Manifold<Wave>::looks_for(Wave& wave, const RefractedQuestion& q, size_t knot) {
  const Path& path = wave.paths[wave.nodes[q.node].path];
  if (!is_alive(wave, path, knot)) return false;
  const ClaimedLight light{ClaimedLight::Kind::small, q.light};
  // Chains that began before this scattering bring it.
  if (owner(path.claims.all(), path.claims.behind_interface(false), light, knot) == Technique::volume_chains)
    return false;
  if constexpr (Wave::kWatched) wave.throughputs.ask(wave.nodes[q.node].path, Technique::manifold, light, knot);
  return true;
}

template <class Wave>
bool Manifold<Wave>::look_for(const Wave& wave, const RefractedQuestion& q, size_t knot, RefractedSearch& s) {
  constexpr uint64_t kPurpose = 0x62656e74;
  const PathNode& node = wave.nodes[q.node];
  const Path& path = wave.paths[node.path];
  const uint64_t seed = hash_of(hash_of(path.stream.key(), kPurpose, path.sample), path.order(), q.light, knot);
  return sight_->begin(s, from_node(wave, node), q.end, knot, seed);
}

// What has been found shines; a chain or a guide may begin with it. Whether the search of a chain waits.
template <class Wave>
template <class Chains, class Guide, class Ends>
bool Manifold<Wave>::shine(Wave& wave, Chains& chains, Guide& guide, Ends& ends, Asking& a, RefractedSearch& s) {
  using For = typename Asking::For;
  const RefractedQuestion& q = questions_[a.question];
  const size_t knot = a.knot - 1;
  const RefractedWay* first = nullptr;
  if (!s.all().empty()) ends.find(wave, q.node, q.light, s.all().front().direction);
  for (const RefractedWay& way : s.all())
    if (shine_along(wave, way, q, knot) && !first) first = &way;
  a.what = For::next;
  if (!first) return false;
  switch (chains.sample(wave, *this, q, first->direction, first->at[0].length, knot, a.chain)) {
    case ChainLook::none:
      guide.find(wave, q, *first);
      break;
    case ChainLook::ends:
      break;
    case ChainLook::looks:
      a.what = For::chain;
      return chains.look(wave, *this, a.chain, s);
  }
  return false;
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
