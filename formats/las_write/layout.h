// Bytes of LAS 1.4 as values put behind each other. Internal to formats/las_write.
// Based on: ASPRS, "LAS Specification 1.4 - R15", 2019.
#pragma once
#include <cstring>
#include <string>

#include "formats/las_write/las_write.h"

namespace suite::las {

inline constexpr size_t kHeader = 375, kExtendedRecord = 60;

class Bytes {
 public:
  template <class T>
  void put(T value) {
    const size_t at = all_.size();
    all_.resize(at + sizeof value);
    std::memcpy(all_.data() + at, &value, sizeof value);
  }
  // Cut or filled with zeros to `size` bytes.
  void text(const std::string& text, size_t size) {
    std::string fixed = text.substr(0, size);
    fixed.resize(size, '\0');
    all_ += fixed;
  }
  void point(Vec3 v) { put(v.x), put(v.y), put(v.z); }
  const std::string& all() const { return all_; }
  void clear() { all_.clear(); }

 private:
  std::string all_;
};

// What the header tells of the points.
struct Totals {
  uint64_t points = 0, by_number[15] = {};
  Box3 bounds;
  uint64_t packets_at = 0;  // of the internal record's header, 0 = none
};

inline int format_of(const LasSpec& s) { return s.packets == LasPackets::none ? 6 : 9; }
size_t point_bytes(const LasSpec& spec);
size_t bytes_of(LasExtra::Type type);
std::string records(const LasSpec& spec);  // variable length records, all of them
size_t record_count(const LasSpec& spec);
std::string header(const LasSpec& spec, const Totals& totals);
// The header of the extended record of packets; bytes: behind it.
std::string packets_header(uint64_t bytes);

}  // namespace suite::las
