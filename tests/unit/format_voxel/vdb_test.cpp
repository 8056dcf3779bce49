// Fog volumes written with OpenVDB itself come in cell by cell, at their place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include "base/files.h"
#include "formats/voxel/voxel.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::format_voxel_vdb_test {
namespace {

using ::testing::HasSubstr;

class Vdb : public ::testing::Test {
 protected:
  Vdb() { openvdb::initialize(); }
  // Density 1 + x + 10 y + 100 z at some voxels, temperature 300 there; voxels of half a metre, index 0 at (10, 20,
  // 30).
  static openvdb::FloatGrid::Ptr grid(const std::string& name, float background, bool heat) {
    auto g = openvdb::FloatGrid::create(background);
    g->setName(name);
    g->setGridClass(openvdb::GRID_FOG_VOLUME);
    auto t = openvdb::math::Transform::createLinearTransform(0.5);
    t->postTranslate({10, 20, 30});
    g->setTransform(t);
    auto at = g->getAccessor();
    for (int z = -1; z < 2; ++z)
      for (int y = 0; y < 2; ++y)
        for (int x = 3; x < 7; ++x)
          if (x != 5) at.setValue({x, y, z}, heat ? 300.0f : 101.0f + float(x) + 10.0f * float(y) + 100.0f * float(z));
    return g;
  }
  std::string write(const openvdb::GridPtrVec& grids) {
    openvdb::io::File(folder_ / "g.vdb").write(grids);
    return folder_ / "g.vdb";
  }
  TempFolder folder_;
};

TEST_F(Vdb, CellsLieWhereTheirVoxelsAre) {
  const VoxelData g = read_vdb(write({grid("density", 0, false), grid("heat", 0, true)}), "density", "heat");
  EXPECT_THAT(g.cells, ::testing::ElementsAre(4u, 2u, 3u));
  ASSERT_EQ(g.density.size(), 24u);
  for (uint32_t k = 0; k < 3; ++k)
    for (uint32_t j = 0; j < 2; ++j)
      for (uint32_t i = 0; i < 4; ++i) {
        const size_t cell = i + 4 * (j + 2 * k);
        const bool gap = i == 2;
        EXPECT_EQ(g.density[cell], gap ? 0.0f : 101.0f + float(i + 3) + 10.0f * float(j) + 100.0f * (float(k) - 1));
        EXPECT_EQ(g.temperature[cell], gap ? 0.0f : 300.0f);
        // The middle of the cell is the place of the voxel's value.
        const Vec3 middle = g.to_local.point({i + 0.5, j + 0.5, k + 0.5});
        EXPECT_LT(length(middle - Vec3{10 + 0.5 * (i + 3.0), 20 + 0.5 * j, 30 + 0.5 * (k - 1.0)}), 1e-12);
      }
}

TEST_F(Vdb, WhatIsNoFogIsRefused) {
  const auto said = [&](const openvdb::GridPtrVec& grids, const std::string& heat = "") {
    const std::string path = write(grids);
    return message_of([&] { read_vdb(path, "density", heat); });
  };
  EXPECT_THAT(said({grid("smoke", 0, false)}), HasSubstr("has no grid 'density'; it has: smoke"));
  auto level = grid("density", 0, false);
  level->setGridClass(openvdb::GRID_LEVEL_SET);
  EXPECT_THAT(said({level}), HasSubstr("is a level set"));
  auto doubles = openvdb::DoubleGrid::create(0);
  doubles->setName("density");
  EXPECT_THAT(said({doubles}), HasSubstr("is not one of floats"));
  auto empty = openvdb::FloatGrid::create(0);
  empty->setName("density");
  EXPECT_THAT(said({empty}), HasSubstr("is empty"));
  auto negative = grid("density", 0, false);
  negative->getAccessor().setValue({4, 1, 1}, -1);
  EXPECT_THAT(said({negative}), HasSubstr("has a value of -1"));
  // Two voxels far apart cover more cells than any memory holds.
  auto wide = grid("density", 0, false);
  wide->getAccessor().setValue({1000000, 1000000, 1000000}, 1);
  EXPECT_THAT(said({wide}), HasSubstr("cells; at most 2^28"));
  auto shifted = grid("heat", 0, true);
  shifted->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
  EXPECT_THAT(said({grid("density", 0, false), shifted}, "heat"), HasSubstr("have different cells"));
}

}  // namespace
}  // namespace suite::format_voxel_vdb_test
