// The phase function of leaves against leaves: plates that lie every way, each of which reflects and transmits as
// Lambert's law says.
#include <gtest/gtest.h>

#include <cmath>

#include "optics/phase_function.h"
#include "support/conformance.h"

namespace suite::leaves_test {
namespace {

TEST(LeavesPhase, PlatesThatLieEveryWay) {
  const double r = 0.5, t = 0.3;
  const SpectralState state = test::test_state(1);
  ModelSpec spec{"leaves", {}, {{"transmitted", Curve::constant(t / (r + t))}}, {}, nullptr};
  const auto phase = bake_phase(spec, state);
  constexpr int kHeights = 600, kTurns = 1200;
  for (const double angle : {0.0, 0.3, 1.0, kPi / 2, 2.0, 2.8, kPi}) {
    // Light travels along `in` and on along `out`; a leaf meets |n . in| of it and sends r or t of that on, by the
    // cosine.
    const Vec3 in{0, 0, 1}, out{std::sin(angle), 0, std::cos(angle)};
    double sum = 0;
    for (int i = 0; i < kHeights; ++i)
      for (int j = 0; j < kTurns; ++j) {
        const double z = -1 + (i + 0.5) * 2 / kHeights, a = (j + 0.5) * 2 * kPi / kTurns, s = std::sqrt(1 - z * z);
        const Vec3 n{s * std::cos(a), s * std::sin(a), z};
        const double from = dot(n, in), to = dot(n, out);
        sum += std::fabs(from) * std::fabs(to) * (from * to > 0 ? t : r) / kPi;
      }
    const double mean = sum / (kHeights * kTurns), intercepted = 0.5;
    std::vector<float> p(state.size());
    phase->eval(std::cos(angle), p);
    EXPECT_NEAR(p[0], mean / (intercepted * (r + t)), 2e-5) << angle;
  }
}

}  // namespace
}  // namespace suite::leaves_test
