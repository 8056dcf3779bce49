// Continuations in media towards where light comes from that interfaces bend.
//
// Water scatters forwards: what comes to a place from a small sun is a disk and a bright surround, the shape of the
// phase function about the direction of the way to the sun (manifold.h). Surfaces draw directions without knowing
// of it, and would meet it seldom. So where one has found such a way, it is left twice (splitting.h): as it draws
// itself (density p), and as the medium scatters what comes along the way (density g). Roulette takes light from such a
// direction for as much brighter as g is than even light, 1 / 4 pi: else it would end these paths for having a large
// density. Scatterings are not guided: mixing p and g there was 0.4 % too bright under waves in real air, and no less
// noisy. Based on: J. Vorba et al., "Path guiding in production", SIGGRAPH 2019 courses.
#pragma once
#include <algorithm>
#include <cmath>

#include "transport/techniques/manifold.h"

namespace suite {

template <class Wave>
class ForwardGuide {
 public:
  using Path = typename Wave::Path;
  // splits: whether paths are split, without which there is no second continuation.
  void prepare(bool splits) { on_ = splits; }
  void begin(const Wave& wave) { of_node_.assign(on_ ? wave.nodes.size() : 0, {}); }
  // Guides the node of the question along a way that has been found to the light, if matter is there that scatters.
  void find(Wave& wave, const RefractedQuestion& q, const RefractedWay& way);
  bool guides(const Wave& wave, const PathNode& node) const {
    return !of_node_.empty() && of_node_[wave.number_of(node)].branch;
  }
  enum class Way : uint8_t { own, guided };
  // Shares what the surface draws itself (on.density: p) with what is guided; way: which of the two this one is.
  void share(const Wave& wave, const PathNode& node, Way way, Continuation& on) const;
  // Draws a direction about that of the light.
  bool draw(Wave& wave, const PathNode& node, Vec2 u, double who, std::span<float> memory, Continuation& on) const;

 private:
  struct Guide {
    bool branch = false;  // a continuation is drawn about `toward`, beside the others
    Dir toward;
  };
  bool on_ = false;
  std::vector<Guide> of_node_;  // of the stage; empty where nothing refracts
};

// Where media do not scatter paths.
template <class Wave>
class NoForwardGuide {
 public:
  void prepare(bool) {}
  void begin(const Wave&) {}
  void find(Wave&, const RefractedQuestion&, const RefractedWay&) {}
  bool guides(const Wave&, const PathNode&) const { return false; }
  enum class Way : uint8_t { own, guided };
  void share(const Wave&, const PathNode&, Way, Continuation&) const {}
};

template <class Wave>
void ForwardGuide<Wave>::find(Wave& wave, const RefractedQuestion& q, const RefractedWay& way) {
  if (!on_) return;
  const PathNode& node = wave.nodes[q.node];
  Guide& guide = of_node_[q.node];
  if (node.event || !q.end.far || guide.branch) return;
  const Dir normal = wave.hits[node.slot].normal;
  if (dot(way.direction, normal) * dot(wave.paths[node.path].direction, normal) > 0) return;  // other matter is there
  wave.space.stand(node.path);
  if (wave.space.scattering(node.path) * way.at[0].length > 0 && wave.space.asymmetry(node.path) > 0)
    guide.branch = true, guide.toward = way.direction;
}

template <class Wave>
void ForwardGuide<Wave>::share(const Wave& wave, const PathNode& node, Way way, Continuation& on) const {
  const Guide& guide = of_node_[wave.number_of(node)];
  const bool forced = way == Way::guided;
  float forward[kMaxKnots] = {};
  if (!on.dirac) wave.space.densities(node.path, -guide.toward, on.in, {forward, wave.knots()});
  for (size_t k = 0; k < wave.knots(); ++k) {
    const float p = on.density[k], g = forward[k];
    on.density[k] = forced ? g : p;
    on.other[k] = forced ? p : g;
  }
  on.branch = forced ? Branch::forced : on.dirac ? Branch::none : Branch::open;
  on.bright = 1 + 4 * kPi * double{forward[0]};
}

template <class Wave>
bool ForwardGuide<Wave>::draw(Wave& wave, const PathNode& node, Vec2 u, double who, std::span<float> memory,
                              Continuation& on) const {
  const Path& path = wave.paths[node.path];
  if (!wave.space.scatter(node.path, -of_node_[wave.number_of(node)].toward, path.knot, u, who, on.in)) return false;
  if (!wave.surfaces.takes(node.path, wave.hits[node.slot], -path.direction, on.in)) return false;
  on.dirac = false;
  wave.surfaces.densities(node.path, -path.direction, on.in, {on.density, wave.knots()});
  on.weight = wave.evaluate(node, on.in, memory);
  return true;
}

}  // namespace suite
