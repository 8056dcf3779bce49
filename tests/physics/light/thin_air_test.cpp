// Short ways and ways out of real air, which are computed by series and from tables, against sums over many steps.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "light/air_vertices.h"
#include "light/stratified_air.h"

namespace suite::thin_air_test {
namespace {

AirSpec hazy_air() {
  AirSpec air;
  air.profile = standard_profile("us_standard");
  air.aerosol = AirSpec::Aerosol{};
  air.gases = shared_builtin_gases();
  air.scattering = AirScattering::single;
  return air;
}

// Oxygen takes what is left of its band within metres and kilometres.
SpectralState some_bins(const AirSpec& air) {
  const std::vector<Band> bands{Band::rectangular("blue", 0.45, 0.01), Band::rectangular("green", 0.55, 0.01),
                                Band::rectangular("oxygen", 0.7625, 0.005), Band::rectangular("infrared", 0.86, 0.01)};
  return with_gas_points(air, make_state(bands, 1));
}

struct Lit {
  explicit Lit(double zenith_deg)
      : state(some_bins(hazy_air())),
        sun(state.size(), 1),
        air(make_stratified_air(hazy_air(), state, {{dir_from_angles(zenith_deg * kDegree, 0.3), sun.data()}})) {}
  SpectralState state;
  std::vector<float> sun;
  std::unique_ptr<const Atmosphere> air;
};

// Light that a way within one layer sends back, in steps; and what it would be if the beam were everywhere as at its
// beginning.
struct Summed {
  std::vector<double> stepped, even;
  std::vector<double> scale;  // what errors are relative to: stepped, or e^-2 of it without any dimming
};
Summed summed(const Lit& lit, Vec3 from, Dir d, double length) {
  constexpr int kSteps = 200;
  const size_t n = lit.state.size(), layer = lit.air->shells().layer_of(lit.air->shells().height(from));
  Summed sums{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
  std::vector<float> scattered(n), depth(n), slope(n), first(n);
  lit.air->beam(0, layer, from, d, {scattered, first, slope});
  for (int i = 0; i < kSteps; ++i) {
    const double s = (i + 0.5) * length / kSteps;
    lit.air->beam(0, layer, from + d * s, d, {scattered, depth, slope});
    for (size_t bin = 0; bin < n; ++bin) {
      const double step = scattered[bin] * length / kSteps, way = double{lit.air->extinction(layer)[bin]} * s;
      sums.stepped[bin] += step * std::exp(-way - double{depth[bin]});
      sums.even[bin] += step * std::exp(-way - double{first[bin]});
    }
  }
  for (size_t bin = 0; bin < n; ++bin)
    sums.scale[bin] = std::max(sums.stepped[bin], std::exp(-2.0) * double{scattered[bin]} * length);
  return sums;
}

TEST(ThinAir, ShortWaysAreSumsOfTheirSteps) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> u(0, 1);
  double worst = 0, without_change = 0, thickest = 0;
  for (const double zenith_deg : {5.0, 40.0, 77.0}) {
    const Lit lit(zenith_deg);
    std::vector<float> T(lit.state.size()), S(T.size());
    for (int i = 0; i < 300; ++i) {
      const Vec3 from{2e3 * (u(random) - 0.5), 0, 1 + 240 * u(random)};
      const double z = i % 2 ? 0.05 * (2 * u(random) - 1) : 2 * u(random) - 1;  // many nearly level
      const Dir d = dir_from_angles(std::acos(z), 2 * kPi * u(random));
      const double to_bound = d.z > 0 ? (248 - from.z) / d.z : (0.1 - from.z) / d.z;
      const double length = std::min(to_bound, std::pow(10, 3.5 * u(random)));
      lit.air->path(from, d, length, T, S);
      const Summed expected = summed(lit, from, d, length);
      for (size_t bin = 0; bin < T.size(); ++bin) {
        // What its steps resolve.
        const double depth = double{lit.air->extinction(0)[bin]} * length;
        if (depth > 4) continue;
        thickest = std::max(thickest, depth);
        worst = std::max(worst, std::fabs(double{S[bin]} - expected.stepped[bin]) / expected.scale[bin]);
        without_change =
            std::max(without_change, std::fabs(expected.even[bin] - expected.stepped[bin]) / expected.scale[bin]);
        EXPECT_NEAR(T[bin], std::exp(-depth), 1e-6);
      }
    }
  }
  std::printf("short ways: %.1e at worst, %.1e if the beam did not change\n", worst, without_change);
  EXPECT_LT(worst, 2e-4);
  EXPECT_GT(without_change, 1e-2);
  EXPECT_GT(thickest, 3);
}

TEST(ThinAir, WaysOutAreThoseOfAllTheirLayers) {
  const Lit lit(40);
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<float> T(lit.state.size()), exact(T.size()), beside(T.size());
  double worst = 0, off = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 from{0, 1e4 * u(random), std::pow(10, 4.3 * u(random)) - 1};
    // Slant, anywhere, and where the Sun stands (over other places, and the edges of its disk).
    const double sun = std::cos(40 * kDegree), cosine = i % 3 == 0   ? 0.051 + 0.1 * u(random)
                                                        : i % 3 == 1 ? 0.051 + 0.949 * u(random)
                                                                     : sun * (0.985 + 0.03 * u(random));
    const Dir d = dir_from_angles(std::acos(cosine), 1);
    lit.air->transmittance(from, d, std::numeric_limits<double>::infinity(), T);
    lit.air->transmittance(from, d, 1e8, exact);
    lit.air->transmittance(from, dir_from_angles(std::acos(cosine) + 1e-3, 1), 1e8, beside);
    for (size_t bin = 0; bin < T.size(); ++bin) {
      worst = std::max(worst, std::fabs(double{T[bin]} - double{exact[bin]}));
      off = std::max(off, std::fabs(double{T[bin]} - double{beside[bin]}));
    }
  }
  std::printf("ways out: %.1e of transmittance at worst; a milliradian beside: %.1e\n", worst, off);
  EXPECT_LT(worst, 5e-6);
  EXPECT_GT(off, 1e-3);
}

AirSpec diffuse_air(bool adjacency) {
  AirSpec air = hazy_air();
  air.scattering = AirScattering::diffuse;
  air.adjacency = adjacency;
  return air;
}
// Under the sun at 40 degrees, with light that is scattered more often.
struct Diffuse {
  explicit Diffuse(bool adjacency = false)
      : state(some_bins(diffuse_air(adjacency))),
        sun(state.size(), 1),
        air(make_stratified_air(diffuse_air(adjacency), state, {{dir_from_angles(40 * kDegree, 0.3), sun.data()}})) {}
  SpectralState state;
  std::vector<float> sun;
  std::unique_ptr<const Atmosphere> air;
};

// path() goes through all at once, parts() piece by piece.
TEST(ThinAir, WaysAtOnceAreTheSumOfTheirParts) {
  const Diffuse lit;
  const size_t n = lit.state.size();
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<float> T(n), S(n), passed(n), thermal(n), single(n), multiple(n);
  double worst = 0, least_more = 1;
  size_t layers = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 from{2e3 * (u(random) - 0.5), 2e3 * (u(random) - 0.5), 1 + 1500 * u(random)};
    const Dir d = dir_from_angles(std::acos(2 * u(random) - 1), 2 * kPi * u(random));
    const double length = std::min(std::pow(10, 3.5 * u(random)), d.z < 0 ? (from.z - 0.5) / -d.z : 1e9);
    lit.air->path(from, d, length, T, S);
    ASSERT_TRUE(lit.air->parts(from, d, length, {passed, thermal, single, multiple}));
    const Shells& shells = lit.air->shells();
    layers = std::max(layers, shells.layer_of(shells.height(from + d * length)) - shells.layer_of(shells.height(from)));
    for (size_t bin = 0; bin < n; ++bin) {
      const double sum = double{thermal[bin]} + double{single[bin]} + double{multiple[bin]};
      EXPECT_NEAR(T[bin], passed[bin], 2e-6);
      // Where little is left of the beam, both are as exact as of what it would send undimmed (as above).
      if (passed[bin] > 0.05) worst = std::max(worst, std::fabs(double{S[bin]} - sum) / sum);
      if (sum > 0) least_more = std::min(least_more, double{multiple[bin]} / sum);
    }
  }
  std::printf("ways at once: %.1e off their parts at worst\n", worst);
  EXPECT_LT(worst, 5e-4);
  EXPECT_LT(least_more, 0.5);
  EXPECT_GT(layers, 1u);
}

