// A span of simulation time.
#pragma once

namespace suite {

// A span of simulation time, s; begin <= end.
struct TimeSpan {
  double begin = 0, end = 0;
  bool contains(double t) const { return t >= begin && t <= end; }
};

}  // namespace suite
