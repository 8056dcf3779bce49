// Mie's series against another program over its whole range, and against closed forms at its ends.
#include "air/mie.h"

#include <gtest/gtest.h>

#include <fstream>
#include <numeric>
#include <sstream>

#include "base/error.h"
#include "math/vec.h"

namespace suite::mie_test {
namespace {

struct Row {
  double x, n, k, extinction, albedo, asymmetry;
  double cosine[5], phase[5];
};

std::vector<Row> reference() {
  std::ifstream in(SUITE_TEST_DATA "/air/mie_miepython.csv");
  std::vector<Row> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream text(line);
    char comma;
    Row r;
    text >> r.x >> comma >> r.n >> comma >> r.k >> comma >> r.extinction >> comma >> r.albedo >> comma >> r.asymmetry;
    for (int i = 0; i < 5; ++i) text >> comma >> r.cosine[i] >> comma >> r.phase[i];
    EXPECT_TRUE(text);
    rows.push_back(r);
  }
  return rows;
}

// The largest relative differences of extinction, albedo and phase function when every index is `factor` times too far
// from 1.
struct Differences {
  double extinction = 0, albedo = 0, asymmetry = 0, phase = 0;
};
Differences differences(double factor) {
  Differences worst;
  for (const Row& r : reference()) {
    const MieSphere sphere(r.x, {1 + factor * (r.n - 1), r.k});
    worst.extinction = std::max(worst.extinction, std::abs(sphere.extinction() / r.extinction - 1));
    worst.albedo = std::max(worst.albedo, std::abs(sphere.albedo() / r.albedo - 1));
    worst.asymmetry = std::max(worst.asymmetry, std::abs(sphere.asymmetry() - r.asymmetry));
    for (int i = 0; i < 5; ++i)
      worst.phase = std::max(worst.phase, std::abs(sphere.phase(r.cosine[i]) / r.phase[i] - 1));
  }
  return worst;
}

TEST(Mie, AgreesWithMiepython) {
  ASSERT_EQ(reference().size(), 200u);
  const Differences is = differences(1), off = differences(1.001);
  EXPECT_LT(is.extinction, 1e-6);
  EXPECT_LT(is.albedo, 1e-6);
  EXPECT_LT(is.asymmetry, 1e-6);
  EXPECT_LT(is.phase, 1e-4);
  // Negative control: an index wrong by 0.1 % of its distance from 1 is seen.
  EXPECT_GT(off.extinction, 1e-3);
  EXPECT_GT(off.phase, 1e-2);
}

TEST(Mie, EndsInRayleighsLimitWithAllDigits) {
  for (const std::complex<double> m : {std::complex<double>(1.5, 0), {1.33, 1e-9}, {1.7, 0.4}, {0.2, 3}}) {
    const double x = 1e-6;
    const MieSphere sphere(x, m);
    // Bohren & Huffman, equations 5.7 and 5.8.
    const std::complex<double> c = (m * m - 1.0) / (m * m + 2.0);
    EXPECT_NEAR(sphere.scattering() / (8.0 / 3 * std::pow(x, 4) * std::norm(c)), 1, 1e-10);
    if (m.imag() > 0) {
      EXPECT_NEAR(sphere.absorption() / (4 * x * c.imag()), 1, 1e-6 * std::max(1e-4, m.imag())) << m;
    }
    for (const double mu : {-1.0, -0.2, 0.5, 1.0})
      EXPECT_NEAR(sphere.phase(mu) / (3 / (16 * kPi) * (1 + mu * mu)), 1, 1e-9);
    EXPECT_NEAR(sphere.asymmetry(), 0, 1e-11);
  }
}

TEST(Mie, LargeSpheresShadeTwice) {
  // The edge's part falls as x^(-2/3): H. van de Hulst, "Light Scattering by Small Particles", 1957, section 17.26.
  for (const double x : {1e3, 1e4, 1e5}) {
    const MieSphere sphere(x, {1.5, 0.1});
    EXPECT_NEAR(sphere.extinction(), 2 + 1.99 * std::pow(x, -2.0 / 3), 0.03 * std::pow(x, -2.0 / 3)) << x;
  }
}

TEST(Mie, ForwardAmplitudeIsExtinction) {
  // The optical theorem (equation 4.76) ties sums that the program forms apart.
  for (const double x : {1e-3, 0.1, 3.0, 50.0, 1e4, 1e5})
    for (const std::complex<double> m : {std::complex<double>(1.33, 0), {1.5, 1e-6}, {0.05, 4}, {2, 1}}) {
      const MieSphere sphere(x, m);
      const auto s = sphere.amplitudes(1);
      EXPECT_NEAR(4 / (x * x) * s.across.real() / sphere.extinction(), 1, 1e-11) << x << m;
      EXPECT_EQ(s.across, s.along);
      if (m.imag() == 0) {
        EXPECT_EQ(sphere.albedo(), 1);
      }
    }
}

TEST(Mie, PhaseFunctionIsWholeAndHasItsAsymmetry) {
  for (const double x : {0.01, 1.0, 30.0, 200.0}) {
    const MieSphere sphere(x, {1.4, 0.01});
    // Simpson's rule in the angle: far finer than the series' highest order. Its error falls as the step's fourth
    // power.
    const int n = 40000;
    double whole = 0, mean = 0;
    for (int i = 0; i <= n; ++i) {
      const double angle = kPi * i / n, w = (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) * kPi / (3 * n);
      const double f = 2 * kPi * std::sin(angle) * sphere.phase(std::cos(angle)) * w;
      whole += f;
      mean += f * std::cos(angle);
    }
    EXPECT_NEAR(whole, 1, 1e-9) << x;
    EXPECT_NEAR(mean, sphere.asymmetry(), 1e-9) << x;
  }
}

TEST(Mie, RefusesWhatIsNoSphere) {
  EXPECT_THROW(MieSphere(-1, {1.5, 0}), Error);
  EXPECT_THROW(MieSphere(0, {1.5, 0}), Error);
  EXPECT_THROW(MieSphere(1e7, {1.5, 0}), Error);
  EXPECT_THROW(MieSphere(std::nan(""), {1.5, 0}), Error);
  EXPECT_THROW(MieSphere(1, {1.5, -0.1}), Error);
  EXPECT_THROW(MieSphere(1, {0, 1}), Error);
  EXPECT_THROW(MieSphere(1, {1, 0}), Error);
  EXPECT_NO_THROW(MieSphere(1e-6, {1.5, 0}));
}

// Scattering matrices in Bohren & Huffman's sign, computed apart in double precision; printed to 8 digits.
TEST(Mie, SumsOfMatricesAreThoseOfAmplitudes) {
  std::vector<double> cosines;
  for (int i = 0; i <= 40; ++i) cosines.push_back(-1 + i / 20.0);
  for (const std::complex<double> index : {std::complex<double>(1.33, 0), std::complex<double>(1.6, 0.05)}) {
    const MieSphere sphere(7.3, index);
    std::vector<PlaneBlocks> sums(cosines.size(), PlaneBlocks{0, 0, 0, 0, 0, 0});
    sphere.add_matrices(cosines, 2.5, sums);
    for (size_t i = 0; i < cosines.size(); ++i) {
      const PlaneBlocks one = sphere.polarised(cosines[i]);
      const double p = 2.5 * sphere.phase(cosines[i]);
      EXPECT_NEAR(sums[i].a, p, 1e-12 * p);
      for (const auto of : {&PlaneBlocks::b, &PlaneBlocks::c, &PlaneBlocks::d, &PlaneBlocks::a2, &PlaneBlocks::c2})
        EXPECT_NEAR(sums[i].*of, p * one.*of, 1e-11 * p) << cosines[i];
    }
  }
}

TEST(Mie, MatricesAgreeWithTheTable) {
  std::ifstream file(SUITE_TEST_DATA "/polarisation/mie_sphere.csv");
  int rows = 0;
  for (std::string line; std::getline(file, line);) {
    double v[10];
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", v, v + 1, v + 2, v + 3, v + 4, v + 5,
                    v + 6, v + 7, v + 8, v + 9) != 10)
      continue;
    const MieSphere sphere(v[0], {v[1], v[2]});
    const double c = std::cos(v[5] * kDegree);
    const PlaneBlocks b = sphere.polarised(c);
    EXPECT_NEAR(4 * kPi * sphere.phase(c), v[6], 2e-8 * std::max(1.0, v[6]));
    EXPECT_NEAR(b.b, v[7], 2e-8) << v[0] << ' ' << v[5];
    EXPECT_NEAR(b.c, v[8], 2e-8) << v[0] << ' ' << v[5];
    EXPECT_NEAR(b.d, v[9], 2e-8) << v[0] << ' ' << v[5];
    EXPECT_GT(least_coherency(b.matrix()), -1e-12);
    ++rows;
  }
  EXPECT_EQ(rows, 52);
}

}  // namespace
}  // namespace suite::mie_test
