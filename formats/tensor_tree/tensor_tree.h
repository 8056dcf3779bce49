// A BRDF as a tensor tree of Radiance (WindowElement XML of the LBNL, rank 3 or 4), see FORMAT.md. Written only.
//
// Based on: G. Ward, M. Kurt, N. Bonneel, "Reducing anisotropic BSDF measurement to common practice", Workshop on
// Material Appearance Modeling 2014, section 2 (tensor trees); P. Shirley & K. Chiu, "A low distortion map between disk
// and square", JGT 2(3), 1997; coordinates and order of cells as Radiance's bsdf_t.c has them.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "math/vec.h"
#include "sqt/function.h"

namespace suite {

// One channel of a function, averaged over the cells of a grid, cells that are alike merged. As a function it is what a
// reader of the file has: constant over cells, 0 at and below the horizon.
class TensorTree final : public sqt::Function {
 public:
  // levels: 2^levels cells along each coordinate, 2 to 7 (isotropic), 2 to 5. merge: cells of a node become one when
  // all of them are within this share of the largest. Error: no BRDF over the hemisphere.
  TensorTree(const sqt::Function& function, size_t channel, int levels, double merge);
  const Info& info() const override { return info_; }
  void value(Dir out, Dir in, std::span<double> f) const override;
  size_t leaves() const { return leaves_; }
  // The whole file; comment goes to its head.
  std::string xml(const std::string& comment) const;

 private:
  using Place = std::array<size_t, 4>;  // of a cell, along each coordinate
  size_t index(const Place& place) const;
  std::array<double, 4> position(Dir out, Dir in) const;
  void fill(const sqt::Function& function, size_t channel);
  // Merges and writes the node of `width` cells at `first`; cells take the values that are written.
  void put(const Place& first, size_t width, double merge);
  Info info_;
  size_t rank_, side_, leaves_ = 0;
  std::vector<double> cells_;
  std::string text_;
};

}  // namespace suite
