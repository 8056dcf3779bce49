// Based on: ASPRS, "LAS Specification" 1.4-R15, 2019, and 1.2, 2008; OGC 19-008r4 for the keys of the reference system.
#include <cctype>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <optional>

#include "base/files.h"
#include "formats/las/las.h"

namespace suite {

namespace {

struct Header {
  int minor = 0;
  size_t header_bytes = 0, first_point = 0, records = 0, format = 0, point_bytes = 0, points = 0;
  Vec3 scale, offset;
};

class Reader {
 public:
  Reader(std::span<const std::byte> bytes, const std::string& file, Report& report)
      : bytes_(bytes), file_(file), report_(report) {}
  PointCloud run();

 private:
  Error fault(size_t at, const std::string& what, const std::string& hint = {}) const {
    return Error(Where{file_, 0, 0, {}, static_cast<long long>(at)}, what, hint);
  }
  // A number of the file, little end first as this machine's. Error: past the end.
  template <class T>
  T get(size_t at) const {
    if (bytes_.size() < sizeof(T) || at > bytes_.size() - sizeof(T)) throw fault(at, "the file ends here");
    T value;
    std::memcpy(&value, bytes_.data() + at, sizeof value);
    return value;
  }
  void read_header();
  void read_records();
  void keys(size_t at, size_t size);
  void well_known_text(size_t at, size_t size);
  void points();
  void check_header();

