// A BRDF as a tensor tree of Radiance (WindowElement XML of the LBNL, rank 3 or 4), see FORMAT.md. Written only.
//
// Based on: G. Ward, M. Kurt, N. Bonneel, "Reducing anisotropic BSDF measurement to common practice", Workshop on
// Material Appearance Modeling 2014, section 2 (tensor trees); P. Shirley & K. Chiu, "A low distortion map between disk
// and square", JGT 2(3), 1997; coordinates and order of cells as Radiance's bsdf_t.c has them, which does not
// interpolate: what a tree is off by is what the function changes by within its cells.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "math/vec.h"
#include "sqt/function.h"

namespace suite {

// One channel of a function, averaged over the cells of a tree that is cut where the function changes. As a function it
// is what a reader of the file has: constant over cells, 0 at and below the horizon.
class TensorTree final : public sqt::Function {
 public:
  struct Aim {
    double error = 0.01;        // relative l1 (sqt_fit/errors.h) below which no cell is cut any more; > 0
    size_t leaves = 2'000'000;  // at most, about; a leaf is some 8 bytes of the file. 1 to kMostLeaves
    // That error of a tree as it is, found with other points than the cells' own few, which miss some of it. Asked each
    // time that they find the error kept, until this finds it, too. None: the cells' own word counts.
    std::function<double(const sqt::Function& tree)> measure = {};
  };
  static constexpr size_t kMostLeaves = 60'000'000;
  // Error: no BRDF over the hemisphere.
  TensorTree(const sqt::Function& function, size_t channel, const Aim& aim);
  const Info& info() const override { return info_; }
  void value(Dir out, Dir in, std::span<double> f) const override;
  size_t leaves() const { return leaves_; }
  int levels() const { return levels_; }  // of the deepest leaf: its sides are 2^-levels
  bool full() const { return full_; }     // cells that were to be cut were not: no more leaves or levels
  // The whole file; comment goes to its head.
  std::string xml(const std::string& comment) const;

 private:
  friend class TensorTreeBuilder;
  struct Node {
    uint32_t branches = 0;  // the first of 2^rank nodes; 0: a leaf
    float value = 0;
  };
  void put(const Node& node, std::string& text) const;
  Info info_;
  size_t rank_, leaves_ = 0;
  int levels_ = 0;
  bool full_ = false;
  std::vector<Node> nodes_;  // the root first; branch b has the upper half of coordinate i where bit i of b is set
};

}  // namespace suite
