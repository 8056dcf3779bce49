// The single things of a hierarchy by number: places, overrides from outside, tags from inside.
#include "scene/leaves.h"

#include <gtest/gtest.h>

namespace suite::leaves_test {
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
  // Each tagged row is one thing, but for the leaf in it with a tag of its own.
  const uint64_t object[] = {0, 1, 2, 3, 4};
  for (uint64_t i = 0; i < 5; ++i) EXPECT_EQ(leaves.object_of(i), object[i]) << i;
  EXPECT_TRUE(tags_groups(s));
}

TEST(Leaves, OfATaggedGroupAreOneObject) {
  Scene s;
  Placement leaf, truck, convoy;
  leaf.kind = TargetKind::primitive;
  truck.kind = convoy.kind = TargetKind::group;
  convoy.target = 1, truck.target = 2;
  Placement tagged = truck, alone = leaf;
  tagged.tag = alone.tag = 0;
  // A leaf; a tagged truck of three leaves; a convoy of a leaf and two tagged trucks; a tagged leaf; a truck without a
  // tag.
  s.groups = {{"root", {leaf, tagged, convoy, alone, truck}},
              {"convoy", {leaf, tagged, tagged}},
              {"truck", {leaf, leaf, leaf}}};
  const Leaves leaves(s);
  const std::vector<uint64_t> object{0, 1, 1, 1, 4, 5, 5, 5, 8, 8, 8, 11, 12, 13, 14};
  ASSERT_EQ(leaves.count(), object.size());
  for (uint64_t i = 0; i < object.size(); ++i) EXPECT_EQ(leaves.object_of(i), object[i]) << i;
  for (Group& g : s.groups)
    for (Placement& p : g.placements)
      if (p.kind == TargetKind::group) p.tag = kNone;
  EXPECT_FALSE(tags_groups(s));
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
}  // namespace suite::leaves_test
