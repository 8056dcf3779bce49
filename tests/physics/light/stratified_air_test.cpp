// Real air along segments: identities, and its field against discrete ordinates and against paths that are scattered in
// the same layers.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "air/column.h"
#include "air/diffuse_field.h"
#include "air/discrete_ordinates.h"
#include "light/kinds/sun.h"
#include "light/stratified_air.h"
#include "math/falling.h"
#include "spectral/planck.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test::stratified_air_test {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

SpectralState bins_at(std::vector<double> centers_um, double width_um = 0.01) {
  std::vector<Band> bands;
  for (const double c : centers_um) bands.push_back(Band::rectangular("b", c, width_um));
  return make_state(bands, 1);
}

AirSpec clear_air() {
  AirSpec air;
  air.profile = standard_profile("us_standard");
  return air;
}
AirSpec hazy_air() {
  AirSpec air = clear_air();
  air.aerosol = AirSpec::Aerosol{};
  return air;
}

struct Sun {
  explicit Sun(const SpectralState& state, double zenith_deg, double irradiance = 1)
      : spectrum(state.size(), static_cast<float>(irradiance)),
        beam{dir_from_angles(zenith_deg * kDegree, 0.3), spectrum.data()} {}
  std::vector<float> spectrum;
  Beam beam;
};

struct Seen {
  std::vector<float> T, S;
};
Seen look(const Atmosphere& air, size_t bins, Vec3 from, Dir d, double distance = kFar) {
  Seen seen{std::vector<float>(bins), std::vector<float>(bins)};
  air.path(from, d, distance, seen.T, seen.S);
  return seen;
}

TEST(Falling, MeansAreThoseOfTheirIntegrals) {
  for (double x = 1e-6; x < 80; x *= 1.07) {
    const float f = static_cast<float>(x), keep = exp_falling(f);
    EXPECT_NEAR(keep / std::exp(-double{f}), 1, 2e-7);
    EXPECT_NEAR(mean_of_even(f, keep) / (-std::expm1(-double{f}) / f), 1, 3e-6);
    const long double L = f, rising = x < 1e-2 ? 1 - 2 * L / 3 + L * L / 4 : 2 * (1 - std::exp(-L) * (1 + L)) / (L * L);
    EXPECT_NEAR(mean_of_rising(f, keep) / static_cast<double>(rising), 1, x < 1e-2 ? 3e-6 : 6e-6) << x;
  }
}

// Air of one temperature over a black ground of the same: Planck's radiance in every direction, whatever the gases.
TEST(StratifiedAir, OneTemperatureIsABlackBody) {
  AirSpec air = clear_air();
  air.gases = shared_builtin_gases();
  air.molecules = false;
  for (AirLevel& l : air.profile.levels) l.temperature = 280;
  air.scattering = AirScattering::single;
  const SpectralState state = with_gas_points(air, bins_at({4.3, 6.3, 9.6, 10.5, 15}, 0.05));
  for (const bool round : {false, true}) {
    air.round = round;
    const auto made = make_stratified_air(air, state, {});
    for (const double zenith : {180.0, 150.0, 120.0}) {
      const Dir d = dir_from_angles(zenith * kDegree, 1);
      constexpr double distance = 2e5;
      const Vec3 ground{0, 0, 0}, from = ground - d * distance;
      const Seen seen = look(*made, state.size(), from, d, distance);
      for (size_t i = 0; i < state.size(); ++i) {
        const Bin& b = state.bins[i];
        const double planck = planck_band_radiance(b.low_um, b.high_um, 280) / (b.high_um - b.low_um);
        EXPECT_NEAR((seen.S[i] + seen.T[i] * planck) / planck, 1, 1e-4) << zenith << " " << b.center_um();
      }
    }
  }
}

TEST(StratifiedAir, FromFarAboveIsFromTheTop) {
  AirSpec air = hazy_air();
  air.gases = shared_builtin_gases();
  const SpectralState state = with_gas_points(air, bins_at({0.45, 0.76, 2.1, 10}));
  const Sun sun(state, 40);
  const auto made = make_stratified_air(air, state, {sun.beam});
  const Dir down{0, 0, -1};
  const double top = made->shells().heights().back();
  const Seen far = look(*made, state.size(), {0, 0, 8e5}, down, 8e5),
             near = look(*made, state.size(), {0, 0, top}, down, top);
  for (size_t i = 0; i < state.size(); ++i) {
    EXPECT_NEAR(far.T[i], near.T[i], 1e-6 * near.T[i]);
    EXPECT_NEAR(far.S[i], near.S[i], 1e-6 * near.S[i]);
  }
}

