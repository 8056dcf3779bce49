// What stored numbers stand for: as the file has them, with its scale, offset and mark of missing values beside them.
// Values: written into the files by their makers (GDAL for the TIFFs, pgm(5) for portable maps).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/files.h"
#include "formats/raster/raster.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::format_raster_numbers_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kData = SUITE_SOURCE_DIR "/tests/data/raster/";

TEST(RasterNumbers, ScaleAndOffsetOfGdalsTag) {
  Raster r = read_raster(kData + "dem_scaled.tif");
  ASSERT_EQ(r.numbers.size(), 1u);
  EXPECT_EQ(r.numbers[0].scale, 0.01);
  EXPECT_EQ(r.numbers[0].offset, 50);
  EXPECT_EQ(r.values[0], 1000);
  EXPECT_EQ(r.scale_z, 0);
  const std::vector<float> values = values_of(std::move(r), Numbers::scaled);
  for (size_t i = 0; i < 5; ++i) EXPECT_FLOAT_EQ(values[i], 60 + static_cast<float>(i)) << i;
  EXPECT_EQ(read_raster(kData + "dem_scale_z.tif").scale_z, 0.01);
}

TEST(RasterNumbers, MarksBecomeGapsBeforeTheyAreScaled) {
  Raster r{3, 1, 1, true, {-9999, 0, 100}, {{0.01, 50}}, -9999.0, 0};
  EXPECT_TRUE(is_no_data(r, -9999));
  const std::vector<float> values = values_of(Raster(r), Numbers::scaled);
  EXPECT_TRUE(std::isnan(values[0]));
  EXPECT_FLOAT_EQ(values[1], 50);
  EXPECT_FLOAT_EQ(values[2], 51);
  EXPECT_FLOAT_EQ(values_of(std::move(r), Numbers::stored)[2], 100);
}

TEST(RasterNumbers, PortableMapsOfAnyGreatestValue) {
  const TempFolder folder;
  const auto read = [&](const std::string& bytes) {
    write_file(folder / "a.pgm", bytes);
    return read_raster(folder / "a.pgm").values;
  };
  EXPECT_THAT(read("P2\n# a comment\n4 1\n3\n0 1 2 3\n"), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(read("P2 4 1 1000 0 1 2 1000"), ElementsAre(0, 1, 2, 1000));
  EXPECT_THAT(read(std::string("P5\n4 1\n3\n\0\1\2\3", 13)), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(read(std::string("P5 2 1 4095\n\x0f\xff\0\x64", 16)), ElementsAre(4095, 100));
  EXPECT_THAT(read("P3 1 1 7 1 2 7"), ElementsAre(1, 2, 7));
  EXPECT_THAT(read(std::string("P6 1 1 31\n\1\2\x1f", 13)), ElementsAre(1, 2, 31));
  const auto said = [&](const std::string& bytes) { return message_of([&] { read(bytes); }); };
  EXPECT_THAT(said("P2 4 1 3 0 1 2 4"), HasSubstr("value 3 is 4, beyond the greatest value 3"));
  EXPECT_THAT(said("P5 4 4 255\nabc"), HasSubstr("declares 4 x 4 pixels in"));
  EXPECT_THAT(said("P2 4 1 3 0 1 2  "), HasSubstr("its value is no whole number"));
  EXPECT_THAT(said("P5 4 1 0\nabcd"), HasSubstr("its greatest value is no whole number from 1 to 65535"));
}

TEST(RasterNumbers, FewerBitsThanTheTypeHas) {
  EXPECT_THAT(read_raster(kData + "two_bits.png").values, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(read_raster(kData + "four_bits.tif").values, ElementsAre(0, 1, 2, 15));
  EXPECT_THAT(read_raster(kData + "twelve_bits.tif").values, ElementsAre(0, 1, 2, 4095));
}

}  // namespace
}  // namespace suite::format_raster_numbers_test
