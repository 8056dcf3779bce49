// Moving geometry: rays at a time see the scene as it is at that time, within the stated bound while they look and
// exactly where they hit; pictures over a window are the mean over its times; windows share what does not change.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "math/sampling.h"
#include "motion/track.h"
#include "tests/support/radiometry_kit.h"
#include "trace/tracer.h"

namespace suite::test::motion_test {
namespace {

// A rotor: three blades of 5 m x 0.3 m, turning about z at `rate`, on a hub that `hub` moves.
struct Rotor {
  std::shared_ptr<Scene> scene;
  TrackPtr hub, spin;
  Affine3 blade[3];
};
Rotor rotor(double rate, TrackPtr hub) {
  Rotor r;
  r.scene =
      scene_of({mesh_of({{0.2, -0.15, 0}, {5, -0.15, 0.1}, {5, 0.15, 0.1}, {0.2, 0.15, 0}}, {0, 1, 2, 0, 2, 3}, 0)},
               {material("blade", lambert(0.5))});
  r.hub = std::move(hub);
  SpinMotion motion;
  motion.rate = rate;
  r.spin = spin_track(motion);
  r.scene->tracks = {{"hub", r.hub}, {"spin", r.spin}};
  Placement body, turning;
  body.kind = turning.kind = TargetKind::group;
  body.target = 1, body.track = 0;
  turning.target = 2, turning.track = 1;
  turning.to_parent = {};
  Group root{"root", {body}}, craft{"craft", {turning}}, blades{"blades", {}};
  for (int k = 0; k < 3; ++k) {
    Placement p;
    p.to_parent = r.blade[k] = rotation({0, 0, 1}, 2 * kPi * k / 3);
    blades.placements.push_back(p);
  }
  r.scene->groups = {root, craft, blades};
  check_scene(*r.scene, "rotor");
  return r;
}

TrackPtr turning_hub() {
  return keyframe_track({{-1, {quat_about({0, 0, 1}, 0.2), {100, 50, 20}}},
                         {0.3, {quat_about(normalized(Vec3{1, 1, 0}), 0.5), {130, 52, 24}}},
                         {2, {quat_about({0, 1, 0}, -0.3), {180, 40, 22}}}});
}

TEST(Motion, RotorOnAMovingHubIsSeenWhereItIs) {
  const Rotor r = rotor(2 * kPi * 5, turning_hub());  // 5 turns a second
  const TimeSpan window{0.1, 0.6};                    // with a keyframe inside
  const Tracer tracer(r.scene, std::nullopt, window);
  Pcg32 rng(3);
  TraceStatistics statistics;
  const double bound = motion_bound(5.01), edge = 4 * bound;
  EXPECT_LT(bound, 1e-4);
  double worst = 0;
  int hits = 0, outside = 0;
  for (int i = 0; i < 20000; ++i) {
    const double t = window.begin + (window.end - window.begin) * rng.uniform();
    const Affine3 pose = r.hub->at(t).affine() * r.spin->at(t).affine() *
                         r.blade[rng.uniform() * 3 < 1 ? 0
                                 : rng.uniform() < 0.5 ? 1
                                                       : 2];
    // A point on the blade, well inside or well outside its edge, seen from a random place 30 m away.
    const bool inside = rng.uniform() < 0.7;
    const double x = 0.3 + 4.6 * rng.uniform(),
                 y = inside ? 0.29 * (rng.uniform() - 0.5)
                            : (rng.uniform() < 0.5 ? 1 : -1) * (0.15 + edge + 0.002 * rng.uniform());
    const Vec3 point = pose.point({x, y, 0.1 * (x - 0.2) / 4.8});
    const Vec3 from = point + pose.vector({0, 0, rng.uniform() < 0.5 ? 1.0 : -1.0}) * 30.0;
    const Ray ray{from, normalized(point - from), t};
    Hit hit;
    tracer.nearest({&ray, 1}, {&hit, 1}, false, statistics);
    if (!inside) {
      outside += hit.hit();
      continue;
    }
    if (std::fabs(y) > 0.15 - edge) continue;
    ASSERT_TRUE(hit.hit()) << i;
    ++hits;
    // The position is on the true surface; it is off the line of sight by no more than the bound of the search.
    const Vec3 local = pose.inverse().point(hit.position);
    EXPECT_NEAR(local.z, 0.1 * (local.x - 0.2) / 4.8, 1e-6);
    worst = std::max(worst, length(hit.position - point));
    // A ray that leaves the hit at the same time does not meet the blade again.
    const Ray away{tracer.leave(hit, -ray.direction), -ray.direction, t};
    const double far = 25;
    uint8_t blocked = 0;
    tracer.occluded({&away, 1}, {&far, 1}, {&blocked, 1}, false, statistics);
    EXPECT_EQ(blocked, 0);
  }
  EXPECT_GT(hits, 10000);
  EXPECT_EQ(outside, 0);
  EXPECT_LT(worst, bound + 1e-6);
  RecordProperty("worst_m", std::to_string(worst));
}

TEST(Motion, TimeOfTheRayMatters) {
  // The same ray half a turn of a third later meets nothing: the check above can fail.
  const Rotor r = rotor(2 * kPi, static_track({}));
  const Tracer tracer(r.scene, std::nullopt, {0, 1});
  TraceStatistics statistics;
  int seen = 0;
  for (const double t : {0.0, 1.0 / 6}) {
    const Ray ray{{3, 0, 10}, {0, 0, -1}, t};
    Hit hit;
    tracer.nearest({&ray, 1}, {&hit, 1}, false, statistics);
    seen += hit.hit() ? 1 : 0;
    EXPECT_EQ(hit.hit(), t == 0);
  }
  EXPECT_EQ(seen, 1);
}

TEST(Motion, BlurOfARotorIsTheShareOfTimeItIsThere) {
  // Looking down the axis at radius x, a blade of width w is there for 3 * 2 atan(w / 2x) / 2 pi of a turn.
  const Rotor r = rotor(2 * kPi * 7, static_track({}));
  const Tracer tracer(r.scene, std::nullopt, {0, 1});
  TraceStatistics statistics;
  constexpr size_t n = 40000;
  std::vector<Ray> rays(n);
  std::vector<Hit> hits(n);
  for (const double x : {0.5, 1.0, 2.5, 4.5}) {
    for (size_t i = 0; i < n; ++i) rays[i] = {{x * 0.6, x * 0.8, 9}, {0, 0, -1}, (static_cast<double>(i) + 0.5) / n};
    tracer.nearest(rays, hits, true, statistics);
    const double share =
        static_cast<double>(std::count_if(hits.begin(), hits.end(), [](const Hit& h) { return h.hit(); })) / n;
    const double expected = 3 * 2 * std::asin(0.15 / x) / (2 * kPi);
    EXPECT_NEAR(share, expected, 42.0 / n + 1e-12) << x;  // two edges a blade, 21 passages
  }
}

TEST(Motion, ExactSurfacesAndPlanesMoveToo) {
  auto scene = scene_of({}, {material("m", lambert(0.5))});
  scene->primitives = {{"ball", PrimitiveKind::sphere, {1}, 0}, {"floor", PrimitiveKind::plane, {0, 0}, 0}};
  StraightMotion east;
  east.speed = 100;
  scene->tracks = {{"east", straight_track(east)},
                   {"rising", keyframe_track({{0, {{}, {0, 0, -10}}}, {2, {{}, {0, 0, -8}}}})}};
  Placement ball, floor;
  ball.kind = floor.kind = TargetKind::primitive;
  ball.track = 0;
  floor.target = 1, floor.track = 1;
  scene->groups[0].placements = {ball, floor};
  check_scene(*scene, "moving surfaces");
  const Tracer tracer(scene, std::nullopt, {0, 2});
  TraceStatistics statistics;
  for (const double t : {0.0, 0.7, 2.0}) {
    const Ray at_ball{{100 * t, 0.3, 50}, {0, 0, -1}, t}, at_floor{{100 * t + 3, 0, 50}, {0, 0, -1}, t};
    Hit hit;
    tracer.nearest({&at_ball, 1}, {&hit, 1}, false, statistics);
    ASSERT_TRUE(hit.hit());
    EXPECT_NEAR(hit.position.z, std::sqrt(1 - 0.09), 1e-9);
    tracer.nearest({&at_floor, 1}, {&hit, 1}, false, statistics);
    ASSERT_TRUE(hit.hit());
    EXPECT_NEAR(hit.position.z, t - 10, 1e-9);
  }
}

TEST(Motion, FastAndFarThingsKeepTheirShape) {
  // A box of 1 m at 7.5 km/s crosses 75 km in the window; it is hit where it is to a micrometre.
  auto scene = scene_of({box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, 0, true)}, {material("m", lambert(0.5))});
  StraightMotion motion;
  motion.speed = 7500;
  motion.azimuth = 0.3;
  motion.start = {2e5, -3e5, 5e5};
  scene->tracks = {{"satellite", straight_track(motion)}};
  scene->groups[0].placements[0].track = 0;
  const Tracer tracer(scene, std::nullopt, {0, 10});
  TraceStatistics statistics;
  Pcg32 rng(5);
  for (int i = 0; i < 2000; ++i) {
    const double t = 10 * rng.uniform();
    const Affine3 pose = scene->tracks[0].track->at(t).affine();
    const Vec3 local{0.9 * (rng.uniform() - 0.5), 0.9 * (rng.uniform() - 0.5), 0.5}, point = pose.point(local);
    const Vec3 from = point + Vec3{0, 0, 100} + Vec3{rng.uniform(), rng.uniform(), 0} * 20.0;
    const Ray ray{from, normalized(point - from), t};
    Hit hit;
    tracer.nearest({&ray, 1}, {&hit, 1}, false, statistics);
    ASSERT_TRUE(hit.hit()) << i;
    EXPECT_LT(length(hit.position - point), 1e-6 + motion_bound(1)) << i;
  }
}

TEST(Motion, TheSameBitsForAnyNumberOfThreads) {
  const Rotor r = rotor(2 * kPi * 5, turning_hub());
  Pcg32 rng(4);
  std::vector<Ray> rays;
  for (int i = 0; i < 8192; ++i) {
    const double t = 0.1 + 0.5 * rng.uniform();
    const Vec3 hub = r.hub->at(t).translation;
    rays.push_back({hub + Vec3{10 * (rng.uniform() - 0.5), 10 * (rng.uniform() - 0.5), 20},
                    normalized(Vec3{0.1 * rng.uniform(), 0, -1}), t});
  }
  std::vector<std::vector<Hit>> results;
  for (const int count : {1, 3}) {
    set_threads(count);
    const Tracer tracer(r.scene, std::nullopt, {0.1, 0.6});
    std::vector<Hit> hits(rays.size());
    parallel_for(0, rays.size(), 64, [&](size_t b, size_t e) {
      const FlushDenormals flush;
      TraceStatistics statistics;
      tracer.nearest(std::span(rays).subspan(b, e - b), std::span(hits).subspan(b, e - b), true, statistics);
    });
    results.push_back(std::move(hits));
  }
  set_threads(0);
  size_t found = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const Hit &a = results[0][i], &b = results[1][i];
    ASSERT_EQ(a.object, b.object);
    if (!a.hit()) continue;
    ++found;
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.distance, b.distance);
    EXPECT_EQ(a.u, b.u);
  }
  EXPECT_GT(found, 100u);
}

