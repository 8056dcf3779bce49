// What is no number is never dropped without a word: a path that ends because a model gave one has a radiance that is
// rejected and counted.
#include <gtest/gtest.h>

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

namespace suite::failure_test {
namespace {

using namespace suite::test;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

// Surfaces whose models go wrong on the second surface of a path, in one way or the other.
enum class Wrong { nothing, density, weight };
template <Wrong wrong>
class Broken : public AnySurfaces {
 public:
  using AnySurfaces::AnySurfaces;
  bool sample(size_t i, uint32_t p, const Hit& hit, Dir out, Vec2 u, double lobe_u, int knot, std::span<float> dense,
              Continuation& on) const {
    const bool drawn = AnySurfaces::sample(i, p, hit, out, u, lobe_u, knot, dense, on);
    if (drawn && hit.position.z > 0.5 && wrong == Wrong::density) on.density[0] = kNone;
    if (drawn && hit.position.z > 0.5 && wrong == Wrong::weight) on.weight.scale = kNone;
    return drawn;
  }
};

// Shares of the paths whose light is no number, and the mean of the others.
struct Outcome {
  double rejected = 0, mean = 0;
};
template <Wrong wrong>
Outcome run(size_t bands) {
  // Ground under a smaller ceiling: about half of the paths meet both.
  const auto scene = scene_of({quad(50, 0, 0), quad(1, 1, 0)}, {material("grey", lambert(0.5))});
  const Tracer tracer(scene);
  std::vector<Band> list;
  for (size_t b = 0; b < bands; ++b) list.push_back(Band::rectangular("b", 0.5 + 0.02 * static_cast<double>(b), 0.01));
  const Optics optics(*scene, make_state(list, 0.01, 0, 1));
  const Surface surface(tracer, optics);
  SourceSpecs sources;
  sources.add(uniform_sky(1, false));
  const Environment environment = bake_environment(sources, tracer, false, optics.state());
  const PipelineOptions options;
  constexpr uint32_t width = 64;
  RadianceSink sink(width, 1, ChannelPlan(default_channels()), false);
  SpectralThroughputs throughputs(width, optics.state().size(), sink.targets());
  PathKernel<Wave<Broken<wrong>, NothingSpace, SpectralThroughputs, StandardEstimator>> kernel(
      {surface, optics, environment, options}, width, throughputs, sink);
  const FlushDenormals flush;
  TraceStatistics statistics;
  Outcome outcome;
  constexpr int waves = 32;
  for (int wave = 0; wave < waves; ++wave) {
    for (uint32_t p = 0; p < width; ++p) {
      throughputs.begin(p, 1, nullptr);
      kernel.start(p, {{{0, 0, 0.3}, {0, 0, -1}, 0}, 1}, SampleStream(1, 0, 0),
                   static_cast<uint32_t>(wave) * width + p);
    }
    complete(kernel, tracer, statistics);
    for (uint32_t p = 0; p < width; ++p) {
      const double L = throughputs.light(p)[0];
      outcome.rejected += std::isnan(L);
      outcome.mean += std::isnan(L) ? 0 : L;
    }
  }
  outcome.mean /= waves * width - outcome.rejected;
  outcome.rejected /= waves * width;
  return outcome;
}

TEST(Failures, OfModelsThatEndPathsAreCounted) {
  // A Lambert floor sees a disk of radius about 1 m one metre above it with a view factor of one half.
  for (const size_t bands : {1u, 3u}) {
    SCOPED_TRACE(bands);
    EXPECT_EQ(run<Wrong::nothing>(bands).rejected, 0);
    EXPECT_NEAR(run<Wrong::density>(bands).rejected, 0.55, 0.1);
    EXPECT_NEAR(run<Wrong::weight>(bands).rejected, 0.55, 0.1);
  }
}

}  // namespace
}  // namespace suite::failure_test
