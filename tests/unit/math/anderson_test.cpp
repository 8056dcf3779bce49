#include "math/anderson.h"

#include <gtest/gtest.h>

#include <cmath>

namespace suite::anderson_test {
namespace {

// A linear map of n unknowns that contracts by 0.999: n + 1 images suffice; plain iteration needs thousands.
TEST(Anderson, SolvesALinearMapInAsManyImagesAsUnknowns) {
  const size_t n = 6;
  const auto image = [n](const std::vector<double>& x) {
    std::vector<double> g(n);
    for (size_t i = 0; i < n; ++i) g[i] = static_cast<double>(i * i) + 0.999 * x[(i + 1) % n];
    return g;
  };
  auto residual = [&](size_t memory, int images) {
    Anderson anderson(std::vector<double>(n, 1.0), memory);
    std::vector<double> x(n, 0.0);
    for (int k = 0; k < images; ++k) x = anderson.next(x, image(x));
    double worst = 0;
    for (size_t i = 0; i < n; ++i) worst = std::fmax(worst, std::fabs(image(x)[i] - x[i]));
    return worst;
  };
  EXPECT_LT(residual(8, static_cast<int>(n) + 1), 1e-10);
  EXPECT_GT(residual(0, static_cast<int>(n) + 1), 1e-3);
}

}  // namespace
}  // namespace suite::anderson_test
