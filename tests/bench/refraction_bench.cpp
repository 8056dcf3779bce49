// The sun on the floor of a pool with waves: CPU time to a standard error of 1 % of the mean pixel, the sun asked for
// through the water and found by chance. Errors are the spread of runs with 8 seeds, not what a run says of itself.
// Usage: refraction_bench [paths asked = 64] [paths by chance = 2048] [half angle of the disk, deg = 1]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "tests/support/media_kit.h"

using namespace suite;
using namespace suite::test;

namespace {

constexpr uint32_t kSide = 16;

class PoolCamera final : public RaySensor {
 public:
  explicit PoolCamera(uint32_t paths) : RaySensor(std::vector<Ray>(kSide * kSide), one_band(), paths) {}
  SensorRay ray(const RayRequest& r) const override {
    const double x = (static_cast<double>(r.problem % kSide) + r.u[0]) / kSide - 0.5,
                 y = (static_cast<double>(r.problem / kSide) + r.u[1]) / kSide - 0.5;
    return {{{0, 0, 4}, normalized(Vec3{x, y, -4}), 0}, 1};
  }
};

std::shared_ptr<Scene> pool() {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("tiles", lambert(0.4)),
                      material("water", {"dielectric", {}, {{"index", Curve::constant(1.33)}}, {}, nullptr})};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -1.5}));
  place(*scene, PrimitiveKind::sinusoid, {20, 20, 0.01, 8, 3, 0.2, 0.008, -6, 9, 1.4}, 1);
  check_scene(*scene, "pool");
  return scene;
}

// CPU seconds until the mean pixel is known to 1 %.
double time_to_a_percent(const std::shared_ptr<Scene>& scene, bool asked, uint32_t paths, double half_angle) {
  SourceSpecs sources;
  sources.add(SunSpec{dir_from_angles(40 * kDegree, 0.5), half_angle, Curve::constant(1)});
  constexpr size_t kSeeds = 8, kPixels = kSide * kSide;
  std::vector<double> sum(kPixels), squares(kPixels);
  const std::clock_t begun = std::clock();
  for (size_t seed = 1; seed <= kSeeds; ++seed) {
    PipelineOptions options;
    options.seed = seed;
    options.refracted_sources = asked;
    const auto r = render(scene, sources, std::make_unique<PoolCamera>(paths), options);
    for (size_t i = 0; i < kPixels; ++i)
      sum[i] += r.result.radiance[i], squares[i] += r.result.radiance[i] * r.result.radiance[i];
  }
  const double seconds = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC / kSeeds;
  double variance = 0, mean = 0;
  for (size_t i = 0; i < kPixels; ++i) {
    variance += (squares[i] - sum[i] * sum[i] / kSeeds) / (kSeeds - 1) / kPixels;
    mean += sum[i] / kSeeds / kPixels;
  }
  const double error = std::sqrt(variance) / mean, time = seconds * (error / 0.01) * (error / 0.01);
  std::printf("%-10s %8u paths  mean %.5f  error %6.2f %%  %8.3f s  to 1 %%: %9.2f s\n", asked ? "asked" : "by chance",
              paths, mean, 100 * error, seconds, time);
  return time;
}

}  // namespace

int main(int argc, char** argv) {
  const auto number = [&](int i, double otherwise) { return argc > i ? std::atof(argv[i]) : otherwise; };
  const double half_angle = number(3, 1) * kDegree;
  const auto scene = pool();
  const double asked = time_to_a_percent(scene, true, static_cast<uint32_t>(number(1, 64)), half_angle),
               chance = time_to_a_percent(scene, false, static_cast<uint32_t>(number(2, 2048)), half_angle);
  std::printf("asked takes %.1f times less\n", chance / asked);
}
