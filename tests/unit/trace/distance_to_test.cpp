// The distance to an exact surface is that of its hit, for every kind.
#include <gtest/gtest.h>

#include <cmath>

#include "math/sampling.h"
#include "trace/primitive_hit.h"

namespace suite::distance_to_test {
namespace {

std::vector<Primitive> all_kinds() {
  const std::pair<PrimitiveKind, std::vector<double>> kinds[] = {
      {PrimitiveKind::plane, {2, 1}},           {PrimitiveKind::plane, {0, 0}},
      {PrimitiveKind::disk, {1, 0.3}},          {PrimitiveKind::box, {-1, -0.5, 0, 1, 0.5, 0.7}},
      {PrimitiveKind::sphere, {0.8}},           {PrimitiveKind::cone, {0.9, 0.2, 1.1, 1}},
      {PrimitiveKind::cylinder, {0.6, 1.2, 0}}, {PrimitiveKind::sinusoid, {2, 2, 0.2, 3, 1, 0.4, 0.1, -2, 5, 1}}};
  std::vector<Primitive> all;
  for (const auto& [kind, parameters] : kinds) all.push_back({"", kind, parameters, kNone});
  return all;
}

TEST(DistanceTo, IsThatOfTheHit) {
  Pcg32 rng(4);
  const auto random = [&] { return Vec3{rng.uniform(), rng.uniform(), rng.uniform()} * 2 - Vec3{1, 1, 1}; };
  for (const Primitive& p : all_kinds()) {
    size_t met = 0, missed = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec3 from = random() * 3, d = random() - from * 0.3;
      const double t_min = rng.uniform() < 0.5 ? 0 : 2 * rng.uniform(),
                   t_max = rng.uniform() < 0.5 ? INFINITY : t_min + 3 * rng.uniform();
      const auto hit = intersect(p, from, d, t_min, t_max);
      const double t = distance_to(p, from, d, t_min, t_max);
      ASSERT_EQ(t, hit ? hit->t : INFINITY) << static_cast<int>(p.kind);
      ++(hit ? met : missed);
    }
    EXPECT_GT(met, 100u) << static_cast<int>(p.kind);
    EXPECT_GT(missed, 300u) << static_cast<int>(p.kind);
  }
}

// Nothing lies where there is no room for it.
TEST(DistanceTo, IsInfiniteInAnEmptyInterval) {
  const Primitive plane{"", PrimitiveKind::plane, {0, 0}, kNone};
  EXPECT_EQ(distance_to(plane, {0, 0, 1}, {0, 0, -1}, 0, -1), INFINITY);
  EXPECT_EQ(distance_to(plane, {0, 0, 1}, {0, 0, -1}, 0, 1), INFINITY);
  EXPECT_EQ(distance_to(plane, {0, 0, 1}, {0, 0, -1}, 0, 1.5), 1);
}

}  // namespace
}  // namespace suite::distance_to_test