// Beams of sun and moon do not know of each other: together they send what each sends alone.
TEST(StratifiedAir, BeamsAddUp) {
  AirSpec air = hazy_air();
  const SpectralState state = bins_at({0.45, 0.8});
  const Sun sun(state, 50), moon(state, 20, 0.3);
  const Beam turned{dir_from_angles(20 * kDegree, 2), moon.spectrum.data()};
  const auto both = make_stratified_air(air, state, {sun.beam, turned}),
             one = make_stratified_air(air, state, {sun.beam}), other = make_stratified_air(air, state, {turned});
  for (const Dir d : {normalized(Vec3{0.3, 0.2, 1}), normalized(Vec3{-1, 0.4, 0.3}), normalized(Vec3{0.2, -1, -0.4})}) {
    const Vec3 from = d.z > 0 ? Vec3{0, 0, 0} : -d * (3e3 / -d.z);
    const double distance = d.z > 0 ? kFar : 3e3 / -d.z;
    const Seen a = look(*both, state.size(), from, d, distance), b = look(*one, state.size(), from, d, distance),
               c = look(*other, state.size(), from, d, distance);
    // Half as many azimuths on either side of a single beam's plane of symmetry: 1 %.
    for (size_t i = 0; i < state.size(); ++i) EXPECT_NEAR(a.S[i] / (b.S[i] + c.S[i]), 1, 0.01);
  }
}

// Levels twice as close change what is seen from below and from above by less than 0.6 %, where gases are opaque and
// where they are not, reflected and emitted; the transmittance by less than 0.005. 0.53 % at 4.3 um from space (0.1 K),
// where the g-points are grouped otherwise, too; all else 0.5 %.
TEST(StratifiedAir, LevelsAreCloseEnough) {
  AirSpec air = hazy_air();
  air.gases = shared_builtin_gases();
  const SpectralState intervals = bins_at({0.45, 0.76, 0.94, 1.6, 4.3, 9.6, 10.9, 14.5}, 0.02);
  const SpectralState state = with_gas_points(air, intervals);
  air.closer = 2;
  const SpectralState closer = with_gas_points(air, intervals);
  // Interval means: g-points of the two need not be the same.
  const auto seen = [&](const Atmosphere& made, const SpectralState& s, Vec3 from, Dir d, double distance) {
    const Seen one = look(made, s.size(), from, d, distance);
    std::vector<double> means;
    for (size_t i = 0; i < s.size(); ++i) {
      if (s.bins[i].g == 0) means.insert(means.end(), {0, 0});
      means[means.size() - 2] += s.bins[i].weight * one.S[i];
      means[means.size() - 1] += s.bins[i].weight * one.T[i];
    }
    return means;
  };
  AirSpec usual = air;
  usual.closer = 1;
  const Sun sun(state, 50), sun_closer(closer, 50);
  const auto made = make_stratified_air(usual, state, {sun.beam}),
             made_closer = make_stratified_air(air, closer, {sun_closer.beam});
  for (const double zenith : {0.0, 60.0, 180.0, 130.0}) {
    const Dir d = dir_from_angles(zenith * kDegree, 1);
    const bool up = d.z > 0;
    const Vec3 from = up ? Vec3{0, 0, 0} : -d * (2e5 / -d.z);
    const std::vector<double> a = seen(*made, state, from, d, up ? kFar : 2e5 / -d.z),
                              b = seen(*made_closer, closer, from, d, up ? kFar : 2e5 / -d.z);
    for (size_t i = 0; i < a.size(); i += 2) {
      EXPECT_NEAR(a[i] / b[i], 1, i / 2 == 4 ? 0.006 : 0.005) << zenith << ", interval " << i / 2;
      EXPECT_NEAR(a[i + 1], b[i + 1], 0.005) << zenith << ", interval " << i / 2;
    }
  }
}

