#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/files.h"
#include "formats/reptran/netcdf3.h"

namespace suite {

namespace {

constexpr size_t kMostBytes = size_t{1} << 30, kMostItems = 100000;
enum Type { kByte = 1, kChar, kShort, kInt, kFloat, kDouble };

size_t size_of(int type) {
  constexpr size_t sizes[] = {0, 1, 1, 2, 4, 4, 8};
  return type >= kByte && type <= kDouble ? sizes[type] : 0;
}

// Big-endian numbers one after the other, never past the end.
class Cursor {
 public:
  Cursor(const std::vector<std::byte>& bytes, const NetCdf3& file) : bytes_(bytes), file_(file) {}
  uint64_t number(size_t width) {
    need(width);
    uint64_t value = 0;
    for (size_t i = 0; i < width; ++i) value = value << 8 | std::to_integer<uint64_t>(bytes_[at_ + i]);
    at_ += width;
    return value;
  }
  size_t count(const char* what, size_t most) {
    const uint64_t n = number(4);
    if (n > most) throw file_.fault(strf("%llu %s", static_cast<unsigned long long>(n), what));
    return static_cast<size_t>(n);
  }
  std::string name() {
    const size_t length = count("bytes in a name", 4096);
    need(length);
    std::string text(reinterpret_cast<const char*>(bytes_.data()) + at_, length);
    skip((length + 3) / 4 * 4);
    return text;
  }
  void skip(size_t width) {
    need(width);
    at_ += width;
  }

 private:
  void need(size_t width) const {
    if (width > bytes_.size() - at_) throw file_.fault("ends within its header");
  }
  const std::vector<std::byte>& bytes_;
  const NetCdf3& file_;
  size_t at_ = 0;
};

// The head of a list: how many, 0 where it is absent.
size_t list(Cursor& in, uint64_t tag, const NetCdf3& file) {
  const uint64_t found = in.number(4);
  const size_t count = in.count("items in a list", kMostItems);
  if (found != tag && !(found == 0 && count == 0)) throw file.fault("has a list of the wrong kind in its header");
  return count;
}

void skip_attributes(Cursor& in, const NetCdf3& file) {
  const size_t count = list(in, 12, file);
  for (size_t i = 0; i < count; ++i) {
    in.name();
    const size_t size = size_of(static_cast<int>(in.count("as the type of an attribute", kDouble)));
    if (size == 0) throw file.fault("has an attribute of no known type");
    in.skip((in.count("values of an attribute", kMostBytes) * size + 3) / 4 * 4);
  }
}

double value_at(const std::byte* from, int type) {
  uint64_t raw = 0;
  const size_t width = size_of(type);
  for (size_t i = 0; i < width; ++i) raw = raw << 8 | std::to_integer<uint64_t>(from[i]);
  switch (type) {
    case kByte:
      return static_cast<int8_t>(raw);
    case kShort:
      return static_cast<int16_t>(raw);
    case kInt:
      return static_cast<int32_t>(raw);
    case kFloat: {
      const auto bits = static_cast<uint32_t>(raw);
      float value;
      std::memcpy(&value, &bits, sizeof value);
      return static_cast<double>(value);
    }
    default: {
      double value;
      std::memcpy(&value, &raw, sizeof value);
      return value;
    }
  }
}

}  // namespace

NetCdf3::NetCdf3(const std::string& path) : NetCdf3(read_bytes(path, kMostBytes), path) {}
NetCdf3::NetCdf3(std::vector<std::byte> bytes, std::string name) : bytes_(std::move(bytes)), name_(std::move(name)) {
  read_header();
}

Error NetCdf3::fault(const std::string& what, const std::string& hint) const {
  return Error(Where{name_, 0, 0, {}, -1}, what, hint);
}

void NetCdf3::read_header() {
  Cursor in(bytes_, *this);
  if (bytes_.size() < 4 || std::memcmp(bytes_.data(), "CDF", 3) != 0)
    throw fault("is no classic netCDF file", "netCDF-4 becomes one by nccopy -k classic");
  in.skip(3);
  const uint64_t version = in.number(1);
  if (version != 1 && version != 2)
    throw fault(strf("is of version %d", static_cast<int>(version)), "1 and 2 are read");
  in.skip(4);  // the count of records
  std::vector<size_t> lengths(list(in, 10, *this));
  for (size_t& length : lengths) {
    in.name();
    length = in.count("as the length of a dimension", kMostBytes);
  }
  skip_attributes(in, *this);
  for (size_t count = list(in, 11, *this); count > 0; --count) {
    const std::string name = in.name();
    Variable v;
    v.count = 1;
    for (size_t n = in.count("dimensions of a variable", 1024); n > 0; --n) {
      const size_t d = in.count("as the number of a dimension", kMostItems);
      if (d >= lengths.size()) throw fault("has a variable '" + name + "' of no known dimension");
      v.shape.push_back(lengths[d]);
      v.count = lengths[d] > kMostBytes / std::max<size_t>(v.count, 1) ? kMostBytes + 1 : v.count * lengths[d];
    }
    skip_attributes(in, *this);
    v.type = static_cast<int>(in.count("as the type of a variable", kDouble));
    in.skip(4);  // its size, which follows from its shape
    v.begin = in.number(version == 1 ? 4 : 8);
    const size_t size = size_of(v.type);
    if (size == 0 || v.begin > bytes_.size() || v.count > (bytes_.size() - v.begin) / size)
      throw fault("has a variable '" + name + "' that reaches beyond its end");
    variables_[name] = v;
  }
}

const NetCdf3::Variable& NetCdf3::find(const std::string& name) const {
  const auto found = variables_.find(name);
  if (found == variables_.end()) throw fault("has no variable '" + name + "'");
  return found->second;
}

std::vector<double> NetCdf3::numbers(const std::string& name, const std::vector<size_t>& expected) const {
  const Variable& v = find(name);
  if (v.type == kChar) throw fault("has text as '" + name + "'", "numbers are expected");
  if (v.shape != expected) throw fault("has a variable '" + name + "' of another shape than expected");
  std::vector<double> out(v.count);
  for (size_t i = 0; i < v.count; ++i) out[i] = value_at(bytes_.data() + v.begin + i * size_of(v.type), v.type);
  return out;
}

std::vector<std::string> NetCdf3::strings(const std::string& name) const {
  const Variable& v = find(name);
  if (v.type != kChar || v.shape.empty()) throw fault("has no text as '" + name + "'");
  const size_t length = v.shape.back();
  std::vector<std::string> out;
  for (size_t i = 0; length > 0 && i < v.count / length; ++i) {
    std::string text(reinterpret_cast<const char*>(bytes_.data()) + v.begin + i * length, length);
    text.erase(text.find_last_not_of(std::string(" \0", 2)) + 1);
    out.push_back(std::move(text));
  }
  return out;
}

}  // namespace suite
