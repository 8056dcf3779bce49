// A span of simulation time.
#pragma once
#include <limits>

namespace suite {

// A span of simulation time, s; begin <= end.
struct TimeSpan {
  double begin = 0, end = 0;
  bool contains(double t) const { return t >= begin && t <= end; }
  bool operator==(const TimeSpan&) const = default;
};
inline constexpr double kEver = std::numeric_limits<double>::infinity();  // s
inline constexpr TimeSpan kAlways{-kEver, kEver};

}  // namespace suite
