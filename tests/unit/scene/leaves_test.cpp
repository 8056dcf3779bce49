// The single things of a hierarchy by number: places, overrides from outside, tags from inside.
#include "scene/leaves.h"

#include <gtest/gtest.h>

namespace suite {
namespace {

TEST(Leaves, AreInTheOrderOfTheHierarchy) {
  Scene s;
  Placement leaf;
  leaf.kind = TargetKind::primitive;
  Placement shifted = leaf;
  shifted.to_parent = translation({0, 0, 5}), shifted.material_override = 4, shifted.tag = 1;
  Placement row;
  row.kind = TargetKind::group, row.target = 1, row.to_parent = translation({10, 0, 0}), row.tag = 0;
  Placement painted = row;
  painted.to_parent = translation({20, 0, 0}), painted.material_override = 9;
  s.groups = {{"root", {row, leaf, painted}}, {"row", {leaf, shifted}}};
  const Leaves leaves(s);
  ASSERT_EQ(leaves.count(), 5u);
  const double x[] = {10, 10, 0, 20, 20}, z[] = {0, 5, 0, 0, 5};
  const uint32_t material[] = {kNone, 4, kNone, 9, 9}, tag[] = {0, 1, kNone, 0, 1};
  for (uint64_t i = 0; i < 5; ++i) {
    const auto one = leaves.at(i, 0);
    ASSERT_TRUE(one);
    EXPECT_EQ(one->place.b.x, x[i]) << i;
    EXPECT_EQ(one->place.b.z, z[i]) << i;
    EXPECT_EQ(one->material_override, material[i]) << i;
    EXPECT_EQ(one->tag, tag[i]) << i;
  }
}

// 2^30 of them, nested: none is walked to but the one that is asked for.
TEST(Leaves, OfDeepNestsAreFound) {
  Scene s;
  Placement leaf, down;
  leaf.kind = TargetKind::primitive;
  down.kind = TargetKind::group;
  for (uint32_t level = 0; level < 30; ++level) {
    Placement a = level < 29 ? down : leaf, b = a;
    a.target = b.target = level < 29 ? level + 1 : 0;
    b.to_parent = translation({static_cast<double>(1u << (29 - level)), 0, 0});
    s.groups.push_back({"", {a, b}});
  }
  const Leaves leaves(s);
  ASSERT_EQ(leaves.count(), 1ull << 30);
  for (const uint64_t i : {0ull, 1ull, 123456789ull, (1ull << 30) - 1})
    EXPECT_EQ(leaves.at(i, 0)->place.b.x, static_cast<double>(i));
}

}  // namespace
}  // namespace suite