// One of the values of the table for each direction; all together what lies between them.
TEST(ThinAir, TheDrawnSkyIsTheSkyInTheMean) {
  const Diffuse lit;
  const size_t n = lit.state.size();
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<float> T(n), S(n), kept(n);
  constexpr int kDirections = 20000;
  double worst = 0, biased = 0;
  for (const double zenith_deg : {20.4, 41.3, 70.6, 85.5})
    for (const double height : {3.0, 480.0}) {
      std::vector<double> drawn(n), squares(n), exact(n);
      for (int i = 0; i < kDirections; ++i) {
        const Dir d = dir_from_angles((zenith_deg + 0.2 * u(random)) * kDegree, 0.31 + 0.01 * u(random));
        const float* const one = lit.air->sky_radiance({0, 0, height}, d, T, kept);
        lit.air->skylight({0, 0, height}, d, T, S);
        for (size_t bin = 0; bin < n; ++bin) {
          const double off = double{one[bin]} - double{S[bin]};
          drawn[bin] += off / kDirections, squares[bin] += off * off / kDirections;
          exact[bin] += double{S[bin]} / kDirections;
        }
      }
      for (size_t bin = 0; bin < n; ++bin) {
        const double error = std::sqrt(squares[bin] / kDirections);
        if (!(error > 0)) continue;
        worst = std::max(worst, std::fabs(drawn[bin]) / error);
        biased = std::max(biased, std::sqrt(squares[bin]) / error);  // the same value for all
      }
    }
  std::printf("drawn sky: %.1f standard errors off at worst\n", worst);
  EXPECT_LT(worst, 4.5);  // two-sided 7e-6 each of some hundred
  EXPECT_GT(biased, 100);
}

