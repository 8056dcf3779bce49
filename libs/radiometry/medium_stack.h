// The bodies of media that a place lies in: entered ones, in the order of entering. Of those that overlap the one of
// highest priority holds, among equals the one entered last; with none, the scene's ambient medium does.
//
// A surface of an object parts two sides. Crossing it takes the object's entry for the side that is left off and puts
// one for the side that is entered on, if that side has a medium; so nested, touching and overlapping bodies need no
// order. Assumes: at most kDeepest bodies at one place; the bodies beyond are not seen. Based on: C. Schmidt & B.
// Budge, "Simple nested dielectrics in ray traced images", JGT 7(2), 2002 (priorities).
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace suite {

class MediumStack {
 public:
  static constexpr uint32_t kNothing = 0xffffffffu;
  static constexpr size_t kDeepest = 12;

  // side: true = behind the object's surface. medium: kNothing takes nothing on.
  void leave(uint32_t object, bool side) {
    for (size_t i = size_; i-- > 0;)
      if (entries_[i].object == object && entries_[i].side == side) {
        for (size_t j = i + 1; j < size_; ++j) entries_[j - 1] = entries_[j];
        --size_;
        return;
      }
  }
  void enter(uint32_t object, bool side, uint32_t medium, int priority) {
    if (medium != kNothing && size_ < kDeepest) entries_[size_++] = {object, medium, priority, side};
  }
  bool holds(uint32_t object, bool side) const {
    for (size_t i = 0; i < size_; ++i)
      if (entries_[i].object == object && entries_[i].side == side) return true;
    return false;
  }
  // Index into Scene::media, or `ambient`.
  uint32_t medium(uint32_t ambient) const {
    if (!size_) return ambient;
    size_t best = 0;
    for (size_t i = 1; i < size_; ++i)
      if (entries_[i].priority >= entries_[best].priority) best = i;
    return entries_[best].medium;
  }
  // Keeps the entries for which keep(object) is true.
  template <class Keep>
  void filter(const Keep& keep) {
    size_t n = 0;
    for (size_t i = 0; i < size_; ++i)
      if (keep(entries_[i].object)) entries_[n++] = entries_[i];
    size_ = n;
  }
  bool empty() const { return size_ == 0; }
  void clear() { size_ = 0; }

 private:
  struct Entry {
    uint32_t object, medium;
    int priority;
    bool side;
  };
  std::array<Entry, kDeepest> entries_;
  size_t size_ = 0;
};

}  // namespace suite
