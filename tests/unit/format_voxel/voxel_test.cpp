// The voxel format, and cells of materials as cubes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "base/files.h"
#include "formats/voxel/voxel.h"
#include "scene/voxel_mesh.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::format_voxel_voxel_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class VoxelFile : public ::testing::Test {
 protected:
  VoxelData read(const std::string& text) {
    write_file(folder_ / "g.vox", text);
    return read_voxels(folder_ / "g.vox");
  }
  std::string fault(const std::string& text) {
    return message_of([&] { read(text); });
  }
  TempFolder folder_;
};

TEST_F(VoxelFile, ValuesFilesAndFrames) {
  write_file(folder_ / "d.u8", std::string("\1\2\3\4"));
  const VoxelData g = read(
      "voxels: 1\ncells: [2, 1, 2]\ncell_m: [0.5, 1, 2]\norigin_m: [10, 0, -1]\nfields: {density: {file: d.u8, type: "
      "uint8, scale: 0.5, offset: 1}, temperature_k: 300, medium: {values: [0, 1, 1, 0]}}\n");
  EXPECT_THAT(g.density, ElementsAre(1.5f, 2.0f, 2.5f, 3.0f));
  EXPECT_THAT(g.temperature, ElementsAre(300, 300, 300, 300));
  EXPECT_THAT(g.medium, ElementsAre(0, 1, 1, 0));
  EXPECT_EQ(g.to_local.point({2, 1, 2}), (Vec3{11, 1, 3}));
  EXPECT_THAT(g.raw_files, ElementsAre("d.u8"));
}

TEST_F(VoxelFile, FaultsAreLocated) {
  const std::string head = "voxels: 1\ncells: [2, 1, 1]\ncell_m: 1\n";
  EXPECT_THAT(fault(head + "fields: {density: {values: [1]}}\n"), HasSubstr("1 values, the grid has 2 cells"));
  EXPECT_THAT(fault(head + "fields: {density: {values: [1, -2]}}\n"), HasSubstr("cell 1 has a density of -2"));
  EXPECT_THAT(fault(head + "fields: {medium: {values: [1, 0.5]}}\n"), HasSubstr("cell 1 has a medium of 0.5"));
  EXPECT_THAT(fault(head + "fields: {density: {file: none.raw}}\n"), HasSubstr("none.raw"));
  EXPECT_THAT(fault(head + "fields: {temperature_k: 3}\n"), HasSubstr("the grid holds nothing"));
  EXPECT_THAT(fault(head + "fields: {densty: 1}\n"), HasSubstr("densty"));
  EXPECT_THAT(fault("voxels: 1\ncells: [1000000, 1000000, 1000000]\ncell_m: 1\nfields: {density: 1}\n"),
              HasSubstr("at most 2^31"));
  EXPECT_THAT(fault("voxels: 1\ncells: [1, 1, 1]\ncell_m: 0\nfields: {density: 1}\n"), HasSubstr("a cell of 0 m"));
  write_file(folder_ / "short.raw", std::string(7, 'x'));
  EXPECT_THAT(fault(head + "fields: {density: {file: short.raw}}\n"), HasSubstr("has 7 bytes, the grid needs 8"));
}

// Signed volume of a closed mesh, by the divergence theorem.
double volume(const SourceMesh& m) {
  double sum = 0;
  for (size_t i = 0; i < m.indices.size(); i += 3)
    sum += dot(m.positions[m.indices[i]], cross(m.positions[m.indices[i + 1]], m.positions[m.indices[i + 2]])) / 6;
  return sum;
}

TEST(VoxelFaces, CubesOfTwoMaterials) {
  // Three cells in a row, 7, 9, empty: the face between 7 and 9 is inside.
  const std::vector<uint16_t> cells{7, 9, 0};
  const SourceMesh m = voxel_faces({3, 1, 1}, scaling({2, 1, 1}), cells, {7, 9});
  EXPECT_EQ(m.indices.size() / 3, 2u * 10);
  ASSERT_EQ(m.runs.size(), 2u);
  EXPECT_EQ(m.runs[0].material, "7");
  EXPECT_EQ(m.runs[1].first_triangle, 10u);
  EXPECT_DOUBLE_EQ(volume(m), 4);
  EXPECT_EQ(m.positions.size(), 12u);
  EXPECT_DOUBLE_EQ(volume(voxel_faces({3, 1, 1}, {}, cells, {0, 7, 9})), 3);
  EXPECT_TRUE(voxel_faces({3, 1, 1}, {}, cells, {5}).indices.empty());
}

TEST_F(VoxelFile, SharesOfSeveralMedia) {
  const VoxelData g = read(
      "voxels: 1\ncells: [2, 1, 1]\ncell_m: 1\nfields: {density: 2, shares: [{values: [0.25, 1]}, {values: [0.5, "
      "0]}]}\n");
  ASSERT_EQ(g.shares.size(), 2u);
  EXPECT_THAT(g.shares[0], ElementsAre(0.25f, 1.0f));
  EXPECT_THAT(g.shares[1], ElementsAre(0.5f, 0.0f));
  EXPECT_THAT(fault("voxels: 1\ncells: [1, 1, 1]\ncell_m: 1\nfields: {shares: [-1]}\n"),
              HasSubstr("cell 0 has a share of -1"));
  EXPECT_THAT(fault("voxels: 1\ncells: [1, 1, 1]\ncell_m: 1\nfields: {shares: [1], medium: 0}\n"),
              HasSubstr("'medium' and 'shares' cannot be combined"));
}

TEST_F(VoxelFile, VdbIsRefusedInWords) {
  write_file(folder_ / "x.vdb", std::string_view("no volume at all"));
  const std::string said = message_of([&] { read_vdb(folder_ / "x.vdb", "density", ""); });
  EXPECT_THAT(said, HasSubstr("x.vdb"));
  EXPECT_THAT(said, HasSubstr(reads_vdb() ? "is no OpenVDB file" : "built without OpenVDB"));
  if (reads_vdb()) {
    EXPECT_THAT(message_of([&] { read_vdb(folder_ / "gone.vdb", "density", ""); }), HasSubstr("no such file"));
  }
}

}  // namespace
}  // namespace suite::format_voxel_voxel_test