TEST(Motion, AnInstantIsExact) {
  // With one time there is one pose: hits agree with a scene at rest placed there, and leave as closely as there.
  const Rotor r = rotor(2 * kPi * 5, turning_hub());
  const Tracer moving(r.scene, std::nullopt, {0.37, 0.37});
  auto frozen = std::make_shared<Scene>(*r.scene);
  frozen->tracks.clear();
  for (Group& g : frozen->groups)
    for (Placement& p : g.placements)
      if (p.track != kNone)
        p.to_parent = (p.track == 0 ? r.hub : r.spin)->at(0.37).affine() * p.to_parent, p.track = kNone;
  const Tracer still(frozen);
  TraceStatistics statistics;
  Pcg32 rng(6);
  int found = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 hub = r.hub->at(0.37).translation;
    const Ray ray{hub + Vec3{10 * (rng.uniform() - 0.5), 10 * (rng.uniform() - 0.5), 20}, normalized(Vec3{0.1, 0, -1}),
                  0.37};
    Hit a, b;
    moving.nearest({&ray, 1}, {&a, 1}, true, statistics);
    still.nearest({&ray, 1}, {&b, 1}, true, statistics);
    ASSERT_EQ(a.hit(), b.hit());
    if (!a.hit()) continue;
    ++found;
    EXPECT_LT(length(a.position - b.position), 5e-6);
    EXPECT_FLOAT_EQ(a.step, b.step);
  }
  EXPECT_GT(found, 100);
}

