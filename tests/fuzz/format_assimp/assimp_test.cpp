// Damaged models: findings or one Error, whatever becomes of the library that reads them.
#include "formats/assimp/assimp.h"

#include "scene/issues.h"
#include "support/fuzz.h"

namespace suite::format_assimp_assimp_test {
namespace {

void check(std::span<const std::byte> bytes, const char* file) {
  Report report(scene_issues());
  SourceModelOptions options;
  options.name = "m";
  const SourceModel model = parse_assimp(bytes, file, options, nullptr, report);
  for (const SourceModel::Part& part : model.meshes)
    for (const uint32_t v : part.mesh.indices)
      if (v >= part.mesh.positions.size()) throw std::runtime_error("an index that is not there came out");
}

void read_and_check(std::span<const std::byte> bytes) { check(bytes, "fuzz.dae"); }

const std::string kTriangle = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit meter="0.5" name="half"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g" name="tri"><mesh><source id="p"><float_array id="pa" count="9">0 0 0 2 0 0 0 0 4</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="1" material="m"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";
const std::vector<std::string> kWords{"99999999999",          "-1", " nan ",      "<p>", "</mesh>",
                                      "count=\"4000000000\"", "#g", "<polylist/>"};

// Each is read in a process of its own: fewer than elsewhere.
TEST(FuzzAssimp, Collada) { test::fuzz(test::bytes_of(kTriangle), read_and_check, 1, test::kMutations, kWords); }

// Long numbers too, which the library would read by recursion or beyond a line.
TEST(FuzzAssimp, Fbx) {
  const std::string digits(400, '7');
  test::fuzz(
      read_bytes(SUITE_SOURCE_DIR "/tests/data/models/box.fbx"), [](auto bytes) { check(bytes, "fuzz.fbx"); }, 2, 200,
      {"99999999999", "-1", "nan", "{", "}", "*4000000000", "a: ", ",", "\"", digits, "0." + digits, "1e" + digits});
}
TEST(FuzzAssimp, ThreeDs) {
  test::fuzz(
      read_bytes(SUITE_SOURCE_DIR "/tests/data/models/box.3ds"), [](auto bytes) { check(bytes, "fuzz.3ds"); }, 3, 300);
}

TEST(FuzzAssimp, WhatTheFileSaysIsDone) {
  Report report(scene_issues());
  SourceModelOptions options;
  options.name = "m";
  const SourceModel model = parse_assimp(test::bytes_of(kTriangle), "a.dae", options, nullptr, report);
  ASSERT_EQ(model.meshes.size(), size_t{1});
  // Half metres and z up: down the groups to the mesh.
  Affine3 all;
  std::string at = "m";
  while (at != model.meshes[0].name)
    for (const DraftGroup& g : model.groups)
      if (g.name == at) {
        ASSERT_EQ(g.placements.size(), size_t{1});
        all = all * g.placements[0].to_parent, at = g.placements[0].target.name;
      }
  double highest = 0;
  for (const Vec3& p : model.meshes[0].mesh.positions) highest = std::max(highest, all.point(p).z);
  EXPECT_NEAR(highest, 2, 1e-6);
}

}  // namespace
}  // namespace suite::format_assimp_assimp_test
