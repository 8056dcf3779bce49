#include "correction/air_correction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "air/column.h"
#include "air/discrete_ordinates.h"
#include "correction/air_kernel.h"
#include "math/vec.h"
#include "support/even_air.h"

namespace suite::air_correction_test {
namespace {

using ::testing::HasSubstr;

AirSpec summer(bool haze) {
  AirSpec air;
  air.profile = standard_profile("midlatitude_summer");
  air.gases = shared_builtin_gases();
  if (haze) air.aerosol.emplace();
  return air;
}

SpectralState bins(const AirSpec& air, double low, double high, int count) {
  const std::vector<Band> all{Band::rectangular("all", 0.5 * (low + high), high - low)};
  return with_gas_points(air, make_state(all, (high - low) / count, 0, 1));
}

// Radiance over a ground of albedo a, by the sum of the header.
double summed(const CorrectionBins& c, size_t i, double sun, double mu0, double albedo) {
  const double down = sun * mu0 * c.down_total[i] / kPi + c.emission_down[i];
  return sun * c.path[i] + c.emission_up[i] + down * albedo * c.up_total[i] / (1 - albedo * c.spherical_albedo[i]);
}

TEST(AirCorrection, SumsToTheRadianceOfAGround) {
  // Straight down the reference is the same column solved with that ground (support/even_air.h), over a flat Earth.
  AirSpec air = summer(true);
  air.round = false;
  air.streams = 8;
  const SpectralState state = bins(air, 0.5, 0.9, 8);
  for (const double height : {100e3, 3000.0}) {
    const std::vector<CorrectionView> views{{std::acos(0.8) / kDegree, 0, 0, height}};
    const CorrectionBins c = air_correction(air, state, views).at(0);
    const test::EvenGround ground{Curve::constant(0.3), Curve::constant(1500), 0.8, height};
    const std::vector<double> right = test::even_radiance(air, state, ground);
    for (size_t i = 0; i < state.size(); ++i) EXPECT_NEAR(summed(c, i, 1500, 0.8, 0.3), right[i], 2e-4 * right[i]) << i;
    // Without the light between ground and air it is less: the control of the test.
    EXPECT_LT(summed(c, 0, 1500, 0.8, 0.3) - 1500 * c.spherical_albedo[0] * 0.01, right[0] * (1 - 2e-4));
  }
}

// Sum over the rings of a bin, with its standard error.
std::pair<double, double> sum_of(const AirKernel& kernel, size_t i, size_t rings) {
  double sum = 0, squares = 0;
  for (const auto& batch : kernel.rings) {
    double one = 0;
    for (size_t r = 0; r < rings; ++r) one += batch[r][i];
    sum += one, squares += one * one;
  }
  const auto n = static_cast<double>(kKernelBatches);
  return {sum / n, std::sqrt((squares / n - sum * sum / (n * n)) / (n - 1))};
}

TEST(AirKernel, SumsToTheDiffuseTransmittanceUp) {
  // Of discrete ordinates; 4 standard errors (16 batches: one in a thousand of the 16 numbers beyond) and 0.5 % for 16
  // streams.
  AirSpec air = summer(true);
  air.round = false;
  const SpectralState state = bins(air, 0.45, 0.75, 4);
  const std::vector<double> heights{100e3, 3000.0};
  const std::vector<CorrectionView> views{{30, 0, 0, heights[0]}, {30, 0, 0, heights[1]}};
  const std::vector<CorrectionBins> solved = air_correction(air, state, views);
  const std::vector<AirKernel> kernels = air_kernel(air, state, heights, {{1000, 10000}, 8192, 1});
  for (size_t h = 0; h < heights.size(); ++h)
    for (size_t i = 0; i < state.size(); ++i) {
      const double right = solved[h].up_total[i] - solved[h].up_direct[i];
      const auto [sum, error] = sum_of(kernels[h], i, 3);
      EXPECT_NEAR(sum, right, 4 * error + 0.005 * right) << h << " " << i;
      EXPECT_NEAR(kernels[h].direct[i], solved[h].up_direct[i], 1e-5);
      if (right < 1e-3) continue;  // within oxygen's lines hardly anything comes up
      EXPECT_LT(error, 0.03 * right);
      // Without what comes from beyond 1 km it is not the whole: the control.
      EXPECT_LT(sum_of(kernels[h], i, 1).first, right - 4 * error - 0.005 * right) << h << " " << i;
    }
  // A sensor low in the haze gets more of it from nearby.
  const auto near = [&](size_t h) { return sum_of(kernels[h], 0, 1).first / sum_of(kernels[h], 0, 3).first; };
  EXPECT_GT(near(1), 1.2 * near(0));
}

TEST(AirKernel, RefusesWhatMakesNoSense) {
  const AirSpec air = summer(false);
  const SpectralState state = bins(air, 0.5, 0.6, 1);
  const std::vector<double> above{5000.0}, below{-500.0};
  const auto fault = [&](std::span<const double> heights, const KernelSpec& spec) {
    try {
      air_kernel(air, state, heights, spec);
    } catch (const Error& e) {
      return std::string(e.message());
    }
    return std::string();
  };
  EXPECT_THAT(fault(above, {{100, 100}, 4096, 1}), HasSubstr("do not ascend at 100 m"));
  EXPECT_THAT(fault(above, {{}, 4096, 1}), HasSubstr("no radii"));
  EXPECT_THAT(fault(above, {{100}, 1, 1}), HasSubstr("1 photons"));
  EXPECT_THAT(fault(below, {{100}, 4096, 1}), HasSubstr("not above the ground"));
}

TEST(AirCorrection, IsReciprocal) {
  // What comes down of a beam and what goes up into the same direction is the same share, whatever the layers are
  // (Helmholtz; S. Chandrasekhar, "Radiative transfer", 1950, section 52). TMS takes single scattering alone
  // with the whole phase function, and a view has it where a flux has not: 1 %.
  AirSpec air = summer(true);
  air.round = false;
  const SpectralState state = bins(air, 0.44, 0.7, 6);
  std::vector<CorrectionView> views;
  for (const double zenith : {0.0, 35.0, 60.0}) views.push_back({zenith, zenith, 90, 120e3});
  for (const CorrectionBins& c : air_correction(air, state, views))
    for (size_t i = 0; i < state.size(); ++i) {
      EXPECT_NEAR(c.up_total[i] / c.down_total[i], 1, 0.01) << i;
      EXPECT_NEAR(c.up_direct[i] / c.down_direct[i], 1, 1e-5) << i;
    }
}

TEST(AirCorrection, OfGasesAloneIsBeersLaw) {
  AirSpec air = summer(false);
  air.molecules = false;
  air.round = false;
  const SpectralState state = bins(air, 2.0, 2.1, 2);
  const CorrectionBins c = air_correction(air, state, std::vector<CorrectionView>{{60, 30, 0, 120e3}}).at(0);
  for (size_t i = 0; i < state.size(); ++i) {
    EXPECT_NEAR(c.path[i], 0, 1e-12);
    EXPECT_NEAR(c.spherical_albedo[i], 0, 1e-12);
    EXPECT_NEAR(c.down_total[i], c.down_direct[i], 1e-9);
    EXPECT_NEAR(c.up_total[i], c.up_direct[i], 1e-9);
    // One depth along two slants: t(60) = t(30)^(cos 30 / cos 60).
    EXPECT_NEAR(c.down_direct[i], std::pow(c.up_direct[i], std::cos(30 * kDegree) / 0.5), 1e-6);
  }
}

TEST(AirCorrection, OfARoundEarthIsLessAirForALowSun) {
  AirSpec air = summer(false);
  const SpectralState state = bins(air, 0.45, 0.46, 1);
  const auto direct = [&](bool round) {
    air.round = round;
    return air_correction(air, state, std::vector<CorrectionView>{{85, 0, 0, 120e3}}).at(0).down_direct[0];
  };
  // Kasten & Young (Appl. Opt. 28, 1989) have an air mass of 10.3 at 85 degrees, a flat Earth 11.47.
  const double flat = direct(false), round = direct(true);
  EXPECT_NEAR(11.47 * std::log(round) / std::log(flat), 10.3, 0.25);
}

TEST(AirCorrection, AirAsWarmAsAnOpaqueBodyShinesLikeOne) {
  // In the middle of carbon dioxide's band the air near the ground is opaque: it sends down what a black body sends.
  const AirSpec air = summer(false);
  const SpectralState state = bins(air, 14.8, 15.2, 1);
  const CorrectionBins c = air_correction(air, state, std::vector<CorrectionView>{{30, 0, 0, 120e3}}).at(0);
  const AirColumn column = bake_column(air, state);
  for (size_t i = 0; i < state.size(); ++i) {
    const double black = double{column.blackbody[column.ground * state.size() + i]};
    EXPECT_NEAR(c.emission_down[i] / black, 1, 0.03);
    EXPECT_LT(c.emission_up[i], 0.7 * black);  // from the cold air above
  }
}

TEST(AirCorrection, ThinLayersMayBeSolvedAsOne) {
  // Over bins with and without emission, for a sensor above the air and one within. Bounds: a quarter of the square of
  // the slant depth, 0.01 (1/0.8 + 1). Negative control: layers a hundred times as deep change more than that.
  const AirSpec air = [] {
    AirSpec hazy = summer(true);
    hazy.streams = 8;
    return hazy;
  }();
  const std::vector<CorrectionView> views{{std::acos(0.8) / kDegree, 0, 0, 120e3}, {0, 40, 60, 3000}};
  const auto furthest = [&](const SpectralState& state, double thin) {
    const auto apart = air_correction(air, state, views), joined = air_correction(air, state, views, thin);
    double most = 0;
    for (size_t v = 0; v < views.size(); ++v)
      for (size_t i = 0; i < state.size(); ++i) {
        EXPECT_NEAR(joined[v].up_direct[i], apart[v].up_direct[i], 1e-6);
        EXPECT_NEAR(joined[v].down_direct[i], apart[v].down_direct[i], 1e-12);
        EXPECT_NEAR(joined[v].emission_up[i], apart[v].emission_up[i], 2e-3 * apart[v].emission_up[i] + 1e-12);
        for (const auto member : {&CorrectionBins::path, &CorrectionBins::down_total, &CorrectionBins::up_total,
                                  &CorrectionBins::spherical_albedo})
          most = std::max(most, std::fabs((joined[v].*member)[i] - (apart[v].*member)[i]));
      }
    return most;
  };
  const double bound = 0.25 * std::pow(0.01 * (1 / 0.8 + 1), 2);
  EXPECT_LT(furthest(bins(air, 0.6, 0.95, 4), 0.01), bound);
  EXPECT_LT(furthest(bins(air, 3.6, 4.0, 2), 0.01), bound);
  EXPECT_GT(furthest(bins(air, 0.6, 0.95, 4), 1), bound);
}

TEST(AirCorrection, FaultsAreNamed) {
  const AirSpec air = summer(false);
  const SpectralState state = bins(air, 0.5, 0.6, 1);
  const auto message = [&](CorrectionView v) {
    try {
      air_correction(air, state, std::vector<CorrectionView>{v});
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(message({90, 0, 0, 1e5}), HasSubstr("zenith angle of the sun of 90 deg"));
  EXPECT_THAT(message({30, 80, 0, 1e5}), HasSubstr("zenith angle of the sensor of 80 deg"));
  EXPECT_THAT(message({30, 0, NAN, 1e5}), HasSubstr("relative azimuth"));
  EXPECT_THAT(message({30, 0, 0, 0}), HasSubstr("is not above the ground"));
}

}  // namespace
}  // namespace suite::air_correction_test
