// Who brings which light, watched in a running kernel: over random scenes every light that a path meets at the end of
// its word of events is brought once, by chance or by the technique that a node of the path has asked. The algebra of
// this kernel keeps the word of each path, as events and flights come, and what its nodes really ask for; claims
// (transport/path/claims.h) have no part in that. The other side, over all words: unit/transport/claims_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <map>
#include <random>
#include <string>

#include "air/air_spec.h"
#include "tests/support/lamps_kit.h"
#include "tests/support/media_kit.h"
#include "transport/estimators/standard.h"
#include "transport/kernel_beside.h"
#include "transport/kernel_fill.h"
#include "transport/kernel_fly.h"
#include "transport/kernel_go_on.h"
#include "transport/kernel_light.h"
#include "transport/kernel_meet.h"
#include "transport/media/space_field.h"
#include "transport/refracted_ray.h"
#include "transport/serve.h"

namespace suite::test::ownership_test {
namespace {

using Kind = ClaimedLight::Kind;

// What is said of claims, over what techniques keep to: a negative control. May be negative.
struct Widened {
  int links = 0, fewest_interfaces = 0, sky_interfaces = 0;
  double reach = 0;  // a share
  Claim of(Claim c) const {
    const auto wider = [](uint8_t& n, int by) { n = static_cast<uint8_t>(n + by); };
    const bool sky = c.lights == Kind::sky;
    if (c.technique == Technique::volume_chains) wider(c.scatterings.most, links);
    if (c.technique == Technique::manifold) wider(c.interfaces.least, fewest_interfaces);
    if (sky) wider(c.interfaces.most, sky_interfaces);
    c.reach *= 1 + reach;
    return c;
  }
};

// What a node asks for.
struct Ask {
  Technique technique;
  ClaimedLight light;
  size_t hero;
  double reach;
  ClaimCone cone;
};
// An event of a path:
//   S     scattered
//   T, U  passed on by a smooth interface; on another way than is looked for to the sky
//   R     reflected by one
//   O, D  at another surface, and by its Dirac lobe
struct Step {
  char letter;
  double flown;  // m, of the flight that a scattering has ended
  Dir in;        // where the path goes on
  std::vector<Ask> asks;
};
struct Word {
  std::vector<Step> steps;
  std::vector<Ask> asks;  // of the node where it stands
  double flown = 0;
  bool other_way = false;
  std::string text() const {
    std::string all;
    for (const Step& s : steps) all += s.letter;
    return all;
  }
};

bool is_interface(char c) { return c == 'T' || c == 'U' || c == 'R'; }

// Whether what has been asked at step `at` of a word brings the light at its end. As volume_chains.h has it: 24 links.
bool brings(const Word& word, size_t at, const Ask& ask) {
  constexpr size_t kMostLinks = 24;
  const std::vector<Step>& steps = word.steps;
  size_t i = at + 1, links = 0;
  if (steps[at].letter == 'D' || is_interface(steps[at].letter)) return false;
  if (ask.technique == Technique::volume_chains) {
    if (!ask.cone.has(steps[at].in)) return false;
    for (; i < steps.size() && steps[i].letter == 'S' && steps[i].flown <= ask.reach; ++i) ++links;
    if (links > kMostLinks || (links == 0 && ask.light.kind == Kind::small)) return false;
  }
  const size_t interfaces = steps.size() - i;
  if (ask.light.kind == Kind::sky) return interfaces == 1 && steps[i].letter == 'T';
  if (interfaces == 0 || interfaces > static_cast<size_t>(RefractedWay::kMostEvents) || steps[i].letter == 'R')
    return false;
  return std::all_of(steps.begin() + static_cast<long>(i), steps.end(),
                     [](const Step& s) { return is_interface(s.letter); });
}

// How often each technique, or chance, would bring the light at the end of a suffix.
using Pairs = std::map<std::pair<std::string, std::string>, size_t>;

// Spectra, and the words of their paths.
class WatchedThroughputs : public SpectralThroughputs {
 public:
  struct Watched {};
  WatchedThroughputs(size_t width, size_t bins, const Widened& widened)
      : SpectralThroughputs(width, bins, 1), words_(width), widened_(widened) {}

