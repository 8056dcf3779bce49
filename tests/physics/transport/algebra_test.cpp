// The order in which the kernel multiplies throughputs: an algebra of matrices that do not commute must come out as the
// product along the path, from the sensor to the light.
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

namespace suite::algebra_test {
namespace {

using namespace suite::test;

struct Matrix {
  double a = 1, b = 0, c = 0, d = 1;
  Matrix operator*(const Matrix& o) const {
    return {a * o.a + b * o.c, a * o.b + b * o.d, c * o.a + d * o.c, c * o.b + d * o.d};
  }
};
void expect_near(const Matrix& x, const Matrix& y) {
  EXPECT_NEAR(x.a, y.a, 1e-6);
  EXPECT_NEAR(x.b, y.b, 1e-6);
  EXPECT_NEAR(x.c, y.c, 1e-6);
  EXPECT_NEAR(x.d, y.d, 1e-6);
}

// No two of these commute.
Matrix scattering(uint32_t material, double w) {
  return material == 0 ? Matrix{w, 0.3, 0, w} : Matrix{0.5 * w, 0, 0.7, w};
}
Matrix weakening(double t) { return {t, 0, 0.2, 0.5 * t}; }
Matrix turning(const Event& e) {
  const double angle = 0.4 * e.out.x + 0.9 * e.in.z;
  return {std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle)};
}

// Of one path of one bin.
class Matrices {
 public:
  void attenuate(uint32_t, const Factor& f) { T = T * weakening(value(f)); }
  void turn(uint32_t, const Event& e) { T = T * turning(e); }
  void scatter(uint32_t, const Factor& f, const Event& e) { T = T * scattering(e.material, value(f)); }
  bool has_room(uint32_t, uint32_t) const { return true; }
  void make_room(uint32_t) {}
  std::span<float> take(uint32_t) { return {&memory_[next_++ % memory_.size()], 1}; }
  void give_back(uint32_t) {}
  Matrix T;

 private:
  static double value(const Factor& f) { return double{f.scale} * (f.spectrum ? f.spectrum[0] : 1); }
  std::array<float, 64> memory_{};
  size_t next_ = 0;
};

struct Found {
  uint16_t light;
  uint32_t order;
  Matrix T;
};
class Record final : public Sink<Matrices> {
 public:
  void add(std::span<const Contribution> stage, Matrices& throughputs) override {
    for (const Contribution& c : stage) found.push_back({c.light, c.order, throughputs.T});
  }
  std::vector<Found> found;
};

// Air that passes a share of the light that depends on how far it comes.
double passes(double distance) { return distance > 1e6 ? 0.8 : 1 / (1 + 0.1 * distance); }
class Air final : public Atmosphere {
 public:
  void transmittance(Vec3, Dir, double distance, std::span<float> T) const override {
    T[0] = static_cast<float>(passes(distance));
  }
  void path(Vec3 from, Dir direction, double distance, std::span<float> T, std::span<float> S) const override {
    transmittance(from, direction, distance, T);
    S[0] = 1;
  }
  // No walk goes through it.
  const Shells& shells() const override { return shells_; }
  std::span<const float> extinction(size_t) const override { return {}; }
  void source(size_t, Vec3, Dir, std::span<float>) const override {}
  size_t beams() const override { return 0; }
  void beam(size_t, size_t, Vec3, Dir, BeamAlong) const override {}

 private:
  Shells shells_ = Shells::flat({0, 1});
};

TEST(Algebra, ThroughputsAreMultipliedInTheOrderOfThePath) {
  // Two mirrors one metre apart, facing each other: up to x = 2.9 below, to x = 2 above.
  const ModelSpec mirror{"mirror", {}, {{"reflectance", Curve::constant(0.9)}}, {}, nullptr};
  const auto scene = scene_of({mesh_of({{-1, -9, 0}, {2.9, -9, 0}, {2.9, 9, 0}, {-1, 9, 0}}, {0, 1, 2, 0, 2, 3}, 0),
                               mesh_of({{-1, -9, 1}, {2, -9, 1}, {2, 9, 1}, {-1, 9, 1}}, {0, 2, 1, 0, 3, 2}, 1)},
                              {material("low", mirror), material("high", mirror)});
  const Tracer tracer(scene);
  const SpectralState state = make_state(one_band(), 0.01, 0, 1);
  const Optics optics(*scene, state);
  Environment environment;
  environment.lights.push_back(std::make_shared<Sky>(uniform_sky(1, true), optics.state()));
  environment.atmosphere = std::make_shared<Air>();
  const Surface surface(tracer, optics);
  const PipelineOptions options;
  Matrices algebra;
  Record sink;
  PathKernel<Wave<AnySurfaces, AirSpace, Matrices, StandardEstimator>> kernel({surface, optics, environment, options},
                                                                              1, algebra, sink);
  const Dir down = normalized(Vec3{0.5, 0, -1}), up = normalized(Vec3{0.5, 0, 1});
  kernel.start(0, {{{0, 0, 0.5}, down, 0}, 1}, SampleStream(1, 0, 0), 0);
  const FlushDenormals flush;
  TraceStatistics statistics;
  complete(kernel, tracer, statistics);

  // Low at x = 0.25, high at 0.75, low at 1.25, high at 1.75, low at 2.25, then past the edge of the high one.
  const double leg = length(Vec3{0.5, 0, 1});
  std::vector<Found> expected;
  Matrix T;
  for (uint32_t n = 0; n <= 5; ++n) {
    expected.push_back({kFromAir, n, T});
    const double way = n == 0 ? leg / 2 : n == 5 ? 1e9 : leg;
    T = T * weakening(passes(way));
    if (n == 5) break;
    const Dir travel = n % 2 ? up : down, next = n % 2 ? down : up;
    const Event event{-travel, next, n % 2, false, true};
    T = T * turning(event) * scattering(n % 2, 0.9);
  }
  expected.push_back({0, 5, T});
  ASSERT_EQ(sink.found.size(), expected.size());
  for (size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(sink.found[i].light, expected[i].light) << i;
    EXPECT_EQ(sink.found[i].order, expected[i].order) << i;
    expect_near(sink.found[i].T, expected[i].T);
  }
  // The test can tell: the same factors in the order from the light to the sensor are another matrix.
  const Matrix ab = scattering(0, 0.9) * scattering(1, 0.9), ba = scattering(1, 0.9) * scattering(0, 0.9);
  EXPECT_GT(std::fabs(ab.a - ba.a), 0.1);
}

}  // namespace
}  // namespace suite::algebra_test
