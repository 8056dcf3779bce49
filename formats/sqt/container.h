// The frame around an .sqt payload, shared by reader and writer; see FORMAT.md.
#pragma once
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace suite::sqt_file {

inline constexpr char kMagic[8] = {'S', 'Q', 'T', 'b', 'u', 'n', 'd', '\n'};
inline constexpr size_t kFixed = 48;  // magic 8, version u32, header length u32, payload length u64, raw length u64,
                                      // coding u32, expanded header length u32, checksum u64
enum Coding : uint32_t { plain = 0, lzma = 1 };

// CRC-64/XZ (ECMA-182 polynomial, reflected) continued from `crc` (0 to begin).
uint64_t crc64(std::span<const std::byte> bytes, uint64_t crc = 0);

// An .xz stream without check, preset 9 extreme, its dictionary no larger than the data.
std::vector<std::byte> lzma_compress(std::span<const std::byte> raw);
// Error when the stream is damaged or does not give exactly raw_size bytes; memory grows with what really comes out.
std::vector<std::byte> lzma_expand(std::span<const std::byte> packed, size_t raw_size);

template <class T>
void put(std::vector<std::byte>& to, T value) {
  const size_t at = to.size();
  to.resize(at + sizeof(T));
  std::memcpy(&to[at], &value, sizeof(T));
}

// Reads forward; ok() turns false (and zeros come out) when the bytes end.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  template <class T>
  T get() {
    T value{};
    if (left() < sizeof(T)) {
      ok_ = false;
      at_ = bytes_.size();
      return value;
    }
    std::memcpy(&value, &bytes_[at_], sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  std::span<const std::byte> take(size_t n) {
    if (left() < n) {
      ok_ = false;
      return {};
    }
    const auto part = bytes_.subspan(at_, n);
    at_ += n;
    return part;
  }
  size_t left() const { return bytes_.size() - at_; }
  size_t at() const { return at_; }
  bool ok() const { return ok_; }

 private:
  std::span<const std::byte> bytes_;
  size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace suite::sqt_file
