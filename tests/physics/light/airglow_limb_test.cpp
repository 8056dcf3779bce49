// Airglow from orbit: layers in front of the ground, along the limb and behind it, by the closed forms of shells.
#include <gtest/gtest.h>

#include <cmath>

#include "light/kinds/night_sky.h"
#include "light/night/glow_shells.h"
#include "support/radiometry_kit.h"

namespace suite::test::airglow_limb_test {
namespace {

constexpr double kHeight = 400e3;
constexpr Geodetic kPlace{0, 20, 0};

// Airglow, and starlight where asked for, over a black plate of 2000 km.
CaptureResult seen(std::vector<Ray> rays, std::array<double, kNightParts> scale, double depth = 0) {
  NightSkyLightSpec night;
  night.scale = scale;
  night.time.utc = "2026-03-20T23:00:00Z";
  night.place = kPlace;
  SourceSpecs sources;
  sources.add(night);
  if (depth > 0) {
    AtmosphereSpec air;
    air.heights = {0, 1000};
    air.rayleigh = false;
    AtmosphereSpec::Gas gas;
    gas.name = "grey";
    gas.layers = {Curve::constant(depth)};
    air.gases.push_back(gas);
    air.temperature_k = {280};
    sources.atmosphere = air;
  }
  auto sensor = std::make_unique<RaySensor>(std::move(rays), std::vector<Band>{Band::rectangular("b", 0.55, 0.02)}, 4);
  return render(scene_of({quad(1e6, 0, 0)}, {material("black", lambert(0))}), sources, std::move(sensor)).result;
}
Ray at(double nadir) { return {{0, 0, kHeight}, {std::sin(nadir), 0, -std::cos(nadir)}, 0}; }

// In the band, W/(m2 sr um), of a line of sight, layer by layer.
double expected(const Ray& ray) {
  double sum = 0;
  const std::vector<AirglowLayer> layers = airglow_layers(130);
  std::vector<double> heights;
  for (const AirglowLayer& l : layers) heights.push_back(l.height);
  const GlowShells shells{SceneFrame(kPlace), heights};
  for (size_t i = 0; i < layers.size(); ++i) {
    const GlowShells::Share s = shells.share(i, ray.origin, ray.direction, INFINITY);
    const bool ground = shells.meets_earth(ray.origin, ray.direction);
    sum += (s.near + (ground ? 0 : s.far)) * layers[i].spectrum.mean(0.54, 0.56);
  }
  return sum;
}

TEST(AirglowLimb, ShinesBeforeTheGroundAndAlongTheLimb) {
  const double limb = std::asin((6378137.0 + 90e3) / (6378137.0 + kHeight));
  const std::vector<Ray> rays{at(0), at(0.8), at(limb), at(limb - 0.004), at(limb + 0.01)};
  const CaptureResult r = seen(rays, {0, 1});
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(r.radiance[i] / expected(rays[i]), 1, 1e-4) << i;
  EXPECT_EQ(r.radiance[4], 0) << "above the layers of this band";
  EXPECT_GT(r.radiance[2], 30 * r.radiance[0]) << "the limb";
  // Straight up there are only the layers above 400 km: none.
  EXPECT_EQ(seen({{{0, 0, kHeight}, {0, 0, 1}, 0}}, {0, 1}).radiance[0], 0);
  // Negative control: as bright as from the ground it would be a zenith's.
  double zenith = 0;
  for (const AirglowLayer& l : airglow_layers(130)) zenith += l.spectrum.mean(0.54, 0.56);
  EXPECT_NEAR(r.radiance[0] / zenith, 1, 1e-4);
}

// Below the sensor's horizon the sky goes on as far as the Earth's limb; through the ground nothing comes.
TEST(AirglowLimb, TheSkyEndsAtTheEarth) {
  const double limb = std::asin((6378137.0 + 90e3) / (6378137.0 + kHeight));
  const CaptureResult r = seen({at(limb), at(limb - 0.06)}, {0, 0, 1});
  EXPECT_GT(r.radiance[0], 0);
  EXPECT_EQ(r.radiance[1], 0);
}

// Air weakens nothing of the layer in front of it.
TEST(AirglowLimb, AirIsBehindIt) { EXPECT_NEAR(seen({at(0)}, {0, 1}, 1.0).radiance[0] / expected(at(0)), 1, 1e-4); }

}  // namespace
}  // namespace suite::test::airglow_limb_test
