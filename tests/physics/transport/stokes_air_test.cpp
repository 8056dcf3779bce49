// Polarised light of real air by its vector field, against paths that are scattered in the same layers every time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "air/particle_data.h"
#include "air/spheres.h"
#include "light/kinds/night_sky.h"
#include "tests/support/lit_air_kit.h"
#include "tests/support/message_of.h"
#include "tests/support/stokes_kit.h"

namespace suite::test::stokes_air_test {
namespace {

const char* long_run() { return std::getenv("SUITE_LONG"); }

AirSpec molecules() {
  AirSpec air;
  air.profile = standard_profile("us_standard");
  return air;
}
// Spheres as a user brings them who knows their phase function alone.
std::shared_ptr<const ParticleData> without_matrices(const SphereSpec& spheres) {
  auto data = std::make_shared<ParticleData>();
  data->name = spheres.name;
  data->wavelengths_um = data->phase_um = {0.4, 0.45, 0.55};
  const ParticleOptics optics = sphere_optics(spheres, data->wavelengths_um);
  for (size_t w = 0; w < 3; ++w) {
    data->extinction.push_back(optics.extinction(w)), data->albedo.push_back(optics.albedo(w));
    data->phase.emplace_back(optics.phase(w).begin(), optics.phase(w).end());
  }
  return data;
}
struct Sky {
  AirSpec air = molecules();
  double um = 0.45, sun_zenith_deg = 60, ground = 0.2;
};
// A ground as the field assumes it, and on it a square of rough glass.
std::shared_ptr<Scene> ground_with_glass(double albedo) {
  const ModelSpec glass{
      "ggx", {{"roughness", 0.2}}, {{"n", Curve::constant(1.5)}, {"k", Curve::constant(0.001)}}, {}, nullptr};
  auto scene = scene_of({quad(5, 0, 1)}, {material("ground", lambert(albedo)), material("glass", glass)});
  // Endless: beyond an edge paths would meet air below.
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -0.1}));
  check_scene(*scene, "ground");
  return scene;
}
const std::vector<Ray> kViews{{{50, 0, 1}, dir_from_angles(20 * kDegree, 2), 0},  // the sky
                              {{50, 0, 1}, dir_from_angles(70 * kDegree, -1.2), 0},
                              {{50, 0, 1}, dir_from_angles(45 * kDegree, 3.3), 0},  // 90 degrees from the sun
                              from_space({50, 0, 0}, 1, 0),                         // down through all of it
                              from_space({50, 0, 0}, 55, 2.5),
                              {{-1.4, 0, 1}, normalized(Vec3{1.4, 0, -1}), 0}};  // the sky in the glass
constexpr size_t kSkyViews = 3;

std::vector<StokesSeen> see(const Sky& sky, AirScattering scattering, uint32_t paths,
                            const std::vector<Ray>& views = kViews) {
  AirSpec air = sky.air;
  air.scattering = scattering, air.ground_albedo = Curve::constant(sky.ground), air.round = false;
  SourceSpecs sources;
  sources.air = std::make_shared<const AirSpec>(air);
  sources.add(SunSpec{{dir_from_angles(sky.sun_zenith_deg * kDegree, 0.3), 0, Curve::constant(1)}});
  const std::vector<Band> bands{Band::rectangular("b", sky.um, 0.01)};
  return seen_of(render(ground_with_glass(sky.ground), sources,
                        std::make_unique<StokesRays>(views, paths, Polarimetry{}, bands, 0.02))
                     .result);
}

// The largest difference of I, Q and U beyond `allowed` of I, over its error; told.
double largest_z(const char* what, const std::vector<StokesSeen>& a, const std::vector<StokesSeen>& b, double allowed) {
  double largest = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const StokesSeen &x = a[i], &y = b[i];
    std::printf("%s view %zu: I %.5f, off %.2f %%, Q %.2f, U %.2f %% of I (+- %.2f); DoLP %.4f, traced %.4f\n", what, i,
                x.S[0], 100 * (x.S[0] / y.S[0] - 1), 100 * (x.S[1] - y.S[1]) / y.S[0], 100 * (x.S[2] - y.S[2]) / y.S[0],
                100 * std::hypot(x.error[1], y.error[1]) / y.S[0], x.dolp(), y.dolp());
    for (size_t k = 0; k < 3; ++k)
      largest = std::max(largest, (std::fabs(x.S[k] - y.S[k]) - allowed * y.S[0]) / std::hypot(x.error[k], y.error[k]));
  }
  return largest;
}

// SUITE_LONG: errors of some 0.2 % of I.
uint32_t many(uint32_t paths) { return paths * (long_run() ? 128u : 1u); }

TEST(StokesAir, SkyPathAndGlassAreThoseOfTracedAir) {
  const Sky sky;
  const auto traced = see(sky, AirScattering::traced, many(1024)), field = see(sky, AirScattering::diffuse, many(256));
  EXPECT_LT(largest_z("molecules", field, traced, 0.005), kSigmas);
  for (size_t i = 0; i < kSkyViews; ++i) {
    EXPECT_EQ(field[i].depolarised, 0) << i;
    EXPECT_GT(field[i].dolp(), 0.05) << i;
  }
  // Control: light scattered once alone, and a frame that is mirrored.
  std::vector<StokesSeen> wrong = field;
  for (StokesSeen& s : wrong) s.S[2] *= -1;
  EXPECT_GT(largest_z("mirrored", wrong, traced, 0.005), 3 * kSigmas);
  const std::vector<Ray> up(kViews.begin(), kViews.begin() + kSkyViews);
  EXPECT_GT(largest_z("once", see(sky, AirScattering::single, 64, up), traced, 0.005), 3 * kSigmas);
}

