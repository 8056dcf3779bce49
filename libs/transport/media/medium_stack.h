// The bodies of media that a place lies in. Of those that overlap the one of highest priority holds, among equals the
// one entered last; with none, the scene's ambient medium does.
//
// What the stack holds. An entry is a side of a body with the medium that fills it: `inside` behind its surface,
// `outside` in front. A body is an instance, with all of its surfaces and materials. Which sides fill space (Bodies):
//   closed surface         the bounded side only. Its medium on the other side (`outside`, front sides out) names what
//                          the body lies in, for refraction; it fills nothing: another body or the ambient medium has
//                          to
//   no bounds (plane)      both: two half-spaces, for ever
//   open, with `outside`   a face that two regions share: crossing it swaps the one medium for the other, whichever
//   body
//                          brought it, and the region that begins there ends at any surface of its medium
//   open, without          behind it, until the path comes back through the same body or leaves the scene
//   no medium behind       no entry: an opaque body, or a sheet; glass by index alone: a clear medium of that index
//                          (Optics::medium_behind)
// Crossing takes the body's entry for the side that is left off and puts one for the side that is entered on; so
// nested, touching and overlapping bodies need no order. A body that is entered again before it was left (one mesh that
// overlaps itself, an open one that a path goes round) is counted, so the stack never holds more entries than there are
// sides of bodies. Bodies of equal priority that overlap in part, neither in the other, hold by the direction that a
// path comes from; scheduler/surroundings.h reports that. There is no limit of depth: the first entries stand in the
// object itself, more take memory, which is kept, so that copies into a stack that was as deep before take none.
// Entries are sorted by priority, then by order of entering: the last one holds. Based on: C. Schmidt & B. Budge,
// "Simple nested dielectrics in ray traced images", JGT 7(2), 2002 (priorities); M. Pharr et al., "Physically Based
// Rendering", 4th ed., section 11.4 (surfaces that name the media of both sides).
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

  // side: true = behind the object's surface. medium: what fills it; another one, where no entry of the side has it.
  // False when there is none.
  bool leave(uint32_t object, bool side, uint32_t medium) {
    const auto own = [&](const Entry& x) { return x.object == object && x.side == side; };
    return take_off([&](const Entry& x) { return own(x) && x.medium == medium; }) || take_off(own);
  }
  // Takes off what any body, or any shared face, has brought of a medium.
  bool leave_any(uint32_t medium) {
    return take_off([&](const Entry& x) { return x.medium == medium; });
  }
  bool leave_shared(uint32_t medium) {
    return take_off([&](const Entry& x) { return x.shared && x.medium == medium; });
  }
  // medium: kNothing takes nothing on. shared: by a face that two regions share.
  void enter(uint32_t object, bool side, uint32_t medium, int priority, bool shared = false) {
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
    e[at] = {object, medium, priority, 1, side, shared};
    ++size_;
  }
  bool holds(uint32_t object, bool side) const {
    const Entry* const e = entries();
    return std::any_of(e, e + size_, [&](const Entry& x) { return x.object == object && x.side == side; });
  }
  // Index into Optics::media, or `ambient`.
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
    uint32_t times : 30, side : 1, shared : 1;  // entered and not yet left
  };
  // The last entry of which `which` is true.
  template <class Which>
  bool take_off(const Which& which) {
    Entry* const e = entries();
    for (size_t i = size_; i-- > 0;)
      if (which(e[i])) {
        if (--e[i].times > 0) return true;
        std::copy(e + i + 1, e + size_, e + i);
        --size_;
        return true;
      }
    return false;
  }
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
