// Every way of light to a path has one owner: over all words of events, what techniques bring by the form of their
// ways, spelled out here, and what owner() leaves to chance make 1 together.
#include "transport/path/claims.h"

#include <gtest/gtest.h>

#include <iostream>
#include <string>
#include <vector>

namespace suite::test::claims_test {
namespace {

// Events of a path, from the sensor to the light:
//   S, s  scattered, and going on where chains look for light (claims hold), or where they do not
//   L     scattered (and so on) after a longer flight than chains reach
//   T, U  passed on by a smooth interface; on another way than chains of the sky look for
//   R     reflected by one
//   O, D  a surface of other kind, and its Dirac lobe
const std::string kAll = "SsLTURDO";
constexpr uint8_t kLinks = 2, kInterfaces = 3;
constexpr double kReach = 10;
constexpr size_t kHeroes = 2;
using Kind = ClaimedLight::Kind;
constexpr ClaimedLight kSun{Kind::small, 4}, kMoon{Kind::small, 5};

struct Scene {
  bool manifold = true, chains = true, sky = true;
  uint32_t heroes = 3;  // whose ways chains look for
};

// What is said of claims, over what techniques keep to: a negative control.
struct Widened {
  uint8_t links = 0, interfaces = 0, sky_interfaces = 0;
  double reach = 0;
  bool heroes = false, cone = false;
};

bool is_scattering(char c) { return c == 'S' || c == 's' || c == 'L'; }

// Ways of technique forms, of the rest of a word behind the node.
bool is_manifold_way(const std::string& w) {
  if (w.empty() || w.size() > kInterfaces || (w[0] != 'T' && w[0] != 'U')) return false;
  return w.find_first_not_of("TUR") == std::string::npos;
}
size_t links_of(const std::string& w) {
  size_t n = 0;
  while (n < w.size() && (w[n] == 'S' || w[n] == 's')) ++n;
  return n;
}
bool is_chain(const std::string& w) {
  const size_t n = links_of(w);
  return n >= 1 && n <= kLinks && is_manifold_way(w.substr(n));
}
bool is_sky_chain(const std::string& w) {
  const size_t n = links_of(w);
  return n <= kLinks && w.substr(n) == "T";
}

// A path through the events of a word, with what its nodes ask for on the way.
class Walk {
 public:
  Walk(const Scene& scene, const std::string& word, const Widened& widened)
      : scene_(scene), word_(word), widened_(widened) {
    for (size_t i = 0; i < word.size(); ++i) step(i);
  }
  // By how many the light at the end of the word is brought.
  int brought(ClaimedLight light, size_t hero) const {
    int n = owner(claims_, light, hero) == Technique::chance;
    for (const Node& node : nodes_) {
      const std::string rest = word_.substr(node.at + 1);
      if (light.kind == Kind::small) {
        n += node.asks[ask_of(light, hero)] && is_manifold_way(rest);
        n += node.chains && light.index == kSun.index && (scene_.heroes >> hero & 1) && is_chain(rest);
      } else {
        n += node.sky && is_sky_chain(rest);
      }
    }
    return n;
  }

 private:
  struct Node {
    size_t at;
    bool asks[2 * kHeroes] = {};  // the manifold: for ask_of()
    bool chains = false, sky = false;
  };
  static size_t ask_of(ClaimedLight light, size_t hero) { return (light.index == kSun.index ? 0 : kHeroes) + hero; }
  void step(size_t i) {
    const char c = word_[i];
    if (c == 'T' || c == 'U' || c == 'R') return meet_interface(c);
    if (is_scattering(c)) claims_.scatter(c == 'L' ? kReach + 1 : kReach);
    if (!is_scattering(c)) claims_.clear();
    Node node{i};
    for (const ClaimedLight light : {kSun, kMoon})
      for (size_t hero = 0; hero < kHeroes; ++hero)
        node.asks[ask_of(light, hero)] =
            scene_.manifold && c != 'D' &&
            owner(claims_.all(), claims_.behind_interface(false), light, hero) != Technique::volume_chains;
    const Dir along{1, 0, 0}, toward{0, 0, 1};
    const ClaimCone cone{!is_scattering(c) || widened_.cone, along, toward};
    NodeClaims made;
    if (!claims_.stands(Technique::volume_chains)) make_claims(made, cone);
    const Dir in = c == 's' ? along : toward;
    const bool holds = c != 's' && c != 'D';  // a Dirac lobe sees nothing of what its node asks for
    node.chains = made.of(Kind::small) && holds, node.sky = made.of(Kind::sky) && holds;
    Claim manifold = Claim::manifold(static_cast<uint8_t>(kInterfaces + widened_.interfaces));
    if (!scene_.manifold) manifold.interfaces = {1, 0};
    if (is_scattering(c)) claims_.leave_scattering(&made, manifold, in);
    if (c == 'O') claims_.leave_surface(&made, manifold, in);
    nodes_.push_back(node);
  }
  void make_claims(NodeClaims& made, const ClaimCone& cone) const {
    const auto links = static_cast<uint8_t>(kLinks + widened_.links);
    const auto interfaces = static_cast<uint8_t>(kInterfaces + widened_.interfaces);
    if (scene_.chains) {
      made.add(Claim::chains(kSun.index, links, interfaces), cone, kReach + widened_.reach);
      for (size_t hero = 0; hero < kHeroes; ++hero)
        if ((scene_.heroes >> hero & 1) || widened_.heroes) made.add_hero(Kind::small, hero);
    }
    Claim sky = Claim::chains_of_sky(links);
    sky.interfaces.most = static_cast<uint8_t>(sky.interfaces.most + widened_.sky_interfaces);
    if (scene_.sky) made.add(sky, cone, kReach + widened_.reach);
  }
  void meet_interface(char c) {
    if (c == 'U') claims_.give_up_sky();
    claims_.meet_interface(c == 'R');
  }