  void begin(uint32_t p, float weight, const float* weights) {
    SpectralThroughputs::begin(p, weight, weights);
    words_[p] = {};
  }
  struct Kept : SpectralThroughputs::Kept {
    Word word;
  };
  void keep(uint32_t p, float share, Kept& to) {
    SpectralThroughputs::keep(p, share, to);
    to.word = words_[p];
  }
  void resume(uint32_t p, const Kept& from) {
    SpectralThroughputs::resume(p, from);
    words_[p] = from.word;
  }

  // What the kernel tells.
  void fly(uint32_t p, Arrival arrival, double m) {
    words_[p].flown += m;
    if (arrival == Arrival::met) words_[p].flown = 0;
  }
  void ask(uint32_t p, Technique technique, ClaimedLight light, size_t hero, const NodeClaims* made = nullptr) {
    std::vector<Ask>& asks = words_[p].asks;
    for (const Ask& a : asks)  // several samples of one light are one question
      if (a.technique == technique && a.light.kind == light.kind && a.light.index == light.index && a.hero == hero)
        return;
    asks.push_back({technique, light, hero, made ? made->reach() : INFINITY, made ? made->cone() : ClaimCone{}});
  }
  void take_other_way(uint32_t p) { words_[p].other_way = true; }
  struct Left {
    bool event, interface, dirac, passes;
    Dir in;
  };
  void leave_node(uint32_t p, const Left& at) {
    Word& word = words_[p];
    char letter = at.event ? 'S' : at.dirac ? 'D' : 'O';
    if (at.interface) letter = !at.passes ? 'R' : word.other_way ? 'U' : 'T';
    word.steps.push_back({letter, at.event ? word.flown : 0, at.in, std::move(word.asks)});
    word.asks.clear(), word.flown = 0, word.other_way = false;
    check_asks(word);
  }
  const NodeClaims* claim(const NodeClaims* made, Claim& manifold) {
    manifold = widened_.of(manifold);
    if (!made) return nullptr;
    changed_ = *made;
    for (Claim& c : changed_.all()) c = widened_.of(c);
    return &changed_;
  }
  void meet_light(uint32_t p, ClaimedLight light, size_t hero, bool claimed) {
    const Word& word = words_[p];
    size_t n = !claimed;
    std::string by = "chance", suffix = word.text();
    for (size_t i = 0; i < word.steps.size(); ++i)
      for (const Ask& a : word.steps[i].asks)
        if (is_for(a, light, hero) && brings(word, i, a)) {
          ++n;
          by = a.technique == Technique::manifold ? "manifold" : "volume chains", suffix = word.text().substr(i + 1);
        }
    ++met;
    if (n != 1 && ++(n > 1 ? twice : never) == 1)
      std::cout << (n > 1 ? "twice: '" : "never: '") << word.text() << "' hero " << hero << " light "
                << (light.kind == Kind::sky ? -1 : int{light.index}) << (claimed ? " claimed" : " by chance") << "\n";
    ++pairs[{by, suffix}];
  }
  size_t met = 0, twice = 0, never = 0;
  Pairs pairs;

 private:
  static bool is_for(const Ask& a, ClaimedLight light, size_t hero) {
    return a.hero == hero && a.light.kind == light.kind && (light.kind == Kind::sky || a.light.index == light.index);
  }
  // What the node that the path has just left asks for, no older one does: behind it, and behind one more scattering.
  void check_asks(Word& word) {
    const size_t last = word.steps.size() - 1;
    for (const Ask& asked : word.steps[last].asks)
      for (const char* const rest : {"T", "ST"}) {
        for (const char* c = rest; *c; ++c) word.steps.push_back({*c, 0, asked.cone.toward, {}});
        size_t n = 0;
        for (size_t i = 0; i <= last; ++i)
          for (const Ask& a : word.steps[i].asks) n += is_for(a, asked.light, asked.hero) && brings(word, i, a);
        if (n > 1 && ++twice == 1)
          std::cout << "twice: '" << word.text() << "' asked for by nodes, hero " << asked.hero << "\n";
        word.steps.resize(last + 1);
      }
  }

