// Which meshes are loose, and that rays meet them as they meet others.
#include "trace/loose_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "math/sampling.h"
#include "trace/tracer.h"

namespace suite::loose_mesh_test {
namespace {

struct Built {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  uint32_t vertex(Vec3 p) {
    for (int a = 0; a < 3; ++a) positions.push_back(static_cast<float>(p[a]));
    return static_cast<uint32_t>(positions.size() / 3 - 1);
  }
  void triangle(Vec3 a, Vec3 b, Vec3 c) {
    for (const Vec3 p : {a, b, c}) indices.push_back(vertex(p));
  }
  Mesh mesh() const {
    Mesh m;
    m.name = "thing";
    std::vector<float> padded = positions;
    padded.push_back(0);
    m.positions = std::move(padded);
    m.indices = std::vector<uint32_t>(indices);
    m.parts.push_back({"thing", 0, static_cast<uint32_t>(m.triangle_count()), kNone});
    return m;
  }
};

Vec3 random(Pcg32& rng) { return Vec3{rng.uniform(), rng.uniform(), rng.uniform()} * 2 - Vec3{1, 1, 1}; }

// Triangles, or pairs of them that share an edge, at random places and turns.
Mesh leaves(size_t count, bool pairs, double size = 0.1) {
  Pcg32 rng(3);
  Built b;
  for (size_t i = 0; i < count; ++i) {
    const Vec3 at = random(rng), x = random(rng) * size, y = random(rng) * size;
    b.triangle(at - x, at - y, at + x);
    if (pairs) b.triangle(at - x, at + x, at + y);
  }
  return b.mesh();
}

// n x n squares; each triangle has corners of its own.
Mesh sheet(int n) {
  Built b;
  const auto at = [&](int i, int j) { return Vec3{i - 0.5 * n, j - 0.5 * n, std::sin(0.3 * i) * std::cos(0.2 * j)}; };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      b.triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      b.triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  return b.mesh();
}

TEST(LooseMesh, IsOneWhoseEdgesAreMostlyOfOneTriangle) {
  EXPECT_TRUE(is_loose(leaves(1, false)));
  EXPECT_TRUE(is_loose(leaves(1000, false)));
  EXPECT_TRUE(is_loose(leaves(1000, true)));
  EXPECT_FALSE(is_loose(sheet(8)));
  // Large ones, of which some edges are looked at.
  EXPECT_TRUE(is_loose(leaves(60000, true)));
  EXPECT_FALSE(is_loose(sheet(200)));
}

// A zero may have a sign; the place is the same.
TEST(LooseMesh, SignsOfZerosMakeNoEdge) {
  Built b;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const double minus = (i + j) % 2 ? -0.0 : 0.0;
      b.triangle({double(i), double(j), minus}, {i + 1.0, double(j), minus}, {i + 1.0, j + 1.0, minus});
      b.triangle({double(i), double(j), -minus}, {i + 1.0, j + 1.0, -minus}, {double(i), j + 1.0, -minus});
    }
  EXPECT_FALSE(is_loose(b.mesh()));
}

std::shared_ptr<const Scene> placed(Mesh mesh) {
  auto s = std::make_shared<Scene>();
  s->meshes.push_back(std::move(mesh));
  s->groups.push_back({"root", {}});
  for (int i = 0; i < 2; ++i) {  // twice, so that it is an instance
    Placement p;
    p.to_parent = translation({100.0 + 5 * i, -70, 3}) * rotation(normalized(Vec3{1, 2, 3}), 1.0 + i);
    s->groups[0].placements.push_back(p);
  }
  return s;
}

// The nearest triangle in double (Moller & Trumbore 1997), and how far the ray stays off all edges, as a share of the
// triangle: a hit nearer to an edge than that may be either.
struct Truth {
  double distance = INFINITY, margin = INFINITY;
};
Truth truth(const Scene& s, const Ray& ray) {
  Truth best;
  const Mesh& m = s.meshes[0];
  for (const Placement& p : s.groups[0].placements)
    for (size_t t = 0; t < m.triangle_count(); ++t) {
      Vec3 v[3];
      for (size_t c = 0; c < 3; ++c) {
        const float* f = &m.positions[3 * size_t{m.indices[3 * t + c]}];
        v[c] = p.to_parent.point({f[0], f[1], f[2]});
      }
      const Vec3 e1 = v[1] - v[0], e2 = v[2] - v[0], h = cross(ray.direction, e2), away = ray.origin - v[0];
      const double a = dot(e1, h), u = dot(away, h) / a, w = dot(ray.direction, cross(away, e1)) / a,
                   along = dot(e2, cross(away, e1)) / a;
      if (!(along > 0)) continue;
      const double inside = std::min({u, w, 1 - u - w});
      best.margin = std::min(best.margin, std::fabs(inside));
      if (inside > 0) best.distance = std::min(best.distance, along);
    }
  return best;
}

std::vector<Ray> rays_at(size_t count) {
  Pcg32 rng(5);
  std::vector<Ray> rays;
  for (size_t i = 0; i < count; ++i) {
    const Vec3 from = Vec3{102.5, -70, 3} + random(rng) * 12, to = Vec3{102.5, -70, 3} + random(rng) * 3;
    rays.push_back({from, normalized(to - from), 0});
  }
  return rays;
}

TEST(LooseMesh, IsMetWhereItIs) {
  const auto scene = placed(leaves(300, true, 0.3));
  ASSERT_TRUE(is_loose(scene->meshes[0]));
  const Tracer tracer(scene);
  const std::vector<Ray> rays = rays_at(4000);
  std::vector<Hit> hits(rays.size());
  std::vector<uint8_t> blocked(rays.size());
  TraceStatistics statistics;
  tracer.nearest(rays, hits, false, statistics);
  tracer.occluded(rays, std::vector<double>(rays.size(), INFINITY), blocked, false, statistics);
  size_t met = 0, unsure = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const Truth t = truth(*scene, rays[i]);
    if (t.margin < 1e-4) {
      ++unsure;
      continue;
    }
    ASSERT_EQ(hits[i].hit(), std::isfinite(t.distance)) << i;
    EXPECT_EQ(blocked[i] != 0, std::isfinite(t.distance)) << i;
    if (!hits[i].hit()) continue;
    ++met;
    EXPECT_NEAR(hits[i].distance, t.distance, 2e-5)
        << i;  // at grazing incidence a float's place moves far along the ray
  }
  EXPECT_GT(met, 800u);
  EXPECT_LT(unsure, rays.size() / 2);
}

