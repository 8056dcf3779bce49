#include <cmath>

#include "base/files.h"
#include "formats/raster/images.h"
#include "formats/raster/raster.h"

namespace suite {

namespace {

// What is declared must be sound and fit what is there: as it is when uncompressed, else by what deflate can do at best
// (1032 : 1), times eight for bits stored as bytes.
void check(const ImageFacts& image, const Where& where, size_t max_pixels, size_t bytes) {
  if (image.width < 1 || image.height < 1 || image.depth > 1 || image.channels < 1 || image.channels > 4096)
    throw Error(where, strf("an image of %d x %d x %d with %d channels", image.width, image.height, image.depth,
                            image.channels));
  const size_t pixels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  if (pixels > max_pixels) throw Error(where, strf("%zu pixels, at most %zu are accepted here", pixels, max_pixels));
  const size_t stored_bytes = pixels * static_cast<size_t>(image.channels) * image.sample_bytes;
  if (image.plain ? stored_bytes > bytes : stored_bytes / (8 * 1032) > bytes)
    throw Error(where, strf("declares %d x %d pixels in %zu bytes", image.width, image.height, bytes),
                "the file is damaged");
}

}  // namespace

Raster read_raster(const std::string& path, size_t max_pixels) {
  const Where where{path, 0, 0, {}, -1};
  const size_t bytes = input_size(path);  // tells missing files and directories apart
  Raster raster;
  ImageFacts image;
  const ImageRead read = image_calls().read(path, image, [&] {
    check(image, where, max_pixels, bytes);
    raster.width = static_cast<uint32_t>(image.width);
    raster.height = static_cast<uint32_t>(image.height);
    raster.channels = static_cast<uint32_t>(image.channels);
    raster.values.resize(size_t{raster.width} * raster.height * raster.channels);
    return raster.values.data();
  });
  if (!read.opened) throw Error(where, "cannot be read as an image: " + read.problem, "PNG and TIFF are expected");
  if (!read.problem.empty()) throw Error(where, "cannot be read: " + read.problem, "the file is damaged");
  if (image.scale == 0)
    throw Error(where, "pixels of type " + image.type, "integers of up to 32 bits, or floats, are expected");
  raster.integer = image.integer;
  // The library maps unsigned integers to 0..1 and signed ones to -1..1; undo that.
  if (image.integer)
    for (float& v : raster.values) v = static_cast<float>(std::round(v * image.scale));
  return raster;
}

}  // namespace suite
