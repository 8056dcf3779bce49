// A sky that is no beam under real air: with the field of the air, paths bring what the air scatters of it, as paths
// that are scattered at every turn do. Fixed seed, three standard errors of the difference (significance 0.003 for each
// of two views); what comes through without being scattered must be told apart from it.
#include <gtest/gtest.h>

#include <cmath>

#include "air/profile.h"
#include "light/environment.h"
#include "light/kinds/night_sky.h"
#include "support/radiometry_kit.h"

namespace suite::test::night_air_test {
namespace {

SourceSpecs galaxies(std::optional<AirScattering> scattering) {
  NightSkyLightSpec night;
  night.scale = {0, 0, 0, 1, 0};
  night.time.utc = "2026-03-20T22:00:00Z";
  night.place = Geodetic{49.4, 8.7, 0};
  SourceSpecs sources;
  sources.add(night);
  if (!scattering) return sources;
  auto air = std::make_shared<AirSpec>();
  air->profile = standard_profile("us_standard");
  air->round = false;
  air->scattering = *scattering;
  sources.air = air;
  return sources;
}

TEST(NightAir, TheFieldsPathsFindWhatIsScattered) {
  const double side = 2e5;
  const auto scene = scene_of(
      {mesh_of({{-side, -side, 0}, {side, -side, 0}, {side, side, 0}, {-side, side, 0}}, {0, 1, 2, 0, 2, 3}, 0)},
      {material("ground", lambert(0.2))});
  const auto seen = [&](std::optional<AirScattering> scattering) {
    std::vector<std::unique_ptr<Sensor>> sensors;
    auto rays = std::make_unique<RaySensor>(
        std::vector<Ray>{{{0, 0, 2}, {0, 0, 1}, 0}, {{0, 0, 2}, normalized(Vec3{0, 0.98, 0.2}), 0}},
        std::vector<Band>{Band::rectangular("blue", 0.45, 0.01)}, 2048);
    const RaySensor& result = *rays;
    sensors.push_back(std::move(rays));
    JobOptions job;
    job.progress = false;
    run_job(scene, galaxies(scattering), sensors, job);
    return result.result;
  };
  const CaptureResult field = seen(AirScattering::diffuse), traced = seen(AirScattering::traced), none = seen({});
  for (size_t ray = 0; ray < 2; ++ray) {
    const double error = std::hypot(field.standard_error[ray], traced.standard_error[ray]);
    EXPECT_LT(error, 0.02 * traced.radiance[ray]);
    EXPECT_NEAR(field.radiance[ray], traced.radiance[ray], 3 * error) << ray;
    // Molecules alone: a depth of 0.22 at 0.45 um.
    const double unscattered = none.radiance[ray] * std::exp(-0.22 / (ray == 0 ? 1 : 0.2));
    EXPECT_GT(std::fabs(unscattered - traced.radiance[ray]), 5 * error) << ray;
  }
}

}  // namespace
}  // namespace suite::test::night_air_test
