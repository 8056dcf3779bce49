#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mesh/check.h"
#include "mesh/repair.h"
#include "mesh/weld.h"
#include "tests/support/mesh_kit.h"

namespace suite::check_test {
namespace {

SourceMesh cube() {
  std::vector<Vec3> p;
  for (int i = 0; i < 8; ++i) p.push_back({i & 1 ? 1.0 : 0.0, i & 2 ? 1.0 : 0.0, i & 4 ? 1.0 : 0.0});
  return soup(
      p, {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5});
}

size_t count(const SourceMesh& m, const std::string& code) {
  for (const MeshFinding& f : check_mesh_quality(m))
    if (f.code == code) return f.count;
  return 0;
}

TEST(Mesh, ACleanCubeHasNoFinding) { EXPECT_TRUE(check_mesh_quality(cube()).empty()); }

TEST(Mesh, WeldFindsEqualPlaces) {
  const std::vector<Vec3> p{{1, 2, 3}, {0, 0, 0}, {1, 2, 3}, {-0.0, 0, 0}, {1, 2, 3.0000001}};
  EXPECT_EQ(weld(p), (std::vector<uint32_t>{0, 1, 0, 1, 4}));
}

TEST(Mesh, EveryFaultIsCountedAndLocated) {
  SourceMesh m = cube();
  m.indices.resize(m.indices.size() - 3);  // a hole
  EXPECT_EQ(count(m, "SP306"), 1u);
  m = cube();
  std::swap(m.indices[1], m.indices[2]);
  EXPECT_EQ(count(m, "SP307"), 3u);
  m = cube();
  for (const uint32_t v : {0u, 2u, 3u}) m.indices.push_back(v);
  EXPECT_EQ(count(m, "SP304"), 1u);
  EXPECT_GE(count(m, "SP305"), 1u);
  for (size_t k = 0; k < 3; ++k) m.indices[m.indices.size() - 3 + k] = std::array{0u, 3u, 2u}[k];
  EXPECT_EQ(count(m, "SP314"), 1u);
  m = cube();
  m.positions.push_back({0.5, 0, 0});
  for (const uint32_t v : {0u, 1u, 8u, 1u, 1u, 2u}) m.indices.push_back(v);
  EXPECT_EQ(count(m, "SP302"), 1u);
  EXPECT_EQ(count(m, "SP301"), 1u);
  m = cube();
  m.positions.push_back({5, 5, 5});
  EXPECT_EQ(count(m, "SP309"), 1u);
  m = cube();
  for (Vec3& p : m.positions) p = p * 1e7;
  EXPECT_EQ(count(m, "SP313"), 1u);
  EXPECT_EQ(count(soup({{0, 0, 0}, {1, 0, 0}, {0.5, 1e-4, 0}}, {0, 1, 2}), "SP303"), 1u);
}

// Normals against their triangles: one finding for each cause, at the worst triangle.
TEST(Mesh, NormalsAgainstTheirTrianglesAreToldByCause) {
  SourceMesh m;
  m.file = "leaf.obj";
  const auto triangle = [&](std::array<double, 3> degrees) {  // facing up; corners whose normals are so far off that
    const uint32_t first = static_cast<uint32_t>(m.positions.size());
    for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}})
      m.positions.push_back(p + Vec3{3.0 * first, 0, 0});
    for (const double d : degrees)
      m.normals.push_back(oct_encode({std::sin(d * kPi / 180), 0, std::cos(d * kPi / 180)}));
    for (uint32_t k = 0; k < 3; ++k) m.indices.push_back(first + k);
    m.lines.push_back(static_cast<int>(m.lines.size() + 1));
  };
  for (int i = 0; i < 50; ++i) triangle({0, 30, 60});
  for (int i = 0; i < 20; ++i) triangle({30, 95.0 + i, 20});
  for (int i = 0; i < 10; ++i) triangle({170.0 - i, 175, 160});
  m.runs = {{"", "", 0, 1}};
  const std::vector<MeshFinding> all = check_mesh_quality(m);
  const auto found = std::find_if(all.begin(), all.end(), [](auto& f) { return f.code == std::string("SP311"); });
  ASSERT_NE(found, all.end());
  EXPECT_EQ(found->count, 30u);
  ASSERT_EQ(found->examples.size(), 2u);
  EXPECT_THAT(found->examples[0].message, testing::HasSubstr("10 triangles whose normals all do"));
  EXPECT_THAT(found->examples[0].message, testing::HasSubstr("by 175 degrees"));
  EXPECT_THAT(found->examples[1].message, testing::HasSubstr("20 triangles some of whose normals do"));
  EXPECT_THAT(found->examples[1].message, testing::HasSubstr("by 114 degrees"));
  EXPECT_EQ(found->examples[1].where.line, 70);
}

TEST(Mesh, CrossingTrianglesAreFoundSharingOrNot) {
  const std::vector<Vec3> p{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0.5, 0.5, -1}, {0.5, 0.5, 1}, {3, 3, 0}};
  EXPECT_EQ(count(soup(p, {0, 1, 2, 3, 4, 5}), "SP308"), 2u);
  // One shared corner, the other edge pierces the face.
  EXPECT_EQ(count(soup(p, {0, 1, 2, 0, 3, 4}), "SP308"), 2u);
  // One shared corner and nothing else.
  EXPECT_EQ(count(soup({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {0, 1, 2, 0, 3, 4}), "SP308"), 0u);
  // Folded flat along a shared edge, and lying open.
  EXPECT_EQ(count(soup({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {0, 1, 2, 1, 0, 3}), "SP308"), 2u);
  EXPECT_EQ(count(soup({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}}, {0, 1, 2, 1, 0, 3}), "SP308"), 0u);
}

