#include "air/particles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "air/particle_phase.h"
#include "air/phase_grid.h"
#include "air/spheres.h"
#include "math/sampling.h"
#include "math/stats.h"
#include "math/vec.h"
#include "support/message_of.h"

namespace suite::particles_test {
namespace {

using ::testing::HasSubstr;

const std::vector<double> kWavelengths = {0.21, 0.35, 0.55, 0.86, 1.24, 1.64, 2.13,
                                          3.75, 4.6,  8.6,  10.8, 12.1, 20,   39.9};

TEST(Particles, EveryKindAnswersOverItsRange) {
  for (const ParticleKind& kind : particle_kinds()) {
    const ParticleOptics optics = particle_optics({.name = kind.name}, kWavelengths);
    ASSERT_EQ(optics.size(), kWavelengths.size());
    for (size_t w = 0; w < optics.size(); ++w) {
      EXPECT_GT(optics.extinction(w), 0) << kind.name;
      const std::vector<double> phase(optics.phase(w).begin(), optics.phase(w).end());
      EXPECT_NEAR(phase_integral(phase), 1, 1e-6) << kind.name;
      const std::vector<double> moments = optics.moments(w, 65);
      EXPECT_NEAR(moments[0], 1, 1e-6);
      EXPECT_NEAR(moments[1], optics.asymmetry(w), 1e-6) << kind.name;
      for (const double m : moments) EXPECT_LE(std::abs(m), 1 + 1e-6);
    }
    if (kind.aerosol) {
      EXPECT_NEAR(optics.extinction(2), 1, 1e-12) << kind.name;
    }
    EXPECT_NO_THROW(particle_optics({.name = kind.name}, std::vector<double>{kind.low_um, kind.high_um}));
  }
}

TEST(Particles, GrowWithHumidity) {
  for (const char* name : {"rural", "maritime", "urban", "free_troposphere"}) {
    double asymmetry = 0, albedo = 0, infrared = 0;
    for (double h = 0; h <= 0.9901; h += 0.01) {
      const ParticleOptics optics =
          particle_optics({.name = name, .relative_humidity = std::min(h, 0.99)}, std::vector<double>{0.55, 3});
      EXPECT_GE(optics.asymmetry(0), asymmetry - 1e-6) << name << h;
      EXPECT_GE(optics.albedo(0), albedo) << name << h;
      // Water takes over at its strongest band, where the dry particles hardly act.
      EXPECT_GE(optics.extinction(1), infrared) << name << h;
      asymmetry = optics.asymmetry(0);
      albedo = optics.albedo(0);
      infrared = optics.extinction(1);
    }
    EXPECT_GT(asymmetry, 0.75) << name;
  }
}

TEST(Particles, RefuseWhatTheyDoNotHave) {
  const std::vector<double> green = {0.55};
  EXPECT_THAT(message_of([&] { particle_optics({.name = "rurl"}, green); }), HasSubstr("did you mean 'rural'"));
  EXPECT_THAT(message_of([&] {
                particle_optics({.name = "rural"}, std::vector<double>{0.55, 41});
              }),
              HasSubstr("41 um"));
  EXPECT_THAT(message_of([&] { particle_optics({.name = "ice"}, std::vector<double>{0.201}); }), HasSubstr("0.201 um"));
  EXPECT_THROW(particle_optics({.name = "rural", .relative_humidity = -0.1}, green), Error);
  EXPECT_THROW(particle_optics({.name = "rural", .relative_humidity = 0.995}, green), Error);
  EXPECT_THROW(particle_optics({.name = "rural", .relative_humidity = std::nan("")}, green), Error);
  EXPECT_THROW(particle_optics({.name = "desert", .wind_m_s = 31}, green), Error);
  EXPECT_THROW(particle_optics({.name = "water", .effective_radius_um = -5}, green), Error);
  EXPECT_THROW(particle_optics({.name = "water", .effective_radius_um = 1}, green), Error);
  EXPECT_THROW(particle_optics({.name = "ice", .effective_radius_um = 61}, green), Error);
  ParticleOptics optics;
  const std::vector<double> flat(phase_cosines().size(), 1), negative(flat.size(), -1), none(flat.size(), 0);
  EXPECT_THROW(optics.add(-1, 0.5, flat), Error);
  EXPECT_THROW(optics.add(1, 1.5, flat), Error);
  EXPECT_THROW(optics.add(1, 0.5, negative), Error);
  EXPECT_THROW(optics.add(1, 0.5, none), Error);
  EXPECT_THROW(particle_phase(optics, {}), std::exception);
}

TEST(Particles, TakeSpheresOfAUser) {
  const std::vector<double> wavelengths = {1.0, 0.5, 1.0};
  SphereSpec spheres{SizeDistribution::log_normal(0.1, 1.6), Curve::constant(1.5),
                     Curve({0.5, 1.0}, {0.005, 0.01}, Outside::error), 2000};
  const ParticleOptics optics = sphere_optics(spheres, wavelengths);
  const auto bulk_at = [&](double um, std::span<const double> cosines = {}) {
    return bulk_optics(spheres.sizes, {1.5, 0.01 * um}, um, cosines, 1e-4, BulkMatrices::all);
  };
  for (size_t w = 0; w < 3; ++w) {
    const BulkOptics bulk = bulk_at(wavelengths[w], phase_cosines());
    EXPECT_NEAR(optics.extinction(w) / bulk.mass_extinction(2000), 1, 2e-3);
    EXPECT_NEAR(optics.albedo(w), bulk.albedo(), 1e-3);
    EXPECT_NEAR(optics.asymmetry(w), bulk.asymmetry, 2e-3);
    const std::vector<PlaneBlocks> m = optics.matrices()(w);
    for (size_t i = 0; i < m.size(); ++i) {
      EXPECT_NEAR(m[i].b, bulk.matrices[i].b, 2e-3) << i;
      EXPECT_NEAR(m[i].c, bulk.matrices[i].c, 2e-3) << i;
      EXPECT_NEAR(m[i].d, bulk.matrices[i].d, 2e-3) << i;
      EXPECT_GT(least_coherency(m[i].matrix()), -1e-6) << i;
    }
  }
  // As aerosols have it: over the extinction at 0.55 um.
  spheres.density = 0;
  EXPECT_NEAR(sphere_optics(spheres, wavelengths).extinction(1),
              bulk_at(0.5).extinction_um2 / bulk_at(0.55).extinction_um2, 2e-3);
  EXPECT_THAT(message_of([&] { sphere_optics(spheres, std::vector<double>{1.1}); }), HasSubstr("no index at 1.1 um"));
  spheres.density = -1;
  EXPECT_THROW(sphere_optics(spheres, wavelengths), Error);
}

// Drops of water scatter as spheres do, by a table; of the other named kinds no matrix is known.
TEST(ParticlePhase, PolarisesAsItsSpheresDo) {
  const std::vector<double> wavelengths = {0.55};
  const std::vector<size_t> knots = {0};
  PlaneBlocks m[1];
  for (const ParticleKind& kind : particle_kinds()) {
    const bool known = kind.name == "water";
    const auto phase = particle_phase(particle_optics({.name = kind.name}, wavelengths), knots);
    for (double c = -1; c <= 1; c += 0.03125) {
      const auto of = phase->polarised(c, m);
      EXPECT_EQ(of.unknown, known ? 0 : 1) << kind.name;
      EXPECT_TRUE(of.grey);
      EXPECT_GT(least_coherency(m[0].matrix()), -1e-6) << kind.name << ' ' << c;
      EXPECT_EQ(m[0].a2, known ? 1 : 0);
      EXPECT_EQ(m[0].c2, m[0].c);
    }
    if (!known) continue;
    phase->polarised(1, m);
    EXPECT_NEAR(m[0].c, 1, 2e-3) << kind.name;  // straight on nothing changes
    EXPECT_NEAR(m[0].b, 0, 2e-3);
    phase->polarised(-1, m);
    EXPECT_NEAR(m[0].c, -1, 2e-3);
  }
  // Water of 0.55 um: n = 1.333 (Hale & Querry 1973), gamma distribution of variance 0.1.
  const std::vector<double> cosines = {-0.9, -0.765, -0.5, 0.0, 0.5};
  const BulkOptics drops =
      bulk_optics(SizeDistribution::gamma(6, 0.1), {1.333, 2.46e-9}, 0.55, cosines, 5e-4, BulkMatrices::all);
  const auto phase = particle_phase(particle_optics({.name = "water", .effective_radius_um = 6}, wavelengths), knots);
  for (size_t i = 0; i < cosines.size(); ++i) {
    phase->polarised(cosines[i], m);
    EXPECT_NEAR(m[0].b, drops.matrices[i].b, 0.01) << cosines[i];
    EXPECT_NEAR(m[0].c, drops.matrices[i].c, 0.01) << cosines[i];
    EXPECT_NEAR(m[0].d, drops.matrices[i].d, 0.01) << cosines[i];
  }
}

// p-value of 100000 cosines drawn at a knot against the density of `claimed` there.
double p_of(const PhaseFunction& drawn, const PhaseFunction& claimed, size_t knots, int knot) {
  // Cells of ten angles of the grid; inside the density is read at its nodes and is linear between.
  const std::span<const double> cosines = phase_cosines();
  std::vector<double> edges, expected, observed;
  for (size_t i = 0; i < cosines.size(); i += 9) edges.push_back(cosines[i]);
  expected.assign(edges.size() - 1, 0);
  observed = expected;
  std::vector<float> p(knots);
  const auto density = [&](double c) {
    claimed.pdf(c, p);
    return static_cast<double>(p[static_cast<size_t>(knot)]);
  };
  const int n = 100000;
  for (size_t i = 1; i < cosines.size(); ++i)
    expected[(i - 1) / 9] += n * kPi * (density(cosines[i - 1]) + density(cosines[i])) * (cosines[i] - cosines[i - 1]);
  Pcg32 random(3);
  for (int i = 0; i < n; ++i) {
    const double c = drawn.sample(random.uniform(), knot);
    const size_t cell = static_cast<size_t>(std::upper_bound(edges.begin(), edges.end(), c) - edges.begin());
    observed[std::clamp<size_t>(cell, 1, observed.size()) - 1] += 1;
  }
  return chi_square_test(observed, expected, 20);
}

TEST(ParticlePhase, IsSampledAsItsDensitySays) {
  const std::vector<double> wavelengths = {0.45, 0.65, 2.1};
  const std::vector<size_t> knots = {1, 2};
  // Family-wise significance 1e-3 over 10 tests.
  for (const char* name : {"maritime", "desert", "water"}) {
    const ParticleOptics optics = particle_optics({.name = name}, wavelengths);
    const auto phase = particle_phase(optics, knots);
    std::vector<float> all(3), at_knots(2), g(3);
    for (const double c : {-1.0, -0.8, 0.1, 0.99, 1.0}) {
      phase->eval(c, all);
      phase->pdf(c, at_knots);
      EXPECT_FLOAT_EQ(all[1], at_knots[0]);
      EXPECT_FLOAT_EQ(all[2], at_knots[1]);
    }
    EXPECT_EQ(all[0], optics.phase(0).back());
    phase->asymmetry(g);
    EXPECT_FLOAT_EQ(g[2], static_cast<float>(optics.asymmetry(2)));
    for (int knot = 0; knot < 2; ++knot) EXPECT_GT(p_of(*phase, *phase, 2, knot), 1e-4) << name;
  }
  // Negative control: a little more humidity is not the same function.
  const auto dry = particle_phase(particle_optics({.name = "maritime", .relative_humidity = 0.6}, wavelengths), knots),
             moist =
                 particle_phase(particle_optics({.name = "maritime", .relative_humidity = 0.7}, wavelengths), knots);
  EXPECT_LT(p_of(*dry, *moist, 2, 0), 1e-4);
}

}  // namespace
}  // namespace suite::particles_test