  std::span<const std::byte> bytes_;
  const std::string& file_;
  Report& report_;
  Header head_;
  PointCloud cloud_;
  Box3 all_;  // of all points, withheld ones, too
};

void Reader::read_header() {
  if (bytes_.size() < 4 || std::memcmp(bytes_.data(), "LASF", 4) != 0)
    throw fault(0, "is no LAS file", "it begins with LASF");
  const int major = get<uint8_t>(24);
  head_.minor = get<uint8_t>(25);
  if (major != 1 || head_.minor > 4) throw fault(24, strf("version %d.%d", major, head_.minor), "1.0 to 1.4 are read");
  head_.header_bytes = get<uint16_t>(94);
  const size_t least = head_.minor == 4 ? 375 : head_.minor == 3 ? 235 : 227;
  if (head_.header_bytes < least)
    throw fault(94, strf("a header of %zu bytes, version 1.%d has %zu", head_.header_bytes, head_.minor, least));
  head_.first_point = get<uint32_t>(96);
  head_.records = get<uint32_t>(100);
  const unsigned format = get<uint8_t>(104);
  if (format & 0xC0)
    throw fault(104, "the points are compressed (LAZ), which is not read here",
                "write them as LAS: 'las2las -i FILE.laz -o FILE.las', or 'pdal translate FILE.laz FILE.las'");
  constexpr size_t sizes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  if (format >= std::size(sizes)) throw fault(104, strf("point format %u", format), "0 to 10 are read");
  head_.format = format;
  head_.point_bytes = get<uint16_t>(105);
  if (head_.point_bytes < sizes[format])
    throw fault(105, strf("points of %zu bytes, format %u has %zu", head_.point_bytes, format, sizes[format]));
  head_.points = get<uint32_t>(107);
  if (head_.minor == 4)
    if (const auto more = get<uint64_t>(247); more > 0) head_.points = more;
  head_.scale = {get<double>(131), get<double>(139), get<double>(147)};
  head_.offset = {get<double>(155), get<double>(163), get<double>(171)};
  for (int c = 0; c < 3; ++c)
    if (!(std::fabs(head_.scale[c]) > 0 && std::fabs(head_.scale[c]) < 1e6 && std::fabs(head_.offset[c]) < 1e12))
      throw fault(131, strf("a scale of %g and an offset of %g", head_.scale[c], head_.offset[c]));
  if (head_.first_point < head_.header_bytes || head_.first_point > bytes_.size())
    throw fault(96, strf("points from byte %zu on, the file has %zu", head_.first_point, bytes_.size()));
  if (head_.points > (bytes_.size() - head_.first_point) / head_.point_bytes)
    throw fault(107, strf("%zu points of %zu bytes cannot be in %zu bytes", head_.points, head_.point_bytes,
                          bytes_.size() - head_.first_point));
  if (head_.points >= 0xFFFFFFFBu) throw fault(107, strf("%zu points", head_.points), "at most 2^32 - 6");
}

// Variable length records; the one with the reference system. Keys and text may both be there: they say the same.
void Reader::read_records() {
  constexpr size_t kRecord = 54;
  size_t at = head_.header_bytes;
  for (size_t r = 0; r < head_.records; ++r) {
    if (at > head_.first_point || head_.first_point - at < kRecord)
      throw fault(at, strf("record %zu of %zu lies beyond the first point", r, head_.records));
    const size_t size = get<uint16_t>(at + 20);
    if (head_.first_point - at - kRecord < size)
      throw fault(at, strf("a record of %zu bytes lies in the points", size));
    const bool projection = std::memcmp(bytes_.data() + at + 2, "LASF_Projection", 15) == 0;
    const unsigned id = get<uint16_t>(at + 18);
    if (projection && id == 34735) keys(at + kRecord, size);
    if (projection && id == 2112 && cloud_.system.empty()) well_known_text(at + kRecord, size);
    at += kRecord + size;
  }
}

// GeoTIFF's directory of keys.
void Reader::keys(size_t at, size_t size) {
  constexpr unsigned kGeographic = 2048, kProjected = 3072, kUserDefined = 32767;
  if (size < 8) return;
  const size_t count = std::min<size_t>(get<uint16_t>(at + 6), (size - 8) / 8);
  unsigned geographic = 0, projected = 0;
  for (size_t k = 0; k < count; ++k) {
    const size_t entry = at + 8 + 8 * k;
    const unsigned key = get<uint16_t>(entry), place = get<uint16_t>(entry + 2), value = get<uint16_t>(entry + 6);
    if (place != 0 || value == kUserDefined) continue;
    if (key == kGeographic) geographic = value;
    if (key == kProjected) projected = value;
  }
  if (projected || geographic) cloud_.system = strf("EPSG:%u", projected ? projected : geographic);
}

namespace {
// The first bracket of these names, with its content: NAME [ ... ]; empty = none. Blanks may stand before brackets.
std::string_view bracket(std::string_view text, std::initializer_list<std::string_view> names) {
  for (size_t at = 0; at < text.size(); ++at) {
    const bool starts = at == 0 || !(std::isalnum(static_cast<unsigned char>(text[at - 1])) || text[at - 1] == '_');
    for (const std::string_view name : names) {
      if (!starts || text.substr(at, name.size()) != name) continue;
      const size_t open = text.find_first_not_of(" \t\r\n", at + name.size());
      if (open == text.npos || text[open] != '[') continue;
      bool quoted = false;
      for (size_t end = open, depth = 0; end < text.size(); ++end) {
        if (text[end] == '"') quoted = !quoted;
        if (quoted) continue;
        depth += (text[end] == '[') - (text[end] == ']');
        if (depth == 0) return text.substr(open + 1, end - open - 1);
      }
      return text.substr(open + 1);
    }
  }
  return {};
}

// The code that a system's bracket itself has, not one of those within: AUTHORITY["EPSG","32610"], ID["EPSG",32610].
std::string own_code(std::string_view within) {
  size_t depth = 0;
  for (size_t at = 0; at < within.size(); ++at) {
    if (within[at] == ']') depth -= depth > 0;
    if (within[at] != '[') continue;
    if (++depth != 1) continue;
    const size_t name_end = within.find_last_not_of(" \t\r\n", at ? at - 1 : 0) + 1;
    const std::string_view before = within.substr(0, name_end);
    if (!before.ends_with("AUTHORITY") && !before.ends_with("ID")) continue;
    const std::string_view inside = within.substr(at + 1, within.find(']', at) - at - 1);
    const size_t epsg = inside.find("\"EPSG\"");
    if (epsg == inside.npos) continue;
    const size_t first = inside.find_first_of("0123456789", epsg);
    if (first == inside.npos) continue;
    const size_t stop = std::min(inside.find_first_not_of("0123456789", first), inside.size());
    if (stop - first <= 6) return std::string(inside.substr(first, stop - first));
  }
  return {};
}
}  // namespace

// The code of the projected (else the geographic) system. A projected one without a code of its own stays nameless: the
// codes within are those of its datum, its unit of length, its geographic system.
void Reader::well_known_text(size_t at, size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes_.data()) + at, size);
  std::string_view within = bracket(text, {"PROJCS", "PROJCRS", "BOUNDCRS"});
  if (within.empty()) within = bracket(text, {"GEOGCS", "GEOGCRS", "GEODCRS"});
  if (within.empty()) return;
  if (const std::string code = own_code(within); !code.empty()) {
    cloud_.system = "EPSG:" + code;
    return;
  }
  const size_t open = within.find('"'), close = within.find('"', open + 1);
  cloud_.system =
      close == within.npos ? std::string() : std::string(within.substr(open + 1, close - open - 1)) + " without a code";
}

