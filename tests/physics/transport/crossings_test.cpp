// What the stack of media holds along random lines through random bodies (nested, touching, overlapping, half-spaces,
// with and without `outside`, priorities, an ambient medium, faces that regions share), against an oracle that knows
// for each place which regions contain it and never crosses anything.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <random>

#include "tests/support/media_kit.h"
#include "transport/media/bodies.h"

namespace suite::test::crossings_test {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

struct Region {  // low < z < high
  double low, high;
  uint32_t medium;
};
struct World {
  std::shared_ptr<Scene> scene = std::make_shared<Scene>();
  std::vector<Region> regions;
};

using Random = std::mt19937;
uint32_t below(Random& random, uint32_t n) { return static_cast<uint32_t>(random() % n); }

uint32_t add_material(Scene& scene, uint32_t inside, uint32_t outside) {
  Material m = boundary(inside);
  m.id = strf("boundary%zu", scene.materials.size());
  m.outside = outside;
  scene.materials.push_back(m);
  return static_cast<uint32_t>(scene.materials.size() - 1);
}

void add_media(Random& random, Scene& scene) {
  constexpr uint32_t kMedia = 4;
  for (uint32_t m = 0; m < kMedia; ++m) {
    scene.media.push_back(medium(Curve::constant(0.1), Curve::constant(0)));
    scene.media.back().priority = static_cast<int>(below(random, 3)) - 1;
  }
  scene.groups.push_back({"root", {}});
  if (below(random, 3) == 0) scene.ambient = below(random, kMedia);
}
uint32_t some_medium(Random& random) { return below(random, 4); }
uint32_t perhaps(Random& random) { return below(random, 2) ? some_medium(random) : kNone; }

void place_mesh(Scene& scene, Mesh mesh) {
  scene.meshes.push_back(std::move(mesh));
  scene.groups[0].placements.push_back(
      {{}, TargetKind::mesh, static_cast<uint32_t>(scene.meshes.size() - 1), kNone, kNone});
}

// Facing up or down, without end or 40 m wide.
void place_plane(Scene& scene, double z, bool up, double size, uint32_t material) {
  Affine3 turn;
  if (!up) turn = scaling({1, -1, -1});
  place(scene, PrimitiveKind::plane, {size, size}, material, translation({0, 0, z}) * turn);
}

World bodies_of(Random& random) {
  World w;
  add_media(random, *w.scene);
  for (uint32_t n = 1 + below(random, 6); n-- > 0;) {
    const double low = below(random, 8), high = low + 1 + below(random, 6);
    const uint32_t inside = some_medium(random), outside = perhaps(random);
    Region region{low, high, inside};
    switch (below(random, 5)) {
      case 0:
        place(*w.scene, PrimitiveKind::box, {-20, -20, low, 20, 20, high}, add_material(*w.scene, inside, outside));
        break;
      case 1:
        place(*w.scene, PrimitiveKind::box, {0, 0, low, 0, 0, high}, add_material(*w.scene, inside, outside));
        break;
      case 2:
        place(*w.scene, PrimitiveKind::cylinder, {30, high - low, 1}, add_material(*w.scene, inside, outside),
              translation({0, 0, low}));
        break;
      case 3:
        place_mesh(*w.scene, box({-20, -20, low}, {20, 20, high}, add_material(*w.scene, inside, outside), true));
        break;
      default:  // its front lies within
        place_mesh(*w.scene, box({-20, -20, low}, {20, 20, high}, add_material(*w.scene, outside, inside), false));
    }
    w.regions.push_back(region);
  }
  if (below(random, 3) == 0) {
    const double z = below(random, 10);
    const uint32_t inside = some_medium(random), outside = perhaps(random);
    const bool up = below(random, 2);
    place_plane(*w.scene, z, up, 0, add_material(*w.scene, inside, outside));
    const Region down{-kForever, z, up ? inside : outside}, over{z, kForever, up ? outside : inside};
    for (const Region& r : {down, over})
      if (r.medium != kNone) w.regions.push_back(r);
  }
  check_scene(*w.scene, "bodies");
  return w;
}

// Cells one above the other that share their faces.
World cells_of(Random& random) {
  World w;
  add_media(random, *w.scene);
  const uint32_t n = 2 + below(random, 4);
  uint32_t under = kNone;
  for (uint32_t i = 0; i <= n; ++i) {
    const uint32_t over = i < n ? some_medium(random) : kNone;
    const bool up = below(random, 2);  // behind an upward face is what lies under it
    place_plane(*w.scene, i, up, 40, add_material(*w.scene, up ? under : over, up ? over : under));
    if (over != kNone) w.regions.push_back({1.0 * i, i + 1.0, over});
    under = over;
  }
  check_scene(*w.scene, "cells");
  return w;
}

// The media that may hold there: one, but where regions of equal priority overlap in part or share a face.
std::vector<uint32_t> oracle(const World& w, double z) {
  std::vector<Region> at;
  for (const Region& r : w.regions)
    if (r.low < z && z < r.high) at.push_back(r);
  std::vector<uint32_t> may;
  if (at.empty()) return {w.scene->ambient};
  const auto priority = [&](const Region& r) { return w.scene->media[r.medium].priority; };
  int highest = priority(at[0]);
  for (const Region& r : at) highest = std::max(highest, priority(r));
  std::erase_if(at, [&](const Region& r) { return priority(r) < highest; });
  for (const Region& r : at) {
    const bool outer =
        std::any_of(at.begin(), at.end(), [&](const Region& o) { return o.low > r.low && o.high < r.high; });
    if (!outer) may.push_back(r.medium);
  }
  return may;
}

struct Seen {
  double z;
  uint32_t medium;
};
// What was around a straight line, stretch by stretch.
std::vector<Seen> walk(Bodies& bodies, const Surface& surface, Vec3 from, Dir d) {
  std::vector<Seen> seen;
  TraceStatistics statistics;
  const uint32_t ambient = surface.tracer().scene().ambient;
  MediumStack stack = bodies.around(from, 0, statistics);
  Ray ray{from, d, 0};
  double gap = 0;
  for (;;) {
    Hit hit;
    surface.tracer().nearest({&ray, 1}, {&hit, 1}, false, statistics);
    if (!hit.hit()) {
      bodies.leave_scene(stack);
      seen.push_back({ray.origin.z + 1e6 * d.z, stack.medium(ambient)});
      return seen;
    }
    if (gap > 0) bodies.settle(hit, ray, gap);
    const Vec3 begin = ray.origin - d * gap;
    if (hit.distance > 1e-3) seen.push_back({0.5 * (begin.z + hit.position.z), stack.medium(ambient)});
    const auto on = bodies.pass(stack, hit, {begin, d, 0}, hit.distance - gap, statistics);
    if (!on) return seen;
    ray.origin = on->start, gap = on->gap;
  }
}

struct Count {
  size_t stretches = 0, wrong = 0, certain = 0;
};
template <class Make>
Count compare(uint32_t seed, size_t worlds, const Make& make, bool show = true) {
  Count count;
  Random random(seed);
  for (size_t i = 0; i < worlds; ++i) {
    const World w = make(random);
    const Tracer tracer(w.scene);
    const RaySensor sensor({{{0, 0, 9}, {0, 0, -1}, 0}}, one_band(), 1);
    const Optics optics(*w.scene, sensor.states()[0]);
    const Surface surface(tracer, optics);
    Bodies bodies(surface);
    for (int line = 0; line < 4; ++line) {
      const double z = line < 2 ? (line ? -5.5 : 20.5) : below(random, 13) + 0.5 * below(random, 2) + 0.21;
      const bool up = line < 2 ? line == 1 : below(random, 2);
      for (const Seen& s : walk(bodies, surface, {0.3, 0.2, z}, normalized(Vec3{0.05, 0.03, up ? 1.0 : -1.0}))) {
        const std::vector<uint32_t> may = oracle(w, s.z);
        ++count.stretches, count.certain += may.size() == 1;
        const bool right = std::find(may.begin(), may.end(), s.medium) != may.end();
        if (!right && show && count.wrong < 5) {
          std::printf("world %zu, from %g %s, at %g: %d, may be %d\n", i, z, up ? "up" : "down", s.z,
                      static_cast<int>(s.medium), static_cast<int>(may[0]));
          for (const Region& r : w.regions)
            std::printf("  %g to %g: %d, priority %d\n", r.low, r.high, static_cast<int>(r.medium),
                        w.scene->media[r.medium].priority);
          for (const Material& m : w.scene->materials)
            std::printf("  inside %d outside %d\n", static_cast<int>(m.inside), static_cast<int>(m.outside));
          for (const Primitive& p : w.scene->primitives)
            std::printf("  kind %d, material %u\n", static_cast<int>(p.kind), p.material);
          std::printf("  ambient %d\n", static_cast<int>(w.scene->ambient));
        }
        count.wrong += !right;
      }
    }
  }
  std::printf("%zu stretches, %zu with one right medium, %zu wrong\n", count.stretches, count.certain, count.wrong);
  return count;
}

TEST(Crossings, BodiesHoldWhereTheyAre) {
  const Count c = compare(1, 2000, bodies_of);
  EXPECT_EQ(c.wrong, 0u);
  EXPECT_GT(c.certain, c.stretches / 2);
}

TEST(Crossings, CellsThatShareFaces) {
  const Count c = compare(2, 1000, cells_of);
  EXPECT_EQ(c.wrong, 0u);
  EXPECT_GT(c.certain, c.stretches * 9 / 10);
}

// Negative control: bodies that also fill all that lies in front of them, as if what they name were around them
// everywhere, are told apart.
TEST(Crossings, AFrontWithoutEndIsSeen) {
  const auto old = [](Random& random) {
    World w = bodies_of(random);
    for (const Region r : std::vector<Region>(w.regions))
      for (const Material& m : w.scene->materials)
        if (m.outside != kNone && m.inside == r.medium) w.regions.push_back({r.high, kForever, m.outside});
    return w;
  };
  const Count c = compare(1, 100, old, false);
  EXPECT_GT(c.wrong, c.stretches / 20);
}

}  // namespace
}  // namespace suite::test::crossings_test
