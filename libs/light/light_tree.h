// Chooses one of very many lamps for a place, with known probability: a tree over bounds of position, direction and
// power, walked down at random by how much each branch can at most send there. Cost grows with the logarithm of the
// number of lamps; every lamp that can reach the place has a positive probability, so the choice is unbiased.
//
// Based on: A. Conty Estevez & C. Kulla, "Importance sampling of many lights with adaptive tree splitting", Proc. ACM
// Comput. Graph. Interact. Tech. 1(2), 2018: orientation cones (section 4.1), importance (4.3), the surface-area
// orientation heuristic (4.4). A walk ends at one lamp; clusters that surround the place are split before it goes on,
// so that lamps that look elsewhere are told apart (the splitting of section 5, for one sample). Added to it: profiles
// of intensity, so that a cluster of street lamps is worth what it sends in the direction asked for, not what it sends
// at most; and eight branches a node, judged together in one go of the vector unit (as the wide trees of ray tracers,
// Wald et al. 2008), which also leaves fewer decisions to be made from the coarse bounds of large clusters.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "light/light_receiver.h"
#include "math/vec.h"

namespace suite {

// Relative intensity by cosine of the angle to the axis, 32 equal steps from -1 to 1: the mean over azimuth, and
// positive wherever the lamp sends anything within a step.
using LightProfile = std::array<float, 32>;

// Where a lamp (or many) can be, and where they send light: into directions within `spread` of their axes, which
// themselves lie within `cone` of `axis`. Angles in rad.
struct LightBounds {
  Box3 box;
  Dir axis{0, 0, 1};
  double cone = 0;          // theta_o, 0..pi
  double spread = kPi / 2;  // theta_e, 0..pi
  double power = 0;         // > 0, any unit common to all
  bool both_sides = false;  // sends along -axis as along axis
  int profile = -1;         // index into the tree's profiles; -1 = falls off with the cosine
};

class LightTree {
 public:
  // lights: at least one. Deterministic.
  explicit LightTree(std::span<const LightBounds> lights, std::vector<LightProfile> profiles = {});
  ~LightTree();

  struct Choice {
    uint32_t light;
    double probability;
  };
  // Nothing when no lamp can reach the place. u in [0, 1).
  std::optional<Choice> sample(const LightReceiver& at, double u) const;
  // Of `light` being chosen by sample(); light is an index into the constructor's span.
  double probability(const LightReceiver& at, uint32_t light) const;
  size_t size() const { return trail_.size(); }

 private:
  struct Node;
  struct Branches;
  uint32_t build(std::span<const LightBounds> lights, std::span<uint32_t> order, int depth,
                 std::vector<Node>& nodes) const;
  uint32_t widen(const std::vector<Node>& nodes, uint32_t root, uint64_t trail, int depth);
  struct Cut;
  // What each branch is worth to a place, 0 for one that cannot reach it; returns the sum. opened: those that are too
  // near to be judged as a whole, a bit each, if there is room for so many; they are worth nothing themselves.
  float importance(const Branches& branches, const LightReceiver& at, float* each, int room, int& opened) const;
  // The branches below a node among which one is drawn.
  void cut(uint32_t from, const LightReceiver& at, Cut& made) const;

  std::vector<float> profiles_;     // [profile][32]
  std::vector<float> peaks_;        // [profile][first step][last step]: the largest value of a range of steps
  std::vector<Branches> branches_;  // the root's first
  Vec3 origin_;                     // of the branches' positions
  std::vector<uint64_t> trail_;     // per light: three bits a level, which branch was taken
};

}  // namespace suite
