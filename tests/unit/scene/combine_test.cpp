// Several scenes as one: indices, names, places on the Earth, motions and times.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "motion/scene_frame.h"
#include "motion/track.h"
#include "scene/combine.h"
#include "support/message_of.h"
#include "support/radiometry_kit.h"
#include "trace/tracer.h"

namespace suite::test::combine_test {
namespace {

using ::testing::HasSubstr;

// A square of half size 1 at the origin with a tag and a map, in a group of its own.
Scene part(double latitude, double longitude, const std::string& tag) {
  Scene s = *scene_of({quad(1, 0, 0)}, {material("grey", lambert(0.5))});
  s.groups.push_back({"inner", s.groups[0].placements});
  s.groups[0].placements[0].kind = TargetKind::group;
  s.groups[0].placements[0].target = 1;
  s.groups[0].placements[0].tag = 0;
  s.tags = {"common", tag};
  s.origin = {latitude, longitude, 300, true};
  ClassMap map;
  map.name = "map";
  map.width = map.height = 1;
  map.classes = {0};
  map.materials = {0};
  map.drape = {-1, 1, 2, 2, Drape::Extend::clamp};
  s.class_maps = {map};
  s.bounds = scene_bounds(s);
  check_scene(s, "part");
  return s;
}

TEST(Combine, ScenesStandWhereTheirOriginsSay) {
  std::vector<ScenePart> parts(2);
  parts[0] = {"a", part(48, 9, "left"), {}, nullptr};
  parts[1] = {"b", part(48.001, 9.002, "right"), {}, nullptr};
  const float* vertices = parts[1].scene.meshes[0].positions.data();
  auto all = std::make_shared<Scene>(combine_scenes(std::move(parts)));
  check_scene(*all, "all");
  EXPECT_EQ(all->meshes[1].positions.data(), vertices) << "vertices are not copied";
  EXPECT_EQ(all->origin.latitude_deg, 48);
  EXPECT_THAT(all->tags, ::testing::ElementsAre("common", "left", "right"));
  EXPECT_EQ(all->materials[1].id, "grey (b)");
  EXPECT_EQ(all->class_maps[1].materials[0], 1u);
  const SceneFrame frame({48, 9, 300});
  const Vec3 there = frame.enu_from_geodetic({48.001, 9.002, 300});
  EXPECT_NEAR(all->class_maps[1].drape.origin_x, there.x - 1, 1e-8);
  const Tracer tracer(all);
  ASSERT_EQ(tracer.object_count(), 2u);
  const Affine3 second = tracer.to_world(1, 0);
  EXPECT_LT(length(second.b - there), 1e-8);
  // Its up is the vertical of its own place.
  EXPECT_LT(length(second.vector({0, 0, 1}) - frame.local_axes(there).z), 1e-12);
  EXPECT_EQ(tracer.object(1).tag, 0u);
  Hit hit;
  TraceStatistics statistics;
  const Ray down{there + Vec3{0.3, 0.2, 5}, {0, 0, -1}, 0};
  tracer.nearest({&down, 1}, {&hit, 1}, false, statistics);
  ASSERT_TRUE(hit.hit());
  EXPECT_EQ(hit.object, 1u);
}

TEST(Combine, PlacementsMotionsAndTimes) {
  std::vector<ScenePart> parts(3);
  parts[0] = {"city", part(48, 9, "t"), {}, nullptr};
  parts[1] = {"shed", part(0, 0, "t"), translation({10, 20, 30}), nullptr};
  parts[2] = {"traffic", part(0, 0, "t"), {}, static_track({{}, {5, 6, 7}})};
  parts[2].scene.class_maps.clear();
  parts[0].scene.epoch = "2024-05-01T10:00:00Z";
  parts[2].scene.epoch = "2024-05-01T10:01:00Z";
  parts[2].scene.tracks = {{"car", keyframe_track({{0, {}}, {10, {{}, {100, 0, 0}}}})}};
  parts[2].scene.groups[1].placements[0].track = 0;
  auto all = std::make_shared<Scene>(combine_scenes(std::move(parts)));
  check_scene(*all, "all");
  EXPECT_EQ(all->epoch, "2024-05-01T10:00:00Z");
  const Tracer tracer(all, std::nullopt, {61, 65});
  ASSERT_EQ(tracer.object_count(), 3u);
  EXPECT_EQ(tracer.to_world(1, 62).b, (Vec3{10, 20, 30}));
  EXPECT_LT(length(tracer.to_world(2, 62.5).b - Vec3{30, 6, 7}), 1e-9);
  EXPECT_THAT(message_of([&] { check_motion(*all, 0, 5, {}); }), HasSubstr("car in traffic is known from 60 to 70 s"));
}

TEST(Combine, VolumesFollowTheirScenes) {
  // One that moves in the first scene, one at rest in a scene that stands elsewhere, and both in a scene that moves.
  const auto with_volumes = [](bool moves) {
    Scene s = part(0, 0, "t");
    s.class_maps.clear();
    s.media.emplace_back();
    s.grids.push_back({"g", {1, 1, 1}, {}, {1}, {}, {0}, {}});
    s.volumes.push_back({0, translation({1, 0, 0}), moves ? 0 : kNone});
    if (moves) s.tracks = {{"puff", static_track({{}, {0, 0, 2}})}};
    return s;
  };
  std::vector<ScenePart> parts(3);
  parts[0] = {"a", with_volumes(true), {}, nullptr};
  parts[1] = {"b", with_volumes(false), translation({10, 20, 30}), nullptr};
  parts[2] = {"c", with_volumes(true), {}, static_track({{}, {5, 6, 7}})};
  const Scene all = combine_scenes(parts);
  check_scene(all, "all");
  ASSERT_EQ(all.volumes.size(), 3u);
  const auto place = [&](const Volume& v) {
    return v.track == kNone ? v.to_world.b : (all.tracks[v.track].track->at(0).affine() * v.to_world).b;
  };
  EXPECT_EQ(place(all.volumes[0]), (Vec3{1, 0, 2}));
  EXPECT_EQ(place(all.volumes[1]), (Vec3{11, 20, 30}));
  EXPECT_EQ(place(all.volumes[2]), (Vec3{6, 6, 9}));
  EXPECT_EQ(all.volumes[2].grid, 2u);
  parts[2].motion = nullptr;
  parts[2].placement = translation({1, 1, 1});
  EXPECT_THAT(message_of([&] { combine_scenes(parts); }), HasSubstr("has a volume that moves"));
}

TEST(Combine, MotionsKeepTheirDates) {
  Scene s = part(48, 9, "t");
  s.tracks = {{"car", keyframe_track({{0, {}}, {10, {{}, {100, 0, 0}}}})}};
  s.epoch = "2024-05-01T10:01:00Z";
  set_epoch(s, "2024-05-01T10:00:30Z");
  EXPECT_EQ(s.tracks[0].track->covered().begin, 30);
  EXPECT_LT(length(s.tracks[0].track->at(35).translation - Vec3{50, 0, 0}), 1e-9);
  // Without an epoch of its own, second 0 is second 0.
  s.epoch.clear();
  set_epoch(s, "2025-01-01T00:00:00Z");
  EXPECT_EQ(s.tracks[0].track->covered().begin, 30);
}

TEST(Combine, ScenesAreThereForTheirTime) {
  std::vector<ScenePart> parts(2);
  parts[0] = {"site", part(48, 9, "t"), {}, nullptr};
  parts[1] = {"crane", part(0, 0, "t"), translation({10, 0, 0}), nullptr, {10, 20}};
  const auto all = std::make_shared<const Scene>(combine_scenes(parts));
  check_scene(*all, "all");
  const auto seen = [&](TimeSpan window, double time) {
    const Tracer tracer(all, std::nullopt, window);
    Hit hit;
    TraceStatistics statistics;
    const Ray down{{10.3, 0.2, 5}, {0, 0, -1}, time};
    tracer.nearest({&down, 1}, {&hit, 1}, false, statistics);
    return hit.hit();
  };
  EXPECT_FALSE(seen({0, 9}, 5));
  EXPECT_TRUE(seen({12, 13}, 12));
  EXPECT_FALSE(seen({20, 21}, 20));
  EXPECT_FALSE(seen({5, 15}, 9.9));
  EXPECT_TRUE(seen({5, 15}, 10));
  // Times of the whole, whose second 0 is the first scene's.
  Scene later = *all;
  later.epoch = "2024-05-01T10:01:00Z";
  set_epoch(later, "2024-05-01T10:00:30Z");
  EXPECT_EQ(later.schedules.at(0).life, (TimeSpan{40, 50}));
  parts[1].scene.media.emplace_back();
  parts[1].scene.ambient = 0;
  EXPECT_THAT(message_of([&] { combine_scenes(parts); }), HasSubstr("an ambient medium, which cannot appear"));
}

TEST(Combine, WhatCannotBeRelatedIsRefused) {
  std::vector<ScenePart> parts(2);
  parts[0] = {"a", part(48, 9, "t"), {}, nullptr};
  parts[1] = {"b", part(48, 9, "t"), {}, nullptr};
  parts[1].scene.origin.given = false;
  EXPECT_THAT(message_of([&] { combine_scenes(parts); }), HasSubstr("'b' has no origin"));
  parts[1].placement = rotation({0, 0, 1}, 1);
  EXPECT_THAT(message_of([&] { combine_scenes(parts); }), HasSubstr("draped maps cannot turn"));
  parts[1].placement.reset();
  parts[1].motion = static_track({});
  EXPECT_THAT(message_of([&] { combine_scenes(parts); }), HasSubstr("which moves"));
}

}  // namespace
}  // namespace suite::test::combine_test
