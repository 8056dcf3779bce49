#include "air/ordinate_angles.h"

#include <cmath>

#include "math/vec.h"

namespace suite {

GaussRule gauss_rule(int n) {
  GaussRule rule;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(kPi * (i + 0.75) / (n + 0.5)), slope = 0;
    for (int step = 0; step < 8; ++step) {
      double value = 1, before = 0;
      for (int l = 0; l < n; ++l) {
        const double next = ((2 * l + 1) * x * value - l * before) / (l + 1);
        before = value;
        value = next;
      }
      slope = n * (x * value - before) / (x * x - 1);
      x -= value / slope;
    }
    rule.nodes.push_back((1 + x) / 2);
    rule.weights.push_back(1 / ((1 - x * x) * slope * slope));
  }
  return rule;
}

void associated_legendre(int order, double mu, std::span<double> values) {
  if (values.empty()) return;
  const double sine2 = std::fmax(0.0, 1 - mu * mu);
  double first = 1;
  for (int i = 1; i <= order; ++i) first *= std::sqrt(sine2 * (2 * i - 1) / (2.0 * i));
  double before = 0;
  values[0] = first;
  for (size_t i = 1; i < values.size(); ++i) {
    const double l = order + static_cast<double>(i), m = order;
    const double next = ((2 * l - 1) * mu * values[i - 1] - std::sqrt((l - 1 + m) * (l - 1 - m)) * before) /
                        std::sqrt((l + m) * (l - m));
    before = values[i - 1];
    values[i] = next;
  }
}

}  // namespace suite