// Everything close to everything: the search is given up and says so, instead of taking hours; repetitions do not
// count.
TEST(Mesh, TangledMeshesAreGivenUp) {
  std::vector<Vec3> fan{{0, 0, 0}};
  std::vector<uint32_t> corners, same;
  for (uint32_t k = 0; k < 20000; ++k) {
    fan.push_back({std::cos(3e-4 * k), std::sin(3e-4 * k), 0});
    if (k) corners.insert(corners.end(), {0, k, k + 1});
    same.insert(same.end(), {0, 1, 2});
  }
  EXPECT_EQ(count(soup(fan, corners), "SP315"), 1u);
  EXPECT_EQ(count(soup(fan, corners), "SP308"), 0u);
  // The same without a common vertex: long strips through each other.
  std::vector<Vec3> strips;
  std::vector<uint32_t> apart;
  for (uint32_t k = 0; k < 3000; ++k) {
    const double y = 1e-3 * k;
    for (const Vec3& p : {Vec3{0, y, 0}, Vec3{1, 3 - y, 0.1}, Vec3{1, 3 - y, 0.2}}) strips.push_back(p);
    apart.insert(apart.end(), {3 * k, 3 * k + 1, 3 * k + 2});
  }
  EXPECT_EQ(count(soup(strips, apart), "SP315"), 1u);
  EXPECT_EQ(count(soup(fan, same), "SP315"), 0u);
  EXPECT_EQ(count(soup(fan, same), "SP304"), 19999u);
}

TEST(Mesh, BoundaryLoopsAreCounted) {
  // A square ring: one outer and one inner loop.
  std::vector<Vec3> p;
  for (const double s : {2.0, 1.0})
    for (const auto& [x, y] : {std::pair{-s, -s}, {s, -s}, {s, s}, {-s, s}}) p.push_back({x, y, 0});
  std::vector<uint32_t> i;
  for (uint32_t k = 0; k < 4; ++k) {
    const uint32_t n = (k + 1) % 4;
    for (const uint32_t v : {k, n, 4 + n, k, 4 + n, 4 + k}) i.push_back(v);
  }
  const Topology t = topology(i, p.size());
  EXPECT_EQ(t.boundary_edges, 8u);
  EXPECT_EQ(t.boundary_loops, 2u);
  EXPECT_EQ(t.pieces, 1u);
}

TEST(Mesh, PinchedAndDegenerateMeshesDoNotReachOpenMesh) {
  // Two triangles meeting in a vertex, and one with two equal corners: half-edge structures abort on such input.
  const std::vector<uint32_t> i{0, 1, 2, 0, 3, 4, 0, 0, 3};
  const Topology t = topology(i, 5);
  EXPECT_EQ(t.pinched, (std::vector<uint32_t>{1}));
  EXPECT_EQ(t.boundary_edges, 6u);
  EXPECT_EQ(t.boundary_loops, 0u);
}

TEST(Mesh, RepairsOrientWeldAndDrop) {
  SourceMesh m = cube();
  // Turn some faces, double one, add a needle, and give every corner its own vertex.
  std::swap(m.indices[1], m.indices[2]);
  std::swap(m.indices[16], m.indices[17]);
  for (const uint32_t v : {4u, 5u, 7u, 1u, 1u, 2u}) m.indices.push_back(v);
  m.lines.push_back(13), m.lines.push_back(14);
  SourceMesh split = m;
  split.positions.clear();
  for (uint32_t& v : split.indices)
    split.positions.push_back(m.positions[v]), v = static_cast<uint32_t>(split.positions.size() - 1);
  const MeshRepairs done = repair_mesh(split);
  EXPECT_EQ(done.welded, split.positions.size() - 8);
  EXPECT_EQ(done.dropped, 2u);
  EXPECT_EQ(done.turned, 2u);
  double volume = 0;
  for (size_t t = 0; t + 2 < split.indices.size(); t += 3)
    volume += dot(split.positions[split.indices[t]],
                  cross(split.positions[split.indices[t + 1]], split.positions[split.indices[t + 2]])) /
              6;
  EXPECT_DOUBLE_EQ(volume, 1);
  EXPECT_EQ(count(split, "SP307"), 0u);
}

TEST(Mesh, RepairLeavesAMoebiusStripAlone) {
  std::vector<Vec3> p;
  std::vector<uint32_t> i;
  constexpr uint32_t n = 12;
  for (uint32_t k = 0; k < n; ++k) {
    const double a = 2 * kPi * k / n;
    for (const double s : {-0.3, 0.3})
      p.push_back(
          {(1 + s * std::cos(a / 2)) * std::cos(a), (1 + s * std::cos(a / 2)) * std::sin(a), s * std::sin(a / 2)});
  }
  for (uint32_t k = 0; k < n; ++k) {
    const uint32_t a = 2 * k, b = 2 * k + 1, c = k + 1 < n ? a + 2 : 1, d = k + 1 < n ? b + 2 : 0;
    for (const uint32_t v : {a, b, d, a, d, c}) i.push_back(v);
  }
  SourceMesh m = soup(p, i);
  EXPECT_EQ(repair_mesh(m).turned, 0u);
  EXPECT_EQ(m.indices, i);
}

}  // namespace
}  // namespace suite::check_test