// Between the two halves of a leaf next to nothing slips: of rays into a strip of 1e-4 of its width along the edge that
// they share less than one in 2000, so of those that meet the leaf less than one in 1e7.
TEST(LooseMesh, LetsHardlyAnythingThroughItsEdges) {
  Built b;
  const Vec3 left{-1, 0, 0.1}, right{1, 0, 0.07}, near{0, -1, 0}, far{0, 1, 0};
  b.triangle(left, near, right);
  b.triangle(left, right, far);
  const auto scene = placed(b.mesh());
  ASSERT_TRUE(is_loose(scene->meshes[0]));
  const Tracer tracer(scene);
  Pcg32 rng(8);
  const Affine3& place = scene->groups[0].placements[0].to_parent;
  for (const double strip : {1e-4, 1e-1}) {
    std::vector<Ray> rays;
    for (int i = 0; i < 100000; ++i) {
      const double x = 0.05 + 0.9 * rng.uniform();
      const Vec3 on_edge = left * x + right * (1 - x), side = rng.uniform() < 0.5 ? near : far;
      const Vec3 to = place.point(on_edge + (side - on_edge) * (strip * rng.uniform() * 0.5));
      const Dir d = normalized(random(rng));
      rays.push_back({to - d * (0.5 + rng.uniform()), d, 0});
    }
    std::vector<uint8_t> blocked(rays.size());
    TraceStatistics statistics;
    tracer.occluded(rays, std::vector<double>(rays.size(), 2.0), blocked, false, statistics);
    const auto through = static_cast<double>(std::count(blocked.begin(), blocked.end(), 0));
    RecordProperty(strip < 1e-3 ? "through_strip" : "through_leaf", static_cast<int>(through));
    EXPECT_LT(through, (strip < 1e-3 ? 5e-4 : 2e-5) * static_cast<double>(rays.size()));
  }
}

}  // namespace
}  // namespace suite::loose_mesh_test
