// Things that come, go and change their material: rays of a time meet what is there at that time, whole windows and
// windows in which it happens; pictures over a window are the mean over its times.
#include <gtest/gtest.h>

#include <cmath>

#include "motion/track.h"
#include "tests/support/radiometry_kit.h"
#include "trace/tracer.h"

namespace suite::test::lifetime_test {
namespace {

constexpr double kGround = 0.1, kPanel = 0.8, kOther = 0.4;

// A black-edged ground of reflectance 0.1 (material 0) under a panel of 0.8 (material 1) at height 1, which `panel`
// places; material 2 is another one.
std::shared_ptr<Scene> ground_under(Placement panel, std::vector<SceneTrack> tracks, std::vector<Schedule> schedules) {
  auto scene = scene_of(
      {quad(50, 0, 0), quad(2, 1, 1)},
      {material("ground", lambert(kGround)), material("panel", lambert(kPanel)), material("other", lambert(kOther))});
  scene->tracks = std::move(tracks);
  scene->schedules = std::move(schedules);
  Placement ground;
  panel.target = 1;
  scene->groups = {{"root", {ground, panel}}};
  check_scene(*scene, "test");
  return scene;
}

Schedule life(double begin, double end) {
  Schedule s;
  s.name = "panel";
  s.life = {begin, end};
  return s;
}
Placement scheduled() {
  Placement p;
  p.schedule = 0;
  return p;
}

// What a ray from above meets at a time: the material and the height.
struct Seen {
  double height;
  uint32_t material, instance;
};
Seen seen(const Tracer& tracer, double t, Vec3 from = {0.3, 0.2, 10}) {
  TraceStatistics statistics;
  const FlushDenormals flush;
  std::vector<Ray> rays(3, Ray{from, {0, 0, -1}, t});
  std::vector<Hit> hits(3);
  tracer.nearest(rays, hits, true, statistics);
  const Hit& hit = hits[1];
  EXPECT_TRUE(hit.hit());
  // Visibility agrees with what is nearest.
  const std::vector<double> distance(3, 9.5);
  std::vector<uint8_t> blocked(3);
  tracer.occluded(rays, distance, blocked, true, statistics);
  EXPECT_EQ(blocked[0] != 0, hit.position.z > 0.6) << t;
  const TracedObject o = tracer.object(hit.object);
  const uint32_t own = tracer.scene().meshes[o.mesh].parts[0].material;
  return {hit.position.z, o.material_override == kNone ? own : o.material_override, o.instance};
}

TEST(Lifetime, RaysMeetWhatIsThereAtTheirTime) {
  const auto scene = ground_under(scheduled(), {}, {life(2, 5)});
  for (const TimeSpan window : {TimeSpan{0, 10}, TimeSpan{2, 5}, TimeSpan{3, 7}, TimeSpan{0, 3}}) {
    const Tracer tracer(scene, std::nullopt, window);
    for (const double t : {0.0, 1.999, 2.0, 3.0, 4.999, 5.0, 9.0})
      if (window.contains(t)) {
        EXPECT_NEAR(seen(tracer, t).height, t >= 2 && t < 5 ? 1 : 0, 1e-6) << t << " in " << window.begin;
      }
  }
  // Where it is not there at all it is no part of the tracer.
  EXPECT_NEAR(Tracer(scene, std::nullopt, {5, 9}).bounds().high.z, 0, 1e-6);
  EXPECT_NEAR(Tracer(scene, std::nullopt, {4, 9}).bounds().high.z, 1, 1e-3);
  EXPECT_NEAR(scene_bounds(*scene, 5, 9).high.z, 0, 1e-6);
  EXPECT_NEAR(scene_bounds(*scene, 0, 9).high.z, 1, 1e-6);
}

TEST(Lifetime, ATrackThatEndsTakesItsPlacementWithIt) {
  const auto pass = [](double t, double x) { return PoseKey{t, {{}, {x, 0, 0}}}; };
  const TrackPtr track = ending_track(keyframe_track({pass(2, -30), pass(5, 30)}));
  Placement p;
  p.track = 0;
  const auto scene = ground_under(p, {{"panel", track}}, {});
  EXPECT_NO_THROW(check_motion(*scene, 0, 10, {}));
  const Tracer tracer(scene, std::nullopt, {0, 10});
  for (const double t : {0.0, 1.9, 2.0, 2.1, 3.5, 4.9, 5.0, 5.1, 10.0}) {
    const bool there = t >= 2 && t <= 5;
    const double x = -30 + 20 * (t - 2);
    EXPECT_NEAR(seen(tracer, t, {there ? x : 0, 0, 10}).height, there ? 1 : 0, 1e-6) << t;
    EXPECT_NEAR(seen(tracer, t, {there ? x + 3 : -30, 0, 10}).height, 0, 1e-6) << t;
  }
  // Without it the run is refused, as ever.
  const auto refused = ground_under(p, {{"panel", keyframe_track({pass(2, -30), pass(5, 30)})}}, {});
  EXPECT_THROW(check_motion(*refused, 0, 10, {}), Error);
  EXPECT_THROW(Tracer(refused, std::nullopt, {0, 10}), Error);
  // A lifetime says when the track is needed.
  Placement timed = p;
  timed.schedule = 0;
  const auto lived = ground_under(timed, {{"panel", keyframe_track({pass(2, -30), pass(5, 30)})}}, {life(2.5, 4)});
  EXPECT_NO_THROW(check_motion(*lived, 0, 10, {}));
  const Tracer both(lived, std::nullopt, {0, 10});
  EXPECT_NEAR(seen(both, 3, {-10, 0, 10}).height, 1, 1e-6);
  EXPECT_NEAR(seen(both, 4, {10, 0, 10}).height, 0, 1e-6);
}

TEST(Lifetime, MaterialsChangeAndTheInstanceStaysTheSame) {
  Schedule s = life(-kEver, kEver);
  s.when = {{0, 4, 6}, 10};
  s.there = {1, 1, 0};
  s.material = {kNone, 2, kNone};
  const auto scene = ground_under(scheduled(), {}, {s});
  const Tracer tracer(scene, std::nullopt, {0, 40});
  const uint32_t instance = seen(tracer, 1).instance;
  for (const double cycle : {0.0, 10.0, 30.0}) {
    EXPECT_EQ(seen(tracer, cycle + 1).material, 1u);
    EXPECT_EQ(seen(tracer, cycle + 4).material, 2u);
    EXPECT_EQ(seen(tracer, cycle + 5.9).instance, instance);
    EXPECT_EQ(seen(tracer, cycle + 6).material, 0u);
    EXPECT_NE(seen(tracer, cycle + 9).instance, instance);
  }
}

TEST(Lifetime, GroupsTakeWhatTheyPlaceWithThem) {
  // A group that lives from 2 to 5 places a panel that lives from 4 to 8, and one that is always there.
  auto scene = ground_under(scheduled(), {}, {life(2, 5), life(4, 8)});
  Placement group, first, second;
  group.kind = TargetKind::group, group.target = 1, group.schedule = 0;
  first.target = second.target = 1;
  first.schedule = 1;
  second.to_parent.b = {10, 0, 0};
  scene->groups = {{"root", {scene->groups[0].placements[0], group}}, {"group", {first, second}}};
  const Tracer tracer(scene, std::nullopt, {0, 10});
  for (const double t : {1.0, 2.0, 3.9, 4.0, 4.9, 5.0, 7.0}) {
    EXPECT_NEAR(seen(tracer, t).height, t >= 4 && t < 5 ? 1 : 0, 1e-6) << t;
    EXPECT_NEAR(seen(tracer, t, {10, 0, 10}).height, t >= 2 && t < 5 ? 1 : 0, 1e-6) << t;
  }
}

TEST(Lifetime, ExactSurfacesComeAndGoToo) {
  for (const bool endless : {false, true}) {
    auto scene = ground_under(scheduled(), {}, {life(2, 5)});
    Primitive plane;
    plane.name = "plane";
    plane.kind = PrimitiveKind::plane;
    plane.parameters = endless ? std::vector<double>{0, 0} : std::vector<double>{4, 4};
    plane.material = 1;
    scene->primitives = {plane};
    Placement& p = scene->groups[0].placements[1];
    p.kind = TargetKind::primitive, p.target = 0;
    p.to_parent.b = {0, 0, 1};
    const Tracer tracer(scene, std::nullopt, {0, 10});
    TraceStatistics statistics;
    for (const double t : {1.0, 2.0, 4.9, 5.0}) {
      const Ray ray{{0.1, 0.1, 10}, {0, 0, -1}, t};
      Hit hit;
      tracer.nearest({&ray, 1}, {&hit, 1}, false, statistics);
      EXPECT_NEAR(hit.position.z, t >= 2 && t < 5 ? 1 : 0, 1e-6) << t << " " << endless;
      const double all = 20;
      uint8_t blocked = 0;
      const Ray up{{0.1, 0.1, 0.5}, {0, 0, 1}, t};
      tracer.occluded({&up, 1}, {&all, 1}, {&blocked, 1}, false, statistics);
      EXPECT_EQ(blocked != 0, t >= 2 && t < 5) << t << " " << endless;
    }
  }
}

TEST(Lifetime, WindowsShareATracerWhileTheSameIsThere) {
  TracerCache cache(ground_under(scheduled(), {}, {life(2, 5)}));
  const auto before = cache.get({0, 1}), after = cache.get({6, 9}), there = cache.get({2, 3}),
             still = cache.get({4, 4.5}), across = cache.get({4, 6}), within = cache.get({4.5, 6});
  EXPECT_EQ(before, after);
  EXPECT_EQ(there, still);
  EXPECT_NE(before, there);
  EXPECT_NE(across, within);
  EXPECT_NE(across, there);
  EXPECT_EQ(cache.builds(), 4u);
}

// A camera pixel over a window: the mean over the times at which it looks.
TEST(Lifetime, AnExposureSeesTheMeanOfItsWindow) {
  SourceSpecs sky;
  sky.add(uniform_sky(1, false));
  // A panel close over the ground is seen with its own radiance under a uniform sky of radiance 1.
  for (const TimeSpan window : {TimeSpan{0, 4}, TimeSpan{3, 7}, TimeSpan{0, 10}}) {
    const Rendered run =
        render(ground_under(scheduled(), {}, {life(2, 5)}), sky, std::make_unique<Exposure>(5, window, 1 << 12));
    const double there = (std::min(window.end, 5.0) - std::max(window.begin, 2.0)) / (window.end - window.begin);
    EXPECT_NEAR(run.result.radiance[0], there * kPanel + (1 - there) * kGround,
                4 * run.result.standard_error[0] + 1e-3);
    EXPECT_TRUE(there > 0.1 && there < 0.9) << "something that is always there would do";
  }
}

}  // namespace
}  // namespace suite::test::lifetime_test
