// `temperature: {model: heat}` of a scene text: what comes of it, and faults at their places.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/scene_text/scene_text.h"
#include "heat/heated_material.h"
#include "scene/bake.h"
#include "scene/issues.h"
#include "support/temp_folder.h"

namespace suite::format_scene_text_heat_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class HeatInScenes : public testing::Test {
 protected:
  HeatInScenes() { write_file(folder_ / "tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl grey\nf 1 2 3\n"); }
  // A material with more keys, which begin on line 4.
  Scene bake(const std::string& more) {
    return bake_text("scene: 1\nmaterials:\n  grey: {model: lambert, reflectance: 0.2,\n    " + more +
                     "}\nobjects:\n  tri: {obj: tri.obj}\nworld:\n  - {place: tri}\n");
  }
  Scene bake_text(const std::string& text) {
    write_file(folder_ / "s.yaml", text);
    report_ = Report(scene_issues());
    return bake_scene(read_scene_text(folder_ / "s.yaml", {}, report_), report_);
  }
  std::string told(const std::string& more) {
    bake(more);
    return report_.text();
  }
  TempFolder folder_;
  Report report_{scene_issues()};
};

constexpr const char* kLayer =
    "{thickness_m: 0.1, density_kg_m3: 2000, specific_heat_j_kg_k: 900, conductivity_w_m_k: 1.5}";

TEST_F(HeatInScenes, KeysArrive) {
  const std::string layers = std::string("thermal: {layers: [") + kLayer + "]}, ";
  const Scene s = bake(layers +
                       "temperature: {model: heat, convection: tarp, roughness: rough, wetness: 0.2, back: "
                       "air, back_k: 294, back_film_w_m2_k: 8, source_w_m2: 12, emissivity: 0.9}");
  ASSERT_TRUE(report_.ok()) << report_.text();
  const HeatedMaterial m = heated_material(s.temperatures.at(0).spec);
  EXPECT_EQ(m.layers.at(0).density, 2000);
  EXPECT_EQ(m.behind.film, 8);
  EXPECT_EQ(m.front.wetness, 0.2);
  EXPECT_EQ(m.source, 12);
  EXPECT_EQ(m.emissivity, 0.9);
  // Numbers of the material are its one layer.
  const Scene one = bake(
      "thermal: {thickness_m: 0.1, density_kg_m3: 2000, specific_heat_j_kg_k: 900, conductivity_w_m_k: 1.5}, "
      "temperature: {model: heat}");
  ASSERT_TRUE(report_.ok()) << report_.text();
  EXPECT_EQ(heated_material(one.temperatures.at(0).spec).layers.at(0).thickness, 0.1);
}

TEST_F(HeatInScenes, Messages) {
  const std::vector<std::pair<std::string, std::string>> table{
      {"temperature: {model: heat, back: opne}", "did you mean 'open'?"},
      {"temperature: {model: heat, back: ground, back_k: 290}", "without heat capacity"},
      {"temperature: {model: heat, convection: mcadam}", "did you mean 'mcadams'?"},
      {"temperature: {model: heat, convection: none, wetness: 0.5}", "asks for air"},
      {"temperature: {model: heat, wetness: 2}", "wetness"},
      {"temperature: {model: heat, emissivity: 1.5}", "emissivity"},
      {"temperature: {model: heat, wetnes: 0.5}", "wetnes"},
      {"temperature: {model: heat, thickness_m: 0.1}", "the one layer needs"},
      {"temperature: {model: heat, table: [[0, 280], [1, 290]]}", "takes no table"},
      {"thermal: {layers: [{thickness_m: 0.1, density_kg_m3: 2000, specific_heat_j_kg_k: 900, conductivity_w_m_k: "
       "-1}]}, temperature: {model: heat}",
       "conductivity"},
      {"thermal: {layers: [{thickness_m: 0, density_kg_m3: 2000, specific_heat_j_kg_k: 900, conductivity_w_m_k: "
       "1}]}, temperature: {model: heat}",
       "thickness_m"}};
  for (const auto& [text, says] : table)
    EXPECT_THAT(told(text), AllOf(HasSubstr("s.yaml:4:"), HasSubstr(says))) << text;
}

// What a class map does not cover is as its first material, which was as cold as space there.
TEST_F(HeatInScenes, BesideAClassMapItsFirstMaterialHoldsAndIsAsWarm) {
  write_file(folder_ / "one.pgm", std::string_view("P2\n1 1\n255\n7\n"));
  const auto baked = [&](const std::string& first, const std::string& own) {
    const Scene s = bake_text(
        "scene: 1\nmaterials:\n  first: {model: lambert, reflectance: 0.2, " + first + "}\n  chosen: {" + own +
        "map: which}\nmaps:\n  which: {type: class, file: one.pgm, materials: {7: first}, projection: drape, "
        "drape: {origin: [0, 0], gsd: 1, extend: none}}\nobjects:\n  tri: {obj: tri.obj, materials: {grey: "
        "chosen}}\nworld:\n  - {place: tri}\n");
    EXPECT_TRUE(report_.ok()) << report_.text();
    return s;
  };
  const Scene warm = baked("temperature_k: 300", "");
  EXPECT_EQ(warm.materials.at(1).surface.model, "lambert");
  EXPECT_EQ(warm.materials.at(1).temperature_k, 300);
  EXPECT_EQ(baked("temperature_k: 300", "temperature_k: 280, ").materials.at(1).temperature_k, 280);
  EXPECT_EQ(baked("temperature_k: 300", "model: lambert, reflectance: 0.1, ").materials.at(1).temperature_k, 0);
  const Scene heated = baked("temperature: {table: [[0, 280], [9, 290]]}", "");
  ASSERT_EQ(heated.temperatures.size(), 2u);
  EXPECT_EQ(heated.temperatures[1].material, 1u);
  EXPECT_EQ(heated.temperatures[1].spec.times, heated.temperatures[0].spec.times);
}

}  // namespace
}  // namespace suite::format_scene_text_heat_test
