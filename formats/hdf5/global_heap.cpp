#include "formats/hdf5/global_heap.h"

#include <cstdint>
#include <cstring>
#include <string_view>

#include "base/mapped_file.h"

namespace suite::h5 {

namespace {

constexpr size_t kHeader = 16;  // of a heap, and of an object in it
constexpr size_t kAligned = 8;
constexpr std::string_view kHeap("GCOL\1\0\0\0", 8);  // with its version; the library reads no other

template <class T>
T at(std::span<const std::byte> bytes, size_t place) {
  T value;
  std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

// Of a heap that begins at `begin`.
std::optional<size_t> broken_object(std::span<const std::byte> bytes, size_t begin) {
  const auto size = at<uint64_t>(bytes, begin + 8);
  if (size < kHeader || size > bytes.size() - begin) return begin;
  const size_t end = begin + size;
  for (size_t object = begin + kHeader; object + kHeader <= end;) {
    const auto index = at<uint16_t>(bytes, object);
    const auto length = at<uint64_t>(bytes, object + 8);
    if (length > end - object) return object;
    // What is free counts its header in its length.
    const uint64_t need = index == 0 ? length : kHeader + (length + kAligned - 1) / kAligned * kAligned;
    if (need == 0 || need > end - object) return object;
    object += need;
  }
  return std::nullopt;
}

}  // namespace

std::optional<size_t> broken_global_heap(std::span<const std::byte> bytes) {
  // In damaged files they need not lie at multiples of eight.
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (size_t i = text.find(kHeap); i != std::string_view::npos && i + kHeader <= text.size();
       i = text.find(kHeap, i + 1))
    if (const auto broken = broken_object(bytes, i)) return broken;
  return std::nullopt;
}

std::optional<size_t> broken_global_heap(const std::string& path) {
  const MappedFile file(path);
  return broken_global_heap({file.data(), file.size()});
}

}  // namespace suite::h5
