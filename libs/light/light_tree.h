// Chooses one of very many lamps for a place, with known probability: a tree over bounds of position, direction and
// power, walked down at random by how much each branch can at most send there. Cost grows with the logarithm of the
// number of lamps; every lamp that can reach the place has a positive probability, so the choice is unbiased.
//
// Based on: A. Conty Estevez & C. Kulla, "Importance sampling of many lights with adaptive tree splitting", Proc. ACM
// Comput. Graph. Interact. Tech. 1(2), 2018: orientation cones (section 4.1), importance (4.3), the surface-area
// orientation heuristic (4.4). Clusters that are near and count for much are opened before one is drawn, so that lamps
// close by, which look elsewhere or stand below the horizon, are told apart (the splitting of section 5, for one
// sample); what is drawn farther off is walked down. Added to it: profiles of intensity, so that a cluster of street
// lamps is worth what it sends in the direction asked for, not what it sends at most; clusters cut by the receiver's
// horizon are worth what of them is above it; and eight branches a node, judged together in one go of the vector unit
// (as the wide trees of ray tracers, Wald et al. 2008): the lowest nodes are eight lamps, which cost no more to judge
// one by one than as a whole.
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

struct LightBranches;
struct LightNode;

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
  // The same for several numbers, which costs less than one by one; drawn: as many.
  void sample(const LightReceiver& at, std::span<const double> u, std::span<std::optional<Choice>> drawn) const;
  // Of `light` being chosen by sample(); light is an index into the constructor's span.
  double probability(const LightReceiver& at, uint32_t light) const;
  size_t size() const { return place_.size(); }

 private:
  uint32_t build(std::span<const LightBounds> lights, std::span<uint32_t> order, int depth,
                 std::vector<LightNode>& nodes) const;
  static std::vector<uint32_t> branches_of(const std::vector<LightNode>& nodes, uint32_t top);
  uint32_t widen(const std::vector<LightNode>& nodes, std::span<const LightProfile> profiles, uint32_t top,
                 uint32_t parent);
  void set(LightBranches& to, uint32_t k, const LightBounds& bounds, bool evenly) const;
  struct Cut;
  // A receiver in single precision, its position from origin_.
  struct Asker {
    float rounding;  // m, of differences of positions
    float x, y, z, normal_x, normal_y, normal_z;
    bool looks, two_sided;  // looks: has a normal
  };
  Asker asker(const LightReceiver& at) const;
  // What each branch is worth to a place, 0 for one that cannot reach it; returns the sum. before: what the cut is
  // worth without them. opened: those that are to be opened, a bit each.
  double importance(const LightBranches& branches, const Asker& at, double before, float* each, uint32_t& opened) const;
  // The branches below a node among which one is drawn.
  void cut(uint32_t from, const Asker& at, Cut& made) const;
  // light: the branch's child, as in LightBranches.
  Choice choose(const Cut& cut, double& u) const;

  std::vector<float> profiles_;          // [profile][32]
  std::vector<float> peaks_;             // [profile][first step][last step]: the largest value of a range of steps
  std::vector<LightBranches> branches_;  // the root's first
  Vec3 origin_;                          // of the branches' positions
  double extent_ = 0;                    // m, how far lamps are from it at most
  std::vector<uint32_t> place_;          // per light: 8 x the node + the branch that it is
};

}  // namespace suite
