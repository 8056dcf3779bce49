#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "air/phase_grid.h"
#include "formats/particles/particles.h"
#include "math/vec.h"
#include "optics/phases/henyey_greenstein.h"
#include "support/message_of.h"

namespace suite::format_particles_read_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::string kBulk = "# dust\nwavelength_um, extinction_relative, albedo\n0.4, 1.5, 0.9\n0.55 1 0.95\n0.9,0.5,1\n";

// 1/(4 pi), even in all directions.
std::string even(double factor = 1) {
  const double p = factor / (4 * kPi);
  return strf("wavelength_um angle_deg phase_per_sr\n0.55 0 %.9g\n0.55 90 %.9g\n0.55 180 %.9g\n", p, p, p);
}

TEST(Particles, ExtinctionAndAlbedoBetweenWavelengths) {
  const ReadParticles r = parse_particles(kBulk + even(), "p.txt");
  EXPECT_TRUE(r.notes.empty());
  const double between = std::sqrt(0.55 * 0.9);
  const double at[] = {0.4, between};
  const ParticleOptics o = r.data.optics(at);
  EXPECT_DOUBLE_EQ(o.extinction(0), 1.5);
  EXPECT_DOUBLE_EQ(o.albedo(0), 0.9);
  EXPECT_NEAR(o.extinction(1), std::sqrt(0.5), 1e-9);  // half way of the logarithms
  EXPECT_GT(o.albedo(1), 0.95);
  EXPECT_NEAR(o.asymmetry(1), 0, 1e-9);
  EXPECT_NEAR(o.phase(1)[100], 1 / (4 * kPi), 1e-7);
  EXPECT_EQ(r.data.green(), 1);
  // By way of a specification, and refused outside.
  ParticleSpec spec;
  spec.data = std::make_shared<const ParticleData>(r.data);
  EXPECT_DOUBLE_EQ(particle_optics(spec, at).extinction(0), 1.5);
  EXPECT_THAT(message_of([&] { particle_optics(spec, std::vector<double>{0.91}); }), HasSubstr("'p.txt'"));
}

// The three ways to give one phase function agree: Henyey-Greenstein's moments are powers of its asymmetry.
TEST(Particles, PhaseFunctionsBySeriesTableAndAsymmetry) {
  constexpr double g = 0.6;
  const std::string bulk = "wavelength_um, extinction_m2_g, albedo\n0.4, 0.1, 0.9\n0.9, 0.2, 0.9\n";
  std::string series = bulk + "wavelength_um, order, moment\n",
              table = bulk + "wavelength_um, angle_deg, phase_relative\n";
  for (int l = 0; l < 60; ++l) series += strf("0.5, %d, %.9g\n", l, std::pow(g, l));
  for (int i = 0; i <= 1800; ++i)
    table += strf("0.5, %g, %.9g\n", 0.1 * i, 7 * hg_value(g, std::cos(0.1 * i * kDegree)));
  const std::string named =
      "wavelength_um, extinction_m2_g, albedo, asymmetry\n0.4, 0.1, 0.9, 0.6\n0.9, 0.2, 0.9, 0.6\n";
  const double at[] = {0.5};
  const ParticleOptics a = parse_particles(named, "n").data.optics(at),
                       b = parse_particles(series, "s").data.optics(at),
                       c = parse_particles(table, "t").data.optics(at);
  for (size_t i = 0; i < a.phase(0).size(); ++i) {
    EXPECT_NEAR(b.phase(0)[i] / a.phase(0)[i], 1, 1e-3) << i;
    EXPECT_NEAR(c.phase(0)[i] / a.phase(0)[i], 1, 1e-3) << i;
  }
  EXPECT_NEAR(b.moments(0, 9)[8], std::pow(g, 8), 1e-3);
  EXPECT_NEAR(a.extinction(0), 1000 * 0.1 * std::pow(2.0, std::log(0.5 / 0.4) / std::log(0.9 / 0.4)), 1e-6);
  // Two terms: the mean of the asymmetries by their shares.
  const std::string two =
      "wavelength_um, extinction_m2_g, albedo, asymmetry, asymmetry_2, share_2\n0.4, 0.1, 0.9, 0.8, -0.4, 0.25\n"
      "0.9, 0.2, 0.9, 0.8, -0.4, 0.25\n";
  EXPECT_NEAR(parse_particles(two, "2").data.optics(at).asymmetry(0), 0.75 * 0.8 - 0.25 * 0.4, 1e-3);
}

