// Media of water in scene texts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/scene_text/scene_text.h"
#include "scene/bake.h"
#include "scene/issues.h"
#include "support/temp_folder.h"
#include "water/sea_water.h"

namespace suite::format_scene_text_water_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class WaterText : public ::testing::Test {
 protected:
  Scene bake(const std::string& water, const std::string& beside = "") {
    write_file(folder_ / "s.yaml", "scene: 1\nmedia:\n  bay:\n    water: " + water + "\n" + beside +
                                       "materials:\n  surface: {model: dielectric, inside: bay}\n"
                                       "objects:\n  bay: {plane: {}, material: surface}\nworld: [{place: bay}]\n");
    report_ = Report(scene_issues());
    return bake_scene(read_scene_text(folder_ / "s.yaml", {}, report_), report_);
  }
  TempFolder folder_;
  Report report_{scene_issues()};
};

TEST_F(WaterText, BecomesAMediumAndTheSurfacesIndex) {
  const Scene s = bake("{chlorophyll: 0.5, cdom: 0.02, mineral: 0, temperature_c: 15, salinity: 35}");
  ASSERT_TRUE(report_.ok()) << report_.text();
  const Medium& m = s.media.at(0);
  EXPECT_EQ(m.phase.model, "sea");
  EXPECT_NEAR(m.index.at(0.55), sea_water_index(0.55, 15, 35), 1e-9);
  EXPECT_NEAR(s.materials.at(0).surface.curves.at("index").at(0.55), m.index.at(0.55), 1e-9);
  EXPECT_GT(m.scattering.at(0.55), 0.2);
  EXPECT_NEAR(m.temperature_k, 288.15, 1e-9);
  EXPECT_THAT(report_.text(), HasSubstr("SP608"));
  EXPECT_THAT(report_.text(), HasSubstr("Raman scattering is left out"));
}

TEST_F(WaterText, TakesATableAndOtherPureWater) {
  write_file(folder_ / "iop.csv", "wavelength_um,a,b,bb\n0.4,0.1,0.5,0.008\n0.7,0.7,0.4,0.006\n");
  const Scene s = bake("{iop: iop.csv, iop_backscatter: true, phase: fournier_forand}");
  ASSERT_TRUE(report_.ok()) << report_.text();
  EXPECT_NEAR(s.media.at(0).absorption.at(0.55), 0.4, 1e-9);
  EXPECT_NEAR(s.media.at(0).phase.numbers.at("backscatter"), 0.015, 0.003);
  const Scene t = bake("{pure_absorption: {points: [[0.4, 0.0066], [0.7, 0.62]]}, phase: petzold, cdom: case_1}",
                       "    priority: 3\n");
  ASSERT_TRUE(report_.ok()) << report_.text();
  EXPECT_EQ(t.media.at(0).priority, 3);
  EXPECT_EQ(t.media.at(0).phase.texts.at("kind"), "petzold");
}

TEST_F(WaterText, FaultsAreLocated) {
  bake("{chlorophyll: -1}");
  EXPECT_THAT(report_.text(), HasSubstr("water: chlorophyll -1"));
  bake("{chlorofyll: 1}");
  EXPECT_THAT(report_.text(), HasSubstr("did you mean 'chlorophyll'?"));
  bake("{phase: mud}");
  EXPECT_THAT(report_.text(), HasSubstr("unknown phase 'mud'"));
  bake("{}", "    albedo: 0.5\n");
  EXPECT_THAT(report_.text(), HasSubstr("'albedo' and 'water' cannot be combined"));
}

TEST_F(WaterText, WavesBecomeAMeshThatMovesWithTime) {
  const auto sea = [&](const std::string& more, const std::string& wind = "6") {
    write_file(folder_ / "w.yaml",
               "scene: 1\nmaterials:\n  sea: {model: sea, wind_m_s: 2}\nobjects:\n"
               "  sea: {waves: {wind_m_s: " +
                   wind + ", size_m: [40, 20], step_m: 0.5" + more + "}, material: sea}\nworld: [{place: sea}]\n");
    report_ = Report(scene_issues());
    return bake_scene(read_scene_text(folder_ / "w.yaml", {}, report_), report_);
  };
  const auto heights = [](const Scene& s) {
    std::vector<float> z;
    for (size_t i = 2; i < s.meshes.at(0).positions.size(); i += 3) z.push_back(s.meshes[0].positions[i]);
    return z;
  };
  const Scene still = sea("");
  ASSERT_TRUE(report_.ok()) << report_.text();
  EXPECT_EQ(still.meshes.at(0).triangle_count(), 2u * 80 * 40);
  EXPECT_THAT(report_.text(), HasSubstr("SP609"));
  EXPECT_EQ(heights(still), heights(sea("")));
  EXPECT_NE(heights(still), heights(sea(", time_s: 0.2")));
  EXPECT_NE(heights(still), heights(sea(", seed: 2")));
  EXPECT_THAT(report_.text(), Not(HasSubstr("SP108")));
  for (const float z : heights(sea("", "0"))) EXPECT_EQ(z, 0);
  EXPECT_THAT(report_.text(), HasSubstr("no wind, flat water"));
  sea("", "0.2");
  EXPECT_THAT(report_.text(), HasSubstr("or 0 for flat water"));
  sea(", spectrum: choppy");
  EXPECT_THAT(report_.text(), HasSubstr("elfouhaily"));
  sea(", fetch_m: 1");
  EXPECT_THAT(report_.text(), HasSubstr("waves: fetch_m 1"));
}

TEST_F(WaterText, WindsBeyondWhatWasMeasuredAreTold) {
  const auto findings = [&](const char* wind) {
    write_file(folder_ / "w.yaml", std::string("scene: 1\nmaterials:\n  sea: {model: sea, wind_m_s: ") + wind +
                                       "}\nobjects: {sea: {plane: {}, material: sea}}\nworld: [{place: sea}]\n");
    report_ = Report(scene_issues());
    bake_scene(read_scene_text(folder_ / "w.yaml", {}, report_), report_);
    EXPECT_TRUE(report_.ok()) << report_.text();
    return report_.text();
  };
  EXPECT_THAT(findings("30"), HasSubstr("beyond the 14 m/s"));
  EXPECT_THAT(findings("0"), HasSubstr("is not flat"));
  EXPECT_THAT(findings("7"), Not(HasSubstr("SP108")));
}

}  // namespace
}  // namespace suite::format_scene_text_water_test
