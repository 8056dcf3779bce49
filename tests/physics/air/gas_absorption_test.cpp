// The builtin gas absorption against what others computed. The numbers come from scripts/air_reference, which names the
// files that it reads; all paths are vertical through all air unless said otherwise.
#include <gtest/gtest.h>

#include <cmath>
#include <string_view>
#include <vector>

#include "air/lowtran.h"
#include "spectral/planck.h"

namespace suite::gas_absorption_test {
namespace {

std::vector<AirLevel> levels_of(const AirProfile& profile, double from = 0) {
  std::vector<AirLevel> levels;
  for (double h = from; h <= 120000; h += h < 20000 ? 500 : h < 50000 ? 2500 : 5000) levels.push_back(profile.at(h));
  return levels;
}

// The same with one gas only.
std::vector<AirLevel> alone(std::vector<AirLevel> levels, Gas gas) {
  for (AirLevel& level : levels)
    for (size_t g = 0; g < kGases; ++g)
      if (static_cast<Gas>(g) != gas) level.fraction[g] = 0;
  return levels;
}

GasReduction points(int most) {
  GasReduction reduction;
  reduction.most = most;
  return reduction;
}

double through(const GasPoints& p, std::span<const AirLevel> levels, double path = 1) {
  const std::vector<double> depth = vertical_depths(p, levels);
  double sum = 0;
  for (size_t g = 0; g < depth.size(); ++g) sum += p.weight[g] * std::exp(-path * depth[g]);
  return sum;
}

double between_cm(std::span<const AirLevel> levels, double low_cm, double high_cm, int most, double path = 1,
                  const GasProvider& gases = builtin_gases()) {
  return through(gas_points(gases, levels, 1e4 / high_cm, 1e4 / low_cm, points(most)), levels, path);
}

// Root mean square and largest of differences.
struct Differences {
  double squares = 0, largest = 0;
  int count = 0;
  void add(double d) { squares += d * d, largest = std::max(largest, std::abs(d)), ++count; }
  double rms() const { return std::sqrt(squares / count); }
};

// LOWTRAN 7 itself, compiled with gfortran: the product of its gases' transmittances, US standard; not in the heads of
// oxygen's A and B bands, 13100 to 13180 and 14525 to 14580 cm-1, which are MODTRAN's (in the latter LOWTRAN has 0.78,
// and lines 0.70).
TEST(GasAbsorption, IsLowtran) {
  constexpr struct {
    double v, transmittance;
  } lowtran[] = {{560, 0.1120},   {690, 0.0000},   {720, 0.0347},   {790, 0.6456},   {900, 0.8785},   {1040, 0.4092},
                 {1110, 0.8405},  {1250, 0.3712},  {1310, 0.0678},  {1400, 0.0000},  {2000, 0.3000},  {2050, 0.4915},
                 {2150, 0.6871},  {2240, 0.0220},  {2400, 0.4317},  {2600, 0.8550},  {2800, 0.7291},  {2950, 0.6427},
                 {3200, 0.3401},  {3400, 0.2651},  {3950, 0.0017},  {4250, 0.7663},  {4700, 0.9508},  {5300, 0.0051},
                 {6000, 0.9698},  {6300, 0.9817},  {7000, 0.1715},  {7900, 0.9279},  {8700, 0.4502},  {10600, 0.4780},
                 {12300, 0.9392}, {13800, 0.8588}, {25000, 1.0000}, {30000, 0.9779}, {32000, 0.5736}, {33000, 0.1209},
                 {36000, 0.0000}};
  const auto levels = levels_of(standard_profile("us_standard"));
  for (const auto& l : lowtran)
    EXPECT_NEAR(between_cm(levels, l.v - 2.5, l.v + 2.5, 16, 1, lowtran_gases()), l.transmittance, 0.004) << l.v;
}

// MODTRAN (tape7.VISSun, tropical, ground to space, 0.40 to 0.75 um; means of 10 nm, LOWTRAN's Rayleigh and rural
// aerosol divided out, which leaves up to 2 % in the blue) and a path of 1 km at the ground (path1000, 0.72 to 0.83
// um).
TEST(GasAbsorption, FollowsModtranFromBlueToInfrared) {
  constexpr double sun[] = {1.0189, 1.0201, 1.0204, 1.0202, 1.0181, 1.0189, 1.0164, 1.0097, 1.0098,
                            1.0079, 0.9936, 0.9974, 0.9900, 0.9824, 0.9731, 0.9733, 0.9636, 0.9510,
                            0.9501, 0.9208, 0.9650, 0.9716, 0.9625, 0.9680, 0.9587, 0.9582, 0.9868,
                            0.9912, 0.9312, 0.9050, 0.9344, 0.8620, 0.7661, 0.8916, 0.9970},
                   ground[] = {0.8507, 0.9376, 0.9993, 0.9882, 0.8462, 1.0045, 0.9956, 0.9830, 0.9801, 0.8606, 0.8733};
  const AirProfile tropical = standard_profile("tropical");
  auto levels = levels_of(tropical);
  Differences vertical, horizontal;
  for (size_t i = 0; i < std::size(sun); ++i) {
    const double low = 0.40 + 0.01 * static_cast<double>(i);
    vertical.add(through(gas_points(builtin_gases(), levels, low, low + 0.01), levels) - sun[i]);
  }
  EXPECT_LT(vertical.rms(), 0.03);
  EXPECT_LT(vertical.largest, 0.10);
  levels = levels_of(tropical, 9);
  for (size_t i = 0; i < std::size(ground); ++i) {
    const double low = 0.72 + 0.01 * static_cast<double>(i);
    const GasPoints p = gas_points(builtin_gases(), levels, low, low + 0.01);
    double sum = 0;
    for (size_t g = 0; g < p.count(); ++g) sum += p.weight[g] * std::exp(-1000 * static_cast<double>(p.absorption[g]));
    horizontal.add(sum - ground[i]);
  }
  EXPECT_LT(horizontal.rms(), 0.03);
  EXPECT_LT(horizontal.largest, 0.10);
  std::printf("MODTRAN: vertical rms %.4f largest %.4f; 1 km rms %.4f largest %.4f\n", vertical.rms(), vertical.largest,
              horizontal.rms(), horizontal.largest);
}

// REPTRAN's thermal bands, pairs of them: 30 cm-1 from 715 cm-1 on, each gas alone, US standard.
TEST(GasAbsorption, FollowsReptranInTheThermalWindow) {
  constexpr struct {
    Gas gas;
    double transmittance[17];
  } reptran[] = {{Gas::co2,
                  {0.1035, 0.6724, 0.9451, 0.9892, 0.9983, 0.9991, 0.9975, 0.9751, 0.9704, 0.9987, 0.9563, 0.9593,
                   0.9735, 1.0000, 1.0000, 1.0000, 0.9999}},
                 {Gas::o3,
                  {0.9454, 0.9806, 0.9969, 0.9987, 1.0000, 1.0000, 1.0000, 0.9999, 0.9955, 0.8205, 0.4549, 0.5464,
                   0.9724, 0.9737, 0.9828, 0.9925, 0.9992}},
                 {Gas::ch4,
                  {1.0000, 1.0000, 1.0000, 1.0000, 1.0000, 1.0000, 1.0000, 1.0000, 1.0000, 1.0000, 1.0000, 1.0000,
                   0.9999, 0.9999, 0.9994, 0.9949, 0.9567}},
                 {Gas::n2o,
                  {0.9999, 1.0000, 1.0000, 1.0000, 1.0000, 1.0000, 1.0000, 0.9999, 1.0000, 1.0000, 1.0000, 1.0000,
                   1.0000, 0.9988, 0.9646, 0.9669, 0.9928}}};
  const auto all = levels_of(standard_profile("us_standard"));
  for (const auto& r : reptran) {
    const auto levels = alone(all, r.gas);
    Differences d;
    for (size_t i = 0; i < std::size(r.transmittance); ++i) {
      const double low = 715 + 30 * static_cast<double>(i);
      d.add(between_cm(levels, low, low + 30, 8) - r.transmittance[i]);
    }
    // LOWTRAN's carbon dioxide: 0.0245 rms.
    EXPECT_LT(d.rms(), r.gas == Gas::co2 ? 0.02 : 0.03) << gas_name(r.gas);
    EXPECT_LT(d.largest, 0.10) << gas_name(r.gas);
    std::printf("REPTRAN %s: rms %.4f largest %.4f\n", std::string(gas_name(r.gas)).c_str(), d.rms(), d.largest);
  }
}

// ecCKD's shortwave bands, all gases, US standard, weighted with its sun (here the Planck function of 5772 K).
TEST(GasAbsorption, FollowsEcckdInTheNearInfrared) {
  constexpr struct {
    double low_cm, high_cm, transmittance;
  } bands[] = {{2600, 3750, 0.3349}, {3750, 5350, 0.5401},  {5350, 7150, 0.6525},
               {7150, 8700, 0.7054}, {8700, 10650, 0.8140}, {10650, 12100, 0.8929}};
  const auto levels = levels_of(standard_profile("us_standard"));
  for (const auto& b : bands) {
    double sum = 0, weights = 0;
    for (double v = b.low_cm; v < b.high_cm; v += 50) {
      const double w = planck_band_radiance(1e4 / (v + 50), 1e4 / v, 5772);
      sum += w * between_cm(levels, v, v + 50, 4);
      weights += w;
    }
    EXPECT_NEAR(sum / weights, b.transmittance, 0.02) << b.low_cm;
  }
}

// libs/air/lines itself, each gas alone, US standard, vertical: oxygen from all lines of HITRAN 2020 in 20 cm-1; water
// from the main isotopologue of HITRAN 2020 with the continuum of MT_CKD 4 (bake_lines: steps of 0.004 to 0.005 cm-1,
// 15 pressures from 1 Pa on by factors of 2.2; 190, 215, 240, 265, 290 and 305 K).
struct LineBand {
  Gas gas;
  double low_cm, width_cm, rms, largest;  // limits of the builtin absorption; LOWTRAN's water exceeds its own
  std::vector<double> transmittance;
};

TEST(GasAbsorption, FollowsLinesOfOxygenAndWater) {
  const LineBand bands[] = {
      // With the head of the A band from MODTRAN, as that of the B band below.
      {Gas::o2,
       12980,
       20,
       0.03,
       0.10,
       {0.9865, 0.9726, 0.9241, 0.8167, 0.6790, 0.5629, 0.5244, 0.5442, 0.2632, 0.8330, 0.9998, 1.0000}},
      {Gas::o2,
       7780,
       20,
       0.02,
       0.10,
       {0.9958, 0.9933, 0.9765, 0.9615, 0.9222, 0.8760, 0.9298, 0.9574, 0.9866, 0.9927, 0.9964}},
      // With the head of the B band at 687 nm from MODTRAN: it is narrower than LOWTRAN's 20 cm-1.
      {Gas::o2,
       14380,
       20,
       0.03,
       0.10,
       {0.9986, 0.9913, 0.9787, 0.9621, 0.9265, 0.8906, 0.8565, 0.9030, 0.6972, 0.9991, 1.0000}},
      {Gas::h2o, 3440, 20, 0.012, 0.04, {0.1508, 0.1024, 0.0325, 0.0167, 0.0073, 0.0007, 0.0000, 0.0000,
                                         0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000,
                                         0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0001,
                                         0.0009, 0.0018, 0.0539, 0.1685, 0.1820, 0.3097}},
      {Gas::h2o,
       2930,
       30,
       0.03,
       0.06,
       {0.7935, 0.5897, 0.5072, 0.4748, 0.3994, 0.2775, 0.2273, 0.6825, 0.4085, 0.2882, 0.2470, 0.2334, 0.3132, 0.4202,
        0.2478, 0.2735, 0.2512}},
      // Of the lines themselves only the main isotopologue: the others take some 0.03 here.
      {Gas::h2o, 1800, 30, 0.06, 0.15, {0.0013, 0.0071, 0.0414, 0.0589, 0.1645, 0.3728, 0.4198,
                                        0.5557, 0.6255, 0.7328, 0.8167, 0.8152, 0.8989, 0.9212,
                                        0.9511, 0.9445, 0.9737, 0.9875, 0.9938, 0.9956}}};
  const auto all = levels_of(standard_profile("us_standard"));
  for (const LineBand& b : bands) {
    const auto levels = alone(all, b.gas);
    Differences d;
    for (size_t i = 0; i < b.transmittance.size(); ++i) {
      const double low = b.low_cm + b.width_cm * static_cast<double>(i);
      d.add(between_cm(levels, low, low + b.width_cm, 8) - b.transmittance[i]);
    }
    EXPECT_LT(d.rms(), b.rms) << b.low_cm;
    EXPECT_LT(d.largest, b.largest) << b.low_cm;
    std::printf("lines of %s from %g cm-1: rms %.4f largest %.4f\n", std::string(gas_name(b.gas)).c_str(), b.low_cm,
                d.rms(), d.largest);
  }
}

// The oxygen A band at 0.76 um there and back: with points a product stays right, with means it does not.
TEST(GasAbsorption, TwoWaysThroughOxygen) {
  const auto levels = levels_of(standard_profile("us_standard"));
  const GasPoints p = gas_points(builtin_gases(), levels, 0.755, 0.765);
  double true_two_way = 0;
  int parts = 0;
  for (double v = 1e4 / 0.765; v < 1e4 / 0.755; v += 5, ++parts) true_two_way += between_cm(levels, v, v + 5, 16, 2);
  true_two_way /= parts;
  const double once = through(p, levels), twice = through(p, levels, 2);
  EXPECT_NEAR(twice, true_two_way, 0.01);
  EXPECT_GT(twice - once * once, 0.1);
  // REPTRAN's 10 nm at 760 nm: 0.73 and 0.67.
  EXPECT_NEAR(once, 0.73, 0.04);
  EXPECT_NEAR(twice, 0.67, 0.04);
}

// What the reduction changes, 60 to 25000 cm-1 in intervals of 20 cm-1. The limits are what sorted 16-point sets
// reduced by Gauss quadrature leave with 4 and 8 points.
TEST(GasAbsorption, FewPointsAreEnough) {
  const auto levels = levels_of(standard_profile("us_standard"));
  Differences by_points[3];
  for (double v = 60; v < 25000; v += 220) {
    double truth = 0;
    for (int i = 0; i < 4; ++i) truth += 0.25 * between_cm(levels, v - 10 + 5 * i, v - 5 + 5 * i, 16);
    for (int i = 0; i < 3; ++i) by_points[i].add(between_cm(levels, v - 10, v + 10, 2 << i) - truth);
  }
  EXPECT_LT(by_points[1].largest, 0.016);
  EXPECT_LT(by_points[1].rms(), 0.004);
  EXPECT_LT(by_points[2].largest, 0.0085);
  EXPECT_LT(by_points[2].rms(), 0.002);
  EXPECT_GT(by_points[0].largest, by_points[1].largest);
}

// Radiance that leaves the air upwards, in W/(m2 sr um), Planck linear in depth within a layer.
double leaving(const GasPoints& p, std::span<const AirLevel> levels, double wavelength_um) {
  const size_t n = p.count();
  double sum = 0;
  for (size_t g = 0; g < n; ++g) {
    double radiance = planck_radiance(wavelength_um, levels[0].temperature);
    for (size_t i = 0; i + 1 < levels.size(); ++i) {
      const double a = static_cast<double>(p.absorption[i * n + g]),
                   b = static_cast<double>(p.absorption[(i + 1) * n + g]);
      const double depth = (2 * std::sqrt(a * b) + (a + b) / 2) / 3 * (levels[i + 1].height - levels[i].height),
                   through = std::exp(-depth), low = planck_radiance(wavelength_um, levels[i].temperature),
                   high = planck_radiance(wavelength_um, levels[i + 1].temperature);
      const double mean = depth < 1e-4 ? 1 - depth / 2 : (1 - through) / depth;
      radiance = radiance * through + high * (1 - mean) + low * (mean - through);
    }
    sum += p.weight[g] * radiance;
  }
  return sum;
}

// What the reduction changes of the light that leaves, 600 to 2700 cm-1 in intervals of 15 cm-1, as brightness
// temperature.
TEST(GasAbsorption, FewPointsKeepTheEmission) {
  const auto levels = levels_of(standard_profile("us_standard"));
  Differences by_points[2];
  for (double v = 600; v < 2700; v += 60) {
    const double um = 1e4 / v;
    double truth = 0;
    for (int i = 0; i < 3; ++i)
      truth +=
          leaving(gas_points(builtin_gases(), levels, 1e4 / (v - 2.5 + 5 * i), 1e4 / (v - 7.5 + 5 * i), {16, 0, 0}),
                  levels, um) /
          3;
    for (int i = 0; i < 2; ++i) {
      const double few =
          leaving(gas_points(builtin_gases(), levels, 1e4 / (v + 7.5), 1e4 / (v - 7.5), points(4 << i)), levels, um);
      by_points[i].add(brightness_temperature(um, few) - brightness_temperature(um, truth));
    }
  }
  EXPECT_LT(by_points[0].rms(), 0.6);
  EXPECT_LT(by_points[0].largest, 2.5);
  EXPECT_LT(by_points[1].rms(), 0.4);
  EXPECT_LT(by_points[1].largest, 1.5);
  std::printf("emission: 4 points rms %.2f K largest %.2f K; 8 points %.2f, %.2f K\n", by_points[0].rms(),
              by_points[0].largest, by_points[1].rms(), by_points[1].largest);
}

}  // namespace
}  // namespace suite::gas_absorption_test