// Scattering matrices beside the phase function: mixed between wavelengths by what is scattered there.
TEST(Particles, MatricesAreThoseOfTheTable) {
  const double p = 1 / (4 * kPi);
  std::string text = kBulk + "wavelength_um angle_deg phase_per_sr p12 p22 p33 p34 p44\n";
  for (const double um : {0.4, 0.9})
    for (const double angle : {0.0, 90.0, 180.0}) {
      const bool across = angle == 90, blue = um == 0.4;
      text += strf("%g %g %.9g %g 0.9 %g %g %g\n", um, angle, p, across ? (blue ? -0.6 : -0.2) : 0,
                   angle == 180 ? -0.9
                   : across     ? 0.3
                                : 0.9,
                   across ? 0.1 : 0,
                   angle == 180 ? -0.8
                   : across     ? 0.25
                                : 0.8);
    }
  const double at[] = {0.4, std::sqrt(0.4 * 0.9)};
  const ParticleOptics o = parse_particles(text, "p.txt").data.optics(at);
  ASSERT_TRUE(o.matrices());
  const std::vector<PlaneBlocks> blue = o.matrices()(0), mixed = o.matrices()(1);
  for (const double cosine : {-1.0, -0.5, 0.0, 0.25, 1.0}) {
    const PhasePlace place = phase_place(cosine);
    const auto of = [&](const std::vector<PlaneBlocks>& m) {
      return m[place.below] * (1 - place.share) + m[place.below + 1] * place.share;
    };
    const double across = 1 - std::fabs(cosine);
    EXPECT_NEAR(of(blue).b, -0.6 * across, 2e-3);
    EXPECT_NEAR(of(blue).a2, 0.9, 1e-6);
    EXPECT_NEAR(of(blue).d, 0.1 * across, 1e-3);
    // Scattering 1.35 and 0.5 at both ends, half way of the logarithms.
    EXPECT_NEAR(of(mixed).b, across * -(0.6 * 1.35 + 0.2 * 0.5) / 1.85, 2e-3);
  }
  EXPECT_FALSE(parse_particles(kBulk + even(), "p.txt").data.optics(at).matrices());
}

TEST(Particles, WhatShouldBeOneIsMadeSoAndTold) {
  const ReadParticles r = parse_particles(kBulk + even(1.008), "p.txt");
  ASSERT_EQ(r.notes.size(), 1u);
  EXPECT_THAT(r.notes[0], HasSubstr("the integral of the phase function was made 1; it was 1.00800 at 0.55 um"));
  const double at[] = {0.55};
  EXPECT_NEAR(r.data.optics(at).phase(0)[7], 1 / (4 * kPi), 1e-7);
  EXPECT_THAT(message_of([] { parse_particles(kBulk + even(1.02), "p.txt"); }),
              HasSubstr("p.txt:7:1: error: the integral of the phase function at 0.55 um is 1.02, not 1"));
  const std::string bulk = "wavelength_um extinction_relative albedo asymmetry\n0.5 1.005 1 0\n0.6 1.005 1 0\n";
  EXPECT_THAT(parse_particles(bulk, "p").notes.at(0), HasSubstr("1.00500 at 0.55 um"));
  EXPECT_NEAR(parse_particles(bulk, "p").data.extinction_at(0.6), 1, 1e-12);
}

TEST(Particles, RelativeToGreen) {
  const std::string by_gram = "wavelength_um extinction_m2_g albedo asymmetry\n0.5 4 1 0\n0.6 4 1 0\n1 2 1 0\n",
                    far = "wavelength_um extinction_m2_g albedo asymmetry\n8 4 1 0\n14 4 1 0\n";
  const ParticleData data = parse_particles(by_gram, "p").data;
  EXPECT_NEAR(data.green().value(), 4000, 1e-9);
  EXPECT_NEAR(relative(data).extinction_at(1), 0.5, 1e-12);
  EXPECT_FALSE(parse_particles(far, "p").data.green());
  EXPECT_THAT(message_of([&] { relative(parse_particles(far, "p").data); }), HasSubstr("not given"));
}

