// Integrals over one layer against quadrature, where their closed forms change and where secants meet k.
#include "air/layer_modes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "air/ordinate_angles.h"

namespace suite::ordinates::layer_modes_test {
namespace {

// sinh(k y) / sinh(k T), for any size of k T.
double shape(double k, double y, double depth) {
  if (k * depth < 1e-9) return y / depth;
  return std::exp(-k * (depth - y)) * -std::expm1(-2 * k * y) / -std::expm1(-2 * k * depth);
}

// 16 points of Gauss's rule in each of 400 parts that grow from both faces.
template <class F>
double quadrature(double depth, F f) {
  static const GaussRule rule = gauss_rule(16);
  double sum = 0;
  const auto part = [&](double from, double to) {
    for (int i = 0; i < 16; ++i) sum += (to - from) * rule.weights[i] * f(from + (to - from) * rule.nodes[i]);
  };
  double from = 0;
  for (int i = 199; i >= 0; --i) {
    const double to = depth / 2 * std::pow(0.8, i);
    part(from, to);
    part(depth - to, depth - from);
    from = to;
  }
  return sum;
}

TEST(LayerModes, BeamIntegrals) {
  for (const double depth : {1e-7, 0.03, 1.0, 50.0})
    for (const double k : {0.0, 1e-5, 0.49 / depth, 0.51 / depth, 1.0, 3.7, 40.0})
      for (const double secant : {0.0, 0.7, 1.0, 3.7, 3.7 * (1 + 1e-12), 40.0, -0.5, 1.01 / depth, 2 * k}) {
        const EndIntegrals i = beam_integrals(k, secant, depth);
        const double top = quadrature(depth,
                                      [&](double x) { return std::exp(-secant * x) * shape(k, depth - x, depth); }),
                     bottom = quadrature(depth, [&](double x) { return std::exp(-secant * x) * shape(k, x, depth); });
        EXPECT_NEAR(i.top, top, 2e-12 * top) << k << " " << secant << " " << depth;
        EXPECT_NEAR(i.bottom, bottom, 2e-12 * bottom) << k << " " << secant << " " << depth;
      }
}

TEST(LayerModes, LinearIntegrals) {
  for (const double depth : {1e-7, 0.03, 1.0, 50.0, 1e5})
    for (const double k : {0.0, 1e-5, 0.09 / depth, 0.11 / depth, 1.0, 40.0}) {
      const EndIntegrals i = linear_integrals(k, depth);
      const double near = quadrature(depth, [&](double x) { return (1 - x / depth) * shape(k, depth - x, depth); }),
                   far = quadrature(depth, [&](double x) { return x / depth * shape(k, depth - x, depth); });
      EXPECT_NEAR(i.top, near, 1e-11 * near) << k << " " << depth;
      EXPECT_NEAR(i.bottom, far, 1e-11 * far + 1e-13 * near) << k << " " << depth;
    }
}

TEST(LayerModes, EmissionAndDecay) {
  for (const double y : {1e-9, 0.0099, 0.0101, 1.0, 30.0}) {
    const EndIntegrals i = emission_integrals(y);
    EXPECT_NEAR(i.top, quadrature(y, [&](double x) { return (1 - x / y) * std::exp(-x); }), 1e-12 * y);
    EXPECT_NEAR(i.bottom, quadrature(y, [&](double x) { return x / y * std::exp(-x); }), 1e-12 * y);
    for (const double a : {-2.0, 0.0, 1e-12, 1.0}) {
      const double exact = quadrature(y, [&](double x) { return std::exp(-a * x); });
      EXPECT_NEAR(decay_integral(a, y), exact, 1e-12 * exact);
    }
  }
}

// Two streams by hand: A = 1 / mu, B = (1 - albedo) / mu (isotropic), k = sqrt(A B); reflection and transmission of the
// two-stream equations (W. Meador, W. Weaver 1980, equations 14 and 15 for isotropic light).
TEST(LayerModes, TwoStreams) {
  for (const double albedo : {0.0, 0.6, 1.0})
    for (const double depth : {1e-12, 0.7, 20.0}) {
      const double mu = 0.5, gain = albedo / 2 / mu, loss = 1 / mu - gain;
      double a[1] = {1 / mu}, b[1] = {(1 - albedo) / mu}, S[1], D[1], k[1], r[1], t[1];
      ASSERT_TRUE(find_modes(a, b, albedo == 1, {S, D, k}, 1));
      EXPECT_NEAR(k[0], std::sqrt(1 - albedo) / mu, 1e-15);
      layer_response({S, D, k}, depth, r, t, 1);
      const double x = k[0] * depth;
      const double reflection = albedo == 1 ? gain * depth / (1 + gain * depth)
                                            : gain * std::sinh(x) / (loss * std::sinh(x) + k[0] * std::cosh(x));
      const double transmission =
          albedo == 1 ? 1 / (1 + gain * depth) : k[0] / (loss * std::sinh(x) + k[0] * std::cosh(x));
      EXPECT_NEAR(r[0], reflection, 1e-14 * std::fmin(1, depth));
      EXPECT_NEAR(t[0], transmission, 1e-15);
    }
}

TEST(LayerModes, RefusesWhatIsNoPhaseFunction) {
  double a[1] = {-1}, b[1] = {1}, S[1], D[1], k[1];
  EXPECT_FALSE(find_modes(a, b, false, {S, D, k}, 1));
  a[0] = 1, b[0] = -1;
  EXPECT_FALSE(find_modes(a, b, false, {S, D, k}, 1));
}

}  // namespace
}  // namespace suite::ordinates::layer_modes_test
