// Inherent optical properties of water against published values and closed forms.
#include "water/water.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "optics/phases/sea_particles.h"
#include "support/message_of.h"
#include "water/constituents.h"

namespace suite::water_test {
namespace {

using ::testing::HasSubstr;

TEST(SeaWater, AbsorptionIsThatOfTheTables) {
  // k of Hale & Querry at 0.7 um is 3.35e-8.
  EXPECT_NEAR(pure_water_absorption(PureWater::hale_querry, 0.7), 4 * kPi * 3.35e-8 / 0.7e-6, 1e-9);
  // The two tables are of one group; the later one is known to differ where water is clear.
  for (const double um : {0.65, 0.7, 0.75, 0.8})
    EXPECT_NEAR(pure_water_absorption(PureWater::segelstein, um) / pure_water_absorption(PureWater::hale_querry, um), 1,
                0.03);
  for (const double um : {kWaterLowUm, 10.0, kWaterHighUm})
    EXPECT_GT(pure_water_absorption(PureWater::segelstein, um), 0);
}

TEST(SeaWater, IndexIsThatOfWaterAndRisesWithSalt) {
  // 1.33299 at the sodium line and 20 degrees (CRC Handbook of Chemistry and Physics).
  EXPECT_NEAR(sea_water_index(0.5893, 20, 0), 1.33299, 1e-4);
  // Seawater of 35 PSU at 20 degrees: 1.3394 (R. Austin & G. Halikas, 1976).
  EXPECT_NEAR(sea_water_index(0.5893, 20, 35), 1.3394, 3e-4);
  EXPECT_NEAR(sea_water_index(1.1 - 1e-9, 15, 35), sea_water_index(1.1 + 1e-9, 15, 35), 1e-8);
}

TEST(SeaWater, MoleculesScatterAsPublished) {
  // Backscatter of pure sea water in the synthetic data set of H. Loisel et al., Earth Syst. Sci. Data 15, 2023, half
  // of all (20 degrees, 35 PSU).
  const std::array<std::pair<double, double>, 3> published{
      {{0.40, 3.30460e-3}, {0.45, 1.99510e-3}, {0.50, 1.27711e-3}}};
  for (const auto& [um, back] : published) EXPECT_NEAR(0.5 * sea_water_scattering(um, 20, 35) / back, 1, 5e-3) << um;
  // Salt of 38.4 PSU adds 30 % (A. Morel, 1974; Zhang et al. 2009).
  EXPECT_NEAR(sea_water_scattering(0.5, 20, 38.4) / sea_water_scattering(0.5, 20, 0), 1.30, 0.03);
  EXPECT_NEAR(sea_water_scattering(1.1 - 1e-9, 15, 35) / sea_water_scattering(1.1 + 1e-9, 15, 35), 1, 1e-6);
}

TEST(Constituents, AreWhatTheirSourcesSay) {
  EXPECT_DOUBLE_EQ(phytoplankton_absorption(0.44, 1), 0.0378);
  EXPECT_NEAR(phytoplankton_absorption(0.44, 10), 0.0378 * std::pow(10, 0.6266), 1e-12);
  EXPECT_EQ(phytoplankton_absorption(0.8, 10), 0);
  EXPECT_NEAR(phytoplankton_absorption(0.7 - 1e-12, 1), phytoplankton_absorption(0.7 + 1e-12, 1), 1e-10);
  EXPECT_NEAR(phytoplankton_scattering(0.55, 1), 0.416, 1e-12);
  EXPECT_NEAR(phytoplankton_backscatter(1), 0.007, 1e-12);
  EXPECT_NEAR(dissolved_absorption(0.44, 0.1, 0.014), 0.1, 1e-15);
  EXPECT_NEAR(mineral_scattering(2), 1.02, 1e-12);
}

double backscatter_of(const CosineTable& table) {
  double sum = 0;
  constexpr int n = 20000;
  for (int i = 0; i < n; ++i) sum += 2 * kPi * table.at(-1 + (i + 0.5) / n) / n;
  return sum;
}

TEST(SeaParticles, FournierForandHasItsClosedFormsAndPublishedBackscatter) {
  // n 1.10, slope 3.5835 is the pair of Mobley et al. 2002 that scatters back as Petzold's average particle, 0.0183.
  EXPECT_NEAR(fournier_forand_backscatter(1.10, 3.5835), 0.0183, 1e-4);
  for (const auto& [index, slope] : {std::pair{1.10, 3.5835}, {1.05, 3.25}, {1.2, 4.2}})
    EXPECT_NEAR(backscatter_of(fournier_forand_table(index, slope)) / fournier_forand_backscatter(index, slope), 1,
                2e-3)
        << index;
  for (const double b : {kLeastBackscatter, 0.0183, 0.05, kMostBackscatter}) {
    const SeaParticles p = sea_particles(b);
    EXPECT_NEAR(fournier_forand_backscatter(p.index, p.slope) / b, 1, 1e-6);
  }
}

// The shape itself is normalised before the table normalises it: checked by Simpson's rule in log angle.
TEST(SeaParticles, FournierForandIsNormalised) {
  const double index = 1.1, slope = 3.5835;
  constexpr int n = 20000;
  const double low = std::log(1e-5), high = std::log(kPi);
  double sum = 0;
  for (int i = 0; i <= n; ++i) {
    const double angle = std::exp(low + (high - low) * i / n), w = i == 0 || i == n ? 1 : (i % 2 ? 4 : 2);
    sum +=
        w * 2 * kPi * angle * std::sin(angle) * fournier_forand(index, slope, std::cos(angle)) * (high - low) / n / 3;
  }
  // What lies within 1e-5 rad goes as the angle to 2 |nu|.
  const double within = kPi * 1e-10 * fournier_forand(index, slope, std::cos(1e-5)) / (0.5 * (slope - 3));
  EXPECT_NEAR(sum + within, 1, 2e-4);
}

TEST(SeaParticles, PetzoldHasThePublishedMoments) {
  const CosineTable table = petzold_table();
  EXPECT_NEAR(backscatter_of(table), 0.0183, 2e-4);  // Mobley 1994, section 3.8
  EXPECT_NEAR(table.asymmetry(), 0.924, 2e-3);       // the same
  EXPECT_NEAR(table.at(0) / 4.29232e-3, 1, 0.01);    // normalised as tabulated
}

TEST(Water, IsTheSumOfItsParts) {
  WaterSpec s;
  s.chlorophyll = 0.5, s.dissolved_440 = 0.02, s.mineral = 1;
  const Medium m = water_medium(s);
  EXPECT_NEAR(m.absorption.at(0.44),
              pure_water_absorption(PureWater::segelstein, 0.44) + phytoplankton_absorption(0.44, 0.5) + 0.02 +
                  mineral_absorption(0.44, 1),
              1e-9);
  const double b = sea_water_scattering(0.55, 15, 35) + phytoplankton_scattering(0.55, 0.5) + 0.51;
  EXPECT_NEAR(m.scattering.at(0.55), b, 1e-9);
  EXPECT_NEAR(m.phase.curves.at("minerals").at(0.55), 0.51 / b, 1e-9);
  Medium checked = m;
  check_medium(checked);
  const std::string notes = ::testing::PrintToString(water_notes(s, m));
  EXPECT_THAT(notes, HasSubstr("Raman scattering is left out, some "));
  EXPECT_THAT(notes, HasSubstr("Pope & Fry"));
}

TEST(Water, TakesMeasuredPropertiesAndTheirBackscatter) {
  WaterSpec s;
  std::vector<double> um, sum, back;
  for (int i = 0; i <= 120; ++i) {
    um.push_back(0.4 + 0.0025 * i);
    const double water = sea_water_scattering(um.back(), 15, 35);
    sum.push_back(0.45);
    back.push_back(0.5 * water + 0.01 * (0.45 - water));
  }
  const Curve a({0.4, 0.7}, {0.1, 0.7}, Outside::error), b(um, sum, Outside::error), bb(um, back, Outside::error);
  s.measured = MeasuredWater{a, b, bb, true};
  const Medium m = water_medium(s);
  EXPECT_NEAR(m.absorption.at(0.55), 0.4, 1e-9);
  EXPECT_NEAR(m.scattering.at(0.55), 0.45, 1e-9);
  EXPECT_NEAR(m.phase.numbers.at("backscatter"), 0.01, 1e-6);
  EXPECT_FALSE(m.absorption.covers(0.39, 0.4));
  s.measured->scattering = Curve({0.4, 0.7}, {1e-4, 1e-4}, Outside::error);
  EXPECT_THAT(message_of([&] { water_medium(s); }), HasSubstr("less than the"));
}

TEST(Water, FaultsAreNamed) {
  WaterSpec s;
  s.chlorophyll = -1;
  EXPECT_THAT(message_of([&] {
                water_medium(s, {"w.yaml", 2, 3, {}, -1});
              }),
              HasSubstr("w.yaml:2:3: error: water: chlorophyll -1"));
  s.chlorophyll = 1, s.particles = "sand";
  EXPECT_THAT(message_of([&] { water_medium(s); }), HasSubstr("unknown phase 'sand'"));
  s.particles = "hg", s.temperature_c = 80;
  EXPECT_THAT(message_of([&] { water_medium(s); }), HasSubstr("temperature_c 80"));
}

}  // namespace
}  // namespace suite::water_test