TEST(Particles, PeaksNarrowerThanTheGridAreTold) {
  std::string text = kBulk + "wavelength_um angle_deg phase_relative\n";
  for (const double angle : {0.0, 0.001, 0.002}) text += strf("0.55 %g %g\n", angle, 1e9);
  const ReadParticles r = parse_particles(text + "0.55 0.003 1\n0.55 180 1\n", "p");
  ASSERT_EQ(r.notes.size(), 1u);
  EXPECT_THAT(r.notes[0], HasSubstr("narrower than the angles"));
}

struct Bad {
  std::string text, message;
};
class BadParticles : public testing::TestWithParam<Bad> {};
TEST_P(BadParticles, AreToldAtTheirPlace) {
  const std::string message = message_of([] { parse_particles(GetParam().text, "p.txt"); });
  EXPECT_THAT(message, HasSubstr(GetParam().message));
  EXPECT_THAT(message, StartsWith("p.txt:"));
}
const std::string kTable = kBulk + "wavelength_um angle_deg phase_per_sr\n",
                  kSeries = kBulk + "wavelength_um order moment\n";
const Bad kBad[] = {
    {"", "holds no particles"},
    {"0.4 1 1\n", "before any names"},
    {"wavelength_um extinction albedo\n", "unknown column 'extinction'"},
    {"wavelength_um albedo albedo\n", "a second column"},
    {"wavelength_um albedo asymmetry\n0.4 1 0\n0.5 1 0\n", "not of extinction"},
    {"wavelength_um extinction_m2_g extinction_relative albedo\n", "not of extinction"},
    {"wavelength_um extinction_m2_g albedo asymmetry\n0.4 1 1 0\n", "1 wavelengths"},
    {"wavelength_um extinction_m2_g albedo asymmetry\n0.4 1 1 0\n0.4 1 1 0\n",
     "p.txt:3:1: error: 0.4 um is not ascending"},
    {"wavelength_um extinction_m2_g albedo asymmetry\n0.4 1 1.1 0\n", "p.txt:2:7"},
    {"wavelength_um extinction_m2_g albedo asymmetry\n0.4 1 1\n", "a row of 3 numbers"},
    {"wavelength_um extinction_m2_g albedo asymmetry_2\n0.4 1 1 0\n0.5 1 1 0\n", "without a first"},
    {"wavelength_um extinction_m2_g albedo asymmetry asymmetry_2\n0.4 1 1 0 0\n0.5 1 1 0 0\n", "has both"},
    {"wavelength_um extinction_relative albedo asymmetry\n0.5 2 1 0\n0.6 2 1 0\n",
     "extinction_relative at 0.55 um is 2"},
    {"wavelength_um extinction_m2_g albedo order\n0.4 1 1 0\n0.5 1 1 0\n", "'order' stands in the first"},
    {kBulk, "no phase function"},
    {"wavelength_um extinction_m2_g albedo asymmetry\n0.4 1 1 0\n0.5 1 1 0\n" + even(), "both asymmetries"},
    {kTable, "without rows"},
    {kTable + "0.5 1 1\n0.5 180 1\n", "an angle of 1 degrees"},
    {kTable + "0.5 0 1\n0.5 0 1\n", "an angle of 0 degrees"},
    {kTable + "0.5 0 1\n0.5 179 1\n", "the last angle"},
    {kTable + "0.5 0 0\n0.5 180 0\n", "all zero"},
    {kTable + "0.5 0 -1\n", "p.txt:7:7"},
    {kBulk + even() + even(), "a third block"},
    {kBulk + "wavelength_um angle_deg phase_per_sr p12\n0.5 0 1 0\n", "1 of the five elements"},
    {kBulk + "wavelength_um order moment p12 p22 p33 p34 p44\n0.5 0 1 0 1 1 0 1\n", "not of phase functions"},
    {kBulk + "wavelength_um angle_deg phase_per_sr p12 p22 p33 p34 p44\n0.5 0 1 0.9 1 1 0 1\n",
     "p.txt:7:1: error: the matrix is none of a scatterer"},
    {kSeries + "0.5 1 0.5\n", "order 1"},
    {kSeries + "0.5 0 1.5\n", "moment"},
    {kSeries + "0.5 0 0.9\n", "the moment of order 0 at 0.5 um is 0.9"},
    {kSeries + "0.5 0 1\n0.5 1 0.9\n", "is negative"},
    {kSeries + "0.5 0 1\n0.4 0 1\n", "0.4 um follow 0.5 um"}};
INSTANTIATE_TEST_SUITE_P(All, BadParticles, testing::ValuesIn(kBad));

}  // namespace
}  // namespace suite::format_particles_read_test
