// A grid over half-vector angles, and where a pair of directions lies in it.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "sqt/half_angles.h"

namespace suite::sqt {

// Nodes [phi_d][theta_d][theta_h]. Angles in rad, strictly ascending, one of each at least; theta within [0, pi/2],
// where the outermost hold beyond; phi_d within [-pi, pi), which goes round (one node: phi_d does not matter).
struct HalfGrid {
  std::vector<double> theta_h, theta_d, phi_d;
  size_t nodes() const { return theta_h.size() * theta_d.size() * phi_d.size(); }
  size_t node(size_t p, size_t d, size_t h) const { return (p * theta_d.size() + d) * theta_h.size() + h; }
  HalfAngles angles(size_t node) const;
  // Eight nodes and their weights, >= 0, which sum to 1. A node may occur twice.
  struct Corners {
    std::array<size_t, 8> node;
    std::array<double, 8> weight;
  };
  Corners at(const HalfAngles& a) const;
  // Error: what is wrong with an axis.
  void check() const;
};

// Two entries of an ascending table and the share of the second; the outermost hold beyond.
struct GridPlace {
  size_t low = 0, high = 0;
  double t = 0;
};
GridPlace place_in(const std::vector<double>& ascending, double x);
// The same where the table goes round, from -pi to pi.
GridPlace place_around(const std::vector<double>& ascending, double x);

}  // namespace suite::sqt
