// Which groups are kept once, and how much is kept.
#include "scene/unfolded.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace suite::unfolded_test {
namespace {

// Groups, each of which places others so many times: {group: {target, times}}, target kNone for a sphere.
Scene scene_of(const std::vector<std::vector<std::pair<uint32_t, int>>>& groups) {
  Scene s;
  s.primitives.push_back({"ball", PrimitiveKind::sphere, {1}, kNone});
  for (const auto& of : groups) {
    Group g;
    for (const auto& [target, times] : of) {
      Placement p;
      p.kind = target == kNone ? TargetKind::primitive : TargetKind::group;
      p.target = target == kNone ? 0 : target;
      g.placements.insert(g.placements.end(), static_cast<size_t>(times), p);
    }
    s.groups.push_back(g);
  }
  return s;
}

std::vector<char> shared(std::initializer_list<int> of) { return {of.begin(), of.end()}; }

TEST(ShareGroups, SmallScenesAreUnfolded) {
  const Scene s = scene_of({{{1, 1000}, {kNone, 5}}, {{kNone, 1000}}});
  const Sharing all = share_groups(s);
  EXPECT_EQ(all.instances, (std::vector<double>{1000005, 1000}));
  EXPECT_EQ(all.shared, shared({0, 0}));
  EXPECT_EQ(all.kept, 1000005);
  const Sharing less = share_groups(s, 1e6);
  EXPECT_EQ(less.shared, shared({0, 1}));
  EXPECT_EQ(less.kept, 2005);
}

TEST(ShareGroups, AsFewLevelsAsWillDo) {
  const Scene s = scene_of({{{1, 1000}}, {{2, 1000}}, {{kNone, 1000}}});
  EXPECT_EQ(share_groups(s).instances[0], 1e9);
  // Either level alone would do: the larger group has fewer placements that rays enter.
  EXPECT_EQ(share_groups(s).shared, shared({0, 1, 0}));
  EXPECT_EQ(share_groups(s).kept, 1001000);
  EXPECT_EQ(share_groups(s, 1e5).shared, shared({0, 1, 1}));
  EXPECT_EQ(share_groups(s, 1e5).kept, 3000);
  // Thirty levels of two: one in the middle.
  std::vector<std::vector<std::pair<uint32_t, int>>> deep;
  for (uint32_t g = 0; g < 30; ++g) deep.push_back({{g < 29 ? g + 1 : kNone, 2}});
  const Sharing halves = share_groups(scene_of(deep));
  EXPECT_EQ(halves.instances[0], std::pow(2, 30));
  EXPECT_EQ(halves.kept, 65536);
  EXPECT_EQ(halves.shared[15], 1);
}

TEST(ShareGroups, ManyKindsGoTogether) {
  // Forty kinds of trees in a thousand places each, and one that is placed once, which saves nothing.
  std::vector<std::vector<std::pair<uint32_t, int>>> groups(1);
  for (uint32_t g = 1; g <= 41; ++g) {
    groups[0].push_back({g, g <= 40 ? 1000 : 1});
    groups.push_back({{kNone, 500 + static_cast<int>(g)}});
  }
  const Sharing some = share_groups(scene_of(groups));
  EXPECT_LE(some.kept, kUnfoldedAtMost);
  EXPECT_EQ(some.shared[41], 0);
  const Sharing all = share_groups(scene_of(groups), 0);
  EXPECT_EQ(std::count(all.shared.begin(), all.shared.end(), 1), 40);
  EXPECT_EQ(all.kept, 40 * 1000 + 541 + 40 * 500 + 40 * 41 / 2);
}

TEST(ShareGroups, WhatMovesComesOrHasNoEndIsNeverShared) {
  Scene s = scene_of({{{1, 1000}}, {{2, 1000}}, {{kNone, 1000}}});
  s.groups[2].placements[3].track = 0;
  EXPECT_EQ(share_groups(s).shared, shared({0, 0, 0}));
  EXPECT_EQ(share_groups(s).kept, 1e9);
  s = scene_of({{{1, 1000}}, {{2, 1000}}, {{kNone, 1000}}});
  s.primitives.push_back({"plane", PrimitiveKind::plane, {0, 0}, kNone});
  s.groups[1].placements[0].kind = TargetKind::primitive, s.groups[1].placements[0].target = 1;
  EXPECT_EQ(share_groups(s).shared, shared({0, 0, 1}));
  // A placement that moves may be one of a shared group.
  s = scene_of({{{1, 1000}}, {{2, 1000}}, {{kNone, 1000}}});
  s.groups[0].placements[0].track = 0;
  EXPECT_EQ(share_groups(s).shared, shared({0, 1, 0}));
}

TEST(ShareGroups, CountsBeyondAnyMemory) {
  std::vector<std::vector<std::pair<uint32_t, int>>> deep;
  for (uint32_t g = 0; g < 500; ++g) deep.push_back({{g < 499 ? g + 1 : kNone, 10}});
  const Sharing all = share_groups(scene_of(deep));
  EXPECT_TRUE(std::isinf(all.instances[0]));
}

}  // namespace
}  // namespace suite::unfolded_test
