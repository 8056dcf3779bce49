// Motion as DIRSIG writes it: as tracks and jitter of ours (formats/motion/FORMAT.md).
#pragma once
#include <array>
#include <functional>

#include "formats/dirsig/import.h"

namespace suite::dirsig {

// s, for which the ends of motions and of tabulated mounts are held: no public page says what lies beyond. Bounds of
// what spins take time in proportion.
inline constexpr double kHeld = 600;

// What motions need to know of where they stand.
struct MotionPlace {
  Import& import;
  Folders folders;
  // UTC of second 0, as ISO 8601; where it is empty, the first date that a motion has becomes it.
  std::string* epoch;
};

// A `<platformmotion>` or `<motion>` of type generic or flexible. jitter: what belongs beside the track, or null where
// nothing takes it.
Tree track_of(const Item& motion, const MotionPlace& place, Tree* jitter);
// A file of delta motion (.mov).
Tree track_of_mov(const Item& mov, const MotionPlace& place);

// Position keys of a `<location>` of any frame.
void set_location(const Item& location, Tree& to);
// Seconds since second 0 of a `<datetime>`, relative or absolute.
double seconds_of(const Item& datetime, const MotionPlace& place);
// A quaternion w, x, y, z of turns about fixed axes, the first letter of `order` first. rad.
std::array<double, 4> turned(const std::array<double, 3>& angles, const std::string& order);
// `order` is three of x, y, z. Error, located.
std::string order_of(const Item* attribute);
// 1 or pi/180 of an attribute of units of angle.
double radians_of(const Item* attribute, bool degrees_unless_said);

}  // namespace suite::dirsig
