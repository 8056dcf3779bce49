// What is baked, kept by value for as long as there is room: the least recently used goes first, what is in use stays.
#pragma once
#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>

#include "base/memory.h"

namespace suite {

// Bytes of an entry are what the heap grew by while it was made; what other threads take at the same time counts, too,
// which makes entries leave sooner, never results differ. For one thread at a time.
class KitCache {
 public:
  enum class Kind : uint8_t { optics, lights, lights_at, bands };
  // What an entry was made from. state: number of a spectral state, equal for equal values (items.h).
  struct Key {
    Kind kind;
    size_t state;
    const void* of = nullptr;  // tracer or sensor; an entry keeps what it names alive, or names what outlives the cache
    double at = 0;             // moment, s, or number of the sensor's state
    auto operator<=>(const Key&) const = default;
  };

  explicit KitCache(size_t budget) : budget_(static_cast<double>(budget)) {}

  // The entry of a key, made by make() -> shared_ptr<const T> when there is none.
  template <class T, class Make>
  std::shared_ptr<const T> get(const Key& key, const Make& make) {
    if (const auto known = entries_.find(key); known != entries_.end()) {
      known->second.used = ++clock_;
      return std::static_pointer_cast<const T>(known->second.value);
    }
    const double before = heap_in_use();
    std::shared_ptr<const T> made = make();
    const double bytes = std::max(0.0, heap_in_use() - before);
    entries_[key] = {made, bytes, ++clock_};
    bytes_ += bytes;
    make_room();
    return made;
  }
  bool has(const Key& key) const { return entries_.contains(key); }
  // Gives up all that belongs to a state.
  void drop(size_t state);

  double bytes() const { return bytes_; }
  size_t held(Kind kind) const;

 private:
  struct Entry {
    std::shared_ptr<const void> value;
    double bytes = 0;
    uint64_t used = 0;
  };
  void make_room();
  double budget_, bytes_ = 0;
  uint64_t clock_ = 0;
  std::map<Key, Entry> entries_;
};

}  // namespace suite
