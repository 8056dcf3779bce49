// Triangles put together into cells, and cut into several.
#include "heat/mesh_cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "math/sampling.h"
#include "support/radiometry_kit.h"

namespace suite::mesh_cells_test {
namespace {

using namespace test;

// Triangles of areas from 1e-4 to 8 m2, one without area, on two parts.
Mesh uneven() {
  std::vector<Vec3> v;
  std::vector<uint32_t> f;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> any(0, 1);
  for (uint32_t k = 0; k < 200; ++k) {
    const double size = 0.01 * std::pow(400.0, any(random));
    const Vec3 at{20 * any(random), 20 * any(random), 5 * any(random)};
    v.push_back(at);
    v.push_back(at + Vec3{size, 0.1 * any(random), 0});
    v.push_back(k == 77 ? at : at + Vec3{0.2 * any(random), size, any(random)});
    for (uint32_t c = 0; c < 3; ++c) f.push_back(3 * k + c);
  }
  Mesh m = mesh_of(v, f, 0);
  m.origin = {1000, -2000, 30};
  m.parts = {{"a", 0, 120, 4}, {"b", 120, 80, 7}};
  return m;
}

Vec3 place(const Mesh& m, const MeshCells::Point& p) {
  const auto corner = [&](size_t c) {
    const float* x = &m.positions[3 * size_t{m.indices[3 * size_t{p.triangle} + c]}];
    return Vec3{x[0], x[1], x[2]};
  };
  return m.origin + corner(0) * (1 - p.u - p.v) + corner(1) * p.u + corner(2) * p.v;
}

TEST(MeshCells, PointsLieInTheirCells) {
  for (const Mesh& mesh : {uneven(), dome(10), quad(5, 1, 0), box({0, 0, 0}, {1, 2, 3}, 0, true)})
    for (const double wanted : {1.0, 7.0, 100.0, 3000.0}) {
      std::vector<uint32_t> materials;
      for (const Part& p : mesh.parts) materials.push_back(p.material);
      const MeshCells cells(mesh, materials, wanted);
      double sum = 0;
      size_t astray = 0, asked = 0;
      Pcg32 random(5);
      for (size_t c = 0; c < cells.size(); ++c) {
        sum += cells.area(c);
        EXPECT_GT(cells.area(c), 0);
        for (int k = 0; k < 20; ++k, ++asked) {
          const MeshCells::Point p = cells.point(c, random.uniform(), random.uniform(), random.uniform());
          EXPECT_GE(std::fmin(p.u, p.v), 0);
          EXPECT_LE(p.u + p.v, 1 + 1e-12);
          const uint32_t part = p.triangle < mesh.parts[0].triangle_count ? 0 : 1;
          EXPECT_EQ(cells.material(c), mesh.parts[part].material);
          astray += cells.cell_of(p.triangle, place(mesh, p)) != c;
        }
      }
      EXPECT_NEAR(sum, cells.total_area(), 1e-9 * sum);
      // Only those within rounding of an edge between parts of one triangle.
      EXPECT_LE(astray, asked / 1000) << wanted << " cells wanted, " << cells.size() << " made";
      // As many as wanted, but that materials are apart and cut triangles have a square of parts.
      EXPECT_LE(static_cast<double>(cells.size()), 3 * wanted + 2);
      EXPECT_GE(static_cast<double>(cells.size()), wanted / 3);
    }
}

// Uniform: the mean of many points is the centroid, and shares of triangles are those of their areas.
TEST(MeshCells, PointsAreUniform) {
  const Mesh mesh = uneven();
  const MeshCells cells(mesh, {4, 7}, 10);
  for (size_t c = 0; c < cells.size(); ++c) {
    std::map<uint32_t, double> share;
    constexpr int kPoints = 20000;
    for (int k = 0; k < kPoints; ++k) {
      const double x = (k + 0.5) / kPoints, y = std::fmod(k * 0.618033988749895, 1.0);
      share[cells.point(c, x, y, 0.5).triangle] += 1.0 / kPoints;
    }
    for (const auto& [triangle, s] : share) {
      const Vec3 o = place(mesh, {triangle, 0, 0}), a = place(mesh, {triangle, 1, 0}),
                 b = place(mesh, {triangle, 0, 1});
      const double area = length(cross(a - o, b - o)) / 2;
      if (!cells.whole(triangle)) continue;
      EXPECT_NEAR(s, area / cells.area(c), 2.0 / kPoints + 1e-6) << triangle;
    }
  }
}

// Cut in two again and again, they hold the same surface, each point in one.
TEST(MeshCells, CellsThatAreSplit) {
  for (const Mesh& mesh : {uneven(), dome(10), quad(5, 1, 0), box({0, 0, 0}, {1, 2, 3}, 0, true)}) {
    std::vector<uint32_t> materials;
    for (const Part& p : mesh.parts) materials.push_back(p.material);
    MeshCells cells(mesh, materials, 7);
    const size_t before = cells.size();
    Pcg32 random(11);
    for (int k = 0; k < 200; ++k) {
      // Often the same ones, so that pieces become small.
      const auto cell = static_cast<uint32_t>(static_cast<double>(cells.size()) * std::pow(random.uniform(), 3));
      const double area = cells.area(cell);
      cells.split(cell);
      EXPECT_NEAR(cells.area(cell) + cells.area(cells.size() - 1), area, 1e-12 * area);
      EXPECT_EQ(cells.material(cell), cells.material(cells.size() - 1));
    }
    EXPECT_EQ(cells.size(), before + 200);
    double sum = 0;
    size_t astray = 0, asked = 0;
    for (size_t c = 0; c < cells.size(); ++c) {
      sum += cells.area(c);
      EXPECT_GT(cells.area(c), 0);
      for (int k = 0; k < 20; ++k, ++asked) {
        const MeshCells::Point p = cells.point(c, random.uniform(), random.uniform(), random.uniform());
        astray += cells.cell_of(p.triangle, place(mesh, p)) != c;
      }
    }
    EXPECT_NEAR(sum, cells.total_area(), 1e-9 * sum);
    EXPECT_LE(astray, asked / 1000);
  }
}

TEST(MeshCells, FoldsAreApartAndWhatHasNoPartHasNone) {
  const Mesh cube = box({0, 0, 0}, {1, 1, 1}, 0, true);
  const MeshCells six(cube, {0}, 6);
  ASSERT_EQ(six.size(), 6u);
  for (size_t c = 0; c < 6; ++c) EXPECT_NEAR(six.area(c), 1, 1e-12);
  const Mesh mesh = uneven();
  const MeshCells some(mesh, {kNone, 7}, 10);
  EXPECT_EQ(some.cell_of(3, {}), kNone);
  EXPECT_LT(some.total_area(), MeshCells(mesh, {4, 7}, 10).total_area());
  EXPECT_EQ(MeshCells(mesh, {4, 7}, 10).cell_of(77, {}), kNone) << "without area";
}

}  // namespace
}  // namespace suite::mesh_cells_test
