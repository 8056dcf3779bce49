// Small vectors that the compiler keeps in registers, and memory that is not cleared before it is written. Internal to
// libs/sqt. Integer lanes and unfused float lanes give the same bits on every machine.
#pragma once
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

namespace suite::sqt {

using Short16 = int16_t __attribute__((vector_size(32)));
using Ushort16 = uint16_t __attribute__((vector_size(32)));
using Short8 = int16_t __attribute__((vector_size(16)));
using Ushort8 = uint16_t __attribute__((vector_size(16)));
using Int8 = int32_t __attribute__((vector_size(32)));
using Uint8 = uint32_t __attribute__((vector_size(32)));
using EightFloats = float __attribute__((vector_size(32)));

template <class V>
inline V load(const void* from) {
  V v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
template <class V>
inline void store(void* to, V v) {
  std::memcpy(to, &v, sizeof v);
}

// A vector whose resize leaves new elements as they are.
template <class T>
struct Unset : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = Unset<U>;
  };
  template <class U>
  void construct(U* at) noexcept {
    ::new (static_cast<void*>(at)) U;
  }
  template <class U, class... Args>
  void construct(U* at, Args&&... args) {
    ::new (static_cast<void*>(at)) U(std::forward<Args>(args)...);
  }
};
template <class T>
using UnsetVector = std::vector<T, Unset<T>>;

// Numbers of a row, filled up to whole vectors of sixteen.
constexpr size_t padded_row(size_t n) { return (n + 15) / 16 * 16; }

}  // namespace suite::sqt
