// Sunlight that mirrors and glass send on: closed forms. Beside metal that is all but smooth:
// mirror_and_ground_test.cpp.
#include <gtest/gtest.h>

#include <cmath>

#include "support/heated_scene_kit.h"

namespace suite::mirrored_sun_test {
namespace {

using namespace test;

constexpr double kDisk = 0.00465;  // rad, of the sun
constexpr double kUp = 30 * kDegree;
const Dir kSun{std::cos(kUp), 0, std::sin(kUp)};

ModelSpec mirror(double reflectance) {
  return {"mirror", {}, {{"reflectance", Curve::constant(reflectance)}}, {}, nullptr};
}

// W absorbed by a material's faces for 1 W/m2, mean over three moments of a sun that stands still, and the standard
// error of that by blocks.
struct Watts {
  double mean = 0, error = 0;
};
Watts watts(const HeatKit& kit, uint32_t material, Dir sun, const PathOptions& options = {8, 64, 1}) {
  const Sunlight light = kit.sunlight(still_sun(sun, kDisk, {0, 600, 1200}), options);
  Watts out;
  std::vector<double> blocks(options.blocks, 0.0);
  for (size_t f = 0; f < light.faces(); ++f) {
    const HeatElement& e = (*kit.elements)[kit.faces->element(f)];
    if (e.material != material) continue;
    for (size_t k = 0; k < 3; ++k) out.mean += e.area * light.beam.at(f, k) / 3;
    for (size_t k = 0; k < blocks.size() * Sunlight::kParts; ++k)
      blocks[k / Sunlight::kParts] +=
          e.area * light.beam_of_block.at(f * blocks.size() + k / Sunlight::kParts, k % Sunlight::kParts) / 3;
  }
  out.error = error_of(blocks);
  return out;
}

// A wall of 3 m x 3 m on an endless mirror, facing a sun of irradiance E at 30 degrees of elevation: E cos 30 come
// straight and as much by the mirror. What the wall scatters finds no way back.
double wall_over_mirror(double absorptance, double reflectance) {
  HeatedScene s;
  const uint32_t wall = s.heated(absorptance, heat());
  s.plane(0, 0, s.given(mirror(reflectance), 300));
  s.plane(3, 3, wall, with_axes({0, 1, 0}, {0, 0, 1}, {0, 0, 1.5}));  // faces east
  return watts(HeatKit(std::move(s), 32), wall, kSun).mean / 9;
}

TEST(MirroredSun, BlackWallOverEndlessMirror) {
  const double exact = 2 * std::cos(kUp), found = wall_over_mirror(1, 1);
  std::printf("black wall over an endless mirror: %.5f of %.5f (%+.3f %%)\n", found, exact, 100 * (found / exact - 1));
  EXPECT_NEAR(found, exact, 0.003 * exact);
  EXPECT_NEAR(wall_over_mirror(0.5, 0.6), 0.5 * 1.6 * std::cos(kUp), 0.003);
}

// A small mirror that stands on black ground turns down what it does not keep: the difference to a black board.
TEST(MirroredSun, SmallMirrorOverBlackGround) {
  const auto ground = [](double reflectance) {
    HeatedScene s;
    const uint32_t floor = s.heated(1, heat());
    s.plane(40, 40, floor);
    s.plane(2, 2, s.given(mirror(reflectance), 300), with_axes({0, 1, 0}, {0, 0, 1}, {0, 0, 1.5}));
    return watts(HeatKit(std::move(s), 400), floor, kSun, {8, 16, 1}).mean;
  };
  const double turned = ground(0.7) - ground(0);
  std::printf("mirror of 4 m2: %.5f W turned down of %.5f\n", turned, 0.7 * 4 * std::cos(kUp));
  EXPECT_NEAR(turned, 0.7 * 4 * std::cos(kUp), 1e-3);
}

// A black floor under smooth water takes what Fresnel lets in, though radiance in the water is larger by the square of
// the index.
TEST(MirroredSun, BlackFloorUnderWater) {
  constexpr double kIndex = 1.33;
  HeatedScene s;
  const uint32_t floor = s.heated(1, heat());
  s.plane(3, 3, floor);
  const uint32_t water = s.given(ModelSpec{"dielectric", {}, {{"index", Curve::constant(kIndex)}}, {}, nullptr}, 300);
  s.plane(0, 0, water, shifted({0, 0, 1}));
  const double c = std::sin(kUp), t = std::sqrt(1 - (1 - c * c) / (kIndex * kIndex));
  const double rs = (c - kIndex * t) / (c + kIndex * t), rp = (kIndex * c - t) / (kIndex * c + t);
  const double exact = c * (1 - (rs * rs + rp * rp) / 2),
               found = watts(HeatKit(std::move(s), 16), floor, kSun, {8, 512, 1}).mean / 9;
  std::printf("black floor under water: %.5f of %.5f (%+.3f %%)\n", found, exact, 100 * (found / exact - 1));
  EXPECT_NEAR(found, exact, 0.003 * exact);
}

}  // namespace
}  // namespace suite::mirrored_sun_test
