// Parts of the light as channels of a result: closed forms in an isothermal box, and a channel with a sign.
#include <gtest/gtest.h>

#include <cmath>

#include "spectral/planck.h"
#include "tests/support/radiometry_kit.h"
#include "transport/estimators/standard.h"
#include "transport/kernel_beside.h"
#include "transport/kernel_fill.h"
#include "transport/kernel_fly.h"
#include "transport/kernel_go_on.h"
#include "transport/kernel_light.h"
#include "transport/kernel_meet.h"
#include "transport/serve.h"
#include "transport/sinks/radiance.h"

namespace suite::test::channels_test {
namespace {

constexpr double kReflectance = 0.4, kKelvin = 300;
const double kWall = planck_radiance(10, kKelvin);

// Emission B of a wall of emissivity 1 - r: e = (1 - r) B comes unscattered, r e scattered once, r^n e n times.
double order(int n) { return (1 - kReflectance) * std::pow(kReflectance, n) * kWall; }

std::shared_ptr<Scene> warm_box() {
  Material wall = material("wall", lambert(kReflectance));
  wall.temperature_k = kKelvin;
  return scene_of({box({-1, -1, -1}, {1, 1, 1}, 0, false)}, {wall});
}

class Channels final : public RaySensor {
 public:
  Channels(std::vector<std::string> names, std::vector<Band> bands)
      : RaySensor({{{0, 0, 0}, {0.3, 0.2, std::sqrt(1 - 0.13)}, 0}}, std::move(bands), 1 << 14), names_(names) {}
  std::span<const std::string> channels() const override { return names_; }

 private:
  std::vector<std::string> names_;
};

std::vector<Band> thermal(size_t bands) {
  std::vector<Band> list;
  for (size_t b = 0; b < bands; ++b) list.push_back(Band::rectangular("b", 10 + 1e-3 * static_cast<double>(b), 1e-4));
  return list;
}

TEST(Channels, PartsOfAnIsothermalBox) {
  const std::vector<std::string> names{"radiance", "unscattered",         "single_scattering",
                                       "emitted",  "multiple_scattering", "path_radiance"};
  const double all = kWall;
  const double expected[] = {all, order(0), order(0) + order(1), all, all - order(0) - order(1), 0};
  for (const size_t bands : {1u, 3u}) {
    SCOPED_TRACE(bands);
    const Rendered r = render(warm_box(), {}, std::make_unique<Channels>(names, thermal(bands)));
    ASSERT_EQ(r.result.channels, names.size());
    for (size_t c = 0; c < names.size(); ++c) {
      // A millionth of the scale: single precision of the sums of a path; bands stand within 2e-3 um.
      const size_t at = c * bands;
      EXPECT_NEAR(r.result.radiance[at], expected[c], 4 * r.result.standard_error[at] + 1e-3 * all) << names[c];
    }
    EXPECT_NEAR(r.result.radiance[2 * bands] + r.result.radiance[4 * bands], r.result.radiance[0], 1e-6 * all);
    EXPECT_LT(r.result.standard_error[bands], 1e-6 * all) << "every path brings the same";
  }
}

TEST(Channels, UnknownNamesAreRefused) {
  EXPECT_THROW(ChannelPlan(std::vector<std::string>{"radiance", "singel"}), Error);
  try {
    render(warm_box(), {}, std::make_unique<Channels>(std::vector<std::string>{"radiance", "emited"}, thermal(1)));
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("emitted"), std::string::npos) << e.what();
  }
}

// Odd orders count against even ones: the mean is (1 - r) B / (1 + r), and single samples are negative, too.
TEST(Channels, MayBeSigned) {
  const auto alternating = [](const Contribution& c) { return c.order % 2 ? -1.0f : 1.0f; };
  const ChannelRow with_sign{{"alternating", "", "", alternating}, true};
  const auto scene = warm_box();
  const Tracer tracer(scene);
  for (const size_t bands : {1u, 3u}) {
    SCOPED_TRACE(bands);
    const Optics optics(*scene, make_state(thermal(bands), 0.01, 0, 1));
    const Surface surface(tracer, optics);
    const Environment environment = bake_environment({}, tracer, false, optics.state());
    const PipelineOptions options;
    constexpr uint32_t width = 64, waves = 256;
    RadianceSink sink(width, 1, ChannelPlan({&channel_rows().find("radiance"), &with_sign}), false);
    SpectralThroughputs throughputs(width, optics.state().size(), sink.targets());
    PathKernel<Wave<AnySurfaces, NothingSpace, SpectralThroughputs, StandardEstimator>> kernel(
        {surface, optics, environment, options}, width, throughputs, sink);
    const FlushDenormals flush;
    TraceStatistics statistics;
    double sum = 0, square = 0;
    for (uint32_t wave = 0; wave < waves; ++wave) {
      for (uint32_t p = 0; p < width; ++p) {
        throughputs.begin(p, 1, nullptr);
        kernel.start(p, {{{0, 0, 0}, {0, 0, -1}, 0}, 1}, SampleStream(1, 0, 0), wave * width + p);
      }
      complete(kernel, tracer, statistics);
      for (uint32_t p = 0; p < width; ++p) {
        const double L = throughputs.light(p, sink.target(0, 1, false))[0];
        sum += L, square += L * L;
      }
    }
    constexpr double n = width * waves;
    const double mean = sum / n, error = std::sqrt((square / n - mean * mean) / n);
    const double expected = (1 - kReflectance) / (1 + kReflectance) * kWall;
    EXPECT_NEAR(mean, expected, 4 * error + 1e-4 * expected);
    EXPECT_GT(std::fabs(mean - kWall), 20 * error) << "the test would see a sign that is lost";
  }
}

}  // namespace
}  // namespace suite::test::channels_test
