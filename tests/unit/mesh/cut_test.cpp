// Polygons with holes and surfaces over points against areas and heights that are known.
#include "mesh/cut.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scene/issues.h"
#include "scene/mesh_builder.h"
#include "support/mesh_kit.h"

namespace suite::cut_test {
namespace {

const Where kHere{"p.json", 1, 0, {}, -1};

double area_of(const SourceMesh& m, Vec3 up) {
  double sum = 0;
  for (size_t k = 0; k < m.indices.size(); k += 3) {
    const Vec3 a = m.positions[m.indices[k]], b = m.positions[m.indices[k + 1]], c = m.positions[m.indices[k + 2]];
    const double one = dot(cross(b - a, c - a), up) / 2;
    EXPECT_GT(one, 0) << "a triangle is turned over, or has no area";
    sum += one;
  }
  return sum;
}

struct Plate {
  std::vector<Vec3> corners;
  std::vector<size_t> ends;
  void ring(std::vector<Vec3> r) {
    corners.insert(corners.end(), r.begin(), r.end());
    ends.push_back(corners.size());
  }
  // Cut, in a plane that stands at an angle.
  SourceMesh cut(Report& report, const Affine3& turn = {}) const {
    MeshBuilder builder("p.json", report);
    builder.part("a", "wall", 1);
    std::vector<uint32_t> v;
    for (const Vec3& c : corners) v.push_back(builder.vertex(turn.point(c), kHere));
    builder.holed_polygon(v, ends, kHere);
    SourceMesh mesh = builder.take();
    cut_holed(mesh, report);
    return mesh;
  }
};

std::vector<Vec3> square(double x, double y, double half) {
  return {{x - half, y - half, 0}, {x + half, y - half, 0}, {x + half, y + half, 0}, {x - half, y + half, 0}};
}
std::vector<Vec3> diamond(double x, double y, double half) {
  return {{x - half, y, 0}, {x, y - half, 0}, {x + half, y, 0}, {x, y + half, 0}};
}

TEST(CutHoled, AWallWithWindows) {
  Report report(scene_issues());
  Plate wall;
  wall.ring(square(0, 0, 10));
  for (const double x : {-5.0, 0.0, 5.0})
    for (const double y : {-5.0, 0.0, 5.0}) {
      auto window = square(x, y, 1);
      if (x > 0) std::reverse(window.begin(), window.end());  // holes may go round either way
      wall.ring(window);
    }
  const Affine3 turn = translation({1e5, 2e5, 30}) * rotation({0.6, 0, 0.8}, 1.1);
  const SourceMesh mesh = wall.cut(report, turn);
  EXPECT_NEAR(area_of(mesh, turn.vector({0, 0, 1})), 400 - 9 * 4, 1e-8);
  // A simple polygon with h holes and n corners has n + 2 h - 2 triangles.
  EXPECT_EQ(mesh.indices.size() / 3, size_t{40 + 2 * 9 - 2});
  EXPECT_EQ(report.count("SP206"), size_t{0});
  ASSERT_EQ(mesh.runs.size(), size_t{1});
  EXPECT_EQ(mesh.runs[0].material, "wall");
}

TEST(CutHoled, HolesThatTouchEachOtherAndTheEdge) {
  Report report(scene_issues());
  for (int rows = 1; rows <= 3; ++rows) {
    Plate plate;
    plate.ring(square(0, 0, 3));
    for (int i = -1; i <= 1; ++i)
      for (int j = 0; j < rows; ++j) plate.ring(diamond(2 * i, -2 + 2 * j, 1));  // at three corners of the edge, too
    EXPECT_NEAR(area_of(plate.cut(report), {0, 0, 1}), 36 - 3 * rows * 2, 1e-12) << rows;
  }
  EXPECT_EQ(report.count("SP206"), size_t{0});
}

TEST(CutHoled, StarsInStars) {
  Report report(scene_issues());
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto star = [&](int corners, double x, double y, double least, double most) {
    std::vector<Vec3> ring;
    const int n = corners + static_cast<int>(12 * uniform(random));
    for (int k = 0; k < n; ++k) {
      const double r = least + (most - least) * uniform(random), a = 2 * kPi * k / n;
      ring.push_back({x + r * std::cos(a), y + r * std::sin(a), 0});
    }
    return ring;
  };
  const auto area = [](const std::vector<Vec3>& r) {
    double twice = 0;
    for (size_t k = 0; k < r.size(); ++k) twice += cross(r[k], r[(k + 1) % r.size()]).z;
    return twice / 2;
  };
  for (int t = 0; t < 300; ++t) {
    Plate plate;
    plate.ring(star(8, 0, 0, 30, 40));
    double wanted = area(plate.corners);
    for (int i = -2; i <= 2; ++i)
      for (int j = -2; j <= 2; ++j) {
        if (uniform(random) < 0.5) continue;
        const auto hole = star(3, 5 * i, 5 * j, 0.3, 2.4);
        wanted -= area(hole);
        plate.ring(hole);
      }
    EXPECT_NEAR(area_of(plate.cut(report), {0, 0, 1}), wanted, 1e-9 * wanted) << t;
  }
  EXPECT_EQ(report.count("SP206"), size_t{0});
}

// What cannot be is told, and the wall stands without its holes.
TEST(CutHoled, HolesThatCrossAreTold) {
  for (const double x : {9.5, 20.0}) {
    Report report(scene_issues());
    Plate wall;
    wall.ring(square(0, 0, 10));
    wall.ring(square(x, 0, 1));
    EXPECT_NEAR(area_of(wall.cut(report), {0, 0, 1}), 400, 1e-9);
    EXPECT_EQ(report.count("SP206"), size_t{1}) << x;
  }
}

double height_at(const SourceMesh& m, double x, double y) {
  for (size_t k = 0; k < m.indices.size(); k += 3) {
    const Vec3 a = m.positions[m.indices[k]], b = m.positions[m.indices[k + 1]] - a,
               c = m.positions[m.indices[k + 2]] - a, p = Vec3{x, y, 0} - a;
    const double area = b.x * c.y - b.y * c.x, u = (p.x * c.y - p.y * c.x) / area, v = (b.x * p.y - b.y * p.x) / area;
    if (u >= -1e-9 && v >= -1e-9 && u + v <= 1 + 1e-9) return a.z + u * b.z + v * c.z;
  }
  return NAN;
}

std::vector<Vec3> hills() {
  std::vector<Vec3> points;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 100);
  for (int k = 0; k < 3000; ++k) {
    const double x = uniform(random), y = uniform(random);
    points.push_back({x, y, 5 * std::sin(x / 15) * std::cos(y / 20)});
  }
  return points;
}

TEST(Tin, EveryPointIsWithinTheError) {
  const std::vector<Vec3> points = hills();
  size_t before = points.size() + 1;
  for (const double error : {0.05, 0.5}) {
    SourceMesh mesh = soup(points, {});
    const Tin tin = make_tin(mesh, error, 0);
    double worst = 0;
    for (const Vec3& p : points) worst = std::max(worst, std::fabs(height_at(mesh, p.x, p.y) - p.z));
    EXPECT_LE(worst, error + 1e-9);
    EXPECT_NEAR(worst, tin.error, 1e-9);
    EXPECT_EQ(tin.points, points.size());
    EXPECT_EQ(tin.used, mesh.positions.size());
    EXPECT_LT(tin.used, before / 2);  // hills of 5 m need few points
    before = tin.used;
    area_of(mesh, {0, 0, 1});
  }
}

TEST(Tin, AllPointsWithoutAnError) {
  SourceMesh mesh = soup(hills(), {});
  const Tin tin = make_tin(mesh, 0, 0);
  EXPECT_EQ(tin.used, size_t{3000});
  EXPECT_EQ(tin.error, 0);
}

TEST(Tin, LongEdgesAreGaps) {
  std::vector<Vec3> points;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 5; ++y)
      if (x < 5 || x > 14) points.push_back({static_cast<double>(x), static_cast<double>(y), 0});
  SourceMesh mesh = soup(points, {});
  make_tin(mesh, 0, 2);
  EXPECT_NEAR(area_of(mesh, {0, 0, 1}), 2 * 4 * 4, 1e-12);
}

TEST(Tin, OddPoints) {
  for (const std::vector<Vec3>& points :
       {std::vector<Vec3>{}, {{0, 0, 0}}, {{0, 0, 0}, {1, 1, 0}, {2, 2, 5}}, {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}}}) {
    SourceMesh mesh = soup(points, {});
    make_tin(mesh, 0.1, 0);
    EXPECT_TRUE(mesh.indices.empty());
  }
}

}  // namespace
}  // namespace suite::cut_test
