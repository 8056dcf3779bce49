// Anderson's acceleration of a fixed-point iteration x -> g(x).
#pragma once
#include <cstddef>
#include <deque>
#include <vector>

namespace suite {

// Combines the last images so that the residuals g - x, each component times its weight, cancel as well as they can.
// For a linear g it is as good as GMRES: n unknowns need at most n + 1 images, whatever the contraction. Based on: D.
// G. Anderson, "Iterative procedures for nonlinear integral equations", J. ACM 12(4), 1965.
class Anderson {
 public:
  // weights: one a component, > 0; memory: differences it looks back at, 0 = plain iteration.
  explicit Anderson(std::vector<double> weights, size_t memory = 8);
  // The next guess from x and its image g, both as long as the weights.
  std::vector<double> next(const std::vector<double>& x, const std::vector<double>& g);

 private:
  std::vector<double> weights_, last_f_, last_g_;
  size_t memory_;
  std::deque<std::vector<double>> df_, dg_;
};

}  // namespace suite