  const Scene scene_;
  const std::string word_;
  const Widened widened_;
  PathClaims claims_;
  std::vector<Node> nodes_;
};

// Words whose light is not brought once; 0 where all is right. letters, longest: of the words.
int wrong_words(const std::string& letters, size_t longest, const Widened& widened = {}) {
  int wrong = 0;
  std::vector<std::string> words{""};
  for (size_t begin = 0, length = 0; length < longest; ++length) {
    const size_t end = words.size();
    for (; begin < end; ++begin)
      for (const char c : letters) words.push_back(words[begin] + c);
  }
  for (int set = 0; set < 16; ++set) {
    const Scene scene{(set & 1) != 0, (set & 2) != 0, (set & 4) != 0, set & 8 ? 3u : 1u};
    if (!scene.manifold && scene.chains) continue;  // chains begin with the ways that it finds
    for (const std::string& word : words) {
      const Walk walk(scene, word, widened);
      bool once = walk.brought(ClaimedLight::sky(), 0) == 1;
      for (size_t hero = 0; hero < kHeroes; ++hero)
        once = once && walk.brought(kSun, hero) == 1 && walk.brought(kMoon, hero) == 1;
      if (!once && ++wrong == 1) std::cout << "not once: '" << word << "' of set " << set << "\n";
    }
  }
  return wrong;
}

TEST(Claims, EveryWordOfEventsHasOneOwner) {
  EXPECT_EQ(wrong_words("SLTRO", 7), 0);
  EXPECT_EQ(wrong_words(kAll, 5), 0);
}

TEST(Claims, AClaimWiderThanWhatIsDrawnIsNoticed) {
  EXPECT_GT(wrong_words("STO", 5, {.links = 1}), 0);
  EXPECT_GT(wrong_words("STO", 5, {.interfaces = 1}), 0);
  EXPECT_GT(wrong_words("STO", 5, {.sky_interfaces = 1}), 0);
  EXPECT_GT(wrong_words("SLTO", 4, {.reach = 2}), 0);
  EXPECT_GT(wrong_words("STO", 4, {.heroes = true}), 0);
  EXPECT_GT(wrong_words("SsTO", 4, {.cone = true}), 0);
}

TEST(Claims, OlderClaimsComeFirst) {
  PathClaims path;
  NodeClaims made;
  made.add(Claim::chains(kSun.index, kLinks, kInterfaces), {}, kReach).heroes = 1;
  path.leave_surface(&made, Claim::manifold(kInterfaces), {0, 0, 1});
  path.scatter(1);
  path.leave_scattering(nullptr, Claim::manifold(kInterfaces), {0, 0, 1});
  path.meet_interface(false);
  EXPECT_EQ(owner(path, kSun, 0), Technique::volume_chains);
  EXPECT_EQ(owner(path, kSun, 1), Technique::manifold);
  EXPECT_EQ(owner(path, kMoon, 0), Technique::manifold);
  EXPECT_EQ(owner(path, ClaimedLight::sky(), 0), Technique::chance);
}

// A flight that boundaries interrupt is one flight.
TEST(Claims, BoundariesLengthenFlights) {
  NodeClaims made;
  made.add(Claim::chains_of_sky(kLinks), {}, kReach);
  for (const double last : {1.0, 3.0}) {
    PathClaims path;
    path.leave_surface(&made, Claim::manifold(kInterfaces), {0, 0, 1});
    path.pass_boundary(4), path.pass_boundary(4);
    path.scatter(last);
    EXPECT_EQ(path.stands(Technique::volume_chains), 8 + last <= kReach) << last;
  }
}

TEST(Claims, CountsGoNoFurtherThanTheyCan) {
  Suffix s;
  for (int i = 0; i < 1000; ++i) s.scatter(1), s.meet_interface(i > 0);
  EXPECT_EQ(s.scatterings, Suffix::kCountless);
  EXPECT_EQ(s.interfaces, Suffix::kCountless);
  EXPECT_FALSE(Claim::manifold(10).covers(s));
  EXPECT_FALSE(s.mirrored);
}

}  // namespace
}  // namespace suite::test::claims_test
