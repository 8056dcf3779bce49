// Draws directions of the upper hemisphere whose density depends on the polar angle only: a table over the cosine, fine
// at grazing. Within a cell directions follow the cosine.
#pragma once
#include <functional>
#include <vector>

#include "math/vec.h"

namespace suite {

class PolarLobe {
 public:
  // Follows weight(mu) x mu, mu in (0, 1); weight >= 0. Follows mu when the weight is 0 everywhere.
  explicit PolarLobe(const std::function<double(double)>& weight);
  Dir sample(Vec2 u) const;
  double pdf(double mu) const;  // 1/sr; mu in (0, 1]

 private:
  std::vector<double> below_;    // share of the cells below each, and 1
  std::vector<double> density_;  // over projected solid angle
};

}  // namespace suite
