// Meshes with fewer triangles for pictures: the number is kept to, the shape within what is told.
#include "mesh/sketch.h"

#include <gtest/gtest.h>

#include <cmath>

namespace suite::sketch_test {
namespace {

// n x n vertices over the unit square, two materials: left and right.
Mesh sheet(uint32_t n) {
  std::vector<float> positions;
  std::vector<uint32_t> left, right;
  for (uint32_t i = 0; i < n * n; ++i) {
    const double x = static_cast<double>(i % n) / (n - 1), y = static_cast<double>(i / n) / (n - 1);
    for (const double v : {x, y, 0.1 * x * x}) positions.push_back(static_cast<float>(v));
  }
  positions.push_back(0);
  for (uint32_t r = 0; r + 1 < n; ++r)
    for (uint32_t c = 0; c + 1 < n; ++c) {
      const uint32_t a = r * n + c;
      std::vector<uint32_t>& to = 2 * c < n ? left : right;
      to.insert(to.end(), {a, a + 1, a + n + 1, a, a + n + 1, a + n});
    }
  Mesh m;
  m.origin = {1e6, 0, 0};
  m.parts = {{"left", 0, static_cast<uint32_t>(left.size() / 3), 7},
             {"right", static_cast<uint32_t>(left.size() / 3), static_cast<uint32_t>(right.size() / 3), 3}};
  left.insert(left.end(), right.begin(), right.end());
  m.positions = std::move(positions), m.indices = std::move(left);
  return m;
}

double area(const Sketch& s) {
  double sum = 0;
  const auto at = [&](size_t i) {
    const float* p = &s.positions[3 * size_t{s.indices[i]}];
    return Vec3{p[0], p[1], p[2]};
  };
  for (size_t t = 0; t < s.material.size(); ++t)
    sum += 0.5 * length(cross(at(3 * t + 1) - at(3 * t), at(3 * t + 2) - at(3 * t)));
  return sum;
}

TEST(Sketch, OfASmallMeshIsTheMesh) {
  const Sketch s = sketch_of(sheet(20), 10000);
  EXPECT_EQ(s.material.size(), 2u * 19 * 19);
  EXPECT_EQ(s.moved, 0);
  EXPECT_EQ(s.origin.x, 1e6);
  EXPECT_TRUE(std::is_sorted(s.material.begin(), s.material.end()));
}

TEST(Sketch, OfALargeMeshHasItsShape) {
  const Sketch s = sketch_of(sheet(300), 2000);
  EXPECT_LE(s.material.size(), 2000u);
  EXPECT_GT(s.material.size(), 1000u);
  EXPECT_EQ(s.before, 2u * 299 * 299);
  EXPECT_FALSE(s.thinned);
  EXPECT_GT(s.moved, 0);
  EXPECT_LT(s.moved, 0.06);  // the diagonal of cells of a 32nd
  // Corners are means of corners: the rim shrinks by half a cell a side. Length of the parabola by quadrature: 1.0066.
  EXPECT_NEAR(area(s), 1.0066, 0.08);
  for (size_t v = 0; v + 2 < s.positions.size(); v += 3)
    EXPECT_NEAR(s.positions[v + 2], 0.1 * s.positions[v] * s.positions[v], 1e-3);
}

TEST(Sketch, OfLeavesKeepsTheirArea) {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < 30000; ++i) {
    const double x = std::fmod(i * 0.7548776662, 1.0), y = std::fmod(i * 0.5698402910, 1.0);
    for (const auto& [dx, dy] : {std::pair{0.0, 0.0}, {1e-3, 0.0}, {0.0, 1e-3}})
      for (const double v : {x + dx, y + dy, std::fmod(i * 0.618034, 1.0)}) positions.push_back(static_cast<float>(v));
    indices.insert(indices.end(), {3 * i, 3 * i + 1, 3 * i + 2});
  }
  positions.push_back(0);
  Mesh m;
  m.parts = {{"", 0, 30000, 0}};
  m.positions = std::move(positions), m.indices = std::move(indices);
  const Sketch s = sketch_of(m, 1000);
  EXPECT_TRUE(s.thinned);
  EXPECT_EQ(s.material.size(), 1000u);
  EXPECT_NEAR(area(s), 30000 * 0.5e-6, 1e-5);
}

TEST(Sketch, OfExactSurfacesHasTheirArea) {
  const auto of = [](PrimitiveKind kind, std::vector<double> parameters) {
    Primitive p;
    p.kind = kind, p.parameters = std::move(parameters), p.material = 2;
    const Sketch s = sketch_of(p, 10);
    EXPECT_EQ(s.material.front(), 2u);
    return area(s);
  };
  EXPECT_NEAR(of(PrimitiveKind::sphere, {2}), 16 * kPi, 0.01 * 16 * kPi);
  EXPECT_NEAR(of(PrimitiveKind::plane, {0, 0}), 400, 1e-6);
  EXPECT_NEAR(of(PrimitiveKind::box, {0, 0, 0, 1, 2, 3}), 22, 1e-6);
  EXPECT_NEAR(of(PrimitiveKind::disk, {3, 1}), 8 * kPi, 0.01 * 8 * kPi);
  EXPECT_NEAR(of(PrimitiveKind::cylinder, {1, 2, 1}), 6 * kPi, 0.01 * 6 * kPi);
  EXPECT_NEAR(of(PrimitiveKind::cone, {3, 0, 4, 0}), 15 * kPi, 0.01 * 15 * kPi);
}

}  // namespace
}  // namespace suite::sketch_test