// By which paths remember their ways, beside the exact ones.
TEST(ThinAir, ChancesOfBeingScatteredOnAWayAreAboutRight) {
  const Diffuse lit(true);
  const AirVertices* const vertices = lit.air->vertices();
  ASSERT_TRUE(vertices);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> u(0, 1);
  double worst = 0, largest = 0;
  for (int i = 0; i < 5000; ++i) {
    const double cosine = 2 * u(random) - 1;
    const Vec3 from{1e4 * u(random), 1e4 * u(random), std::pow(10, 4 * u(random))};
    const Dir d = dir_from_angles(std::acos(cosine), 2 * kPi * u(random));
    const double length = cosine > 0 && i % 2 ? std::numeric_limits<double>::infinity() : std::pow(10, 4.3 * u(random));
    if (cosine < 0 && length * -cosine > from.z) continue;
    const auto exact = vertices->chances(from, d, length), about = vertices->about_chances(from, d, length);
    for (size_t k = 0; k < lit.state.knots.size(); ++k) {
      worst = std::max(worst, std::fabs(about[k] / exact[k] - 1));
      largest = std::max(largest, exact[k]);
    }
  }
  std::printf("chances: %.3f off at worst, up to %.2f\n", worst, largest);
  EXPECT_LT(worst, 0.1);
  EXPECT_GT(largest, 0.5);
}

// A place moves on with the number that draws it, by what its density says.
TEST(ThinAir, PlacesAreDrawnWithTheDensityTheyTell) {
  const Diffuse lit(true);
  const AirVertices* const vertices = lit.air->vertices();
  ASSERT_TRUE(vertices);
  constexpr int kSteps = 40000;
  struct Way {
    Vec3 from;
    double zenith_deg, length;
  };
  const double far = std::numeric_limits<double>::infinity();
  for (const Way& way :
       {Way{{0, 0, 2}, 10, far}, Way{{0, 0, 2}, 77, far}, Way{{9e3, 0, 3100}, 60, far}, Way{{0, 0, 9000}, 140, 1.1e4},
        Way{{0, 0, 2}, 70, 800}, Way{{0, 0, 2}, 89, far}, Way{{0, 0, 500}, 95, 4000}, Way{{0, 0, 7e5}, 160, 7.4e5}})
    for (size_t knot = 0; knot < lit.state.knots.size(); ++knot) {
      const Dir d = dir_from_angles(way.zenith_deg * kDegree, 0.7);
      double before = 0, integral = 0, others = 0, skewed = 0;
      for (int i = 0; i < kSteps; ++i) {
        const auto place = vertices->draw(way.from, d, way.length, (i + 0.5) / kSteps, knot);
        ASSERT_TRUE(place);
        ASSERT_GE(place->distance, before);
        ASSERT_LE(place->distance, way.length);
        const double height = lit.air->shells().height(way.from + d * place->distance);
        EXPECT_GE(height, lit.air->shells().heights()[place->layer] - 1e-3);
        EXPECT_LE(height, lit.air->shells().heights()[place->layer + 1] + 1e-3);
        // The integral over the places of the density with which others draw them is 1 for each of them.
        const size_t other = (knot + 1) % lit.state.knots.size();
        others += place->density[other] / place->density[knot] / kSteps;
        if (i > 0) integral += place->density[knot] * (place->distance - before);
        if (i > 0) skewed += place->density[knot] * (place->distance - before) * (1 + 0.02 * i / kSteps);
        before = place->distance;
      }
      EXPECT_NEAR(integral, 1, 3e-3) << way.zenith_deg;
      EXPECT_NEAR(others, 1, 3e-3) << way.zenith_deg;
      EXPECT_GT(std::fabs(skewed - 1), 3e-3);  // were it wrong by two parts in a hundred at the far end
    }
}

}  // namespace
}  // namespace suite::thin_air_test