TEST(Motion, AWindowThatIsNotCoveredIsAnError) {
  const Rotor r = rotor(1, turning_hub());
  EXPECT_THROW(Tracer(r.scene, std::nullopt, {0, 3}), Error);
  EXPECT_THROW(Tracer(r.scene, Periodic{{0, 0}, {10, 10}}, {0, 1}), Error);
}

TEST(Motion, WindowsShareWhatRests) {
  // Nothing can move: one tracer for all windows.
  TracerCache still(scene_of({quad(1, 0, 0)}, {material("m", lambert(0.5))}));
  const auto first = still.get({0, 1});
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(still.get({i * 1.0, i + 0.5}), first);
  EXPECT_EQ(still.builds(), 1u);
  // A door that opens between 10 and 11 s: windows before and after share one tracer each.
  auto scene = scene_of({quad(1, 0, 0)}, {material("m", lambert(0.5))});
  const Pose closed{}, open{quat_about({0, 0, 1}, 1.5), {0, 0, 0}};
  scene->tracks = {{"door", keyframe_track({{0, closed}, {10, closed}, {11, open}, {100, open}})}};
  scene->groups[0].placements[0].track = 0;
  TracerCache door(scene);
  const auto before = door.get({0, 1});
  for (int i = 1; i < 9; ++i) EXPECT_EQ(door.get({i * 1.0, i + 0.5}), before);
  EXPECT_NE(door.get({10.2, 10.4}), before);
  const auto after = door.get({12, 13});
  EXPECT_NE(after, before);
  EXPECT_EQ(door.get({50, 60}), after);
  EXPECT_EQ(door.get({2, 3}), before);
  EXPECT_EQ(door.builds(), 3u);
  EXPECT_NE(door.get({10.2, 10.5}), door.get({10.2, 10.4}));
}

