#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "formats/obj/obj.h"
#include "scene/bake.h"
#include "scene/issues.h"
#include "scene/vertex_normals.h"

namespace suite::vertex_normals_test {
namespace {

constexpr const char* kCorners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
constexpr const char* kSides[6] = {"f 4 3 2 1\n", "f 5 6 7 8\n", "f 1 2 6 5\n",
                                   "f 3 4 8 7\n", "f 2 3 7 6\n", "f 4 1 5 8\n"};

Mesh mesh_of(const std::string& text, NormalRule rule = NormalRule::file, double crease_deg = 180) {
  Report report(scene_issues());
  const SourceMesh source = parse_obj(text, "m.obj", report);
  EXPECT_EQ(report.count(Severity::error), 0u) << report.text();
  const std::vector<uint32_t> none(source.runs.size(), kNone);
  return make_mesh(source, Affine3{}, rule, none, crease_deg * kPi / 180);
}
Vec3 place(const Mesh& m, size_t v) {
  return m.origin + Vec3{m.positions[3 * v], m.positions[3 * v + 1], m.positions[3 * v + 2]};
}
Dir facet(const Mesh& m, size_t t) {
  const Vec3 a = place(m, m.indices[3 * t]);
  return normalized(cross(place(m, m.indices[3 * t + 1]) - a, place(m, m.indices[3 * t + 2]) - a));
}
double off(Dir a, Dir b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

// A cube cut unevenly: by angle each corner's normal is the diagonal, however many triangles meet there.
TEST(VertexNormals, OneGroupRoundsACubeExactly) {
  std::string text = std::string(kCorners) + "s 1\n";
  for (const char* side : kSides) text += side;
  const Mesh m = mesh_of(text);
  ASSERT_EQ(m.vertex_count(), 8u);
  ASSERT_EQ(m.normals.size(), 8u);
  for (size_t v = 0; v < 8; ++v)
    EXPECT_LT(off(oct_decode(m.normals[v]), normalized(place(m, v) - Vec3{0.5, 0.5, 0.5})), 6e-5) << v;
}

// A group a side, and "s off", keep the cube's edges; a file without `s` has no normals at all.
TEST(VertexNormals, GroupsKeepTheEdgesBetweenThem) {
  std::string grouped = kCorners, off_ = std::string(kCorners) + "s 3\ns off\n", bare = kCorners, mixed = kCorners;
  for (int k = 0; k < 6; ++k) {
    grouped += strf("s %d\n", k + 1) + kSides[k];
    off_ += kSides[k];
    bare += kSides[k];
    // Top and one side round, the rest flat; "s 0" is off.
    mixed += (k == 1 ? "s 2\n" : k == 2 ? "s 2\n" : "s 0\n") + std::string(kSides[k]);
  }
  EXPECT_TRUE(mesh_of(bare).normals.empty());
  for (const std::string& text : {grouped, off_}) {
    const Mesh m = mesh_of(text);
    ASSERT_EQ(m.normals.size(), m.vertex_count());
    for (size_t c = 0; c < m.indices.size(); ++c)
      EXPECT_LT(off(oct_decode(m.normals[m.indices[c]]), facet(m, c / 3)), 6e-5) << c;
  }
  EXPECT_EQ(mesh_of(grouped).vertex_count(), 24u);
  const Mesh m = mesh_of(mixed);
  for (size_t c = 0; c < m.indices.size(); ++c) {
    const Vec3 p = place(m, m.indices[c]);
    const Dir n = facet(m, c / 3),
              expected = n.z > 0.5 || n.y < -0.5 ? p.z > 0.5 && p.y < 0.5 ? normalized(Vec3{0, -1, 1}) : n : n;
    EXPECT_LT(off(oct_decode(m.normals[m.indices[c]]), expected), 6e-5) << c;
  }
}

std::string cylinder(int sides, const std::string& walls, const std::string& caps) {
  std::string text, top = "f", bottom = "f";
  for (int k = 0; k < sides; ++k) {
    const double a = 2 * kPi * k / sides;
    text += strf("v %.17g %.17g 0\nv %.17g %.17g 2\n", std::cos(a), std::sin(a), std::cos(a), std::sin(a));
  }
  text += walls;
  for (int k = 0; k < sides; ++k) {
    const int next = (k + 1) % sides;
    text += strf("f %d %d %d %d\n", 2 * k + 1, 2 * next + 1, 2 * next + 2, 2 * k + 2);
    top += strf(" %d", 2 * k + 2);
    bottom += strf(" %d", 2 * (sides - 1 - k) + 1);
  }
  return text + caps + top + "\n" + bottom + "\n";
}

// Walls smooth, caps flat: by groups, and the same by a crease angle between 360/24 and 90 degrees.
TEST(VertexNormals, ACylinderHasRoundWallsAndFlatCaps) {
  for (const Mesh& m : {mesh_of(cylinder(24, "s 1\n", "s 2\n")), mesh_of(cylinder(24, "s 1\n", "s off\n")),
                        mesh_of(cylinder(24, "", ""), NormalRule::smooth, 40)}) {
    ASSERT_EQ(m.normals.size(), m.vertex_count());
    for (size_t c = 0; c < m.indices.size(); ++c) {
      const Vec3 p = place(m, m.indices[c]);
      const Dir n = facet(m, c / 3), expected = std::fabs(n.z) > 0.5 ? n : normalized(Vec3{p.x, p.y, 0});
      EXPECT_LT(off(oct_decode(m.normals[m.indices[c]]), expected), 6e-5) << c;
    }
  }
  // Below the angle between two walls nothing is smoothed; at 180 degrees caps and walls run into each other.
  const Mesh sharp = mesh_of(cylinder(24, "", ""), NormalRule::smooth, 14.9);
  for (size_t c = 0; c < sharp.indices.size(); ++c)
    EXPECT_LT(off(oct_decode(sharp.normals[sharp.indices[c]]), facet(sharp, c / 3)), 6e-5);
  EXPECT_EQ(mesh_of(cylinder(24, "", ""), NormalRule::smooth).vertex_count(), 48u);
}

// Normals that are there stay; the corner without one takes part in its group.
TEST(VertexNormals, TheFilesOwnNormalsWin) {
  const Mesh m = mesh_of(std::string(kCorners) + "vn 0 0 -2\ns 1\nf 5//1 6//1 7 8\nf 1 2 6 5\n");
  for (size_t c = 0; c < 6; ++c) {
    const Vec3 p = place(m, m.indices[c]);
    const Dir expected = p.y < 0.5 ? Dir{0, 0, -1} : Dir{0, 0, 1};
    EXPECT_LT(off(oct_decode(m.normals[m.indices[c]]), expected), 6e-5) << c;
  }
}

// 200 000 facets around one vertex, all in groups of their own: time must not grow with the square.
TEST(VertexNormals, ManyFansAtOnePlaceStayCheap) {
  SourceMesh m;
  const uint32_t n = 200000;
  m.positions.push_back({0, 0, 0});
  for (uint32_t k = 0; k <= n; ++k) m.positions.push_back({std::cos(1e-5 * k), std::sin(1e-5 * k), k % 2 ? 1.0 : 0.0});
  for (uint32_t k = 0; k < n; ++k) m.indices.insert(m.indices.end(), {0, k + 1, k + 2}), m.smoothing.push_back(k % 77);
  EXPECT_GT(vertex_normals(m, false, kPi).from.size(), size_t{n});
  EXPECT_GT(vertex_normals(m, true, 0.1).from.size(), size_t{n});
  EXPECT_EQ(vertex_normals(m, true, kPi).from.size(), size_t{n} + 2);
}

}  // namespace
}  // namespace suite::vertex_normals_test
