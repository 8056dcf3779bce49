// Media within layers of air: what the air does between, before and within them, against quadrature through the
// atmosphere's own closed forms, which share nothing with the walk through media; and equilibrium.
#include <gtest/gtest.h>

#include <cmath>

#include "spectral/planck.h"
#include "tests/support/media_kit.h"
#include "transport/media/flight.h"

namespace suite::test::media_air_test {
namespace {

// Two-sided at 4.5 standard errors of 64 independent means: less than 1e-4 a comparison by chance.
constexpr double kSigmas = 4.5;
const Dir kAlong = normalized(Vec3{0.8, 0.1, 0.2});

// One layer at 270 K whose gas dims horizontal ways by about 1/e in 300 m, more at longer waves.
AtmosphereSpec thick_air(double kelvin = 270) {
  AtmosphereSpec a;
  a.heights = {0, 1000};
  a.temperature_k = {kelvin};
  AtmosphereSpec::Gas gas;
  gas.name = "gas";
  gas.layers = {Curve({3, 5}, {2, 5}, Outside::hold)};
  a.gases = {gas};
  return a;
}
std::vector<Band> two_bands() { return {Band::rectangular("a", 3.5, 0.002), Band::rectangular("b", 4.5, 0.002)}; }

// Two cells of 100 m cubed one behind the other along x, of densities 1 and 0.3, from x = 100 m on.
std::shared_ptr<Scene> two_cells(const Medium& m) {
  return scene_with(m, grid_of({2, 1, 1}, translation({100, -50, 0}) * scaling({100, 100, 100}),
                               [](uint32_t i, uint32_t, uint32_t) { return i ? 0.3 : 1.0; }));
}
double density_at(Vec3 p) {
  if (std::fabs(p.y) > 50 || p.z < 0 || p.z > 100 || p.x < 100 || p.x > 300) return 0;
  return p.x < 200 ? 1 : 0.3;
}

TEST(AirAndMedia, AbsorptionAndEmissionAreTheIntegral) {
  const Ray ray{{0, 0, 10}, kAlong, 0};
  const Curve absorption({3, 5}, {0.002, 0.03}, Outside::hold);
  for (const double kelvin : {0.0, 330.0}) {
    Medium gas = medium(absorption, Curve::constant(0));
    gas.temperature_k = kelvin;
    SourceSpecs sources;
    sources.atmosphere = thick_air();
    const auto sensor_bands = two_bands();
    auto run = render(two_cells(gas), sources, std::make_unique<RaySensor>(repeated(ray), sensor_bands, 1 << 8, 0.01));
    for (size_t b = 0; b < 2; ++b) {
      const double low = sensor_bands[b].low_um(), high = sensor_bands[b].high_um();
      SpectralState state;
      state.low_um = low, state.high_um = high, state.reference_um = 0.5 * (low + high);
      state.bins = {{low, high}}, state.knots = {0};
      const auto air = make_layered_atmosphere(thick_air(), state, {});
      const double a = absorption.at(state.reference_um), B = planck_band_radiance(low, high, kelvin) / (high - low);
      // By parts that the atmosphere knows: S grows by T dS, dimmed by the medium up to there.
      double expected = 0, undimmed = 0, depth = 0, before = 0;
      std::vector<float> T(1), S(1);
      constexpr double kStep = 0.05;
      for (double s = 0; s < 400; s += kStep) {
        const double rate = a * density_at(ray.origin + kAlong * (s + 0.5 * kStep));
        air->path(ray.origin, kAlong, s + kStep, T, S);
        depth += 0.5 * rate * kStep;
        expected += (S[0] - before) * std::exp(-depth) + T[0] * std::exp(-depth) * rate * kStep * B;
        depth += 0.5 * rate * kStep;
        before = S[0];
      }
      air->path(ray.origin, kAlong, std::numeric_limits<double>::infinity(), T, S);
      expected += (S[0] - before) * std::exp(-depth);
      undimmed = S[0];
      const Repeated got = over_problems(run.result, b);
      EXPECT_NEAR(got.mean, expected, kSigmas * got.error + 1e-3 * expected) << kelvin << " K, band " << b;
      EXPECT_LT(got.error, 0.005 * expected);
      // Negative control: air that the medium does not dim would be seen.
      if (kelvin == 0) {
        EXPECT_GT(std::fabs(undimmed - expected), 10 * kSigmas * got.error);
      }
    }
  }
}

TEST(AirAndMedia, MediaElsewhereChangeNothing) {
  // Sunlit ground seen through hazy air, with a cloud behind the viewer and without.
  SourceSpecs sources;
  sources.add(SunSpec{dir_from_angles(0.5, 1), 0, Curve::constant(1000)});
  sources.atmosphere = AtmosphereSpec{};
  AtmosphereSpec::Aerosol haze;
  haze.depth_550 = 0.3;
  haze.phase = hg(0.7);
  sources.atmosphere->aerosol = haze;
  PipelineOptions options;
  options.max_nodes = 1;
  const std::vector<Ray> rays{{{0, 0, 3000}, normalized(Vec3{0.5, 0.2, -1}), 0}, {{0, 0, 3000}, {0.6, 0, 0.8}, 0}};
  double first[2] = {};
  for (const bool cloud : {false, true}) {
    auto scene = scene_of({quad(5000, 0, 0)}, {material("ground", lambert(0.3))});
    if (cloud) {
      scene->media = {medium(Curve::constant(0.01), Curve::constant(0.1))};
      scene->grids.push_back(
          grid_of({1, 1, 1}, translation({-9000, -9000, 20}), [](uint32_t, uint32_t, uint32_t) { return 1.0; }));
      scene->volumes.push_back({0, {}});
      check_scene(*scene, "cloud");
    }
    const auto run = render(scene, sources, std::make_unique<RaySensor>(rays, one_band(), 4), options);
    for (size_t r = 0; r < 2; ++r) {
      EXPECT_GT(run.result.radiance[r], 0);
      if (cloud) {
        EXPECT_NEAR(run.result.radiance[r], first[r], 1e-5 * first[r]) << r;
      } else {
        first[r] = run.result.radiance[r];
      }
    }
  }
}

TEST(AirAndMedia, OneTemperatureIsBlack) {
  // Air, gas and walls of 290 K, with scattering that depends on wavelength and scattering that does not.
  for (const bool spectral : {false, true}) {
    auto scene = scene_of({box({-50, -200, -200}, {500, 200, 200}, 0, false)}, {material("wall", lambert(0.5))});
    scene->materials[0].temperature_k = 290;
    Medium gas = medium(Curve({3, 5}, {0.002, 0.01}, Outside::hold),
                        spectral ? Curve({3, 5}, {0.03, 0.002}, Outside::hold) : Curve::constant(0.01), hg(0.5));
    gas.temperature_k = 290;
    scene->media = {gas};
    scene->grids.push_back(grid_of({2, 1, 1}, translation({100, -50, 0}) * scaling({100, 100, 100}),
                                   [](uint32_t i, uint32_t, uint32_t) { return i ? 0.3 : 1.0; }));
    scene->volumes.push_back({0, {}});
    check_scene(*scene, "box");
    SourceSpecs sources;
    sources.atmosphere = thick_air(290);
    PipelineOptions options;
    options.max_nodes = 40;
    const auto bands = two_bands();
    const auto run = render(
        scene, sources, std::make_unique<RaySensor>(repeated({{0, 0, 10}, kAlong, 0}), bands, 1 << 9, 0.01), options);
    for (size_t b = 0; b < 2; ++b) {
      const double B = planck_band_radiance(bands[b].low_um(), bands[b].high_um(), 290) / 0.002;
      const Repeated got = over_problems(run.result, b);
      EXPECT_NEAR(got.mean, B, kSigmas * got.error + 1e-3 * B) << (spectral ? "spectral" : "uniform") << b;
      EXPECT_LT(got.error, 0.01 * B);
    }
  }
}

TEST(AirAndMedia, SunlightScatteredOnceIsTheIntegral) {
  // So thin that scattering a second time adds some parts in a thousand; the gas dims the sun's way and the
  // viewer's.
  constexpr double kScattering = 4e-5, kIrradiance = 500;
  const Dir sun = dir_from_angles(0.6, 1);
  const Medium haze = medium(Curve::constant(0), Curve::constant(kScattering), hg(0.7));
  SourceSpecs sources;
  sources.add(SunSpec{sun, 0, Curve::constant(kIrradiance)});
  sources.atmosphere = thick_air(0.1);  // cold: no light of its own
  const Ray ray{{0, 0, 10}, kAlong, 0};
  const auto bands = two_bands();
  const auto run = render(two_cells(haze), sources, std::make_unique<RaySensor>(repeated(ray), bands, 1 << 14, 0.01));
  for (size_t b = 0; b < 2; ++b) {
    SpectralState state;
    state.low_um = bands[b].low_um(), state.high_um = bands[b].high_um();
    state.reference_um = 0.5 * (state.low_um + state.high_um);
    state.bins = {{state.low_um, state.high_um}}, state.knots = {0};
    const auto air = make_layered_atmosphere(thick_air(0.1), state, {});
    const double g = 0.7, cosine = dot(kAlong, sun);
    const double phase = (1 - g * g) / (4 * kPi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
    double expected = 0, clear = 0;
    std::vector<float> there(1), from(1);
    constexpr double kStep = 0.5;
    for (double s = 0.5 * kStep; s < 400; s += kStep) {
      const Vec3 p = ray.origin + kAlong * s;
      if (density_at(p) == 0) continue;
      air->transmittance(ray.origin, kAlong, s, there);
      air->transmittance(p, sun, std::numeric_limits<double>::infinity(), from);
      const double scattered = kIrradiance * kScattering * density_at(p) * phase * kStep;
      expected += scattered * there[0] * from[0], clear += scattered;
    }
    const Repeated got = over_problems(run.result, b);
    EXPECT_NEAR(got.mean, expected, kSigmas * got.error + 5e-3 * expected) << b;
    EXPECT_LT(got.error, 0.05 * expected);
    EXPECT_GT(clear, 1.5 * expected);  // so that the air matters
  }
}

// Three layers of haze.
AtmosphereSpec low_haze() {
  AtmosphereSpec a;
  a.heights = {0, 60, 400, 5000};
  AtmosphereSpec::Aerosol haze;
  haze.depth_550 = 2;
  haze.scale_height = 300;
  haze.phase = hg(0.6);
  a.aerosol = haze;
  return a;
}
// A warm fog bank through the lowest bound of the haze.
double fog_at(Vec3 p) {
  if (std::fabs(p.y) > 200 || p.z < 20 || p.z > 120 || p.x < 40 || p.x > 240) return 0;
  return p.x < 90 ? 0.5 : p.x < 140 ? 0 : p.x < 190 ? 2 : 1;
}
std::shared_ptr<Scene> fog_bank(bool spectral) {
  Medium fog = medium(Curve({0.4, 0.7}, {0.002, 0.0005}, Outside::hold),
                      spectral ? Curve({0.4, 0.7}, {0.02, 0.004}, Outside::hold) : Curve::constant(0.01), hg(0.8));
  fog.temperature_k = 1500;
  return scene_with(fog, grid_of({4, 1, 1}, translation({40, -200, 20}) * scaling({50, 400, 100}),
                                 [](uint32_t i, uint32_t, uint32_t) {
                                   return fog_at({50 + 50.0 * i, 0, 50});
                                 }));
}

// What flights along a ray bring, per bin: light from the way, and what they leave of light from its end.
struct Brought {
  std::vector<RunningStats> light, left;
};
Brought by_flights(const Scene& scene, const Optics& optics, const Atmosphere& air, const Ray& ray, double length) {
  const VolumeField field(scene, optics.state());
  const size_t n = optics.state().size(), knots = optics.state().knots.size();
  const std::vector<double> probability(knots, 1.0 / static_cast<double>(knots));
  Flights flights(field, optics, probability, &air);
  Brought all{std::vector<RunningStats>(n), std::vector<RunningStats>(n)};
  Pcg32 random(11);
  std::vector<float> through(n), emitted(n);
  for (int i = 0; i < 60000; ++i) {
    std::vector<double> light(n), left(n);
    for (size_t k = 0; k < knots; ++k) {
      LivePath live;
      live.origin = ray.origin, live.direction = ray.direction;
      live.relative.start(knots);
      std::fill_n(live.throughput, knots, 1.0);
      live.knot = static_cast<int>(k);
      const double u = random.uniform(), v = random.uniform();
      const Flights::Result flown = flights.fly(live, length, kNone, false, {u, v}, through, emitted);
      for (size_t b = 0; b < n; ++b) {
        if (flown.emits) light[b] += probability[k] * emitted[b];
        if (!flown.scattered) left[b] += probability[k] * flown.scale * (flown.dense ? through[b] : 1);
      }
    }
    for (size_t b = 0; b < n; ++b) all.light[b].add(light[b]), all.left[b].add(left[b]);
  }
  return all;
}

TEST(AirAndMedia, AFogBankInSunlitHazeIsTheIntegral) {
  // Level, up, more steeply than the sun stands, and down from above the air, each through cells of several densities.
  const Ray rays[] = {{{0, 0, 30}, normalized(Vec3{1, 0.1, 0.02}), 0},
                      {{0, 0, 10}, normalized(Vec3{1, 0.1, 0.4}), 0},
                      {{150, 0, -5}, normalized(Vec3{0.15, 0, 1}), 0},
                      {{-7900, 0, 6000}, normalized(Vec3{8100, 0, -5950}), 0}};
  for (const bool spectral : {false, true}) {
    const auto scene = fog_bank(spectral);
    const Optics optics(*scene, make_state(std::vector<Band>{Band::rectangular("b", 0.55, 0.2)}, 0.05, 0, 2));
    ASSERT_EQ(optics.spectral_flights(), spectral);
    const SpectralState& state = optics.state();
    const BakedMedium& fog = optics.media()[0];
    const std::vector<float> sun(state.size(), 1800);
    const auto air = make_layered_atmosphere(low_haze(), state, {{dir_from_angles(0.9, 2), sun.data()}});
    std::vector<float> T(state.size()), S(state.size());
    for (const Ray& ray : rays) {
      const double begin = ray.origin.z > 1000 ? 9000 : 0, length = ray.origin.z > 1000 ? 10400 : 600;
      // By parts that the atmosphere knows: S grows by T dS, dimmed by the fog up to there.
      constexpr double kStep = 0.02;
      air->path(ray.origin, ray.direction, begin, T, S);
      std::vector<double> light(S.begin(), S.end()), before = light, fog_light(state.size()), depth(state.size());
      for (double s = begin; s < length - 0.5 * kStep; s += kStep) {
        const double mass = fog_at(ray.origin + ray.direction * (s + 0.5 * kStep)) * kStep;
        air->path(ray.origin, ray.direction, s + kStep, T, S);
        for (size_t b = 0; b < state.size(); ++b) {
          const double tau = mass * (double{fog.absorption[b]} + fog.scattering[b]);
          const double dimmed = std::exp(-depth[b] - 0.5 * tau),
                       own = dimmed * T[b] * mass * double{fog.absorption[b]} * fog.blackbody[b];
          light[b] += dimmed * (S[b] - before[b]) + own;
          fog_light[b] += own;
          depth[b] += tau;
          before[b] = S[b];
        }
      }
      const Brought got = by_flights(*scene, optics, *air, ray, length);
      for (size_t b = 0; b < state.size(); ++b) {
        SCOPED_TRACE(strf("spectral %d, from z = %g, bin %zu", spectral, ray.origin.z, b));
        const double error = got.light[b].stderr_of_mean(), left = std::exp(-depth[b]) * T[b];
        const double tolerance = kSigmas * error + 2e-4 * light[b];
        EXPECT_NEAR(got.light[b].mean(), light[b], tolerance);
        EXPECT_NEAR(got.left[b].mean(), left, kSigmas * got.left[b].stderr_of_mean() + 2e-5 * left);
        EXPECT_LT(error, 0.01 * light[b]);
        // Negative control: air that the fog does not dim would be seen.
        EXPECT_GT(S[b] + fog_light[b], light[b] + 2 * tolerance);
      }
    }
  }
}

}  // namespace
}  // namespace suite::test::media_air_test
