// Parts that HELIOS++ puts on the ground, with answers by hand.
#include "formats/helios/on_ground.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace suite::helios::format_helios_on_ground_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

SourceMesh mesh(std::vector<Vec3> positions, std::vector<uint32_t> indices) {
  SourceMesh made;
  made.positions = std::move(positions), made.indices = std::move(indices);
  return made;
}

// A slope z = x / 2 over 20 m x 20 m, a table of two triangles, a hill in a raster of 3 x 3 pixels of 10 m.
HeliosFiles files() {
  HeliosFiles made;
  made.text_of = [](const std::string& name) -> std::string {
    if (name == "earth/slope.obj") return "mtllib two words.mtl\nv 0 0 0\nusemtl soil\nf 1 1 1\nusemtl wood\nf 1 1 1\n";
    if (name == "earth/two words.mtl")
      return "newmtl wood\nhelios_isGround false\nnewmtl soil\nKd 1 1 1\nhelios_isGround TRUE\n";
    if (name == "hill.mtl") return "newmtl a\nhelios_isGround 1\nnewmtl b\n";
    if (name == "points.xyz") return "0 0 0\n0.4 0 0\n0 0 3\n";
    if (name == "table.obj") return "v 0 0 0\nf 1 1 1\n";
    throw Error(Where{name, 0, 0, {}, -1}, "cannot be read");
  };
  made.mesh_of = [](const std::string& name) {
    if (name == "earth/slope.obj") return mesh({{0, 0, 0}, {20, 0, 10}, {20, 20, 10}, {0, 20, 0}}, {0, 1, 2, 0, 2, 3});
    return mesh({{10, 5, 7}, {12, 5, 8}, {14, 5, 7.5}, {16, 5, 8}}, {0, 1, 2, 1, 2, 3});
  };
  made.heights_of = [](const std::string&) {
    return HeliosHeights{{{100, 30}, {10, 10}, {}}, 3, 3, {0, 0, 0, 0, 9, 0, 0, 0, 0}};
  };
  return made;
}

Part part(Part::Kind kind, const std::string& path, long long on_ground = 0) {
  Part made;
  made.kind = kind, made.path = path, made.id = path, made.on_ground = on_ground, made.edge_m = 1;
  return made;
}

std::vector<std::string> place(std::vector<Part>& parts) {
  std::vector<std::string> said;
  put_on_ground(parts, files(), [&](const char* code, const Part& of, const std::string& what) {
    said.push_back(code + (" " + of.id + ": " + what));
  });
  return said;
}

// Above the slope the table's corners are 2, 2, 0.5 and 0 m high; its lowest one is the first.
TEST(HeliosOnGround, VerticesThatAreTried) {
  const auto shift = [](long long depth) {
    std::vector<Part> parts{part(Part::Kind::mesh, "earth/slope.obj"), part(Part::Kind::mesh, "table.obj", depth)};
    parts[1].shift.z = 100;
    EXPECT_EQ(place(parts).size(), size_t{depth != 0});
    return parts[1].shift.z;
  };
  EXPECT_NEAR(shift(1), -2, 1e-9);
  EXPECT_NEAR(shift(-1), 0, 1e-9);
  EXPECT_NEAR(shift(2), -2, 1e-9);    // the first and the fourth corner, both 2 m high
  EXPECT_NEAR(shift(3), -0.5, 1e-9);  // the first, third and fifth: 2, 0.5 and 0.5 m
  EXPECT_NEAR(shift(99), 0, 1e-9);
  EXPECT_NEAR(shift(0), 100, 0);
}

// The plane of the hill is level by symmetry and at the mean of the corners of its eight triangles, six of which are
// the summit's: 9 m * 6 / 24. The table, turned by 180 degrees about z and shrunk by half, has its lowest corner at
// (-5, -2.5, 3.5) + (120, 20, 1).
TEST(HeliosOnGround, TurnedAndScaledOnARaster) {
  std::vector<Part> parts{part(Part::Kind::mesh, "table.obj", -1), part(Part::Kind::terrain, "hill.tif")};
  parts[0].scale = 0.5, parts[0].turns = {{{0, 0, 1}, 180}}, parts[0].shift = {120, 20, 1};
  EXPECT_THAT(place(parts), ElementsAre(HasSubstr("stays at its offset")));  // no material: no ground
  EXPECT_EQ(parts[0].shift.z, 1);
  parts[1].matfile = "hill.mtl";
  EXPECT_THAT(place(parts), ElementsAre(HasSubstr("3.897 m (rms)")));  // 9 m sqrt(6 18) / 24
  EXPECT_NEAR(parts[0].shift.z, 2.25 - 3.5, 1e-9);
  parts[1].material = "b";
  EXPECT_THAT(place(parts), ElementsAre(HasSubstr("stays at its offset")));
}

// Points are ground unless a material says otherwise, by the centres of their cubes; what is beside all grounds and
// voxels stay. A file of materials that is missing is told.
TEST(HeliosOnGround, PointsAndWhatCannotBe) {
  std::vector<Part> parts{part(Part::Kind::points, "points.xyz"), part(Part::Kind::mesh, "table.obj", 1),
                          part(Part::Kind::voxels, "a.vox", 1), part(Part::Kind::mesh, "table.obj", 1),
                          part(Part::Kind::terrain, "hill.tif")};
  parts[0].shift = {9.5, 4.5, 0}, parts[3].shift = {500, 0, 0}, parts[4].matfile = "lost.mtl";
  EXPECT_THAT(place(parts), ElementsAre(HasSubstr("SP705 hill.tif: its materials cannot be read"),
                                        HasSubstr("SP705 table.obj: 'onGround': the ground 'points.xyz' is upright"),
                                        HasSubstr("SP705 a.vox"), HasSubstr("stays at its offset, as there")));
}

}  // namespace
}  // namespace suite::helios::format_helios_on_ground_test