// What leaves flat air over an even ground, along paths with the tabulated field, is what discrete ordinates say
// themselves; 1 % of the radiance, for molecules and for haze whose forward peak they leave on its way.
TEST(StratifiedAir, PathsGiveTheRadianceOfDiscreteOrdinates) {
  for (const bool haze : {false, true}) {
    AirSpec air = haze ? hazy_air() : clear_air();
    air.round = false;
    air.ground_albedo = Curve::constant(0.3);
    const SpectralState state = bins_at({0.42, 0.55, 0.8});
    const Sun sun(state, 40, 1.5);
    const auto made = make_stratified_air(air, state, {sun.beam});
    const AirColumn column = bake_column(air, state);
    for (size_t bin = 0; bin < state.size(); ++bin) {
      std::vector<DiffuseLayer> layers(column.layers());
      std::vector<std::vector<double>> moments(column.layers());
      for (size_t n = 0; n < layers.size(); ++n) {
        const size_t l = column.layers() - 1 - n, at = l * column.bins + bin;
        const std::span<const double> h = column.shells.heights();
        double scattering = 0;
        moments[n].assign(17, 0);
        for (const AirColumn::Kind& kind : column.kinds)
          for (size_t m = 0; m < 17; ++m) {
            const double own = m < kind.moments[bin].size() ? kind.moments[bin][m] : 0;
            moments[n][m] += kind.scattering[at] * own;
            if (m == 0) scattering += kind.scattering[at];
          }
        for (double& m : moments[n]) m /= scattering;
        moments[n][0] = 1;
        layers[n] = {column.extinction[at] * (h[l + 1] - h[l]), std::min(1.0, scattering / column.extinction[at]),
                     moments[n], 0, 0};
      }
      DiscreteOrdinates solver(16);
      DiffuseProblem problem;
      problem.layers = layers;
      problem.beam = {1.5, sun.beam.direction.z, {}, {}};
      problem.ground_albedo = 0.3;
      solver.solve(problem);
      for (const double zenith : {0.0, 25.0, 50.0, 70.0})
        for (const double turn : {0.0, 60.0, 180.0}) {
          // Looking down: light rises towards azimuth 0.3 + turn.
          const Dir light = dir_from_angles(zenith * kDegree, 0.3 + kPi + turn * kDegree), d = -light;
          const double distance = 2e5 / light.z;
          const Seen seen = look(*made, state.size(), light * distance, d, distance);
          std::vector<double> phases;
          std::vector<float> p(state.size());
          for (size_t n = 0; n < layers.size(); ++n) {
            const size_t l = column.layers() - 1 - n, at = l * column.bins + bin;
            double sum = 0, scattering = 0;
            for (const AirColumn::Kind& kind : column.kinds) {
              const bool uniform = kind.phase->spectrally_uniform();
              kind.phase->eval(dot(sun.beam.direction, d), uniform ? std::span(p).first(1) : std::span(p));
              sum += kind.scattering[at] * p[uniform ? 0 : bin], scattering += kind.scattering[at];
            }
            phases.push_back(sum / scattering);
          }
          const double expected = solver.radiance({0, 0}, light.z, turn * kDegree, phases);
          const double ground = solver.ground_radiance() * seen.T[bin];
          EXPECT_NEAR((seen.S[bin] + ground) / expected, 1, 0.01)
              << (haze ? "haze " : "clear ") << state.bins[bin].center_um() << " um, " << zenith << ", " << turn;
        }
    }
  }
}

// The default against its reference: paths that are scattered in the same layers as often as they are, over a plane of
// the albedo that the field assumes. z-tests of all rays and bands together at 1e-3, with 0.5 % allowed for what the
// field's table of directions is off.
double largest_z(const CaptureResult& a, const CaptureResult& b) {
  constexpr double allowed = 0.005;
  double largest = 0;
  for (size_t i = 0; i < a.radiance.size(); ++i) {
    const double off = std::fabs(a.radiance[i] - b.radiance[i]) - allowed * b.radiance[i];
    largest = std::max(largest, off / std::hypot(a.standard_error[i], b.standard_error[i]));
  }
  return largest;
}
CaptureResult seen_through(AirSpec air, AirScattering scattering, double albedo, uint32_t paths) {
  air.scattering = scattering;
  SourceSpecs sources;
  sources.air = std::make_shared<const AirSpec>(air);
  sources.add(SunSpec{{dir_from_angles(50 * kDegree, 0.3), 0, Curve::constant(1)}});
  std::vector<Ray> rays;
  for (const double turn : {0.5, 2.5}) {
    const Dir d = -dir_from_angles(45 * kDegree, turn);
    rays.push_back({-d * 2e5, d, 0});
  }
  const auto scene = scene_of({quad(1e6, 0, 0)}, {material("ground", lambert(albedo))});
  const std::vector<Band> bands{Band::rectangular("blue", 0.45, 0.01), Band::rectangular("red", 0.67, 0.01),
                                Band::rectangular("infrared", 1.6, 0.02)};
  return render(scene, sources, std::make_unique<RaySensor>(rays, bands, paths, 0.02)).result;
}
TEST(StratifiedAir, TheFieldIsThatOfPathsScatteredInTheAir) {
  AirSpec air = hazy_air();
  air.aerosol->profile = air.aerosol->profile.with_depth(0.5);
  air.ground_albedo = Curve::constant(0.3);
  air.adjacency = false;  // the field by itself: paths would mend what it has wrong
  const CaptureResult field = seen_through(air, AirScattering::diffuse, 0.3, 1024),
                      traced = seen_through(air, AirScattering::traced, 0.3, 6000);
  constexpr double z = 3.8;  // two-sided 1e-3 of 6
  EXPECT_LT(largest_z(field, traced), z);
  // Controls: light that is scattered once only, and a field over another ground.
  EXPECT_GT(largest_z(seen_through(air, AirScattering::single, 0.3, 256), traced), z);
  air.ground_albedo = Curve::constant(0);
  EXPECT_GT(largest_z(seen_through(air, AirScattering::diffuse, 0.3, 256), traced), z);
}

}  // namespace
}  // namespace suite::test::stratified_air_test
