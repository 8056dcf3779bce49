// Based on: the format descriptions pgm(5) and ppm(5) of Netpbm: numbers from 0 to a greatest value, which is not
// always 255 or 65535; image libraries stretch them to the full range of their type.
#include <cstring>

#include "base/files.h"
#include "formats/raster/stored.h"

namespace suite {

namespace {

class Reader {
 public:
  Reader(const std::string& path, std::vector<std::byte> bytes)
      : where_{path, 0, 0, {}, -1}, bytes_(std::move(bytes)) {}

  Raster read(size_t max_pixels) {
    const char kind = static_cast<char>(bytes_[1]);
    at_ = 2;
    Raster r;
    r.channels = kind == '3' || kind == '6' ? 3 : 1;
    r.width = number("width", 1, 1u << 30);
    r.height = number("height", 1, 1u << 30);
    const uint32_t greatest = number("greatest value", 1, 65535);
    const size_t pixels = size_t{r.width} * r.height, values = pixels * r.channels;
    if (pixels > max_pixels) throw Error(where_, strf("%zu pixels, at most %zu are accepted here", pixels, max_pixels));
    r.integer = true;
    const bool binary = kind >= '5';
    const size_t size = !binary ? 2 : greatest > 255 ? 2 : 1;  // a plain value and its blank are two bytes or more
    if (binary) ++at_;                                         // one blank
    if (at_ > bytes_.size() || values > (bytes_.size() - at_ + 1) / size)
      throw Error(where_, strf("declares %u x %u pixels in %zu bytes", r.width, r.height, bytes_.size()),
                  "the file is damaged");
    r.values.reserve(values);
    for (size_t i = 0; i < values; ++i) {
      const uint32_t v = binary ? stored(size) : number("value", 0, 4294967295u);
      if (v > greatest)
        throw Error(where_, strf("value %zu is %u, beyond the greatest value %u of its header", i, v, greatest),
                    "the file is damaged");
      r.values.push_back(static_cast<float>(v));
    }
    return r;
  }

 private:
  bool blank() const { return at_ < bytes_.size() && std::strchr(" \t\r\n\v\f", static_cast<char>(bytes_[at_])); }

  uint32_t number(const char* what, uint32_t low, uint32_t high) {
    while (blank() || (at_ < bytes_.size() && static_cast<char>(bytes_[at_]) == '#')) {
      if (static_cast<char>(bytes_[at_]) == '#')
        while (at_ < bytes_.size() && static_cast<char>(bytes_[at_]) != '\n') ++at_;
      else
        ++at_;
    }
    uint64_t value = 0;
    const size_t first = at_;
    for (; at_ < bytes_.size() && at_ - first < 11; ++at_) {
      const auto c = static_cast<unsigned char>(bytes_[at_]);
      if (c < '0' || c > '9') break;
      value = 10 * value + (c - '0');
    }
    if (at_ == first || value < low || value > high)
      throw Error(Where{where_.file, 0, 0, {}, static_cast<long long>(first)},
                  strf("its %s is no whole number from %u to %u", what, low, high), "the file is damaged");
    return static_cast<uint32_t>(value);
  }

  uint32_t stored(size_t size) {
    if (at_ + size > bytes_.size()) throw Error(where_, "ends within its pixels", "the file is damaged");
    uint32_t value = 0;
    for (size_t i = 0; i < size; ++i) value = value << 8 | static_cast<uint32_t>(bytes_[at_++]);
    return value;
  }

  Where where_;
  std::vector<std::byte> bytes_;
  size_t at_ = 0;
};

}  // namespace

std::optional<Raster> read_portable_map(const std::string& path, size_t max_pixels) {
  {
    const RandomAccessFile file(path);
    std::vector<std::byte> start(3);
    if (file.size() < start.size()) return std::nullopt;
    file.read_at(0, start);
    const char kind = static_cast<char>(start[1]), next = static_cast<char>(start[2]);
    if (static_cast<char>(start[0]) != 'P' || !std::strchr("2356", kind) || !kind ||
        !(next && std::strchr(" \t\r\n#", next)))
      return std::nullopt;
  }
  return Reader(path, read_bytes(path)).read(max_pixels);
}

}  // namespace suite