// Haze of small spheres, whose matrices are known.
Sky spheres() {
  Sky sky;
  sky.air = haze(0.3);
  sky.air.aerosol->profile = AerosolProfile::exponential(0.3, 2000);
  sky.air.aerosol->one_kind = true;
  sky.air.aerosol->boundary.spheres = std::make_shared<const SphereSpec>(
      SphereSpec{SizeDistribution::log_normal(0.1, 1.6), Curve::constant(1.45), Curve::constant(0.005)});
  return sky;
}
TEST(StokesAir, SpheresPolariseAsInTracedAir) {
  if (!long_run()) GTEST_SKIP() << "in the long run";
  const Sky sky = spheres();
  const auto traced = see(sky, AirScattering::traced, many(1024)), field = see(sky, AirScattering::diffuse, many(256));
  EXPECT_LT(largest_z("spheres", field, traced, 0.005), kSigmas);
  // All but the glass, where what several facets do counts as depolarised.
  for (size_t i = 0; i + 1 < field.size(); ++i) EXPECT_EQ(field[i].depolarised, 0) << i;
  // Control: the same particles, had they no matrices.
  Sky unknown = sky;
  unknown.air.aerosol->boundary.spheres = nullptr;
  unknown.air.aerosol->boundary.data = without_matrices(*sky.air.aerosol->boundary.spheres);
  EXPECT_GT(largest_z("as if they depolarised", see(unknown, AirScattering::diffuse, many(256)), traced, 0.005),
            3 * kSigmas);
}

// A blue sky over snow, and haze, which depolarises in both.
TEST(StokesAir, OtherAirIsThatOfTracedAir) {
  if (!long_run()) GTEST_SKIP() << "in the long run";
  Sky blue, hazy;
  blue.um = 0.4, blue.sun_zenith_deg = 30, blue.ground = 0.6;
  hazy.air = haze(0.3);
  for (const auto& [name, sky] : {std::pair{"snow", blue}, {"haze", hazy}})
    EXPECT_LT(largest_z(name, see(sky, AirScattering::diffuse, many(256)), see(sky, AirScattering::traced, many(1024)),
                        0.005),
              kSigmas)
        << name;
}

std::string said(AirSpec air, std::vector<Band> bands, bool by_night = false) {
  std::string all;
  JobOptions job;
  job.progress = false;
  job.diagnose = [&](const Diagnostic& d) { all += line_of(d) + "\n"; };
  SourceSpecs sources;
  sources.air = std::make_shared<const AirSpec>(std::move(air));
  sources.add(SunSpec{{dir_from_angles(0.5, 0.3), 0, Curve::constant(1)}});
  if (by_night) {
    NightSkyLightSpec night;
    night.scale = {0, 1};  // airglow
    night.time.utc = "2026-03-20T22:00:00Z";
    night.place = Geodetic{49.4, 8.7, 0};
    sources.add(night);
  }
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<StokesRays>(std::vector<Ray>{kViews[0]}, 4, Polarimetry{}, std::move(bands)));
  run_job(ground_with_glass(0.2), sources, sensors, job);
  return all;
}
// What the air does not know of the scene is said.
TEST(StokesAir, TheResidualEstimatorThatIsOffIsNamed) {
  AirSpec air = molecules();
  EXPECT_NE(said(air, one_band()).find("[DR208]"), std::string::npos);
  EXPECT_EQ(said(air, one_band()).find("night sky is left out"), std::string::npos);
  EXPECT_NE(said(air, one_band(), true).find("night sky is left out"), std::string::npos);
  air.adjacency = false;
  EXPECT_EQ(said(air, one_band()).find("[DR208]"), std::string::npos);
}

// Air around media is refused where it is not traced.
TEST(StokesAir, AirAroundMediaIsRefused) {
  SourceSpecs sources;
  sources.air = std::make_shared<const AirSpec>(molecules());
  sources.add(SunSpec{{dir_from_angles(0.5, 0.3), 0, Curve::constant(1)}});
  const auto scene = slab_scene(medium(Curve::constant(0), Curve::constant(0.1)), 1);
  EXPECT_NE(message_of([&] { see_stokes(scene, sources, {kViews[0]}, 4); }).find("the light of air around media"),
            std::string::npos);
}

// Named haze has no matrices: its share counts as depolarised, and the rest polarises less. Spheres have.
TEST(StokesAir, HazeCountsAsDepolarised) {
  const Sky clear, known = spheres();
  Sky hazy;
  hazy.air = haze(0.3);
  const std::vector<Ray> view{kViews[2]};
  const StokesSeen a = see(clear, AirScattering::diffuse, 64, view)[0],
                   b = see(hazy, AirScattering::diffuse, 64, view)[0];
  EXPECT_EQ(a.depolarised, 0);
  EXPECT_GT(b.depolarised, 0.15 * b.S[0]);
  EXPECT_LT(b.depolarised, 0.9 * b.S[0]);
  EXPECT_LT(b.dolp(), 0.8 * a.dolp());
  EXPECT_EQ(see(known, AirScattering::diffuse, 64, view)[0].depolarised, 0);
}

}  // namespace
}  // namespace suite::test::stokes_air_test
