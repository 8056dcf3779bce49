// Coordinates on exact surfaces: there and back, on the surface, areas.
#include "heat/primitive_faces.h"

#include <gtest/gtest.h>

#include <cmath>

namespace suite::primitive_faces_test {
namespace {

struct Case {
  const char* name;
  PrimitiveKind kind;
  std::vector<double> parameters;
  double area;  // m2; 0: not in closed form
};

const std::vector<Case>& cases() {
  static const std::vector<Case> table{
      {"plane", PrimitiveKind::plane, {3, 2}, 6},
      {"endless plane", PrimitiveKind::plane, {0, 0}, 4 * 6},
      {"disk", PrimitiveKind::disk, {2, 0}, 4 * kPi},
      {"ring", PrimitiveKind::disk, {2, 1.5}, 1.75 * kPi},
      {"box", PrimitiveKind::box, {-1, -2, 0, 1, 2, 3}, 2 * (2 * 4 + 2 * 3 + 4 * 3)},
      {"layer", PrimitiveKind::box, {0, 0, -1, 0, 0, 1}, 2 * 4 * 6},
      {"sphere", PrimitiveKind::sphere, {1.5}, 9 * kPi},
      {"cone", PrimitiveKind::cone, {1, 0, 2, 1}, kPi * std::sqrt(5.0) + kPi},
      {"frustum", PrimitiveKind::cone, {1, 3, 2, 1}, kPi * 4 * std::sqrt(8.0) + 10 * kPi},
      {"open frustum", PrimitiveKind::cone, {3, 1, 2, 0}, kPi * 4 * std::sqrt(8.0)},
      {"cylinder", PrimitiveKind::cylinder, {1, 2, 1}, 6 * kPi},
      {"tube", PrimitiveKind::cylinder, {1, 2, 0}, 4 * kPi},
      {"sinusoid", PrimitiveKind::sinusoid, {4, 2, 0.3, 3, 1, 0.2, 0.1, 0, 5, 1}, 0}};
  return table;
}

const Box3 kReach{{-1, -2, 0}, {3, 4, 0}};

TEST(PrimitiveFaces, ThereAndBack) {
  for (const Case& c : cases()) {
    const PrimitiveFaces faces({c.name, c.kind, c.parameters, 0}, kReach);
    for (size_t f = 0; f < faces.size(); ++f)
      for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 9; ++j) {
          const double a = (i + 0.5) / 9, b = (j + 0.5) / 9;
          const PrimitiveFaces::Point p = faces.point(f, a, b);
          const PrimitiveFaces::Place q = faces.place(p.position);
          EXPECT_EQ(q.face, f) << c.name;
          EXPECT_NEAR(q.a, a, 1e-9) << c.name << " face " << f;
          EXPECT_NEAR(q.b, b, 1e-9) << c.name << " face " << f;
          EXPECT_NEAR(length(p.normal), 1, 1e-12) << c.name;
        }
  }
}

// Areas of small patches, from where their corners lie: their sum is the face's, and equal parts of the square are
// equal parts of it; normals stand on them.
TEST(PrimitiveFaces, Areas) {
  constexpr int n = 400;
  for (const Case& c : cases()) {
    const PrimitiveFaces faces({c.name, c.kind, c.parameters, 0}, kReach);
    double whole = 0;
    for (size_t f = 0; f < faces.size(); ++f) {
      double sum = 0, quarter = 0;
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int x, int y) {
            return faces.point(f, static_cast<double>(i + x) / n, static_cast<double>(j + y) / n).position;
          };
          const Vec3 v = cross(corner(1, 1) - corner(0, 0), corner(0, 1) - corner(1, 0)) / 2;
          sum += length(v);
          if (i < n / 2 && j < n / 2) quarter += length(v);
          if (i % 97 == 0 && j % 89 == 0 && j > 0) {
            const PrimitiveFaces::Point p = faces.point(f, (i + 0.5) / n, (j + 0.5) / n);
            EXPECT_NEAR(std::fabs(dot(v, p.normal)), length(v), 1e-3 * length(v)) << c.name;
          }
        }
      EXPECT_NEAR(sum, faces.area(f), 2e-4 * sum) << c.name << " face " << f;
      if (c.kind != PrimitiveKind::sinusoid) {
        EXPECT_NEAR(quarter, sum / 4, 1e-3 * sum) << c.name << " face " << f;
      }
      whole += faces.area(f);
    }
    if (c.area > 0) {
      EXPECT_NEAR(whole, c.area, 1e-9 * c.area) << c.name;
    }
  }
}

TEST(PrimitiveFaces, BeyondTheReachAreTheEdges) {
  const PrimitiveFaces plane({"p", PrimitiveKind::plane, {0, 0}, 0}, kReach);
  EXPECT_EQ(plane.place({100, 0, 0}).a, 1);
  EXPECT_EQ(plane.place({0, -100, 0}).b, 0);
  const PrimitiveFaces layer({"l", PrimitiveKind::box, {0, 0, -1, 0, 0, 1}, 0}, kReach);
  EXPECT_EQ(layer.place({0, 0, 1}).face, 1u);
  EXPECT_EQ(layer.point(1, 0.5, 0.5).normal.z, 1);
  EXPECT_EQ(layer.point(0, 0.5, 0.5).normal.z, -1);
}

// Stretches of a sinusoid are at most the largest told, and so is none of what is flat.
TEST(PrimitiveFaces, Stretches) {
  for (const Case& c : cases()) {
    const PrimitiveFaces faces({c.name, c.kind, c.parameters, 0}, kReach);
    double most = 0;
    for (int i = 0; i < 1600; ++i)
      most = std::fmax(most, faces.point(0, (i % 40 + 0.5) / 40, (i / 40 + 0.5) / 40).stretch);
    EXPECT_LE(most, faces.most_stretch());
    if (c.kind == PrimitiveKind::sinusoid) {
      EXPECT_GT(most, 1.2);
    }
  }
}

}  // namespace
}  // namespace suite::primitive_faces_test
