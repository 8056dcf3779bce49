// The descriptors of the tables of a scene: what they say is what is checked, moved and told.
#include "scene/tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "scene/combine.h"
#include "scene/summary.h"
#include "support/message_of.h"

namespace suite::tables_test {
namespace {

using ::testing::HasSubstr;

// A row in every table but that of motions, and an index wherever there can be one.
Scene one_of_each() {
  Scene s;
  Mesh mesh;
  mesh.name = "triangle";
  mesh.positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0};
  mesh.indices = {0, 1, 2};
  mesh.parts = {{"all", 0, 1, 0}};
  s.meshes = {mesh};
  s.primitives = {{"ball", PrimitiveKind::sphere, {1}, 0}};
  s.tags = {"tag"};
  s.materials.resize(1);
  s.materials[0].id = "grey";
  s.materials[0].inside = s.materials[0].outside = 0;
  Placement of_mesh, of_group, of_primitive;
  of_mesh.material_override = 0, of_mesh.tag = 0;
  of_group.kind = TargetKind::group, of_group.target = 1;
  of_primitive.kind = TargetKind::primitive;
  s.groups = {{"world", {of_mesh, of_group}}, {"inner", {of_primitive}}};
  s.class_maps = {{"classes", 1, 1, {0}, {0}, Projection::uv, {}}};
  s.map_bindings = {{0, 0}};
  PropertyMap mixture;
  mixture.name = "mixture", mixture.width = mixture.height = 1;
  mixture.values = {1}, mixture.materials = {0};
  mixture.projection = Projection::uv;
  s.property_maps = {mixture};
  s.property_bindings = {{0, 0}};
  s.media.resize(1);
  s.grids = {{"grid", {1, 1, 1}, {}, {1}, {}, {0}, {}}};
  s.volumes = {{0, {}, kNone}};
  s.temperatures = {{0, {}}};
  s.files = {{"data", {std::byte{1}}}};
  return s;
}

// What a descriptor says of its indices is what is held to the sizes of the tables.
struct Collect {
  std::vector<std::pair<uint32_t*, std::string>>& all;
  template <class Table>
  void must(uint32_t& index) const {
    all.push_back({&index, Table::one});
  }
  template <class Table>
  void may(uint32_t& index) const {
    must<Table>(index);
  }
};

TEST(SceneTables, EveryIndexOfEveryTableIsChecked) {
  Scene s = one_of_each();
  EXPECT_EQ(message_of([&] { check_scene(s, "s.h5"); }), "no error");
  std::vector<std::pair<uint32_t*, std::string>> indices;
  std::set<std::string> tables;
  for_each_table([&]<class Table>(Table) {
    for (auto& row : s.*Table::rows)
      if constexpr (requires { Table::indices(row, Collect{indices}); }) {
        Table::indices(row, Collect{indices});
        tables.insert(Table::name);
      }
  });
  EXPECT_EQ(tables.size(), 11u);
  EXPECT_GT(indices.size(), 20u);
  for (const auto& [index, one] : indices) {
    const uint32_t before = std::exchange(*index, 1000);
    EXPECT_THAT(message_of([&] { check_scene(s, "s.h5"); }), HasSubstr("names a " + one + " that is not there"));
    *index = before;
  }
}

TEST(SceneTables, CombinedScenesHaveTheRowsOfBothAndIndicesThatHold) {
  const Scene one = one_of_each();
  const Scene both = combine_scenes({{"a", one, {}, {}}, {"b", one, translation({5, 0, 0}), {}}});
  for_each_table([&]<class Table>(Table) {
    const size_t rows = (one.*Table::rows).size();
    const size_t expected = std::is_same_v<Table, TagTable>     ? rows          // the same name is the same tag
                            : std::is_same_v<Table, GroupTable> ? 2 * rows + 1  // and a root
                                                                : 2 * rows;
    EXPECT_EQ((both.*Table::rows).size(), expected) << Table::name;
  });
  EXPECT_EQ(message_of([&] { check_scene(both, "both.h5"); }), "no error");
  EXPECT_EQ(both.temperatures[1].material, 1u);
  EXPECT_EQ(both.materials[1].inside, 1u);
  EXPECT_EQ(both.grids[1].media[0], 1u);
  EXPECT_EQ(both.volumes[1].to_world.b.x, 5);
}

TEST(SceneTables, TheSummaryTellsOfEveryTable) {
  const std::string text = summary_text(one_of_each());
  for (const char* line : {"meshes        1 with", "primitives    1", "placements    3 in 2 groups", "tags          1",
                           "materials     1", "class maps    1 with 1 pixels", "files         1", "property maps 1",
                           "media         1", "grids   1", "volumes       1", "temperatures  1"})
    EXPECT_THAT(text, HasSubstr(line));
  EXPECT_THAT(text, HasSubstr("embedded files, exact primitives, media, nested groups, property maps, voxel grids"));
}

}  // namespace
}  // namespace suite::tables_test
