// Rays that run alongside each other meet instances as single rays do: faces in the sides of an instance's box above
// all, where the rays of a packet begin.
#include <gtest/gtest.h>

#include <cmath>

#include "math/sampling.h"
#include "trace/loose_mesh.h"
#include "trace/tracer.h"

namespace suite::together_test {
namespace {

// The surface of a box between two corners; a sheet when it has no height.
Mesh box(Vec3 low, Vec3 high) {
  Mesh m;
  m.name = "box";
  std::vector<float> p;
  for (int k = 0; k < 8; ++k)
    for (int a = 0; a < 3; ++a) p.push_back(static_cast<float>(k >> a & 1 ? high[a] : low[a]));
  p.push_back(0);
  m.positions = std::move(p);
  m.indices = std::vector<uint32_t>{0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                    1, 3, 7, 1, 7, 5, 3, 2, 6, 3, 6, 7, 2, 0, 4, 2, 4, 6};
  m.parts.push_back({"box", 0, 12, kNone});
  return m;
}

std::shared_ptr<const Scene> town(double size) {
  auto s = std::make_shared<Scene>();
  Pcg32 rng(7);
  for (int k = 0; k < 4; ++k)
    s->meshes.push_back(box({-0.4 * size, -0.4 * size, 0}, {0.4 * size, 0.4 * size, (0.3 + 0.2 * k) * size}));
  s->groups.push_back({"root", {}});
  for (int i = 0; i < 400; ++i) {
    Placement p;
    p.target = static_cast<uint32_t>(i % 4);
    p.to_parent = translation({(i % 20 - 10) * size, (i / 20 - 10.0) * size, 0}) *
                  (i % 3 ? rotation({0, 0, 1}, rng.uniform()) : Affine3{});
    s->groups[0].placements.push_back(p);
  }
  return s;
}

class Together : public testing::TestWithParam<double> {};

TEST_P(Together, MeetsWhatSingleRaysMeet) {
  const double size = GetParam();
  const auto scene = town(size);
  ASSERT_FALSE(is_loose(scene->meshes[0]));
  const Tracer tracer(scene);
  for (const Dir d : {Dir{0, 0, -1}, normalized(Vec3{0.3, 0.1, -1}), normalized(Vec3{1, 0, -0.05}), Dir{1, 0, 0}}) {
    std::vector<Ray> rays;
    for (int j = 0; j < 128; ++j)
      for (int i = 0; i < 128; ++i) {
        const Vec3 at{(0.15 * i - 9.6) * size, (0.15 * j - 9.6) * size, 0.29 * size};
        rays.push_back({at - d * (30 * size), d, 0});
      }
    std::vector<Hit> single(rays.size()), packet(rays.size());
    std::vector<uint8_t> blocked(rays.size());
    TraceStatistics statistics;
    tracer.nearest(rays, single, false, statistics);
    tracer.nearest(rays, packet, true, statistics);
    tracer.occluded(rays, std::vector<double>(rays.size(), INFINITY), blocked, true, statistics);
    size_t met = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(packet[i].hit(), single[i].hit()) << i;
      EXPECT_EQ(blocked[i] != 0, single[i].hit()) << i;
      if (!single[i].hit()) continue;
      ++met;
      EXPECT_NEAR(packet[i].distance, single[i].distance, 2e-5 * size) << i;
    }
    EXPECT_GT(met, 4000u);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Together, testing::Values(1e-3, 1.0, 1e3));

}  // namespace
}  // namespace suite::together_test
