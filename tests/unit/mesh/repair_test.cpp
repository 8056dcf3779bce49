// What is done to meshes on request: orientation of what touches and nests, holes, lighter versions.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "mesh/check.h"
#include "mesh/decimate.h"
#include "mesh/fill_holes.h"
#include "mesh/repair.h"
#include "tests/support/mesh_kit.h"

namespace suite::repair_test {
namespace {

// Appends a cube that faces outwards.
void add_cube(SourceMesh& m, Vec3 low, double size) {
  const auto at = static_cast<uint32_t>(m.positions.size());
  for (int i = 0; i < 8; ++i) m.positions.push_back(low + Vec3{i & 1 ? size : 0, i & 2 ? size : 0, i & 4 ? size : 0});
  for (const uint32_t v :
       {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5})
    m.indices.push_back(at + v);
  for (int k = 0; k < 12; ++k) m.lines.push_back(static_cast<int>(m.lines.size() + 1));
  m.runs = {{"", "", 0, 1}};
}
void turn(SourceMesh& m, size_t first, size_t last) {
  for (size_t t = first; t < last; ++t) std::swap(m.indices[3 * t + 1], m.indices[3 * t + 2]);
}
double volume(const SourceMesh& m) {
  double v = 0;
  for (size_t t = 0; t + 2 < m.indices.size(); t += 3)
    v += dot(m.positions[m.indices[t]], cross(m.positions[m.indices[t + 1]], m.positions[m.indices[t + 2]])) / 6;
  return v;
}
double area(const SourceMesh& m, size_t first, size_t last) {
  double a = 0;
  for (size_t t = first; t < last; ++t) {
    const Vec3 p = m.positions[m.indices[3 * t]];
    a += length(cross(m.positions[m.indices[3 * t + 1]] - p, m.positions[m.indices[3 * t + 2]] - p)) / 2;
  }
  return a;
}
size_t count(const SourceMesh& m, const std::string& code) {
  for (const MeshFinding& f : check_mesh_quality(m))
    if (f.code == code) return f.count;
  return 0;
}

// Two bodies along a common edge, where four triangles meet: each is closed by itself, and the one that is inside out
// is turned as a whole. A soup cut apart at that edge alone would count as open there.
TEST(MeshRepair, TouchingShellsAreTurnedOneByOne) {
  SourceMesh m;
  add_cube(m, {0, 0, 0}, 1);
  add_cube(m, {1, 1, 0}, 1);
  turn(m, 12, 24);
  ASSERT_NEAR(volume(m), 0, 1e-12);
  const MeshRepairs done = repair_mesh(m);
  EXPECT_EQ(done.turned, 12u);
  EXPECT_NEAR(volume(m), 2, 1e-12);
}

// A cavity faces into the hollow, a stone in a body outwards: inside of others the majority counts, not the volume.
TEST(MeshRepair, ShellsInsideOthersKeepTheirMajority) {
  SourceMesh m;
  add_cube(m, {0, 0, 0}, 4);
  add_cube(m, {1, 1, 1}, 1);        // becomes a cavity
  add_cube(m, {2.5, 2.5, 2.5}, 1);  // a stone
  turn(m, 12, 24);
  turn(m, 14, 15);
  turn(m, 30, 31);
  const MeshRepairs done = repair_mesh(m);
  EXPECT_EQ(done.turned, 2u);
  EXPECT_NEAR(volume(m), 64 - 1 + 1, 1e-9);
  // The outer one is turned outwards whatever its majority.
  turn(m, 0, 12);
  EXPECT_EQ(repair_mesh(m).turned, 12u);
  EXPECT_NEAR(volume(m), 64 - 1 + 1, 1e-9);
}

TEST(MeshHoles, SmallOnesAreClosedWithWhatLiesBeside) {
  SourceMesh m;
  add_cube(m, {0, 0, 0}, 1);
  m.indices.erase(m.indices.begin() + 6, m.indices.begin() + 12);  // without its lid
  m.lines.erase(m.lines.begin() + 2, m.lines.begin() + 4);
  m.normals.assign(m.positions.size(), oct_encode({0, 0, 1}));
  for (size_t v = 0; v < m.positions.size(); ++v) m.uvs.push_back(static_cast<float>(v)), m.uvs.push_back(0.5f);
  m.runs = {{"a", "floor", 0, 1}, {"b", "wall", 2, 3}};
  SourceMesh other = m;
  const FilledHoles none = fill_holes(other, 3);
  EXPECT_EQ(none.holes, 0u);
  EXPECT_EQ(none.left, 1u);
  EXPECT_EQ(count(other, "SP306"), 1u);
  const FilledHoles done = fill_holes(m, 4);
  EXPECT_EQ(done.holes, 1u);
  EXPECT_EQ(done.triangles, 2u);
  EXPECT_EQ(done.left, 0u);
  EXPECT_NEAR(volume(m), 1, 1e-12);
  EXPECT_EQ(count(m, "SP306"), 0u);
  ASSERT_EQ(m.runs.size(), 3u);
  EXPECT_EQ(m.runs[2].material, "wall");
  EXPECT_EQ(m.runs[2].first_triangle, 10u);
  EXPECT_EQ(m.lines.size(), 12u);
  EXPECT_EQ(m.normals.size(), m.positions.size());
  EXPECT_EQ(m.uvs.size(), 2 * m.positions.size());
  for (size_t c = 30; c < 36; ++c) {
    const uint32_t v = m.indices[c];
    EXPECT_EQ(m.normals[v], kNoNormal);
    const uint32_t from = v - 8;  // copies of corners 4 to 7 keep their coordinates
    EXPECT_GE(m.uvs[2 * v], 4.0f) << from;
  }
}

// 40 x 40 cells, the left half of one material.
SourceMesh sheet(double bend) {
  constexpr uint32_t n = 41;
  std::vector<Vec3> p;
  std::vector<uint32_t> left, right;
  for (uint32_t j = 0; j < n; ++j)
    for (uint32_t i = 0; i < n; ++i) p.push_back({0.1 * i, 0.1 * j, bend * std::sin(0.2 * i) * std::cos(0.15 * j)});
  for (uint32_t j = 0; j + 1 < n; ++j)
    for (uint32_t i = 0; i + 1 < n; ++i) {
      const uint32_t v = j * n + i;
      for (const uint32_t k : {v, v + 1, v + n + 1, v, v + n + 1, v + n}) (i < 20 ? left : right).push_back(k);
    }
  const auto half = static_cast<uint32_t>(left.size() / 3);
  left.insert(left.end(), right.begin(), right.end());
  SourceMesh m = soup(p, left);
  m.runs = {{"", "grass", 0, 1}, {"", "road", half, 1}};
  return m;
}

TEST(MeshDecimation, KeepsMaterialsAndOpenEdges) {
  SourceMesh m = sheet(0);
  const double left = area(m, 0, 1600), right = area(m, 1600, 3200);
  const Decimated done = decimate_mesh(m, 0, HUGE_VAL);
  EXPECT_EQ(done.before, 3200u);
  EXPECT_EQ(done.after, m.indices.size() / 3);
  EXPECT_LE(done.after, 20u);  // straight borders and rims need their ends only
  EXPECT_LT(done.distance, 1e-9);
  ASSERT_EQ(m.runs.size(), 2u);
  EXPECT_NEAR(area(m, 0, m.runs[1].first_triangle), left, 1e-9);
  EXPECT_NEAR(area(m, m.runs[1].first_triangle, done.after), right, 1e-9);
  EXPECT_EQ(m.lines.size(), done.after);
  EXPECT_EQ(count(m, "SP305") + count(m, "SP307") + count(m, "SP312"), 0u);
}

TEST(MeshDecimation, KeepsTheErrorAllowed) {
  SourceMesh fine = sheet(0.3), coarse = fine;
  const Decimated exact = decimate_mesh(fine, 0, 0.01), free = decimate_mesh(coarse, 0.03, HUGE_VAL);
  EXPECT_LT(exact.after, exact.before / 3);
  EXPECT_LE(exact.distance, 0.01);
  EXPECT_GT(exact.distance, 0.003);  // it is made use of
  EXPECT_GT(free.distance, 0.01);    // negative control
}

TEST(MeshDecimation, KeepsTextureSeamsAndNormals) {
  // A tube whose coordinates jump from 1 to 0 along one line.
  constexpr uint32_t around = 48, along = 20;
  SourceMesh m;
  for (uint32_t j = 0; j <= along; ++j)
    for (uint32_t i = 0; i <= around; ++i) {
      const double a = 2 * kPi * (i % around) / around;
      m.positions.push_back({std::cos(a), std::sin(a), 0.1 * j});
      m.normals.push_back(oct_encode({std::cos(a), std::sin(a), 0}));
      m.uvs.push_back(static_cast<float>(i) / around), m.uvs.push_back(static_cast<float>(j) / along);
    }
  for (uint32_t j = 0; j < along; ++j)
    for (uint32_t i = 0; i < around; ++i) {
      const uint32_t v = j * (around + 1) + i, w = v + around + 1;
      for (const uint32_t k : {v, v + 1, w + 1, v, w + 1, w}) m.indices.push_back(k);
    }
  m.runs = {{"", "", 0, 1}};
  const double whole = area(m, 0, m.indices.size() / 3);
  std::set<std::array<double, 6>> corners;
  const auto corner = [](const SourceMesh& s, uint32_t v) {
    return std::array<double, 6>{s.positions[v].x, s.positions[v].y, s.positions[v].z,
                                 s.uvs[2 * v],     s.uvs[2 * v + 1], static_cast<double>(s.normals[v])};
  };
  for (const uint32_t v : m.indices) corners.insert(corner(m, v));
  const Decimated done = decimate_mesh(m, 0.3, HUGE_VAL);
  EXPECT_LE(done.after, done.before * 3 / 10 + 1);
  EXPECT_NEAR(area(m, 0, done.after), whole, 0.02 * whole);
  double uv_area = 0;
  for (size_t t = 0; t < done.after; ++t) {
    const uint32_t* v = &m.indices[3 * t];
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(corners.count(corner(m, v[k])));
    const auto uv = [&](int k, int i) { return static_cast<double>(m.uvs[2 * v[k] + static_cast<size_t>(i)]); };
    const double signed_area =
        ((uv(1, 0) - uv(0, 0)) * (uv(2, 1) - uv(0, 1)) - (uv(2, 0) - uv(0, 0)) * (uv(1, 1) - uv(0, 1))) / 2;
    EXPECT_GT(signed_area, 0) << t;  // a triangle across the seam would be turned over
    uv_area += signed_area;
  }
  EXPECT_NEAR(uv_area, 1, 1e-6);  // the whole of the picture, once
}

// Every facet with normals of its own: all vertices are on borders.
TEST(MeshDecimation, FacetNormalsHoldEverything) {
  SourceMesh m, source = sheet(0.3);
  for (size_t c = 0; c < source.indices.size(); ++c) {
    m.positions.push_back(source.positions[source.indices[c]]);
    m.indices.push_back(static_cast<uint32_t>(c));
    m.normals.push_back(oct_encode(normalized(Vec3{std::sin(static_cast<double>(c / 3)), 0.1, 1})));
  }
  m.runs = {{"", "", 0, 1}};
  EXPECT_EQ(decimate_mesh(m, 0.1, HUGE_VAL).after, 3200u);
}

// Loose leaves, bodies along an edge, a one-sided strip: nothing to take away, or not safely; never an abort.
TEST(MeshDecimation, OddMeshesPass) {
  SourceMesh leaves = soup({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}}, {0, 1, 2, 3, 4, 5});
  EXPECT_EQ(decimate_mesh(leaves, 0.1, HUGE_VAL).after, 2u);
  SourceMesh cubes;
  add_cube(cubes, {0, 0, 0}, 1);
  add_cube(cubes, {1, 1, 0}, 1);
  turn(cubes, 12, 24);
  const Decimated done = decimate_mesh(cubes, 1, HUGE_VAL);
  EXPECT_EQ(done.after, 24u);
  EXPECT_NEAR(volume(cubes), 0, 1e-12);  // winding is no business of decimation
  SourceMesh nothing;
  EXPECT_EQ(decimate_mesh(nothing, 0.5, HUGE_VAL).after, 0u);
}

}  // namespace
}  // namespace suite::repair_test
