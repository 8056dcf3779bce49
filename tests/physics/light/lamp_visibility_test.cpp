// Next-event estimation towards glowing surfaces of every kind, beside every other kind of surface: a point of a convex
// lamp that faces a receiver is seen when nothing is between. Form factor of a square (Howell's catalog C-3), of a
// disk (B-15), of a sphere ((R / d)^2 overhead). Each table has controls: what lies just behind the lamp's samples must
// block rays that end beyond it, and a plate in between must block all.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>

#include "math/sampling.h"
#include "spectral/state.h"
#include "tests/support/lamps_kit.h"
#include "trace/tracer.h"

namespace suite::test::lamp_visibility_test {
namespace {

constexpr int kSamples = 1500;

// What glows: about one metre wide, faces down at the origin of its frame.
enum class Lamp { mesh, mesh_within_ground, plane, disk, sphere };
constexpr Lamp kLamps[] = {Lamp::mesh, Lamp::mesh_within_ground, Lamp::plane, Lamp::disk, Lamp::sphere};
const char* const kLampNames[] = {"mesh", "mesh within a wide ground", "plane", "disk", "sphere"};

// What else stands in the scene, out of the way.
enum class Beside { nothing, sphere, far_box, wide_plane, endless_plane, mesh, turned_mesh, many_meshes };
constexpr Beside kBeside[] = {Beside::nothing,       Beside::sphere, Beside::far_box,     Beside::wide_plane,
                              Beside::endless_plane, Beside::mesh,   Beside::turned_mesh, Beside::many_meshes};
const char* const kBesideNames[] = {"nothing",       "sphere", "far box",     "wide plane",
                                    "endless plane", "mesh",   "turned mesh", "many meshes"};

struct Setting {
  const char* name;
  Affine3 place;     // of the lamp
  double keep;       // placements kept before groups are shared
  bool nested;       // in a group that is placed twice
  Vec3 origin = {};  // of it all
  bool periodic = false;
  double size = 1;  // scale of the lamp
};

Mesh facing_down(double half, uint32_t material) {
  return mesh_of({{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}}, {0, 2, 1, 0, 3, 2},
                 material);
}

// A square that glows, in one mesh with a ground 3 km wide, 1 km under it.
Mesh within_ground() {
  Mesh m = mesh_of({{-0.5, -0.5, 0},
                    {0.5, -0.5, 0},
                    {0.5, 0.5, 0},
                    {-0.5, 0.5, 0},
                    {-1500, -1500, -1000},
                    {1500, -1500, -1000},
                    {1500, 1500, -1000},
                    {-1500, 1500, -1000}},
                   {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7}, 1);
  m.parts = {{"lamp", 0, 2, 1}, {"ground", 2, 2, 0}};
  return m;
}

Placement placed(TargetKind kind, uint32_t target, const Affine3& at) {
  Placement p;
  p.kind = kind, p.target = target, p.to_parent = at;
  return p;
}

std::shared_ptr<Scene> scene_with(Lamp lamp, Beside beside, const Setting& s) {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("dark", lambert(0)), material("lamp", lambert(0))};
  scene->groups.emplace_back();
  scene->groups[0].name = "root";
  const auto primitive = [&](PrimitiveKind kind, std::vector<double> q, uint32_t material) {
    scene->primitives.push_back({"p", kind, std::move(q), material});
    return static_cast<uint32_t>(scene->primitives.size() - 1);
  };
  const auto mesh = [&](Mesh m) {
    scene->meshes.push_back(std::move(m));
    return static_cast<uint32_t>(scene->meshes.size() - 1);
  };
  const Affine3 flip{{1, 0, 0, 0, -1, 0, 0, 0, -1}, {}}, base = translation(s.origin);
  const Affine3 own = s.place * scaling({s.size, s.size, s.size});
  Placement p;
  if (lamp == Lamp::mesh) p = placed(TargetKind::mesh, mesh(facing_down(0.5, 1)), own);
  if (lamp == Lamp::mesh_within_ground) p = placed(TargetKind::mesh, mesh(within_ground()), own);
  if (lamp == Lamp::plane) p = placed(TargetKind::primitive, primitive(PrimitiveKind::plane, {1, 1}, 1), own * flip);
  if (lamp == Lamp::disk) p = placed(TargetKind::primitive, primitive(PrimitiveKind::disk, {0.5, 0}, 1), own * flip);
  if (lamp == Lamp::sphere) p = placed(TargetKind::primitive, primitive(PrimitiveKind::sphere, {0.5}, 1), own);
  if (s.nested) {
    scene->groups.emplace_back();
    scene->groups[1].name = "inner";
    scene->groups[1].placements = {p};
    scene->groups[0].placements = {placed(TargetKind::group, 1, base),
                                   placed(TargetKind::group, 1, base * translation({0, 2000, 0}))};
  } else {
    p.to_parent = base * p.to_parent;
    scene->groups[0].placements = {p};
  }
  const auto add = [&](TargetKind kind, uint32_t target, const Affine3& at) {
    scene->groups[0].placements.push_back(placed(kind, target, base * at));
  };
  const Affine3 turned = translation({0, 300, 5}) * rotation({0, 0, 1}, 0.3);
  if (beside == Beside::sphere)
    add(TargetKind::primitive, primitive(PrimitiveKind::sphere, {0.1}, 0), translation({50, 0, 0}));
  if (beside == Beside::far_box)
    add(TargetKind::primitive, primitive(PrimitiveKind::box, {-1, -1, -1, 1, 1, 1}, 0), translation({1900, 700, 0}));
  if (beside == Beside::wide_plane)
    add(TargetKind::primitive, primitive(PrimitiveKind::plane, {500, 500}, 0), translation({0, 0, -1200}));
  if (beside == Beside::endless_plane)
    add(TargetKind::primitive, primitive(PrimitiveKind::plane, {0, 0}, 0), translation({0, 0, -1200}));
  if (beside == Beside::mesh) add(TargetKind::mesh, mesh(quad(5, -3, 0)), translation({0, -300, 0}));
  if (beside == Beside::turned_mesh) add(TargetKind::mesh, mesh(quad(5, -3, 0)), turned);
  if (beside == Beside::many_meshes) {
    const uint32_t m = mesh(quad(1, 0, 0));
    for (int i = 0; i < 30; ++i)
      add(TargetKind::mesh, m, translation({100.0 + 10 * i, 900, 3}) * rotation({1, 0, 0}, i));
  }
  check_scene(*scene, "lamp visibility");
  return scene;
}

struct Count {
  int samples = 0, blocked = 0, passed = 0;  // passed: rays beyond the lamp that it did not stop
  double irradiance = 0;
};

// From `at` towards the lamps; samples on the first one only.
Count look(const Lamps& lamps, const Tracer& tracer, Vec3 at, Dir normal, Vec3 middle, double radius) {
  Count count;
  Pcg32 rng(11);
  const LightReceiver from{at, normal, false};
  std::vector<Ray> rays, beyond;
  std::vector<double> reach, further;
  for (int i = 0; i < kSamples; ++i) {
    const auto s = lamps.sample(from, {rng.uniform(), rng.uniform(), rng.uniform(), rng.uniform()}, 0);
    if (!s || length(s->end - middle) > radius) continue;
    const Vec3 way = s->end - at;
    const double distance = length(way);
    rays.push_back({at, way / distance, 0}), reach.push_back(distance);
    // The ray goes on by as much again as it may end before the surface, over the cosine of the flattest.
    const double more = 40 * Tracer::arrive(1e-6 * (1 + distance), 4000, distance) + 2 * radius;
    beyond.push_back(rays.back()), further.push_back(distance + more);
    count.irradiance += s->scale * std::max(0.0, dot(normal, s->direction)) / s->density / kSamples;
  }
  std::vector<uint8_t> blocked(rays.size());
  TraceStatistics statistics;
  tracer.occluded(rays, reach, blocked, false, statistics);
  for (const uint8_t b : blocked) count.blocked += b;
  tracer.occluded(beyond, further, blocked, false, statistics);
  for (const uint8_t b : blocked) count.passed += !b;
  count.samples = static_cast<int>(rays.size());
  return count;
}

std::vector<Setting> settings() {
  const double all = 1e9;
  const Affine3 up = translation({0, 0, 2}), lean = translation({0, 0, 2}) * rotation(normalized(Vec3{1, 2, 0.5}), 0.2);
  return {{"translated", up, all, false},
          {"turned", lean, all, false},
          {"scaled", up * scaling({1.3, 1.3, 1.3}), all, false},
          {"mirrored", lean * scaling({-1, 1, 1}), all, false},
          {"nested", lean, all, true},
          {"in a shared group", lean, 0, true},
          {"periodic", lean, all, false, {}, true},
          {"100 km away", lean, all, false, {1e5, 3e4, 0}},
          {"100 km away, translated", up, all, false, {1e5, 3e4, 0}},
          {"1 cm wide", up, all, false, {}, false, 0.01}};
}

TEST(LampVisibility, NoLampStandsInItsOwnLight) {
  const std::vector<Band> bands = one_band();
  const SpectralState state = make_state(bands, 0.01, 0, 1);
  const std::vector<LampSpec> specs{glow("lamp", 1)};
  int cells = 0, looks = 0, bad = 0;
  for (const Setting& s : settings())
    for (const Lamp lamp : kLamps)
      for (const Beside beside : kBeside) {
        if (s.periodic && lamp == Lamp::mesh_within_ground) continue;  // wider than the cell
        if (lamp == Lamp::mesh_within_ground && s.size != 1) continue;
        const auto scene = scene_with(lamp, beside, s);
        std::optional<Periodic> cell;
        if (s.periodic) cell = Periodic{{-2100, -2100}, {4200, 4200}};
        const Tracer tracer(scene, cell, {}, nullptr, {}, s.keep);
        const FlushDenormals flush;
        const Lamps lamps(specs, tracer, state);
        ++cells;
        const Affine3 to = translation(s.origin) * s.place;
        const Vec3 middle = to.point({});
        const double radius = s.size;
        for (const double d : {1e-3, 0.1, 2.0, 47.3, 900.0, 36e6}) {
          if (d > 100 && (s.periodic || lamp == Lamp::mesh_within_ground || beside == Beside::endless_plane ||
                          beside == Beside::wide_plane))
            continue;
          // Across from the lamp's lowest point, a little aside.
          const double depth = lamp == Lamp::sphere ? 0.5 * s.size : 0;
          const Vec3 at = to.point({0.07 * d, -0.04 * d, -(depth + d)});
          const Count c = look(lamps, tracer, at, normalized(middle - at), middle, 2 * radius);
          ++looks;
          const std::string what = strf("%s %s beside %s, %g m: %d of %d blocked, %d of %d pass beyond", s.name,
                                        kLampNames[static_cast<int>(lamp)], kBesideNames[static_cast<int>(beside)], d,
                                        c.blocked, c.samples, c.passed, c.samples);
          EXPECT_GT(c.samples, kSamples / 10) << what;
          // Rays that graze a rim may pass beside it.
          const bool wrong = c.blocked || (c.passed > c.samples / 10 && d < 1e6);
          if (wrong && ++bad < 20) ADD_FAILURE() << what;
        }
      }
  std::printf("%d scenes, %d looks, %d bad\n", cells, looks, bad);
  EXPECT_EQ(bad, 0);
}

// From a point on the axis; plate: something dark of this kind half-way.
enum class Plate { none, mesh, turned_mesh, plane, sphere };
struct Seen {
  double mean = 0, error = 0;
};
Seen lit(Lamp lamp, Beside beside, const Setting& s, double d, Plate plate) {
  auto scene = scene_with(lamp, beside, s);
  const Affine3 to = translation(s.origin) * s.place, half = to * translation({0, 0, -0.5 * d});
  if (plate == Plate::mesh || plate == Plate::turned_mesh) {
    scene->meshes.push_back(quad(3, 0, 0));
    const auto mesh = static_cast<uint32_t>(scene->meshes.size() - 1);
    scene->groups[0].placements.push_back(
        placed(TargetKind::mesh, mesh, plate == Plate::mesh ? translation(half.point({})) : half));
  } else if (plate != Plate::none) {
    const bool flat = plate == Plate::plane;
    scene->primitives.push_back({"plate", flat ? PrimitiveKind::plane : PrimitiveKind::sphere,
                                 flat ? std::vector<double>{6, 6} : std::vector<double>{0.49 * d}, 0});
    scene->groups[0].placements.push_back(
        placed(TargetKind::primitive, static_cast<uint32_t>(scene->primitives.size() - 1), half));
  }
  check_scene(*scene, "lit");
  const Tracer tracer(scene, std::nullopt, {}, nullptr, {}, s.keep);
  const FlushDenormals flush;
  const std::vector<LampSpec> specs{glow("lamp", 100)};
  const Lamps lamps(specs, tracer, make_state(one_band(), 0.01, 0, 1));
  const Vec3 at = to.point({0, 0, -d});
  const Dir normal = normalized(to.vector({0, 0, 1}));
  Pcg32 rng(5);
  constexpr int n = 40000;
  double sum = 0, square = 0;
  TraceStatistics statistics;
  for (int i = 0; i < n; ++i) {
    const auto one = lamps.sample({at, normal, false}, {rng.uniform(), rng.uniform(), rng.uniform(), rng.uniform()}, 0);
    if (!one) continue;
    const double distance = length(one->end - at);
    const Ray ray{at, (one->end - at) / distance, 0};
    uint8_t blocked = 0;
    tracer.occluded({&ray, 1}, {&distance, 1}, {&blocked, 1}, false, statistics);
    const double e = blocked ? 0 : 100 * one->scale * dot(normal, one->direction) / one->density;
    sum += e, square += e * e;
  }
  const double mean = sum / n;
  return {mean, std::sqrt((square / n - mean * mean) / n)};
}

TEST(LampVisibility, IrradianceIsTheFormFactor) {
  const std::vector<Setting> all = settings();
  for (const double d : {0.3, 2.0}) {
    const double a = 0.5 / d, root = std::sqrt(1 + a * a);
    const double square = 4 * (2 * a / root * std::atan(a / root)) / (2 * kPi);
    const double truths[] = {square, square, square, 0.25 / (0.25 + d * d), std::pow(0.5 / d, 2)};
    for (const size_t k : {size_t{0}, size_t{1}, size_t{5}, size_t{7}})
      for (const Lamp lamp : kLamps) {
        if (lamp == Lamp::sphere && d < 1) continue;
        SCOPED_TRACE(strf("%s %s from %g m", all[k].name, kLampNames[static_cast<int>(lamp)], d));
        const double truth = 100 * kPi * truths[static_cast<int>(lamp)];
        const Seen seen = lit(lamp, Beside::sphere, all[k], d, Plate::none);
        EXPECT_NEAR(seen.mean, truth, 4.5 * seen.error + 1e-6 * truth);
        EXPECT_GT(std::fabs(seen.mean - 1.02 * truth), 4.5 * seen.error);
      }
  }
}

TEST(LampVisibility, APlateBetweenTakesAll) {
  const std::vector<Setting> all = settings();
  for (const size_t k : {size_t{0}, size_t{1}, size_t{7}})
    for (const Lamp lamp : kLamps)
      for (const Plate plate : {Plate::mesh, Plate::turned_mesh, Plate::plane, Plate::sphere}) {
        if (plate == Plate::sphere && lamp == Lamp::mesh_within_ground) continue;
        SCOPED_TRACE(strf("%s %s, plate %d", all[k].name, kLampNames[static_cast<int>(lamp)], static_cast<int>(plate)));
        const double open = lit(lamp, Beside::sphere, all[k], 2, Plate::none).mean;
        const double left = lit(lamp, Beside::sphere, all[k], 2, plate).mean;
        if (plate == Plate::sphere)
          EXPECT_LT(left, 0.7 * open);  // a part of the square looks past it
        else
          EXPECT_EQ(left, 0);
      }
}

}  // namespace
}  // namespace suite::test::lamp_visibility_test
