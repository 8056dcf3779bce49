#include "formats/tensor_file/tensor_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace suite {

namespace {

constexpr size_t kTypeSize[12] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};

}  // namespace

TensorFile::TensorFile(std::span<const std::byte> bytes, const std::string& file) : reader_(bytes, file) {
  const auto magic = bytes.size() >= 12 ? reader_.take(12, "the magic") : std::span<const std::byte>{};
  if (magic.empty() || std::memcmp(magic.data(), "tensor_file\0", 12) != 0) {
    reader_.seek(0, "the start");
    throw reader_.error("is not a tensor file: the magic is missing",
                        "RGL's .bsdf files and .pbsdf files start with 'tensor_file'");
  }
  const int major = reader_.get<uint8_t>("the version"), minor = reader_.get<uint8_t>("the version");
  if (major != 1 || minor != 0)
    throw reader_.error(strf("tensor file version %d.%d is unknown", major, minor), "version 1.0 is read");
  const uint32_t n = reader_.get<uint32_t>("the number of fields");
  // The smallest field header has 13 bytes.
  if (n > reader_.left() / 13) throw reader_.error(strf("declares %u fields, more than the file can hold", n));
  for (uint32_t i = 0; i < n; ++i) read_field();
}

const TensorFile::Field& TensorFile::field(const std::string& name, Type type, size_t rank,
                                           const std::string& hint) const {
  const auto found = fields_.find(name);
  if (found == fields_.end()) throw fault(0, "field '" + name + "' is missing", hint);
  const Field& f = found->second;
  if (f.type != type) throw fault(f.offset, strf("field '%s' has type %d, expected %d", name.c_str(), f.type, type));
  if (f.shape.size() != rank)
    throw fault(f.offset, strf("field '%s' has %zu dimensions, expected %zu", name.c_str(), f.shape.size(), rank));
  if (f.count == 0) throw fault(f.offset, "field '" + name + "' is empty");
  return f;
}

std::vector<float> TensorFile::floats(const std::string& name, const Field& f, Missing missing) {
  reader_.seek(f.offset, name.c_str());
  std::vector<float> v = reader_.get_many<float>(f.count, name.c_str());
  const auto bad = std::find_if(
      v.begin(), v.end(), [&](float x) { return !std::isfinite(x) && !(missing == Missing::keep && std::isnan(x)); });
  if (bad != v.end())
    throw fault(f.offset + 4 * static_cast<size_t>(bad - v.begin()),
                strf("field '%s' holds a value that is not finite", name.c_str()));
  return v;
}

std::vector<uint16_t> TensorFile::words(const std::string& name, const Field& f) {
  reader_.seek(f.offset, name.c_str());
  return reader_.get_many<uint16_t>(f.count, name.c_str());
}

std::string TensorFile::bytes(const std::string& name, const Field& f) {
  reader_.seek(f.offset, name.c_str());
  const auto raw = reader_.take(f.count, name.c_str());
  return std::string(reinterpret_cast<const char*>(raw.data()), raw.size());
}

Error TensorFile::fault(size_t offset, std::string what, std::string hint) const {
  return Error(Where{reader_.file(), 0, 0, {}, static_cast<long long>(offset)}, std::move(what), std::move(hint));
}

void TensorFile::read_field() {
  const size_t length = reader_.get<uint16_t>("a field name");
  const auto raw = reader_.take(length, "a field name");
  const std::string name(reinterpret_cast<const char*>(raw.data()), raw.size());
  const size_t rank = reader_.get<uint16_t>("a field's rank");
  Field f{reader_.get<uint8_t>("a field's type"), 0, 1, {}};
  if (f.type < 1 || f.type > 11) throw reader_.error(strf("field of unknown type %d", f.type), "types 1 to 11");
  const uint64_t offset = reader_.get<uint64_t>("a field's offset");
  f.shape = reader_.get_many<size_t>(rank, "a field's shape");
  for (const size_t s : f.shape)
    if (__builtin_mul_overflow(f.count, s, &f.count)) throw reader_.error("the shape of a field overflows");
  if (offset > reader_.size() || f.count > (reader_.size() - offset) / kTypeSize[f.type])
    throw reader_.error("a field's data lie beyond the end of the file",
                        strf("it has %zu bytes; is it complete?", reader_.size()));
  f.offset = offset;
  if (!fields_.emplace(name, f).second) throw reader_.error("a field is given twice");
}

}  // namespace suite