TEST(Instances, AnyScaleMirroredAndTurned) {
  // From a micrometre to a thousand kilometres, mirrored or not, near and far: hits to 1e-6 of the instance's size.
  Pcg32 rng(9);
  TraceStatistics statistics;
  for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6})
    for (const double mirror : {1.0, -1.0})
      for (const double away : {0.0, 1e4, 1e7}) {
        if (away * 1e-15 > scale * 1e-7) continue;  // double cannot place it that finely
        auto scene = scene_of({box({-1, -1, -1}, {1, 1, 1}, 0, true)}, {material("m", lambert(0.5))});
        const Affine3 place = translation(Vec3{0.6, 0.8, 0.1} * away) * rotation(normalized(Vec3{1, 2, 3}), 0.7) *
                              scaling({mirror * scale, scale, 2 * scale});
        scene->groups[0].placements[0].to_parent = place;
        const Tracer tracer(scene);
        for (int i = 0; i < 50; ++i) {
          const Vec3 point = place.point({1.9 * (rng.uniform() - 0.5), 1.9 * (rng.uniform() - 0.5), 1}),
                     normal = normalized(place.normal({0, 0, 1})) * mirror;
          const Dir towards = normalized(normal * -1.0 + Vec3{0.1, 0.05, 0} * rng.uniform());
          const Ray ray{point - towards * (10 * scale), towards, 0};
          Hit hit;
          tracer.nearest({&ray, 1}, {&hit, 1}, false, statistics);
          ASSERT_TRUE(hit.hit()) << scale << " " << away;
          EXPECT_LT(length(hit.position - point), 2e-6 * scale + 4e-16 * away) << scale << " " << away;
          EXPECT_GT(dot(hit.normal, normal), 1 - 1e-9);
          // Leaving outwards meets nothing; going in meets the far side.
          const Ray out{tracer.leave(hit, normal), normal, 0}, in{tracer.leave(hit, -normal), -normal, 0};
          const double far = INFINITY;
          uint8_t blocked = 1;
          tracer.occluded({&out, 1}, {&far, 1}, {&blocked, 1}, false, statistics);
          EXPECT_EQ(blocked, 0) << scale << " " << away;
          tracer.nearest({&in, 1}, {&hit, 1}, false, statistics);
          ASSERT_TRUE(hit.hit());
          EXPECT_NEAR(hit.distance, 4 * scale, 1e-3 * scale);
        }
      }
}

TEST(Instances, TilesWaitForTheFirstRay) {
  // A hundred boxes over 1000 km: a ray builds the tiles it comes to, from any thread, and no others.
  auto scene = scene_of({box({-5, -5, 0}, {5, 5, 10}, 0, true)}, {material("m", lambert(0.5))});
  scene->groups[0].placements.clear();
  for (int i = 0; i < 100; ++i) {
    Placement p;
    p.to_parent = translation({i * 1e4, 0, 0});
    scene->groups[0].placements.push_back(p);
  }
  const Tracer tracer(scene);
  EXPECT_EQ(tracer.tiles(), 100u);
  EXPECT_EQ(tracer.tiles_built(), 0u);
  const Ray down{{5e4, 0, 7e5}, {0, 0, -1}, 0};
  Hit hit;
  TraceStatistics statistics;
  tracer.nearest({&down, 1}, {&hit, 1}, false, statistics);
  EXPECT_TRUE(hit.hit());
  EXPECT_EQ(tracer.tiles_built(), 1u);
  std::atomic<int> hits{0};
  parallel_for(0, 4000, 1, [&](size_t begin, size_t end) {
    const FlushDenormals flush;
    TraceStatistics mine;
    for (size_t k = begin; k < end; ++k) {
      const Ray ray{{static_cast<double>(k % 50) * 1e4 + 1, 2, 7e5}, {0, 0, -1}, 0};
      Hit h;
      tracer.nearest({&ray, 1}, {&h, 1}, false, mine);
      hits += h.hit() && std::fabs(h.position.z - 10) < 1e-5 ? 1 : 0;
    }
  });
  EXPECT_EQ(hits, 4000);
  EXPECT_EQ(tracer.tiles_built(), 50u);
}

}  // namespace
}  // namespace suite::test::motion_test