  std::vector<Word> words_;
  const Widened widened_;
  NodeClaims changed_;
};

class Nothing final : public Sink<WatchedThroughputs> {
 public:
  void add(std::span<const Contribution>, WatchedThroughputs&) override {}
};

// A random scene: water over a bed, calm or with waves, alone or with layers, a ball of glass, a body of haze, lamps.
class Drawn {
 public:
  explicit Drawn(uint32_t seed) : random_(seed) {
    const double depth = draw(1, 5);
    const Curve index = coin() ? Curve({0.4, 0.7}, {1.35, 1.33}, Outside::hold) : Curve::constant(1.34);
    scene_->media = {medium(Curve::constant(draw(0.005, 0.05)), Curve::constant(draw(0.1, 1)), hg(draw(0.8, 0.95)))};
    scene_->media[0].index = index;
    Material surface = material("water", {"dielectric", {}, {{"index", index}}, {}, nullptr});
    surface.inside = 0;
    scene_->materials = {material("bed", lambert(draw(0.1, 0.8))), surface};
    place(*scene_, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -depth}));
    const bool waves = coin();
    if (waves)
      add_waves();
    else
      place(*scene_, PrimitiveKind::plane, {0, 0}, 1);
    if (coin()) add_layer(index, depth);
    const bool ball = coin() && coin(), haze = coin() && coin();
    if (ball) add_ball();
    if (haze) add_haze();
    if (coin()) add_lamp(depth);
    check_scene(*scene_, "random scene");
    sources_.add(SunSpec{dir_from_angles(draw(0, 1), draw(0, 6)), draw(0.005, 0.1), Curve::constant(1)});
    if (coin()) sources_.add(uniform_sky(0.1, false));
  }
  // Real air, whose sky is asked for through calm water and waves.
  void put_under(const std::shared_ptr<const AirSpec>& air) { sources_.air = air; }
  const std::shared_ptr<Scene>& scene() const { return scene_; }
  const SourceSpecs& sources() const { return sources_; }

