// A cursor over the bytes of a binary file that refuses, with the file and the byte, whatever the file does not hold.
// Little-endian, as all our binary formats are.
#pragma once
#include <bit>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "base/error.h"

namespace suite {

static_assert(std::endian::native == std::endian::little, "binary formats are read by copying little-endian values");

class ByteReader {
 public:
  ByteReader(std::span<const std::byte> bytes, std::string file) : bytes_(bytes), file_(std::move(file)) {}

  size_t offset() const { return offset_; }
  size_t size() const { return bytes_.size(); }
  size_t left() const { return bytes_.size() - offset_; }
  const std::string& file() const { return file_; }
  // Error when `offset` is beyond the end.
  void seek(size_t offset, const char* what) {
    if (offset > bytes_.size()) throw error(strf("%s lies at byte %zu, beyond the end", what, offset), ended());
    offset_ = offset;
  }
  // The next n bytes. Error when there are fewer.
  std::span<const std::byte> take(size_t n, const char* what) {
    if (n > left()) throw error(strf("the file ends within %s (%zu bytes wanted, %zu left)", what, n, left()), ended());
    offset_ += n;
    return bytes_.subspan(offset_ - n, n);
  }
  template <class T>
  requires std::is_arithmetic_v<T> T get(const char* what) {
    T value;
    std::memcpy(&value, take(sizeof(T), what).data(), sizeof(T));
    return value;
  }
  // n values; checked against the file before anything is allocated.
  template <class T>
  requires std::is_arithmetic_v<T> std::vector<T> get_many(size_t n, const char* what) {
    if (n > left() / sizeof(T))
      throw error(
          strf("the file ends within %s (%zu values of %zu bytes wanted, %zu bytes left)", what, n, sizeof(T), left()),
          ended());
    std::vector<T> values(n);
    if (n) std::memcpy(values.data(), take(n * sizeof(T), what).data(), n * sizeof(T));
    return values;
  }
  // A fault located at the current byte.
  Error error(std::string what, std::string hint = {}, std::string code = {}) const {
    return Error(Where{file_, 0, 0, {}, static_cast<long long>(offset_)}, std::move(what), std::move(hint),
                 std::move(code));
  }

 private:
  std::string ended() const { return strf("it has %zu bytes; is it complete?", bytes_.size()); }
  std::span<const std::byte> bytes_;
  std::string file_;
  size_t offset_ = 0;
};

}  // namespace suite
