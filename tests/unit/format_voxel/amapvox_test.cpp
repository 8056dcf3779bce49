// Voxels of AMAPVox: headers of its versions, columns, what was not seen, and faults with their lines.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/voxel/voxel.h"
#include "scene/issues.h"
#include "support/message_of.h"

namespace suite::format_voxel_amapvox_test {
namespace {

using testing::HasSubstr;

const std::string kFile =
    "VOXEL SPACE\n#min_corner: 10.0 20.0 -1.0\n#max_corner: 12.0 21.0 2.0\n#split: 2 1 3\n"
    "#res: 1.0 #MAX_PAD: 5.0\ni j k PadBVTotal angleMean transmittance\n"
    "0 0 0 0.5 30 0.9\n1 0 0 NaN NaN NaN\n0 0 1 0 20 1\n1 0 2 2.25 20 0.1\n";

VoxelData parse(const std::string& text, Report& report, const std::string& column = "") {
  return parse_amapvox(text, "a.vox", column, report);
}

TEST(AmapVox, DensitiesAndPlaces) {
  Report report(scene_issues());
  const VoxelData v = parse(kFile, report);
  EXPECT_EQ(v.cells, (std::array<uint32_t, 3>{2, 1, 3}));
  EXPECT_EQ(v.density, (std::vector<float>{0.5f, 0, 0, 0, 0, 2.25f}));
  EXPECT_EQ(v.to_local.point({0, 0, 0}), (Vec3{10, 20, -1}));
  EXPECT_EQ(v.to_local.point({2, 1, 3}), (Vec3{12, 21, 2}));
  EXPECT_EQ(report.count("SP705"), size_t{3});  // one has no value, two are not there
  EXPECT_FLOAT_EQ(parse(kFile, report, "transmittance").density[5], 0.1f);
}

TEST(AmapVox, ResolutionsThatDisagree) {
  std::string text = kFile;
  Report same(scene_issues()), other(scene_issues());
  parse(text, same);
  EXPECT_EQ(same.count("SP709"), size_t{0});
  text.replace(text.find("#res: 1.0"), 9, "#res: 0.5");
  EXPECT_EQ(parse(text, other).to_local.point({2, 1, 3}), (Vec3{12, 21, 2}));
  EXPECT_EQ(other.count("SP709"), size_t{1});
  EXPECT_THAT(other.text(), HasSubstr("#res says cells of 0.5 m, the corners and #split make them 1 x 1 x 1 m"));
}

TEST(AmapVox, OlderHeaders) {
  std::string text = kFile;
  text.replace(text.find("10.0 20.0 -1.0"), 14, "(10.0, 20.0, -1.0)");
  text.replace(text.find("PadBVTotal"), 10, "PAD");
  Report report(scene_issues());
  EXPECT_EQ(parse(text, report).density[5], 2.25f);
}

// Blanks before and behind keys and columns, many keys on a line, Windows' line ends.
TEST(AmapVox, LooseHeaders) {
  Report report(scene_issues());
  const VoxelData v = parse(
      "VOXEL SPACE\r\n#min_corner:  0.0 0.0 0.0 \r\n #max_corner: 20.0 20.0 10.0 \r\n\t#split: 2 1 1\r\n"
      "#res:10.0 #nsubvoxel:8 #lad_type:Erectophile #type:TLS\r\n i j k bsEntering PadBVTotal\r\n0 0 0 1 0.25\r\n1 0 0 "
      "1 3\r\n",
      report);
  EXPECT_EQ(v.density, (std::vector<float>{0.25f, 3}));
  EXPECT_EQ(v.to_local.point({2, 1, 1}), (Vec3{20, 20, 10}));
  EXPECT_EQ(report.count("SP707"), size_t{1});  // leaves that stand upright
}

TEST(AmapVox, FaultsHaveTheirLine) {
  const auto said = [](const std::string& from, const std::string& to, const std::string& column = "") {
    std::string text = kFile;
    text.replace(text.find(from), from.size(), to);
    Report report(scene_issues());
    return message_of([&] { parse(text, report, column); });
  };
  EXPECT_THAT(said("1 0 2 2.25", "2 0 2 2.25"), HasSubstr("a.vox:10:1"));
  EXPECT_THAT(said("1 0 2 2.25", "1 0 2 -2.25"), HasSubstr("a.vox:10:7"));
  EXPECT_THAT(said("0 0 1 0 20", "0 0 0 0 20"), HasSubstr("given twice"));
  EXPECT_THAT(said("2 1 3", "2000 1000 3000"), HasSubstr("#split into 6e+09 cells"));
  EXPECT_THAT(said("#max_corner: 12", "#max_corner: 10"), HasSubstr("does not lie beyond"));
  EXPECT_THAT(said("#split", "#splat"), HasSubstr("#split is missing above"));
  EXPECT_THAT(said("PadBVTotal", "Pad"), HasSubstr("neither a column PadBVTotal nor PAD"));
  EXPECT_THAT(said("PadBVTotal", "Pad", "LAI"), HasSubstr("no column 'LAI'"));
}

}  // namespace
}  // namespace suite::format_voxel_amapvox_test
