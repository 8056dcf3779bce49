// Damaged pictures in memory, as models bring them.
#include "formats/raster/raster.h"
#include "support/fuzz.h"

namespace suite::format_raster_picture_test {
namespace {

void read_and_check(std::span<const std::byte> bytes) {
  const Raster r = read_picture(bytes, "fuzz", 1 << 22);
  if (r.values.size() != size_t{r.width} * r.height * r.channels) throw std::runtime_error("pixels are missing");
  for (const float v : r.values)
    if (!(v >= 0 && v <= 1)) throw std::runtime_error("a value beyond 0 to 1 came out");
}

TEST(FuzzPicture, Png) {
  test::fuzz(read_bytes(SUITE_SOURCE_DIR "/sample_scenes/calibration_range/landcover.png"), read_and_check, 1, 200);
}
TEST(FuzzPicture, Jpeg) {
  test::Bytes jpeg = read_bytes(SUITE_SOURCE_DIR "/sample_scenes/crossing/picture.jpg");
  test::fuzz(jpeg, read_and_check, 2, 200);
}

}  // namespace
}  // namespace suite::format_raster_picture_test
