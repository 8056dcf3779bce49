// Small vectors that the compiler keeps in registers, and memory that is not cleared before it is written. Internal to
// libs/sqt. Integer lanes and unfused float lanes give the same bits on every machine.
#pragma once
#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>
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

// A vector whose memory this thread uses again for the next one with the same Tag, unless it is large: what a decoder
// needs on the way would otherwise be taken from and given back to the system for every file.
template <class V, class Tag>
class Lent : public V {
 public:
  Lent() : V(std::move(kept())) { V::clear(); }
  Lent(const Lent&) = delete;
  Lent& operator=(const Lent&) = delete;
  ~Lent() {
    constexpr size_t kMost = 32 << 20;
    if (V::capacity() * sizeof(typename V::value_type) <= kMost) kept() = std::move(static_cast<V&>(*this));
  }

 private:
  static V& kept() {
    static thread_local V v;
    return v;
  }
};

// Numbers of a row, filled up to whole vectors of sixteen.
constexpr size_t padded_row(size_t n) { return (n + 15) / 16 * 16; }

}  // namespace suite::sqt
