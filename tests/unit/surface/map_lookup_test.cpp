// Maps at points: pixels computed by hand at corners, edges and outside, for drapes and texture coordinates, every rule
// of extension and of filtering; and the table of blackbodies against Planck's law.
#include <gtest/gtest.h>

#include <cmath>

#include "spectral/blackbody_table.h"
#include "spectral/planck.h"
#include "surface/map_lookup.h"

namespace suite::map_lookup_test {
namespace {

// 3 x 2 pixels, values 10 row + column: 0 1 2 / 10 11 12.
PropertyMap raster(Projection projection, Drape::Extend extend, PropertyMap::Filter filter) {
  PropertyMap m;
  m.name = "m";
  m.kind = MapKind::temperature;
  m.width = 3, m.height = 2;
  m.values = {0, 1, 2, 10, 11, 12};
  m.projection = projection;
  m.filter = filter;
  m.drape = {100, 50, 2, 4, extend};  // x 100 to 106, y 50 down to 42
  return m;
}
using enum Drape::Extend;
constexpr auto kNearest = PropertyMap::Filter::nearest, kLinear = PropertyMap::Filter::linear;
float at(const PropertyMap& m, double x, double y) { return value_at(m, {{x, y, 7}, {x, y}}).value_or(-1); }

TEST(MapLookup, DrapedPixelsAtCornersEdgesAndOutside) {
  const PropertyMap m = raster(Projection::drape, none, kNearest);
  EXPECT_EQ(at(m, 100, 50), 0);  // outer corner of the first pixel
  EXPECT_EQ(at(m, 101.999, 46.001), 0);
  EXPECT_EQ(at(m, 102, 46.001), 1);  // edges belong to the pixel to the right and below
  EXPECT_EQ(at(m, 101.999, 46), 10);
  EXPECT_EQ(at(m, 105.999, 42.001), 12);
  EXPECT_EQ(at(m, 106, 45), -1);
  EXPECT_EQ(at(m, 99.999, 45), -1);
  EXPECT_EQ(at(m, 103, 50.001), -1);
  EXPECT_EQ(at(m, 103, 42), -1);

  const PropertyMap c = raster(Projection::drape, clamp, kNearest);
  EXPECT_EQ(at(c, -1e6, 1e6), 0);
  EXPECT_EQ(at(c, 1e6, -1e6), 12);
  EXPECT_EQ(at(c, 104.5, 1e6), 2);

  const PropertyMap r = raster(Projection::drape, repeat, kNearest);
  EXPECT_EQ(at(r, 106, 49), 0);
  EXPECT_EQ(at(r, 99.999, 49), 2);
  EXPECT_EQ(at(r, 101, 50.001), 10);
  EXPECT_EQ(at(r, 101 - 6 * 1000, 45 + 8 * 1000), 10);
}

TEST(MapLookup, GapsSayNothing) {
  for (const auto filter : {kNearest, kLinear}) {
    PropertyMap m = raster(Projection::drape, none, filter);
    m.values[1] = NAN;  // x 102 to 104, y 50 to 46
    EXPECT_EQ(at(m, 103, 48), -1);
    EXPECT_EQ(at(m, 102.001, 46.001), -1);
    EXPECT_EQ(at(m, 101, 48), 0);
    EXPECT_NEAR(at(m, 101.999, 48), 0, 1e-6);  // the gap beside it counts as the nearest pixel
    EXPECT_NEAR(at(m, 105, 48), 2, 1e-6);
  }
}

TEST(MapLookup, NegativeDistancesFlip) {
  PropertyMap m = raster(Projection::drape, none, kNearest);
  m.drape.gsd_x = -2, m.drape.gsd_y = -4;  // x 100 down to 94, y 50 up to 58
  EXPECT_EQ(at(m, 99.999, 50.001), 0);
  EXPECT_EQ(at(m, 94.001, 57.999), 12);
  EXPECT_EQ(at(m, 100.001, 52), -1);
}

TEST(MapLookup, TextureCoordinatesRunUpwards) {
  const PropertyMap m = raster(Projection::uv, none, kNearest);
  EXPECT_EQ(at(m, 0, 1), 0);
  EXPECT_EQ(at(m, 0, 0.5), 10);  // on the edge: below it in the raster
  EXPECT_EQ(at(m, 0, 0.501), 0);
  EXPECT_EQ(at(m, 1.0 / 3 + 1e-9, 0.999), 1);
  EXPECT_EQ(at(m, 0.999, 0.001), 12);
  EXPECT_EQ(at(m, 1, 0.5), -1);
  EXPECT_EQ(at(m, 0.5, 0), -1);
  EXPECT_EQ(at(raster(Projection::uv, repeat, kNearest), 1.001, -0.001), 0);
  EXPECT_EQ(at(raster(Projection::uv, clamp, kNearest), 1.5, 0.2), 12);
}

TEST(MapLookup, LinearBetweenCentres) {
  const PropertyMap m = raster(Projection::drape, none, kLinear);
  EXPECT_FLOAT_EQ(at(m, 101, 48), 0);  // centres hold their value
  EXPECT_FLOAT_EQ(at(m, 105, 44), 12);
  EXPECT_FLOAT_EQ(at(m, 102, 46), 5.5);  // the corner of four pixels: their mean
  EXPECT_FLOAT_EQ(at(m, 101.5, 47), 0.25f + 2.5f);
  EXPECT_FLOAT_EQ(at(m, 100, 50), 0);  // half a pixel at the rim is constant
  EXPECT_FLOAT_EQ(at(m, 105.9, 46), 7);
  const PropertyMap r = raster(Projection::drape, repeat, kLinear);
  EXPECT_FLOAT_EQ(at(r, 100, 48), 1);  // between the last column and the first
  EXPECT_FLOAT_EQ(at(r, 106, 48), 1);
  EXPECT_FLOAT_EQ(at(r, 101, 50), 5);
  const PropertyMap c = raster(Projection::drape, clamp, kLinear);
  EXPECT_FLOAT_EQ(at(c, 300, 46), 7);
}

TEST(MapLookup, SlopesOfARampAreExactAndContinuous) {
  PropertyMap m = raster(Projection::drape, clamp, kLinear);
  m.width = 8, m.height = 4, m.values.clear();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 8; ++column) m.values.push_back(static_cast<float>(0.5 * column - 2 * row));
  for (const double x : {102.1, 104.0, 107.3})
    for (const double y : {45.9, 42.0, 40.3}) {
      const Vec2 s = slope_at(m, {{x, y, 0}, {}});
      EXPECT_NEAR(s.x, 0.5, 1e-5);
      EXPECT_NEAR(s.y, -2, 1e-5);
    }
}

TEST(MapLookup, ChannelsTravelTogetherAndCurveNumbersAreNeverMixed) {
  PropertyMap m = raster(Projection::drape, clamp, kLinear);
  m.kind = MapKind::curve_index;
  EXPECT_EQ(at(m, 102.4, 46.5), 1);
  m.kind = MapKind::mixture, m.channels = 2, m.width = 3, m.height = 1;
  float v[2];
  ASSERT_TRUE(values_at(m, {{103, 48, 0}, {}}, v));  // centre of the middle pixel
  EXPECT_FLOAT_EQ(v[0], 2);
  EXPECT_FLOAT_EQ(v[1], 10);
}

TEST(MapLookup, ClassesAtCornersAndOutside) {
  ClassMap m;
  m.width = 2, m.height = 2, m.classes = {0, 1, 2, 3}, m.materials = {4, 5, 6, 7};
  m.drape = {0, 0, 1, 1, none};
  EXPECT_EQ(class_at(m, {{0, 0, 0}, {}}), 0u);
  EXPECT_EQ(class_at(m, {{1.5, -0.5, 0}, {}}), 1u);
  EXPECT_EQ(class_at(m, {{0.5, -1.5, 0}, {}}), 2u);
  EXPECT_EQ(class_at(m, {{1.999, -1.999, 0}, {}}), 3u);
  EXPECT_EQ(class_at(m, {{2, -1, 0}, {}}), kNone);
  EXPECT_EQ(class_at(m, {{NAN, -1, 0}, {}}), kNone);
}

TEST(BlackbodyTable, AgreesWithPlanck) {
  std::vector<Bin> bins;
  for (const double um : {0.3, 0.5, 1.0, 2.0, 4.0, 8.0, 10.0, 13.0, 50.0, 1000.0}) bins.push_back({um, um * 1.02});
  const BlackbodyTable table(bins, 1, 1e5);
  std::vector<float> got(bins.size());
  for (double kelvin = 1; kelvin < 1e5; kelvin *= 1.0137) {
    table.radiance(kelvin, got);
    for (size_t i = 0; i < bins.size(); ++i) {
      const double expected =
          planck_band_radiance(bins[i].low_um, bins[i].high_um, kelvin) / (bins[i].high_um - bins[i].low_um);
      if (expected > 1e-36) {
        EXPECT_NEAR(got[i] / expected, 1, 2e-5) << kelvin << " K, " << bins[i].low_um << " um";
      } else {
        EXPECT_LT(got[i], 2e-36);
      }
    }
  }
  const BlackbodyTable one(bins, 300, 300);  // a range of nothing
  one.radiance(300, got);
  EXPECT_NEAR(got[6], planck_band_radiance(10, 10.2, 300) / 0.2, 1e-4);
}

}  // namespace
}  // namespace suite::map_lookup_test