void Reader::points() {
  const bool long_form = head_.format >= 6;
  const size_t kind_at = long_form ? 16 : 15;
  size_t withheld = 0;
  cloud_.places.reserve(head_.points);
  cloud_.kind.reserve(head_.points);
  for (size_t k = 0; k < head_.points; ++k) {
    const size_t at = head_.first_point + k * head_.point_bytes;
    const Vec3 place{get<int32_t>(at) * head_.scale.x + head_.offset.x,
                     get<int32_t>(at + 4) * head_.scale.y + head_.offset.y,
                     get<int32_t>(at + 8) * head_.scale.z + head_.offset.z};
    all_.grow(place);
    const unsigned flags = get<uint8_t>(at + 15);
    if (flags & (long_form ? 0x04u : 0x80u)) {
      ++withheld;
      continue;
    }
    const unsigned kind = get<uint8_t>(at + kind_at);
    cloud_.kind.push_back(static_cast<uint8_t>(long_form ? kind : kind & 0x1F));
    cloud_.places.push_back(place);
  }
  if (withheld)
    report_.add("SP706", file_,
                {Where{file_, 0, 0, {}, -1}, strf("%zu points are marked as withheld and left out", withheld)},
                withheld);
}

// What the header says of the points against the points themselves. A file that was cut, added to or re-projected by a
// program that left the header as it was is read by its points.
void Reader::check_header() {
  const auto add_finding = [&](size_t at, const std::string& what) {
    report_.add("SP709", file_, {Where{file_, 0, 0, {}, static_cast<long long>(at)}, what});
  };
  const size_t room = (bytes_.size() - head_.first_point) / head_.point_bytes;
  const bool has_more_records =
      (head_.minor >= 3 && get<uint64_t>(227) > 0) || (head_.minor == 4 && get<uint64_t>(235) > 0);
  if (room > head_.points && !has_more_records)
    add_finding(107, strf("the header counts %zu points, the file has room for %zu: those behind are not read",
                          head_.points, room));
  const uint32_t old_count = get<uint32_t>(107);
  if (head_.minor == 4 && old_count != 0 && old_count != head_.points)
    add_finding(107,
                strf("the header counts %u points in its older field and %zu in the one of version 1.4, which is taken",
                     old_count, head_.points));
  if (all_.empty()) return;
  for (int c = 0; c < 3; ++c) {
    const size_t at = 179 + 16 * static_cast<size_t>(c);
    const double high = get<double>(at), low = get<double>(at + 8), step = std::fabs(head_.scale[c]);
    if (std::fabs(high - all_.high[c]) <= 1.01 * step && std::fabs(low - all_.low[c]) <= 1.01 * step) continue;
    return add_finding(at, strf("the header says %c from %.10g to %.10g, the points are from %.10g to %.10g", "xyz"[c],
                                low, high, all_.low[c], all_.high[c]));
  }
}

PointCloud Reader::run() {
  read_header();
  read_records();
  points();
  check_header();
  return std::move(cloud_);
}

}  // namespace

PointCloud parse_las(std::span<const std::byte> bytes, const std::string& file, Report& report) {
  return Reader(bytes, file, report).run();
}

PointCloud read_las(const std::string& path, Report& report) {
  return parse_las(read_bytes(path, size_t{64} << 30), path, report);
}

}  // namespace suite
