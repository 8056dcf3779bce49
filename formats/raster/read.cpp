#include <cmath>
#include <cstring>
#include <utility>

#include "base/files.h"
#include "formats/raster/images.h"
#include "formats/raster/stored.h"

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

// Grey PNGs of 1, 2 and 4 bits come stretched to 8, and their bits are not passed on; 0: no such file.
int grey_bits_of_png(const std::string& path) {
  const RandomAccessFile file(path);
  std::vector<std::byte> start(26);
  if (file.size() < start.size()) return 0;
  file.read_at(0, start);
  const auto at = [&](size_t i) { return static_cast<int>(start[i]); };
  const bool png = at(0) == 0x89 && at(1) == 'P' && at(2) == 'N' && at(3) == 'G';
  return png && at(25) == 0 && at(24) < 8 ? at(24) : 0;
}

}  // namespace

Raster read_raster(const std::string& path, size_t max_pixels) {
  const Where where{path, 0, 0, {}, -1};
  const size_t bytes = input_size(path);  // tells missing files and directories apart
  if (std::optional<Raster> map = read_portable_map(path, max_pixels)) return std::move(*map);
  Raster raster;
  ImageFacts image;
  const ImageRead read = image_calls().read(path, {}, image, [&] {
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
  if (const int bits = grey_bits_of_png(path)) image.scale = (1 << bits) - 1;
  raster.integer = image.integer;
  // The library maps unsigned integers to 0..1 and signed ones to -1..1; undo that.
  if (image.integer)
    for (float& v : raster.values) v = static_cast<float>(std::round(v * image.scale));
  read_tiff_numbers(path, raster);
  return raster;
}

Raster read_picture(std::span<const std::byte> bytes, const std::string& name, size_t max_pixels) {
  const Where where{name, 0, 0, {}, -1};
  const auto begins = [&](std::string_view with) {
    return bytes.size() > with.size() && std::memcmp(bytes.data(), with.data(), with.size()) == 0;
  };
  const bool png = begins("\x89PNG\r\n\x1a\n"), jpeg = begins("\xff\xd8\xff");
  if (!png && !jpeg) throw Error(where, "is no PNG and no JPEG", "convert the image to one of them");
  Raster raster;
  ImageFacts image;
  const ImageRead read = image_calls().read(png ? "picture.png" : "picture.jpg", bytes, image, [&] {
    check(image, where, max_pixels, bytes.size());
    raster.width = static_cast<uint32_t>(image.width);
    raster.height = static_cast<uint32_t>(image.height);
    raster.channels = static_cast<uint32_t>(image.channels);
    raster.values.resize(size_t{raster.width} * raster.height * raster.channels);
    return raster.values.data();
  });
  if (!read.opened || !read.problem.empty())
    throw Error(where, std::string("cannot be read as ") + (png ? "PNG: " : "JPEG: ") + read.problem,
                "the image is damaged");
  for (float& v : raster.values) v = v > 0 ? std::min(v, 1.0f) : 0.0f;
  return raster;
}

bool is_no_data(const Raster& raster, float stored) {
  if (!raster.no_data) return false;
  const auto mark = static_cast<float>(*raster.no_data);
  return stored == mark || (std::isnan(mark) && std::isnan(stored));
}

std::vector<float> values_of(Raster&& raster, Numbers numbers) {
  std::vector<float> values = std::move(raster.values);
  const bool scaled = numbers == Numbers::scaled && !raster.numbers.empty();
  for (size_t i = 0; i < values.size(); ++i) {
    const float v = values[i];
    const RasterNumbers n = scaled ? raster.numbers[i % raster.channels] : RasterNumbers{};
    values[i] = is_no_data(raster, v) ? NAN : scaled ? static_cast<float>(v * n.scale + n.offset) : v;
  }
  return values;
}

}  // namespace suite
