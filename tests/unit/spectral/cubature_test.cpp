// Non-negative least squares, and the choice of a few cells with weights.
#include "spectral/cubature.h"

#include <gtest/gtest.h>

#include <cmath>

#include "spectral/least_squares.h"

namespace suite::cubature_test {
namespace {

TEST(LeastSquares, FitsALineThroughPoints) {
  // y = 1 + 2 x at x = 0, 1, 2, 3 with residuals +1, -1, -1, +1, which are orthogonal to both columns.
  const std::vector<double> x = least_squares({{1, 1, 1, 1}, {0, 1, 2, 3}}, std::vector<double>{2, 2, 4, 8});
  EXPECT_NEAR(x[0], 1, 1e-12);
  EXPECT_NEAR(x[1], 2, 1e-12);
}

TEST(LeastSquares, GivesNothingToAColumnThatRepeatsAnother) {
  const std::vector<double> x = least_squares({{1, 2, 3}, {2, 4, 6}}, std::vector<double>{2, 4, 6});
  EXPECT_NEAR(x[0], 2, 1e-12);
  EXPECT_EQ(x[1], 0);
}

TEST(NonNegativeFit, HoldsUnknownsAtZero) {
  // The free solution is (2, -1); with both not negative it is (1.5, 0).
  const std::vector<std::vector<double>> a{{1, 1}, {1, 0}};
  const std::vector<double> b{1, 2};
  const std::vector<size_t> both{0, 1};
  NonNegativeFit fit;
  fit_non_negative(
      both, [&](size_t j) { return std::span<const double>(a[j]); }, b, [](size_t) { return false; },
      [](const NonNegativeFit&) { return false; }, 2, fit);
  ASSERT_EQ(fit.chosen, std::vector<size_t>{0});
  EXPECT_NEAR(fit.x[0], 1.5, 1e-12);
}

// Three smooth spectra over 200 cells and two bands that overlap.
SpectralProducts smooth() {
  SpectralProducts p;
  p.cells = 200;
  p.spectra.resize(3);
  for (size_t i = 0; i < p.cells; ++i) {
    const double t = static_cast<double>(i) / 200;
    p.spectra[0].push_back(static_cast<float>(1 + 0.3 * std::sin(40 * t)));
    p.spectra[1].push_back(static_cast<float>(0.1 + 0.8 * t * t));
    p.spectra[2].push_back(static_cast<float>(std::exp(-3 * t)));
  }
  constexpr uint32_t one = SpectralProducts::kOne;
  p.products = {{0, {one, one, one}}, {0, {1, one, one}}, {0, {2, one, one}}, {0, {1, 2, one}}, {0, {1, 1, 2}}};
  return p;
}
std::vector<BandCells> bands() {
  std::vector<BandCells> b{{0, std::vector<double>(120, 1.0 / 120)}, {80, std::vector<double>(120, 1.0 / 120)}};
  return b;
}
double error_of(const SpectralProducts& all, const std::vector<BandCells>& b, const ChosenCells& c) {
  double worst = 0;
  for (size_t i = 0; i < b.size(); ++i)
    for (const SpectralProducts::Product& p : all.products) {
      double right = 0, got = 0;
      for (size_t j = 0; j < b[i].share.size(); ++j) right += b[i].share[j] * all.at(p, b[i].first + j);
      for (size_t k = 0; k < c.cells.size(); ++k) got += c.shares[i * c.cells.size() + k] * all.at(p, c.cells[k]);
      worst = std::max(worst, std::fabs(got / right - 1));
    }
  return worst;
}

TEST(ChosenCells, GiveEveryProductWithinTheTolerance) {
  const SpectralProducts all = smooth();
  const std::vector<BandCells> b = bands();
  size_t before = 1000;
  for (const double tolerance : {1e-4, 1e-3, 1e-2}) {
    const ChosenCells c = choose_cells(all, b, tolerance, 100);
    EXPECT_LE(c.error, tolerance);
    EXPECT_NEAR(error_of(all, b, c), c.error, 1e-12);
    EXPECT_LE(c.cells.size(), 12u);  // two bands, five products and the sum each (Tchakaloff)
    EXPECT_LE(c.cells.size(), before);
    before = c.cells.size();
    for (size_t i = 0; i < b.size(); ++i) {
      double sum = 0;
      for (size_t k = 0; k < c.cells.size(); ++k) {
        EXPECT_GE(c.shares[i * c.cells.size() + k], 0);
        sum += c.shares[i * c.cells.size() + k];
      }
      EXPECT_NEAR(sum, 1, 1e-12);
    }
  }
}

TEST(ChosenCells, NeedAllTheyHave) {
  // Negative control: without any one cell (its share given to the others) some product is off.
  const SpectralProducts all = smooth();
  const std::vector<BandCells> b = bands();
  const ChosenCells c = choose_cells(all, b, 1e-3, 100);
  for (size_t gone = 0; gone < c.cells.size(); ++gone) {
    ChosenCells fewer = c;
    for (size_t i = 0; i < b.size(); ++i) {
      double* row = &fewer.shares[i * c.cells.size()];
      const double left = 1 - row[gone];
      row[gone] = 0;
      for (size_t k = 0; k < c.cells.size(); ++k) row[k] /= left;
    }
    EXPECT_GT(error_of(all, b, fewer), 1e-3) << gone;
  }
}

TEST(ChosenCells, TellWhatTheyCannotReach) {
  const ChosenCells c = choose_cells(smooth(), bands(), 1e-3, 1);
  EXPECT_GT(c.error, 1e-3);
  EXPECT_NEAR(error_of(smooth(), bands(), c), c.error, 1e-12);
}

}  // namespace
}  // namespace suite::cubature_test