 private:
  double draw(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  bool coin() { return draw(0, 1) < 0.5; }
  uint32_t add_material(Material m) {
    m.id += strf(" %zu", scene_->materials.size());
    scene_->materials.push_back(std::move(m));
    return static_cast<uint32_t>(scene_->materials.size()) - 1;
  }
  void add_waves() {
    constexpr uint32_t n = 41;
    const double height = draw(0.01, 0.1);
    std::vector<Vec3> v;
    std::vector<uint32_t> f;
    for (uint32_t j = 0; j < n; ++j)
      for (uint32_t i = 0; i < n; ++i) {
        v.push_back({2.0 * i - 40, 2.0 * j - 40, height * std::sin(i * 1.3)});
        if (i + 1 == n || j + 1 == n) continue;
        const uint32_t a = j * n + i;
        for (const uint32_t k : {a, a + 1, a + n + 1, a, a + n + 1, a + n}) f.push_back(k);
      }
    scene_->meshes.push_back(mesh_of(v, f, 1));
    scene_->groups[0].placements.push_back({{}, TargetKind::mesh, 0, kNone, kNone});
  }
  void add_layer(const Curve& index, double depth) {
    Medium m = medium(Curve::constant(0.03), Curve::constant(draw(0.1, 1)), hg(0.9));
    m.id = "layer", m.index = index, m.priority = 1;
    scene_->media.push_back(m);
    place(*scene_, PrimitiveKind::plane, {0, 0}, add_material(boundary(1)), translation({0, 0, -0.6 * depth}));
  }
  void add_ball() {
    Material glass = scene_->materials[1];
    glass.id = "glass", glass.surface.curves["index"] = Curve::constant(1.5), glass.inside = kNone;
    place(*scene_, PrimitiveKind::sphere, {0.4}, add_material(glass), translation({draw(-1, 1), draw(-1, 1), 1}));
  }
  void add_haze() {
    scene_->media.push_back(medium(Curve::constant(0.01), Curve::constant(0.2), hg(0.7)));
    scene_->media.back().id = "haze";
    const uint32_t border = add_material(boundary(static_cast<uint32_t>(scene_->media.size()) - 1));
    place(*scene_, PrimitiveKind::box, {-20, -20, 2, 20, 20, 4}, border);
  }
  void add_lamp(double depth) {
    const bool below = coin();
    const uint32_t lamp = add_material(material("lamp", lambert(0.1)));
    place(*scene_, PrimitiveKind::sphere, {0.2}, lamp, translation({draw(-1, 1), draw(-1, 1), below ? -depth / 2 : 2}));
    sources_.add(glow(scene_->materials[lamp].id, 1));
  }

  std::mt19937 random_;
  std::shared_ptr<Scene> scene_ = std::make_shared<Scene>();
  SourceSpecs sources_;
};

struct Counted {
  size_t met = 0, twice = 0, never = 0;
  Pairs pairs;
};

// Paths through a random scene, with its air where its number says so.
void count(uint32_t seed, uint32_t paths, const Widened& widened, Counted& all) {
  static const auto air = [] {
    AirSpec spec;
    spec.profile = standard_profile("tropical");
    spec.aerosol = AirSpec::Aerosol{};
    spec.adjacency = false;
    return std::make_shared<const AirSpec>(spec);
  }();
  Drawn drawn(seed);
  if (seed % 4 == 2) drawn.put_under(air);
  const Tracer tracer(drawn.scene());
  const std::vector<Band> bands{Band::rectangular("blue", 0.45, 0.02), Band::rectangular("red", 0.65, 0.02)};
  const SpectralState state = make_state(bands, 0.02, 0, 4);
  const Optics optics(*drawn.scene(), state);
  const Environment environment = bake_environment(drawn.sources(), tracer, false, optics.state());
  const Surface surface(tracer, optics);
  const PipelineOptions options;
  const uint32_t width = std::min(paths, 64u);
  WatchedThroughputs throughputs(width, optics.state().size(), widened);
  Nothing sink;
  PathKernel<Wave<AnySurfaces, FieldSpace, WatchedThroughputs, StandardEstimator>> kernel(
      {surface, optics, environment, options}, width, throughputs, sink);
  const FlushDenormals flush;
  const SampleStream stream(seed, 0, 0);
  TraceStatistics statistics;
  for (uint32_t begin = 0; begin < paths; begin += width) {
    for (uint32_t p = 0; p < width; ++p) {
      const std::array<double, 4> u = stream.draw(begin + p, 0);
      const Vec3 at{4 * u[0] - 2, 4 * u[1] - 2, -0.5};
      const Dir view = dir_from_angles(u[2], 6 * u[3]);
      throughputs.begin(p, 1, nullptr);
      kernel.start(p, {{at + view * 20, -view, 0}, 1}, stream, begin + p);
    }
    complete(kernel, tracer, statistics);
  }
  all.met += throughputs.met, all.twice += throughputs.twice, all.never += throughputs.never;
  for (const auto& [pair, n] : throughputs.pairs) all.pairs[pair] += n;
}

Counted count(uint32_t scenes, uint32_t paths, const Widened& widened = {}) {
  Counted all;
  for (uint32_t seed = 1; seed <= scenes; ++seed) count(seed, paths, widened, all);
  return all;
}

const bool kLong = std::getenv("SUITE_LONG") != nullptr;

TEST(Ownership, EveryLightThatPathsMeetIsBroughtOnce) {
  const Counted all = count(20, kLong ? 4096 : 16);
  std::map<std::string, size_t> of;
  for (const auto& [pair, n] : all.pairs) of[pair.first] += n;
  std::printf("%zu lights met, %zu pairs of technique and suffix; by chance %zu, manifold %zu, volume chains %zu\n",
              all.met, all.pairs.size(), of["chance"], of["manifold"], of["volume chains"]);
  EXPECT_EQ(all.twice, 0u);
  EXPECT_EQ(all.never, 0u);
  EXPECT_GT(of["chance"], 20u);
  EXPECT_GT(of["manifold"], 20u);
  EXPECT_GT(of["volume chains"], 20u);
}

// Negative control.
TEST(Ownership, AClaimWiderThanWhatIsAskedForIsNoticed) {
  struct Case {
    const char* name;
    Widened widened;
    bool wider;
    uint32_t scenes, paths;
  };
  std::vector<Case> cases = {{"manifold, from no interface on", {.fewest_interfaces = -1}, true, 4, 16},
                             {"sky, one interface less", {.sky_interfaces = -1}, false, 4, 32},
                             {"reach, half", {.reach = -0.5}, false, 4, 16}};
  if (kLong) {  // rare words
    cases.push_back({"reach, four times", {.reach = 3}, true, 8, 64});
    cases.push_back({"chains, one scattering more", {.links = 1}, true, 20, 4096});
    cases.push_back({"chains, one scattering less", {.links = -1}, false, 20, 4096});
    cases.push_back({"sky, one interface more", {.sky_interfaces = 1}, true, 20, 4096});
  }
  for (const auto& c : cases) {
    const Counted all = count(c.scenes, c.paths, c.widened);
    std::printf("%s: never %zu, twice %zu of %zu\n", c.name, all.never, all.twice, all.met);
    EXPECT_GT(c.wider ? all.never : all.twice, 0u) << c.name;
  }
}

}  // namespace
}  // namespace suite::test::ownership_test
