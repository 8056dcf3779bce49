#include "air/phase_grid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "air/particles.h"
#include "base/error.h"
#include "math/vec.h"

namespace suite::phase_grid_test {
namespace {

TEST(PhaseGrid, AscendsOverAllCosines) {
  for (const std::span<const double> cosines : {phase_cosines(), stored_cosines()}) {
    EXPECT_EQ(cosines.front(), -1);
    EXPECT_EQ(cosines.back(), 1);
    for (size_t i = 1; i < cosines.size(); ++i) EXPECT_GT(cosines[i], cosines[i - 1]);
  }
  EXPECT_EQ(phase_cosines().size(), 3 * (stored_cosines().size() - 1) + 1);
}

TEST(PhaseGrid, MomentsOfHenyeyGreensteinAreItsPowers) {
  for (const double g : {-0.5, 0.0, 0.3, 0.7, 0.85}) {
    const std::vector<double> values = gridded_hg(g);
    EXPECT_NEAR(phase_integral(values), 1, 1e-3) << g;
    std::vector<float> floats;
    for (const double v : values) floats.push_back(static_cast<float>(v / phase_integral(values)));
    const std::vector<double> moments = legendre_moments(floats, 65);
    ASSERT_EQ(moments.size(), 65u);
    for (size_t l = 0; l < moments.size(); ++l)
      EXPECT_NEAR(moments[l], std::pow(g, static_cast<double>(l)), 5e-4) << g << " " << l;
  }
}

TEST(PhaseGrid, MomentsOfALineInTheCosineAreExact) {
  // (1 + a cos) / 4 pi has the moments 1, a / 3, 0, 0 ...
  std::vector<float> values;
  for (const double c : phase_cosines()) values.push_back(static_cast<float>((1 + 0.6 * c) / (4 * kPi)));
  const std::vector<double> moments = legendre_moments(values, 100);
  EXPECT_NEAR(moments[0], 1, 1e-6);
  EXPECT_NEAR(moments[1], 0.2, 1e-6);
  for (size_t l = 2; l < moments.size(); ++l) EXPECT_NEAR(moments[l], 0, 1e-6) << l;
}

TEST(PhaseGrid, RefinesSmoothFunctions) {
  const auto smooth = [](double c) { return std::exp(3 * c) * (1 + 0.5 * std::cos(5 * std::acos(c))); };
  std::vector<double> logs, exact;
  for (const double c : stored_cosines()) logs.push_back(std::log(smooth(c)));
  for (const double c : phase_cosines()) exact.push_back(smooth(c));
  const std::vector<double> fine = refined_phase(logs);
  EXPECT_NEAR(phase_integral(fine), 1, 1e-12);
  const double whole = phase_integral(exact);
  for (size_t i = 0; i < fine.size(); ++i) EXPECT_NEAR(fine[i] / (exact[i] / whole), 1, 2e-3) << phase_cosines()[i];
}

TEST(PhaseGrid, TakesAUsersTable) {
  const std::vector<double> angles = {0, 1, 2, kPi}, values = {10, 1, 1, 2};
  const std::vector<double> gridded = gridded_phase(angles, values);
  // Straight in the cosine between the entries, so up to the scale.
  EXPECT_NEAR(gridded.back() / gridded.front(), 5, 1e-12);
  EXPECT_THROW(gridded_phase({}, {}), Error);
  EXPECT_THROW(gridded_phase(std::vector<double>{0, 1}, std::vector<double>{1, 1}), Error);
  EXPECT_THROW(gridded_phase(std::vector<double>{0, 2, 1, kPi}, values), Error);
  EXPECT_THROW(gridded_phase(angles, std::vector<double>{1, -1, 1, 1}), Error);
  EXPECT_THROW(gridded_phase(angles, std::vector<double>{0, 0, 0, 0}), Error);
  EXPECT_THROW(gridded_hg(1), Error);
}

}  // namespace
}  // namespace suite::phase_grid_test
