#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "formats/obj/obj.h"
#include "math/polygon.h"
#include "scene/issues.h"
#include "support/message_of.h"

namespace suite::format_obj_read_test {
namespace {

using ::testing::HasSubstr;

struct Read {
  Report report{scene_issues()};
  SourceMesh mesh;
  explicit Read(const std::string& text) : mesh(parse_obj(text, "t.obj", report)) {}
};

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(Obj, SharesCornersAndKeepsRuns) {
  const Read r(kSquare + "usemtl  brick red \ng wall a\nf 1 2 3\nf 1 3 4\nusemtl x\nf -4 -3 -2\n");
  EXPECT_EQ(r.mesh.positions.size(), 4u);
  EXPECT_EQ(r.mesh.indices.size(), 9u);
  ASSERT_EQ(r.mesh.runs.size(), 2u);
  EXPECT_EQ(r.mesh.runs[0].material, "brick red");
  EXPECT_EQ(r.mesh.runs[0].group, "wall a");
  EXPECT_EQ(r.mesh.runs[1].first_triangle, 2u);
  EXPECT_EQ(r.mesh.lines, (std::vector<int>{7, 8, 10}));
  EXPECT_TRUE(r.report.ok());
}

TEST(Obj, NormalsAndUvsSplitVertices) {
  const Read r(kSquare + "vt 0 0\nvt 1 0\nvn 0 0 1\nvn 0 0 -1\nf 1/1/1 2/2/1 3/1/1\nf 1/1/2 3/1/2 4/1/2\n");
  EXPECT_EQ(r.mesh.positions.size(), 6u);
  EXPECT_EQ(r.mesh.normals.size(), 6u);
  EXPECT_EQ(r.mesh.uvs.size(), 12u);
}

TEST(Obj, KeepsGeoreferencedCoordinates) {
  const Read r(
      "v 477660.1258 5473962.8903 127.001\nv 477661.1258 5473962.8903 127\nv 477660.1258 5473963.8903 127\nf 1 2 3\n");
  EXPECT_NEAR(r.mesh.positions[0].x, 477660.1258, 1e-9);
  EXPECT_NEAR(r.mesh.positions[0].y, 5473962.8903, 2e-9);
}

TEST(Obj, ContinuedLinesKeepLineNumbers) {
  const Read r(kSquare + "f 1 2 \\\n 3 4\nf 9 1 2\n");
  EXPECT_EQ(r.mesh.indices.size(), 6u);
  EXPECT_THAT(r.report.text(), HasSubstr("t.obj:7:1: vertex index 9 of 4"));
}

TEST(Obj, ConcavePolygonIsCutAlongItsOutline) {
  // An arrowhead: the fan from its first corner would leave the outline.
  const std::vector<Vec3> p{{0, 0, 0}, {4, 2, 0}, {0, 4, 0}, {1, 2, 0}};
  bool clean = false;
  const auto triangles = split_polygon(p, clean);
  EXPECT_TRUE(clean);
  ASSERT_EQ(triangles.size(), 2u);
  double area = 0;
  for (const auto& t : triangles) {
    const double a = cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]).z / 2;
    EXPECT_GT(a, 0);
    area += a;
  }
  EXPECT_DOUBLE_EQ(area, 6);
}

// Many corners: all at once would take hours if every ear were sought anew. A jagged disk has as many reflex corners as
// others.
TEST(Obj, PolygonsOfManyCornersAreCutInTime) {
  for (const double teeth : {0.0, 0.3}) {
    std::vector<Vec3> p;
    const int n = 20000;
    for (int k = 0; k < n; ++k) {
      const double r = 1 + teeth * (k % 2), a = 2 * kPi * k / n;
      p.push_back({r * std::cos(a), r * std::sin(a), 0});
    }
    bool clean = false;
    const auto triangles = split_polygon(p, clean);
    EXPECT_TRUE(clean) << teeth;
    double area = 0, outline = 0;
    for (const auto& t : triangles) {
      const double a = cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]).z / 2;
      EXPECT_GT(a, 0);
      area += a;
    }
    for (size_t k = 0; k < p.size(); ++k) outline += cross(p[k], p[(k + 1) % p.size()]).z / 2;
    EXPECT_NEAR(area, outline, 1e-9 * outline);
  }
}

// One position with a normal of its own in each of many faces.
TEST(Obj, CrowdedPositionsAreSharedInTime) {
  std::string text = kSquare;
  for (int k = 0; k < 100000; ++k) text += "vn 0 0 1\n";
  for (int turn = 0; turn < 2; ++turn)
    for (int k = 1; k <= 100000; ++k) text += strf("f 1//%d 2//%d 3//%d\n", k, k, k);
  const Read read(text);
  EXPECT_EQ(read.mesh.indices.size(), 600000u);
  EXPECT_EQ(read.mesh.positions.size(), 300000u);
}

TEST(Obj, FaultsAreLocated) {
  // The loader turned these into other numbers and went on.
  EXPECT_THAT(Read(kSquare + "f 1 2 99999999999999999999\n").report.text(),
              HasSubstr("t.obj:5:1: index 99999999999999999999"));
  EXPECT_THAT(Read(kSquare + "f -1 -2 -2147483650\n").report.text(), HasSubstr("t.obj:5:1: index 2147483650"));
  // A mark before UTF-8 once swallowed the first vertex.
  EXPECT_EQ(Read("\xef\xbb\xbf" + std::string(kSquare) + "f 1 2 3\n").report.count(Severity::error), 0u);
  EXPECT_THAT(Read(kSquare + "f 0 1 2\n").report.text(),
              HasSubstr("[SP201] x1: a face names something that is not there\n    t.obj:5:1: vertex index 0"));
  EXPECT_THAT(Read(kSquare + "vt 0 0\nf 1/0 2/1 3/1\n").report.text(), HasSubstr("t.obj:6:1: index 0"));
  EXPECT_THAT(Read(kSquare + "f 1 2\n").report.text(), HasSubstr("[SP202] x1"));
  EXPECT_THAT(Read("v 0 nan 0\nf 1 1 1\n").report.text(), HasSubstr("t.obj:1:1: 'nan' is no finite number"));
  EXPECT_THAT(Read("v 1 2\nf 1 1 1\n").report.text(), HasSubstr("t.obj:1:1: 2 numbers, 3 are needed"));
  EXPECT_THAT(Read("v 3E4570711268 0 0\n").report.text(), HasSubstr("[SP203] x1"));
  EXPECT_THAT(Read("").report.text(), HasSubstr("[SP204] x1"));
  EXPECT_THAT(Read(kSquare + "l 1 2\nf 1 2 3\n").report.text(), HasSubstr("[SP205] x1"));
  Report report(scene_issues());
  EXPECT_THAT(message_of([&] { parse_obj(std::string("v 0 0\0", 6), "t.obj", report); }),
              HasSubstr("byte 5: error: is not a text file"));
}

}  // namespace
}  // namespace suite::format_obj_read_test
