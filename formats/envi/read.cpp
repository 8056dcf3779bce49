// The binary cube of an ENVI image, read in ranges of lines.
#include <bit>
#include <cstring>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "formats/envi/internal.h"

namespace suite {

static_assert(std::endian::native == std::endian::little);

namespace {

// The image that belongs to a header given by name.
std::string image_path(const std::string& path) {
  if (!path.ends_with(".hdr")) return path;
  const std::string stem = path.substr(0, path.size() - 4);
  for (const char* extension : {"", ".img", ".dat", ".bin", ".raw"})
    if (file_exists(stem + extension)) return stem + extension;
  throw Error(Where{path, 0, 0, {}, -1}, "has no image beside it", "expected " + stem + " or " + stem + ".img");
}

template <class T>
double value_at(const std::byte* p, bool swap) {
  std::byte raw[sizeof(T)];
  for (size_t i = 0; i < sizeof(T); ++i) raw[i] = p[swap ? sizeof(T) - 1 - i : i];
  T value;
  std::memcpy(&value, raw, sizeof(T));
  return static_cast<double>(value);
}

double value_at(const std::byte* p, EnviType type, bool swap) {
  switch (type) {
    case EnviType::uint8:
      return value_at<uint8_t>(p, swap);
    case EnviType::int16:
      return value_at<int16_t>(p, swap);
    case EnviType::int32:
      return value_at<int32_t>(p, swap);
    case EnviType::float32:
      return value_at<float>(p, swap);
    case EnviType::float64:
      return value_at<double>(p, swap);
    case EnviType::uint16:
      return value_at<uint16_t>(p, swap);
    case EnviType::uint32:
      return value_at<uint32_t>(p, swap);
    case EnviType::int64:
      return value_at<int64_t>(p, swap);
    case EnviType::uint64:
      return value_at<uint64_t>(p, swap);
  }
  throw Bug("ENVI type without a reader");
}

}  // namespace

struct EnviImage::Impl {
  explicit Impl(const std::string& path) : name(path), file(path) {}
  std::string name;
  RandomAccessFile file;
};

EnviImage::EnviImage(const std::string& path) : header_(read_envi_header(path)) {
  const std::string image = image_path(path);
  impl_ = std::make_unique<Impl>(image);
  const size_t expected = header_.header_offset + header_.values() * size_of(header_.type);
  if (impl_->file.size() != expected)
    throw Error(
        Where{image, 0, 0, {}, -1},
        strf("has %zu bytes, its header describes %zu (%zu samples x %zu lines x %zu bands x %zu bytes + offset %zu)",
             impl_->file.size(), expected, header_.samples, header_.lines, header_.bands, size_of(header_.type),
             header_.header_offset),
        "the image is truncated, or the header belongs to another one");
}
EnviImage::~EnviImage() = default;

void EnviImage::require_units(const std::string& units) const {
  if (header_.data_units == units) return;
  throw Error(
      Where{envi_header_path(impl_->name), 0, 0, {}, -1},
      header_.data_units.empty() ? "the key 'data units' is missing" : "data units are '" + header_.data_units + "'",
      "expected 'data units = " + units + "'");
}

std::vector<double> EnviImage::read_lines(size_t first, size_t count) const {
  const EnviHeader& h = header_;
  SUITE_CHECK(first <= h.lines && count <= h.lines - first);
  const size_t size = size_of(h.type), width = h.samples * h.bands;
  std::vector<double> values(count * width);
  const auto spread = [&](const std::vector<std::byte>& raw, size_t to, size_t stride) {
    for (size_t i = 0; i * size < raw.size(); ++i)
      values[to + i * stride] = value_at(raw.data() + i * size, h.type, h.big_endian);
  };
  if (h.interleave == Interleave::bsq) {
    // One run of `count` lines per band.
    std::vector<std::byte> raw(count * h.samples * size);
    for (size_t b = 0; b < h.bands; ++b) {
      impl_->file.read_at(h.header_offset + (b * h.lines + first) * h.samples * size, raw);
      spread(raw, b, h.bands);
    }
    return values;
  }
  std::vector<std::byte> raw(h.interleave == Interleave::bip ? width * size : h.samples * size);
  for (size_t line = 0; line < count; ++line) {
    const size_t start = h.header_offset + (first + line) * width * size;
    if (h.interleave == Interleave::bip) {
      impl_->file.read_at(start, raw);
      spread(raw, line * width, 1);
    } else {
      for (size_t b = 0; b < h.bands; ++b) {
        impl_->file.read_at(start + b * h.samples * size, raw);
        spread(raw, line * width + b, h.bands);
      }
    }
  }
  return values;
}

}  // namespace suite
