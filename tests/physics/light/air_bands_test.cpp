// Real air with its builtin gases, along segments, against other programs' bands: MODTRAN's transmittance along the
// horizon, and windows of the thermal infrared as brightness temperatures. The numbers come from
// `scripts/air_reference bands`, which names the files that it reads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "air/column.h"
#include "light/stratified_air.h"
#include "spectral/planck.h"

namespace suite::air_bands_test {
namespace {

// Intervals side by side, by wavenumber, with their g-points.
SpectralState intervals_of(const AirSpec& air, double low_cm, double width_cm, int count) {
  SpectralState state =
      make_state(std::vector<Band>{Band::rectangular("all", 0.5e4 / low_cm + 0.5e4 / (low_cm + count * width_cm),
                                                     1e4 / low_cm - 1e4 / (low_cm + count * width_cm))},
                 1e3);
  state.bins.clear();
  for (int i = count; i-- > 0;)
    state.bins.push_back({1e4 / (low_cm + (i + 1) * width_cm), 1e4 / (low_cm + i * width_cm)});
  place_knots(state, 1);
  return with_gas_points(air, state);
}

// Means over the intervals, by ascending wavenumber.
std::vector<double> means(const SpectralState& state, const std::vector<float>& values) {
  std::vector<double> sums;
  for (size_t i = 0; i < state.size(); ++i) {
    if (state.bins[i].g == 0) sums.push_back(0);
    sums.back() += state.bins[i].weight * double{values[i]};
  }
  return {sums.rbegin(), sums.rend()};
}

// 1 km from the ground up at 89 degrees, tropical air with rural particles and 23 km of visibility: total transmittance
// of MODTRAN (path1000/tape7 of ComputationalRadiometry, MPL-2.0) in 20 cm-1 from 12000 to 14000 cm-1.
TEST(AirBands, TransmittanceAlongTheHorizon) {
  const double modtran[] = {
      0.8006, 0.8151, 0.8151, 0.7686, 0.8219, 0.8258, 0.8312, 0.6302, 0.8354, 0.8127, 0.7562, 0.7156, 0.7145,
      0.7245, 0.7683, 0.8477, 0.8555, 0.8797, 0.8879, 0.8914, 0.8940, 0.8796, 0.8734, 0.8752, 0.8713, 0.8902,
      0.8875, 0.8633, 0.8856, 0.8990, 0.8834, 0.8790, 0.8774, 0.8660, 0.8871, 0.8894, 0.8984, 0.8992, 0.9010,
      0.9011, 0.9008, 0.9005, 0.9005, 0.9003, 0.8999, 0.8996, 0.8993, 0.8987, 0.8975, 0.8945, 0.8859, 0.8622,
      0.8172, 0.7482, 0.7003, 0.6954, 0.7110, 0.5290, 0.8105, 0.8969, 0.8967, 0.8962, 0.8960, 0.8959, 0.8956,
      0.8953, 0.8950, 0.8948, 0.8944, 0.8939, 0.8925, 0.8916, 0.8918, 0.8863, 0.8818, 0.8782, 0.8714, 0.8680,
      0.8495, 0.8575, 0.8456, 0.8398, 0.8378, 0.7576, 0.7745, 0.7337, 0.7737, 0.7658, 0.7540, 0.7262, 0.7026,
      0.7869, 0.8363, 0.7581, 0.6772, 0.6661, 0.6904, 0.7678, 0.8619, 0.8642};
  AirSpec air;
  air.profile = standard_profile("tropical");
  air.gases = shared_builtin_gases();
  air.aerosol = AirSpec::Aerosol{};
  air.scattering = AirScattering::single;
  constexpr int kCount = 100;
  static_assert(std::size(modtran) == kCount);
  const SpectralState state = intervals_of(air, 12000, 20, kCount);
  const auto made = make_stratified_air(air, state, {});
  std::vector<float> T(state.size());
  const auto off = [&](double distance) {
    made->transmittance({0, 0, 0}, dir_from_angles(89 * kDegree, 0), distance, T);
    const std::vector<double> ours = means(state, T);
    double sum = 0, largest = 0;
    for (size_t i = 0; i < kCount; ++i) {
      sum += std::fabs(ours[i] - modtran[i]);
      largest = std::max(largest, std::fabs(ours[i] - modtran[i]));
    }
    std::printf("%.0f m: mean difference %.4f, largest %.4f\n", distance, sum / kCount, largest);
    return sum / kCount;
  };
  EXPECT_LT(off(1000), 0.02);
  EXPECT_GT(off(1500), 0.03) << "control";
}

// From 715 cm-1 on, in 30 cm-1.
constexpr double kFirst = 715, kStep = 30;
constexpr int kWindows = 17;

// What is seen straight down from space over a black ground of 300 K.
std::vector<double> brightness(const std::vector<Gas>& gases, double first = kFirst, size_t windows = kWindows) {
  AirSpec air;
  air.profile = standard_profile("us_standard");
  for (AirLevel& l : air.profile.levels)
    for (size_t g = 0; g < kGases; ++g)
      if (std::find(gases.begin(), gases.end(), static_cast<Gas>(g)) == gases.end()) l.fraction[g] = 0;
  air.gases = shared_builtin_gases();
  air.molecules = false;
  air.scattering = AirScattering::single;
  const SpectralState state = intervals_of(air, first, kStep / 2, static_cast<int>(2 * windows));
  const auto made = make_stratified_air(air, state, {});
  std::vector<float> T(state.size()), S(state.size());
  made->path({0, 0, 120e3}, {0, 0, -1}, 120e3, T, S);
  for (size_t i = 0; i < state.size(); ++i) {
    const Bin& b = state.bins[i];
    const double planck = planck_band_radiance(b.low_um, b.high_um, 300) / (b.high_um - b.low_um);
    // As a share of Planck's function, which varies over the interval.
    S[i] = (S[i] + T[i] * static_cast<float>(planck)) / static_cast<float>(planck);
  }
  const std::vector<double> halves = means(state, S);
  std::vector<double> kelvin;
  for (size_t i = 0; i < windows; ++i) {
    const double um = 1e4 / (first + kStep * (static_cast<double>(i) + 0.5));
    kelvin.push_back(brightness_temperature(um, 0.5 * (halves[2 * i] + halves[2 * i + 1]) * planck_radiance(um, 300)));
  }
  return kelvin;
}

// 8 to 14 um: carbon dioxide, ozone, methane and nitrous oxide each alone and together, by REPTRAN (libRadtran).
// Windows are what keeps above 295 K there: 2 K, but for all four together at the foot of the band at 15 um (775 to 805
// cm-1), which is 2.23 K too cold, 1.99 K of them by carbon dioxide. Within the bands of 9.6 and 15 um up to 5.3 K.
TEST(AirBands, ThermalWindowsOfDryAir) {
  const double reptran[][kWindows] = {{254.24, 288.17, 298.25, 299.71, 299.95, 299.97, 299.94, 299.34, 299.18, 299.97,
                                       298.75, 298.84, 299.33, 300.00, 300.00, 300.00, 300.00},
                                      {296.83, 298.88, 299.82, 299.93, 300.00, 300.00, 300.00, 300.00, 299.80, 291.14,
                                       270.03, 276.23, 298.72, 298.79, 299.22, 299.67, 299.97},
                                      {300.00, 300.00, 300.00, 300.00, 300.00, 300.00, 300.00, 300.00, 300.00, 300.00,
                                       300.00, 300.00, 300.00, 300.00, 299.98, 299.86, 298.76},
                                      {299.99, 300.00, 300.00, 300.00, 300.00, 300.00, 300.00, 300.00, 300.00, 300.00,
                                       300.00, 300.00, 300.00, 299.96, 298.84, 298.95, 299.77},
                                      {253.11, 287.50, 298.08, 299.64, 299.95, 299.97, 299.94, 299.34, 298.98, 291.11,
                                       269.61, 275.29, 298.06, 298.75, 298.08, 298.48, 298.49}};
  const std::vector<Gas> all = {Gas::co2, Gas::o3, Gas::ch4, Gas::n2o};
  for (size_t g = 0; g <= all.size(); ++g) {
    const bool alone = g < all.size();
    const std::string what(alone ? gas_name(all[g]) : "all four");
    const std::vector<double> ours = brightness(alone ? std::vector{all[g]} : all);
    double in_windows = 0, elsewhere = 0;
    for (size_t i = 0; i < kWindows; ++i) {
      const double off = ours[i] - reptran[g][i];
      double& worst = reptran[g][i] > 295 ? in_windows : elsewhere;
      worst = std::max(worst, std::fabs(off));
      if (reptran[g][i] > 295) {
        EXPECT_NEAR(off, 0, i == 2 && !alone ? 2.3 : 2) << what << " from " << kFirst + kStep * double(i) << " cm-1";
      }
    }
    std::printf("%s: windows %.2f K at worst, the rest %.2f K\n", what.c_str(), in_windows, elsewhere);
    EXPECT_LT(elsewhere, 6) << what;
  }
}

// The range that gases report as unsure beyond 14 um, by REPTRAN as above, from 535 to 715 cm-1 without water: 1.65 K
// rms, 2.95 K at most (2.22 and 2.95 K from 16 to 18 um); within what is reported, which allows for water, too, and
// says that this part is not measured.
TEST(AirBands, FootOfCarbonDioxideIsWithinItsReportedLimit) {
  const std::vector<double> reptran = {298.50, 283.96, 250.41, 224.03, 225.47, 227.36};
  const std::vector<double> ours = brightness({Gas::co2, Gas::o3, Gas::ch4, Gas::n2o}, 535, reptran.size());
  double squares = 0, most = 0;
  for (size_t i = 0; i < reptran.size(); ++i) {
    const double off = ours[i] - reptran[i];
    std::printf("from %.0f cm-1: %+.2f K\n", 535 + kStep * static_cast<double>(i), off);
    squares += off * off, most = std::max(most, std::fabs(off));
  }
  const GasLimit limit = builtin_gases().limits().back();
  ASSERT_NEAR(limit.low_um, 14, 1e-9);
  EXPECT_NE(limit.text().find("measured without water: 1.7 K rms, 3 K"), std::string::npos) << limit.text();
  const double rms = std::sqrt(squares / static_cast<double>(reptran.size()));
  EXPECT_LE(rms, limit.kelvin_down.rms);
  EXPECT_LE(most, limit.kelvin_down.most);
  EXPECT_GT(2.5 * rms, limit.kelvin_down.rms) << "a report of any size would pass";
  EXPECT_GT(2.5 * most, limit.kelvin_down.most) << "a report of any size would pass";
}

// The worst of MODTRAN 5.2.1's paths (pybsm 0.16.1, Apache-2.0, atms/1874.bin and 3197.bin;
// tests/bench/air_paths/compare) that go down with a cosine of about 0.2, and of all from 9.3 to 10.15 um (1814.bin,
// 0.1), which exceeded a limit that fewer paths had been asked for: midlatitude summer, rural aerosol of 5 km, over a
// target of 299 K. The limit of slanted paths holds; that of paths straight down does not in ozone's band.
TEST(AirBands, SlantedPathsKeepWithinTheirReportedLimit) {
  struct Path {
    double height, range, low_um, high_um, modtran;  // m; K over the interval
  };
  for (const Path& p : {Path{2e3, 11e3, 9.865, 10.055, 290.087}, Path{20e3, 115e3, 13.095, 13.445, 258.556},
                        Path{1e3, 10e3, 9.865, 10.055, 290.745}}) {
    AirSpec air;
    air.profile = standard_profile("midlatitude_summer");
    air.gases = shared_builtin_gases();
    air.scattering = AirScattering::single;
    air.aerosol = AirSpec::Aerosol{};
    air.aerosol->profile = AerosolProfile(5e3);
    const double middle = 0.5 * (p.low_um + p.high_um), width = p.high_um - p.low_um;
    const std::vector<Band> bands = {Band::rectangular("all", middle, width)};
    const SpectralState state = with_gas_points(air, make_state(bands, 0.01 * (1 + 1e-9), 0, 1));
    const auto made = make_stratified_air(air, state, {});
    const double angle = p.range / air.radius;
    const Vec3 from{0, 0, p.height}, to{air.radius * std::sin(angle), 0, air.radius * (std::cos(angle) - 1)};
    std::vector<float> T(state.size()), S(state.size());
    made->path(from, normalized(to - from), length(to - from), T, S);
    double radiance = 0, weights = 0;
    for (size_t i = 0; i < state.size(); ++i) {
      const Bin& b = state.bins[i];
      const double ground = planck_band_radiance(b.low_um, b.high_um, 299) / (b.high_um - b.low_um);
      radiance += b.weight * (double{S[i]} + double{T[i]} * ground), weights += b.weight;
    }
    const double off = std::fabs(brightness_temperature(middle, radiance / weights) - p.modtran);
    const std::vector<GasLimit> limits = builtin_gases().limits();
    const auto limit = std::find_if(limits.begin(), limits.end(),
                                    [&](const GasLimit& l) { return l.low_um < middle && middle < l.high_um; });
    ASSERT_NE(limit, limits.end());
    std::printf("%.2f um: %.2f K off, reported %.2g K\n", middle, off, limit->kelvin_slanted.most);
    EXPECT_LE(off, limit->kelvin_slanted.most);
    if (middle < 10.15) {
      EXPECT_GT(off, limit->kelvin_down.most);
    }
  }
}

// The continuum of water alone (MT_CKD 4, AER) where its lines are weak; ours has the lines, too, of which no list is
// at hand there, and they show from 1105 cm-1 on. The builtin continuum is the stronger one, as older MT_CKD: too cold.
TEST(AirBands, ThermalWindowsOfWater) {
  const std::vector<double> continuum = {296.10, 296.73, 297.21, 297.67, 298.02, 298.28, 298.53, 298.78, 298.97,
                                         299.12, 299.25, 299.34, 299.41, 299.45, 299.44, 299.35, 299.04};
  ASSERT_EQ(continuum.size(), size_t{kWindows});
  const std::vector<double> ours = brightness({Gas::h2o});
  for (size_t i = 0; i < kWindows; ++i) {
    const double from = kFirst + kStep * static_cast<double>(i);
    std::printf("water from %.0f cm-1: %.2f K, the continuum alone %.2f K\n", from, ours[i], continuum[i]);
    if ((from >= 805 && from < 985) || (from >= 1070 && from < 1105)) {
      EXPECT_NEAR(ours[i], continuum[i], 2) << from;
    }
  }
}

// In the middle of their bands gases let nothing through: seen from the ground the air has its own temperature there.
TEST(AirBands, LineCoresHaveTheTemperatureOfTheAirAround) {
  AirSpec air;
  air.profile = standard_profile("us_standard");
  air.gases = shared_builtin_gases();
  air.scattering = AirScattering::single;
  for (const double middle_cm : {667.5, 2350.0}) {
    const SpectralState state = intervals_of(air, middle_cm - 7.5, 15, 1);
    const auto made = make_stratified_air(air, state, {});
    // Towards the zenith, from the ground and from within air that thins out.
    for (const double height : {0.0, 3100.0, 11500.0}) {
      std::vector<float> T(state.size()), S(state.size());
      made->path({0, 0, height}, {0, 0, 1}, std::numeric_limits<double>::infinity(), T, S);
      const double kelvin = air.profile.at(height).temperature;
      for (size_t i = 0; i < state.size(); ++i) {
        const Bin& b = state.bins[i];
        const double planck = planck_band_radiance(b.low_um, b.high_um, kelvin) / (b.high_um - b.low_um),
                     um = b.center_um(), seen = brightness_temperature(um, S[i] / planck * planck_radiance(um, kelvin)),
                     free_path = 1 / double{made->extinction(made->shells().layer_of(height))[i]};
        std::printf("%.1f cm-1, %.0f m, point %u of weight %.2f: %+.3f K, mean free path %.3g m\n", middle_cm, height,
                    b.g, b.weight, seen - kelvin, free_path);
        // Where the way to the mean free path changes the temperature by less than half of that.
        if (free_path < 7) {
          EXPECT_NEAR(seen, kelvin, 0.1) << middle_cm << " " << height;
        }
      }
      EXPECT_LT(1 / double{made->extinction(made->shells().layer_of(height))[state.size() - 1]}, 7) << "a core";
    }
  }
}

}  // namespace
}  // namespace suite::air_bands_test
