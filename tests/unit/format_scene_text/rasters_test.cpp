// What a raster's file says of its numbers holds in maps and terrains alike. Values: reflectance cubes of 16 bit times
// 10000, at 0.55 um 0.25 in columns 0 and 1, 0.5 in 2 and 3, the first pixel marked -9999; heights of 60 to 64 m.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/files.h"
#include "formats/scene_text/scene_text.h"
#include "scene/bake.h"
#include "scene/issues.h"
#include "support/temp_folder.h"

namespace suite::format_scene_text_rasters_test {
namespace {

using ::testing::HasSubstr;

const std::string kData = SUITE_SOURCE_DIR "/tests/data/raster/";

class RastersOfScenes : public ::testing::Test {
 protected:
  Scene bake(const std::string& text) {
    write_file(folder_ / "s.yaml", text);
    report_ = Report(scene_issues());
    return bake_scene(read_scene_text(folder_ / "s.yaml", {}, report_), report_);
  }
  Scene with_map(const std::string& map) {
    return bake(
        "scene: 1\nmaterials: {a: {model: lambert, reflectance: 0.1}, m: {model: lambert, reflectance: 0.1, maps: "
        "[c]}}\nmaps: {c: {" +
        map +
        ", drape: {origin: [-2, 2], gsd: 1}}}\nobjects: {p: {plane: {width: 4, depth: 4}, material: m}}\nworld: "
        "[{place: p}]\n");
  }
  void expect_cube(const std::string& file, size_t channels, double factor, const std::string& more = "") {
    const Scene s = with_map("type: cube, file: " + kData + file + ", outside: hold" + more);
    ASSERT_TRUE(report_.ok()) << file << report_.text();
    const PropertyMap& map = s.property_maps.at(0);
    ASSERT_EQ(map.channels, channels) << file;
    for (size_t c = 0; c < channels; ++c) EXPECT_TRUE(std::isnan(map.values[c])) << file;
    EXPECT_NEAR(map.values[channels + 1], 0.25 * factor, 1e-6) << file;
    EXPECT_NEAR(map.values[3 * channels + 1], 0.5 * factor, 1e-6) << file;
    EXPECT_THAT(report_.text(), HasSubstr("1 of 16 pixels are gaps (-9999)"));
  }
  TempFolder folder_;
  Report report_{scene_issues()};
};

TEST_F(RastersOfScenes, CubesAreScaledAndHaveGaps) {
  expect_cube("factor.img", 4, 1);
  expect_cube("gain.img", 4, 1);
  expect_cube("bbl.img", 3, 1);
  EXPECT_THAT(report_.text(), HasSubstr("1 of 4 bands are bad or empty (0.65 um) and left out"));
  // A scale of the text is in place of the file's.
  expect_cube("factor.img", 4, 0.5, ", scale: 0.00005");
  EXPECT_THAT(report_.text(), HasSubstr("by the file a value is stored * 0.0001 + 0"));
}

TEST_F(RastersOfScenes, EveryMapKnowsGapsAndScales) {
  write_file(folder_ / "k.img", std::string("\x00\x01\x02\x03", 4));
  write_file(folder_ / "k.img.hdr",
             "ENVI\nsamples = 4\nlines = 1\nbands = 1\ndata type = 1\ninterleave = bsq\nbyte order = 0\ndata gain "
             "values = {0.25}\ndata offset values = {0}\ndata ignore value = 3\n");
  const Scene holes = with_map("type: opacity, file: k.img");
  ASSERT_TRUE(report_.ok()) << report_.text();
  EXPECT_EQ(holes.property_maps.at(0).values[2], 0.5f);
  EXPECT_TRUE(std::isnan(holes.property_maps.at(0).values[3]));
  const Scene warm = with_map("type: temperature, file: k.img, scale: 10, offset: 290");
  ASSERT_TRUE(report_.ok()) << report_.text();
  EXPECT_EQ(warm.property_maps.at(0).values[2], 310.0f);
  EXPECT_TRUE(std::isnan(warm.property_maps.at(0).values[3]));
  with_map("type: bump, file: k.img");
  EXPECT_THAT(report_.text(), HasSubstr("1 pixels hold the mark of a missing value (3)"));
  with_map("type: class, file: k.img, materials: {0: a, 1: a, 2: a, 3: a}");
  EXPECT_THAT(report_.text(), HasSubstr("but classes are the stored numbers"));
  // The text's mark replaces the file's.
  with_map("type: opacity, file: k.img, no_data: 0");
  EXPECT_THAT(report_.text(), HasSubstr("1 of 4 pixels are gaps (0)"));
}

TEST_F(RastersOfScenes, HeightsAreScaledWhereverTheTerrainIs) {
  const std::string head =
      "scene: 1\norigin: {latitude_deg: 49.652542922439, longitude_deg: 9, height_m: 0}\n"
      "materials: {g: {model: lambert, reflectance: 0.5}}\nobjects: {t: {material: g, terrain: ";
  for (const char* place : {"height: ellipsoid", "local: {origin: [-20, 20], gsd: 10}"}) {
    const Scene s = bake(head + kData + "dem_scaled.tif, " + place + "}}\nworld: [{place: t}]\n");
    ASSERT_TRUE(report_.ok()) << report_.text();
    EXPECT_NEAR(s.bounds.low.z, 60, 0.01) << place;  // the Earth falls by some millimetres
    EXPECT_NEAR(s.bounds.high.z, 64, 0.01) << place;
  }
  bake(head + kData + "dem_scale_z.tif, height: ellipsoid}}\nworld: [{place: t}]\n");
  EXPECT_EQ(report_.count("SP508"), 1u);
}

}  // namespace
}  // namespace suite::format_scene_text_rasters_test
