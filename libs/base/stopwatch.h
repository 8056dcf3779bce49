// How long ago something was, by the clock on the wall.
#pragma once
#include <chrono>

namespace suite {

using Stopwatch = std::chrono::steady_clock;
inline double seconds_since(Stopwatch::time_point t) {
  return std::chrono::duration<double>(Stopwatch::now() - t).count();
}

}  // namespace suite
