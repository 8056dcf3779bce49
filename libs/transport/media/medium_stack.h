// The bodies of media that a place lies in. Of those that overlap the one of highest priority holds, among equals the
// one entered last; with none, the scene's ambient medium does.
//
// A surface of an object parts two sides. Crossing it takes the object's entry for the side that is left off and puts
// one for the side that is entered on, if that side has a medium; so nested, touching and overlapping bodies need no
// order. A body that is entered again before it was left (one mesh that overlaps itself, an open one that a path goes
// round) is counted, so the stack never holds more entries than there are sides of bodies. There is no limit of depth:
// the first entries stand in the object itself, more take memory, which is kept, so that copies into a stack that was
// as deep before take none. Entries are sorted by priority, then by order of entering: the last one holds. Based on: C.
// Schmidt & B. Budge, "Simple nested dielectrics in ray traced images", JGT 7(2), 2002 (priorities).
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace suite {

class MediumStack {
 public:
  static constexpr uint32_t kNothing = 0xffffffffu;

  MediumStack() = default;
  MediumStack(const MediumStack& o) { *this = o; }
  MediumStack& operator=(const MediumStack& o) {
    if (this == &o) return *this;
    if (o.size_ > room()) far_.resize(o.size_);
    std::copy_n(o.entries(), o.size_, entries());
    size_ = o.size_;
    return *this;
  }

  // side: true = behind the object's surface. medium: kNothing takes nothing on.
  void leave(uint32_t object, bool side) {
    Entry* const e = entries();
    for (size_t i = size_; i-- > 0;)
      if (e[i].object == object && e[i].side == side) {
        if (--e[i].times > 0) return;
        std::copy(e + i + 1, e + size_, e + i);
        --size_;
        return;
      }
  }
  void enter(uint32_t object, bool side, uint32_t medium, int priority) {
    if (medium == kNothing) return;
    Entry* e = entries();
    size_t at = size_;  // where it goes
    for (size_t i = size_; i-- > 0;) {
      if (e[i].object == object && e[i].side == side && e[i].medium == medium) {
        ++e[i].times;
        return;
      }
      if (e[i].priority > priority) at = i;
    }
    if (size_ == room()) grow(), e = entries();
    std::copy_backward(e + at, e + size_, e + size_ + 1);
    e[at] = {object, medium, priority, 1, side};
    ++size_;
  }
  bool holds(uint32_t object, bool side) const {
    const Entry* const e = entries();
    return std::any_of(e, e + size_, [&](const Entry& x) { return x.object == object && x.side == side; });
  }
  // Index into Scene::media, or `ambient`.
  uint32_t medium(uint32_t ambient) const { return size_ ? entries()[size_ - 1].medium : ambient; }
  // Keeps the entries for which keep(object) is true.
  template <class Keep>
  void filter(const Keep& keep) {
    Entry* const e = entries();
    size_ = static_cast<size_t>(std::remove_if(e, e + size_, [&](const Entry& x) { return !keep(x.object); }) - e);
  }
  bool empty() const { return size_ == 0; }
  size_t size() const { return size_; }
  void clear() { size_ = 0; }

 private:
  static constexpr size_t kNear = 8;
  struct Entry {
    uint32_t object, medium;
    int priority;
    uint32_t times : 31, side : 1;  // entered and not yet left
  };
  size_t room() const { return far_.empty() ? kNear : far_.size(); }
  Entry* entries() { return far_.empty() ? near_.data() : far_.data(); }
  const Entry* entries() const { return far_.empty() ? near_.data() : far_.data(); }
  void grow() {
    const bool first = far_.empty();
    far_.resize(2 * room());
    if (first) std::copy_n(near_.data(), size_, far_.data());
  }

  std::array<Entry, kNear> near_;  // in use while far_ is empty
  std::vector<Entry> far_;
  size_t size_ = 0;
};

}  // namespace suite
