#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/files.h"
#include "formats/raster/raster.h"
#include "motion/scene_frame.h"
#include "scene/bake.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::terrain_test {
namespace {

using ::testing::HasSubstr;

const std::string kDem = SUITE_SOURCE_DIR "/sample_scenes/calibration_range/dem_hd_sub.tif";

SourceTerrain plain(uint32_t n, const std::function<double(double, double)>& height) {
  SourceTerrain t;
  t.width = t.height = n;
  for (uint32_t j = 0; j < n; ++j)
    for (uint32_t i = 0; i < n; ++i) t.heights.push_back(static_cast<float>(height(10.0 * i, -10.0 * j)));
  t.place = [](double i, double j, double h) { return Vec3{10 * i, -10 * j, h}; };
  return t;
}

TEST(Raster, DemCornersLieAtTheirPublishedCoordinates) {
  // gdalinfo of GDAL 3.6 prints the corners in degrees to 0.01", 0.3 m.
  const GeoReference ref = read_georeference(kDem);
  EXPECT_EQ(ref.epsg, 25832);
  const auto zone = utm_zone_of_epsg(ref.epsg);
  ASSERT_TRUE(zone.has_value());
  const auto dms = [](double d, double m, double s) { return d + m / 60 + s / 3600; };
  const struct {
    double column, row, east, north;
  } corners[] = {{0, 0, dms(8, 38, 39.02), dms(49, 25, 40.91)},
                 {0, 119, dms(8, 38, 39.72), dms(49, 24, 4.57)},
                 {198, 0, dms(8, 42, 44.76), dms(49, 25, 41.59)},
                 {198, 119, dms(8, 42, 45.33), dms(49, 24, 5.25)}};
  for (const auto& c : corners) {
    const double x = ref.to_map[0] + ref.to_map[1] * c.column + ref.to_map[2] * c.row,
                 y = ref.to_map[3] + ref.to_map[4] * c.column + ref.to_map[5] * c.row;
    const Geodetic g = geodetic_from_utm({*zone, x, y, 0});
    EXPECT_NEAR(g.longitude_deg, c.east, 0.005 / 3600 * 1.01);
    EXPECT_NEAR(g.latitude_deg, c.north, 0.005 / 3600 * 1.01);
  }
}

TEST(Raster, DemHeights) {
  const Raster r = read_raster(kDem);
  EXPECT_EQ(r.width, 198u);
  EXPECT_EQ(r.height, 119u);
  EXPECT_FALSE(r.integer);
  const auto [low, high] = std::minmax_element(r.values.begin(), r.values.end());
  EXPECT_NEAR(*low, 78, 0.5);
  EXPECT_NEAR(*high, 451, 0.5);
}

TEST(Raster, ClassMapKeepsItsNumbers) {
  const Raster r = read_raster(SUITE_SOURCE_DIR "/sample_scenes/calibration_range/landcover.png");
  EXPECT_TRUE(r.integer);
  EXPECT_EQ(r.channels, 1u);
  for (const float v : r.values) ASSERT_TRUE(v >= 1 && v <= 5 && v == std::floor(v)) << v;
}

TEST(Raster, BadFilesAreRefused) {
  const TempFolder folder;
  EXPECT_THAT(message_of([&] { read_raster(folder / "none.png"); }), HasSubstr("no such file"));
  EXPECT_THAT(message_of([&] { read_raster(folder.path()); }), HasSubstr("is a directory"));
  write_file(folder / "text.png", "hello");
  EXPECT_THAT(message_of([&] { read_raster(folder / "text.png"); }), HasSubstr("cannot be read as an image"));
  EXPECT_THAT(message_of([&] { read_georeference(folder / "text.png"); }), HasSubstr("is not a TIFF file"));
  std::vector<std::byte> dem = read_bytes(kDem);
  dem.resize(dem.size() / 2);
  write_file(folder / "half.tif", dem);
  EXPECT_THAT(message_of([&] { read_raster(folder / "half.tif"); }), HasSubstr("half.tif"));
}

TEST(Terrain, HeightAtIsTheTriangulatedSurface) {
  // Heights x y are bent within a cell: the surface is the two triangles, not the bilinear patch.
  const TerrainGrid grid(plain(5, [](double x, double y) { return x * y / 100; }));
  EXPECT_DOUBLE_EQ(grid.height_at(10, -20).value(), -2);
  const std::vector<Mesh> tiles = grid.tiles("t", 1e6, 0);
  ASSERT_EQ(tiles.size(), 1u);
  // Compare with the triangles themselves at points inside each.
  const Mesh& m = tiles[0];
  for (size_t t = 0; t < m.triangle_count(); ++t) {
    Vec3 c;
    for (int k = 0; k < 3; ++k) {
      const float* p = &m.positions[3 * m.indices[3 * t + k]];
      c += (m.origin + Vec3{p[0], p[1], p[2]}) / 3;
    }
    EXPECT_NEAR(grid.height_at(c.x, c.y).value(), c.z, 1e-6);
  }
  EXPECT_FALSE(grid.height_at(-0.1, -5).has_value());
  EXPECT_FALSE(grid.height_at(5, 0.1).has_value());
  EXPECT_TRUE(grid.height_at(40, -40).has_value());
}

TEST(Terrain, GapsHaveNoTrianglesAndNoHeight) {
  const TerrainGrid grid(plain(9, [](double x, double y) { return x == 40 && y == -40 ? NAN : 1.0; }));
  EXPECT_EQ(grid.tiles("t", 1e6, 0).at(0).triangle_count(), 2 * 64u - 6);
  EXPECT_FALSE(grid.height_at(41, -40.5).has_value());
  EXPECT_DOUBLE_EQ(grid.height_at(55, -41).value(), 1);
  EXPECT_DOUBLE_EQ(grid.height_at(5, -75).value(), 1);
}

TEST(Terrain, TilesCoverTheGridOnceWithEqualSeams) {
  const TerrainGrid grid(plain(33, [](double x, double y) { return std::sin(x / 30) * 5 + y / 10; }));
  const std::vector<Mesh> tiles = grid.tiles("t", 100, 0);
  EXPECT_EQ(tiles.size(), 16u);
  size_t triangles = 0;
  for (const Mesh& m : tiles) {
    triangles += m.triangle_count();
    EXPECT_EQ(m.normals.size(), m.vertex_count());
    for (size_t t = 0; t < m.triangle_count(); ++t) {
      const auto p = [&](int k) {
        const float* q = &m.positions[3 * m.indices[3 * t + k]];
        return Vec3{q[0], q[1], q[2]};
      };
      EXPECT_GT(cross(p(1) - p(0), p(2) - p(0)).z, 0);
    }
  }
  EXPECT_EQ(triangles, 2 * 32u * 32u);
}

}  // namespace
}  // namespace suite::terrain_test
