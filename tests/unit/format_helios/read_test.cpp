// Scenes of HELIOS++: what their filters become, and faults with their lines.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/params.h"
#include "formats/helios/helios.h"
#include "scene/issues.h"
#include "support/helios_kit.h"
#include "support/message_of.h"

namespace suite {
namespace {

using testing::HasSubstr;

HeliosText parse(const std::string& text, Report& report) {
  return parse_helios(
      text, "s.xml",
      [](const std::string&) {
        return std::array<double, 4>{100, 200, 0.5, 0.25};
      },
      report);
}

TEST(Helios, Filters) {
  Report report(scene_issues());
  const HeliosText made = parse(test::helios_scene(), report);
  const Params root = Params::parse_made(made.yaml, "s.xml", made.origins);
  const auto world = root.at("world").items();
  ASSERT_EQ(world.size(), size_t{3});
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
  EXPECT_EQ(root.at("grids").at("crown").text("voxels"), "crown.vox");
  EXPECT_EQ(root.at("volumes").items()[0].at("translate").as_vec3()[2], 3);
  EXPECT_EQ(report.count("SP705"), size_t{1});  // the point cloud
  EXPECT_EQ(report.count("SP708"), size_t{2});
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
}

}  // namespace
}  // namespace suite
