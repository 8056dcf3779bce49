#include "air/lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numeric>

#include "math/vec.h"
#include "support/message_of.h"

namespace suite::lines_test {
namespace {

using testing::HasSubstr;

// scipy.special.wofz(x + 1j y).real of scipy 1.17.1.
TEST(Lines, VoigtFunction) {
  constexpr double cases[][3] = {{0, 0, 1},
                                 {0.5, 0.0001, 0.778735842},
                                 {3, 0.001, 0.000201972425},
                                 {5.5, 0.0001, 1.96626344e-06},
                                 {15, 0.01, 2.52441354e-05},
                                 {25, 2, 0.00179818398},
                                 {1, 1, 0.304744205},
                                 {0, 30, 0.0187958889},
                                 {2, 0.5, 0.103358824}};
  for (const auto& c : cases) EXPECT_NEAR(voigt(c[0], c[1]) / c[2], 1, 1e-5) << c[0] << " " << c[1];
}

LineGas one_line() {
  LineGas gas{.gas = Gas::co2};
  gas.lines = {{2000, 1e-20, 0.07, 0.09, 0, 0.7, 0, 1}};
  return gas;
}

// A line's cross section sums to its intensity, whatever the grids; of a Lorentz line 25 cm-1 leave 2 w / (25 pi).
TEST(Lines, KeepTheirIntensity) {
  const LineGas gas = one_line();
  for (const double pressure : {100.0, 101325.0}) {
    const double step = 0.001;
    const std::vector<double> k = line_spectrum(gas, 1970, step, 60001, pressure, 296);
    const double sum = std::accumulate(k.begin(), k.end(), 0.0) * step;
    const double cut = 2 * 0.07 * pressure / 101325 / (kPi * 25);
    EXPECT_NEAR(sum / (1e-24 * (1 - cut)), 1, 1e-4) << pressure;
  }
}

// In the middle of a line broadened by pressure alone k = S / (pi w); the width falls with temperature.
TEST(Lines, MiddleOfALorentzLine) {
  LineGas gas = one_line();
  gas.lines[0].air_width_cm = 0.5;
  gas.partition = [](int, double) { return 1.0; };
  const auto middle = [&](double kelvin, double share) {
    gas.share = share;
    return line_spectrum(gas, 2000, 0.001, 3, 101325, kelvin)[0];
  };
  EXPECT_NEAR(middle(296, 0) / (1e-24 / (kPi * 0.5)), 1, 1e-3);
  EXPECT_NEAR(middle(296, 1) / (1e-24 / (kPi * 0.09)), 1, 1e-3);
  EXPECT_NEAR(middle(250, 0) / middle(296, 0), std::pow(250 / 296.0, 0.7), 1e-3);
  EXPECT_EQ(partition_ratio(Gas::co2, 148), 0.5);
}

// S(T) / S(296 K) of one state's energy E: exp(-c2 E (1 / T - 1 / 296)) and the stimulated emission of the line itself,
// with c2 = h c / k = 1.4387769 cm K (L. S. Rothman et al., J. Quant. Spectrosc. Radiat. Transfer 60, 1998, equation
// A11).
TEST(Lines, StrengthFollowsTheLowerState) {
  LineGas gas = one_line();
  gas.partition = [](int, double) { return 1.0; };
  SpectralLine& line = gas.lines[0];
  line.wavenumber_cm = 500, line.air_width_cm = line.self_width_cm = 0.5, line.exponent = 0;
  const auto middle = [&](double kelvin) { return line_spectrum(gas, 500, 0.001, 3, 101325, kelvin)[0]; };
  for (const double energy : {0.0, 1000.0})
    for (const double T : {220.0, 350.0}) {
      line.lower_energy_cm = energy;
      const double c2 = 1.4387769, lower = std::exp(-c2 * energy * (1 / T - 1 / 296.0)),
                   stimulated = (1 - std::exp(-c2 * 500 / T)) / (1 - std::exp(-c2 * 500 / 296.0));
      EXPECT_NEAR(middle(T) / middle(296) / (lower * stimulated), 1, 1e-3) << energy << " cm-1, " << T << " K";
    }
}

// A table of one gas: the mean over g is the mean of the spectrum, and levels at its own pressures and temperatures get
// the transmittance of the spectrum itself.
TEST(Lines, TablesKeepMeanAndTransmittance) {
  std::vector<LineGas> gases = {one_line()};
  for (int i = 0; i < 20; ++i)
    gases[0].lines.push_back({2001.0 + 0.9 * i, 1e-21 * (1 + i % 5), 0.07, 0.09, 50.0 * i, 0.7, 0, 1});
  LineBake bake;
  bake.edges_cm = {1995, 2005, 2015};
  bake.pressure = {10000, 100000};
  bake.temperature = {220, 280};
  bake.source = "a test";
  const GasTable table = bake_lines(gases, nullptr, bake);
  const auto provider = table_gases(table);
  std::vector<AirLevel> levels(2);
  levels[0] = {0, 100000, 280, {}}, levels[1] = {100, 99999, 280, {}};
  for (AirLevel& l : levels) l.share(Gas::co2) = 4e-4;
  for (size_t band = 0; band < 2; ++band) {
    const double low = bake.edges_cm[band], step = 0.002;
    const std::vector<double> k = line_spectrum(gases[0], low + step / 2, step, 5000, 100000, 280);
    double mean = 0;
    for (size_t g = 0; g < table.weight.size(); ++g)
      mean += table.weight[g] * static_cast<double>(table.cross_section[table.index(0, band, 1, 1) + g]);
    EXPECT_NEAR(mean / (std::accumulate(k.begin(), k.end(), 0.0) / 5000), 1, 1e-4);
    const GasPoints p = provider->absorbers({low, low + 10, band}, levels)[0];
    for (const double path : {10.0, 1000.0, 100000.0}) {
      double points = 0, truth = 0;
      for (size_t g = 0; g < p.count(); ++g)
        points += p.weight[g] * std::exp(-path * static_cast<double>(p.absorption[g]));
      for (const double x : k) truth += std::exp(-path * x * levels[0].density() * 4e-4) / 5000;
      EXPECT_NEAR(points, truth, 0.005) << path;
    }
  }
  EXPECT_EQ(provider->bands(2000, 2010).size(), 2u);
  EXPECT_EQ(provider->bands(2000, 2005).size(), 1u);
}

// Fewer points are sums of neighbours: the mean of k stays. Every spectrum is told when it is done.
TEST(Lines, FewerPointsKeepTheMean) {
  const std::vector<LineGas> gases = {one_line()};
  LineBake bake;
  bake.edges_cm = {1995, 2005};
  bake.pressure = {10000, 100000};
  bake.temperature = {220, 280, 300};
  std::atomic<size_t> told = 0;
  bake.done = [&] { ++told; };
  std::vector<double> means;
  for (const size_t points : {16, 8, 4}) {
    bake.points = points;
    const GasTable table = bake_lines(gases, nullptr, bake);
    ASSERT_EQ(table.weight.size(), points);
    const float* k = table.cross_section.data() + table.index(0, 0, 1, 2);
    means.push_back(std::inner_product(table.weight.begin(), table.weight.end(), k, 0.0));
  }
  EXPECT_NEAR(means[1] / means[0], 1, 1e-5);
  EXPECT_NEAR(means[2] / means[0], 1, 1e-5);
  EXPECT_EQ(told, 3 * bake_spectra(1, bake));
}

// Doppler's half width of a heavier isotopologue is smaller as the square root of its mass; under pressure the line is
// as wide as Lorentz's.
TEST(Lines, TheNarrowest) {
  LineGas gas = one_line();
  const double thin = narrowest_line(gas, 1900, 2100, 1e-6, 250).value();
  // nu sqrt(2 ln 2 R T / M) / c of CO2, 44.01 g/mol.
  EXPECT_NEAR(thin / (2000 * std::sqrt(2 * std::log(2.0) * 8.314462618 * 250 / 0.04401) / 299792458), 1, 1e-3);
  gas.mass = [](int isotopologue) { return isotopologue == 1 ? 4 * 0.04401 : 1.0; };
  EXPECT_NEAR(narrowest_line(gas, 1900, 2100, 1e-6, 250).value() / thin, 0.5, 1e-3);
  EXPECT_NEAR(narrowest_line(gas, 1900, 2100, 101325, 296).value(), 0.07, 1e-4);
  EXPECT_FALSE(narrowest_line(gas, 1000, 1999, 101325, 296));
}

// Without lines water absorbs by its continuum alone: foreign by all other air, self by its own pressure.
TEST(Lines, ContinuumOfWater) {
  std::vector<LineGas> gases(1);
  WaterContinuum c{900, 10, std::vector<double>(30, 2e-22), std::vector<double>(30, 3e-26),
                   std::vector<double>(30, 4.0)};
  LineBake bake;
  bake.edges_cm = {1000, 1010};
  bake.pressure = {101325};
  bake.temperature = {280};
  const auto provider = table_gases(bake_lines(gases, &c, bake));
  std::vector<AirLevel> levels(2);
  levels[0] = {0, 101325, 280, {}}, levels[1] = {1, 101324, 280, {}};
  for (AirLevel& l : levels) l.share(Gas::h2o) = 0.01;
  double k = 0;
  for (const GasPoints& p : provider->absorbers({1000, 1010, 0}, levels))
    for (size_t g = 0; g < p.count(); ++g) k += p.weight[g] * static_cast<double>(p.absorption[g]);
  const double field = 1005 * std::tanh(0.5 * 1.438776877 * 1005 / 280), relative = 296.0 / 280;
  const double expected =
      levels[0].density() * 0.01 * 1e-4 * field * relative * (2e-22 * std::pow(relative, 4) * 0.01 + 3e-26);
  EXPECT_NEAR(k / expected, 1, 2e-3);
}

TEST(Lines, RefusesWhatCannotBeBaked) {
  const std::vector<LineGas> gases = {one_line()};
  LineBake bake;
  EXPECT_THAT(message_of([&] { bake_lines(gases, nullptr, bake); }), HasSubstr("without a gas or a band"));
  bake.edges_cm = {1000, 2000};
  EXPECT_THAT(message_of([&] { bake_lines(gases, nullptr, bake); }), HasSubstr("0 pressures"));
  bake.step_cm = 0;
  EXPECT_THAT(message_of([&] { bake_lines(gases, nullptr, bake); }), HasSubstr("a step of 0 cm-1"));
  bake.step_cm = 1e-5;
  EXPECT_THAT(message_of([&] { bake_lines(gases, nullptr, bake); }), HasSubstr("2e7 in a band"));
  bake.step_cm = 0.01, bake.points = 5;
  EXPECT_THAT(message_of([&] { bake_lines(gases, nullptr, bake); }), HasSubstr("5 g-points"));
}

}  // namespace
}  // namespace suite::lines_test
