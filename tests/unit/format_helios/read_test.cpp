// Scenes of HELIOS++: what their filters become, and faults with their lines.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "base/params.h"
#include "formats/helios/helios.h"
#include "formats/helios/xyz.h"
#include "math/vec.h"
#include "scene/issues.h"
#include "support/helios_kit.h"
#include "support/message_of.h"

namespace suite::format_helios_read_test {
namespace {

using testing::HasSubstr;

HeliosText parse(const std::string& text, Report& report) {
  return parse_helios(
      text, "s.xml",
      {.grid_of =
           [](const std::string&) {
             return HeliosGrid{{100, 200}, {0.5, 0.25}, -9999};
           },
       .text_of = [](const std::string&) { return std::string("0.1 0.2 0 255 0 0\n1.9 0.2 0 255 0 0\n# end\n"); },
       .heights_of = {},
       .mesh_of = {}},
      report);
}

TEST(Helios, Filters) {
  Report report(scene_issues());
  const HeliosText made = parse(test::helios_scene(), report);
  const Params root = Params::parse_made(made.yaml, "s.xml", made.origins);
  const auto world = root.at("world").items();
  ASSERT_EQ(world.size(), size_t{4});
  EXPECT_EQ(world[0].text("place"), "tree");
  EXPECT_EQ(world[1].text("place"), "tree");  // one file, one object
  EXPECT_EQ(world[0].text("tag"), "tree-1");
  EXPECT_EQ(world[0].number("scale"), 2);
  EXPECT_EQ(world[0].at("translate").as_vec3(), (std::array<double, 3>{10, 5, -1.5}));
  const auto turns = world[0].at("rotate").items();
  ASSERT_EQ(turns.size(), size_t{2});
  EXPECT_EQ(turns[1].at("axis").as_vec3(), (std::array<double, 3>{1, 0, 0}));
  EXPECT_EQ(turns[1].number("angle_deg"), 10);
  EXPECT_EQ(world[0].where().line, 3);
  const Params objects = root.at("objects");
  EXPECT_EQ(objects.at("tree").text("obj"), "data/tree.obj");
  EXPECT_EQ(objects.at("tree").text("up"), "y");
  EXPECT_EQ(objects.at("ground").at("local").at("gsd").as_numbers(), (std::vector<double>{0.5, 0.25}));
  EXPECT_EQ(objects.at("ground").number("no_data"), -9999);  // it was lost, and depths of 10 km came out
  EXPECT_EQ(root.at("grids").at("crown").text("voxels"), "crown.vox");
  EXPECT_EQ(root.at("volumes").items()[0].at("translate").as_vec3()[2], 3);
  EXPECT_EQ(world[3].text("place"), "points");
  EXPECT_THAT(objects.at("points").at("obj_text").as_text(), HasSubstr("f 1 4 3\n"));
  EXPECT_EQ(report.count("SP705"), size_t{0});
  EXPECT_EQ(report.count("SP707"), size_t{1});  // points are cubes
  EXPECT_EQ(report.count("SP708"), size_t{2});
}

// As HELIOS++ does: the last offset and scale of a part, turns of all filters, local ones about axes that turn along
// (the reverse order about fixed ones). Offsets and scales were added up, and 'local' was passed over.
TEST(Helios, FiltersTwice) {
  Report report(scene_issues());
  const auto filter = [](const std::string& type, const std::string& params) {
    return "<filter type=\"" + type + "\"><param " + params + "</filter>";
  };
  const std::string text = "<document><scene><part>" + filter("objloader", "key=\"filepath\" value=\"a.obj\"/>") +
                           filter("translate", "key=\"offset\" value=\"1;2;3\"/>") +
                           filter("translate", "key=\"offset\" value=\"4;5;6\"/>") +
                           filter("scale", "key=\"scale\" value=\"2\"/>") +
                           filter("scale", "key=\"scale\" value=\"3\"/>") +
                           filter("rotate", "key=\"rotation\"><rot axis=\"z\" angle_deg=\"1\"/></param>") +
                           filter("rotate",
                                  "key=\"rotation\" rotations=\"local\"><rot axis=\"x\" angle_deg=\"2\"/><rot "
                                  "axis=\"y\" angle_deg=\"3\"/></param>") +
                           "</part></scene></document>";
  const HeliosText made = parse(text, report);
  const Params part = Params::parse_made(made.yaml, "s.xml", made.origins).at("world").items()[0];
  EXPECT_EQ(part.at("translate").as_vec3(), (std::array<double, 3>{4, 5, 6}));
  EXPECT_EQ(part.number("scale"), 3);
  std::vector<double> angles;
  for (const Params& turn : part.at("rotate").items()) angles.push_back(turn.number("angle_deg"));
  EXPECT_EQ(angles, (std::vector<double>{1, 3, 2}));
}

// The area and the volume of cubes, by the divergence theorem over the triangles.
std::array<double, 2> area_and_volume(const std::string& obj) {
  std::vector<Vec3> v;
  double area = 0, volume = 0;
  std::istringstream text(obj);
  for (std::string word; text >> word;) {
    if (word == "v") {
      Vec3 p;
      text >> p.x >> p.y >> p.z;
      v.push_back(p);
    } else {
      size_t i[3];
      text >> i[0] >> i[1] >> i[2];
      const Vec3 a = v[i[0] - 1], n = cross(v[i[1] - 1] - a, v[i[2] - 1] - a);
      area += 0.5 * std::sqrt(dot(n, n));
      volume += dot(a, n) / 6;
    }
  }
  return {area, volume};
}

TEST(HeliosPoints, AreCubesWithoutFacesWithin) {
  // Three cubes of 0.5 m in a row, one of which has two points, and one apart.
  const std::string text = "0 0 0\n0.6,0.1 0.2\n 0.7 0.1\t0.2 9 9\n1.0 0.4 0.4\n// no point\n\n5 5 5\n";
  const helios::Cubes cubes = helios::cubes_of_xyz(text, "p.xyz", ",", 0.5);
  EXPECT_EQ(cubes.points, size_t{5});
  EXPECT_EQ(cubes.centres.size(), size_t{4});
  const auto [area, volume] = area_and_volume(cubes.obj);
  EXPECT_NEAR(volume, 4 * 0.125, 1e-12);
  EXPECT_NEAR(area, 0.25 * (14 + 6), 1e-12);
  // The control: cubes that do not touch have all of their faces.
  EXPECT_NEAR(area_and_volume(helios::cubes_of_xyz(text, "p.xyz", ",", 0.05).obj)[0], 0.0025 * 6 * 5, 1e-12);
  EXPECT_THAT(message_of([] { helios::cubes_of_xyz("# none\n", "p.xyz", "", 1); }), HasSubstr("without a point"));
  EXPECT_THAT(message_of([] { helios::cubes_of_xyz("1 2 3\n1 2\n", "p.xyz", "", 1); }), HasSubstr("p.xyz:2"));
  EXPECT_THAT(message_of([] { helios::cubes_of_xyz("1 2 3\n1 x 2\n", "p.xyz", "", 1); }), HasSubstr("p.xyz:2:3"));
  EXPECT_THAT(message_of([] { helios::cubes_of_xyz("0 0 0\n1e6 1e6 1e6\n", "p.xyz", "", 0.1); }),
              HasSubstr("larger voxelSize"));
}

TEST(Helios, FaultsHaveTheirLine) {
  const auto said = [](const std::string& from, const std::string& to) {
    std::string text = test::helios_scene();
    text.replace(text.find(from), from.size(), to);
    Report report(scene_issues());
    return message_of([&] { parse(text, report); });
  };
  EXPECT_THAT(said("10;+5;-1.5", "10;5"), HasSubstr("s.xml:6"));
  EXPECT_THAT(said("10;+5;-1.5", "10;x;5"), HasSubstr("'x' is no number"));
  EXPECT_THAT(said("axis=\"z\"", "axis=\"w\""), HasSubstr("'w' is no axis"));
  EXPECT_THAT(said("key=\"filepath\" value=\"crown.vox\"", "key=\"file\" value=\"crown.vox\""), HasSubstr("s.xml:8"));
  EXPECT_THAT(said("value=\"2\"", "value=\"0\""), HasSubstr("a scale of 0"));
  EXPECT_THAT(said("key=\"onGround\" value=\"0\"", "key=\"onGround\" value=\"0.5\""), HasSubstr("s.xml:6"));
}

}  // namespace
}  // namespace suite::format_helios_read_test
