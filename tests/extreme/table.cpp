#include <chrono>
#include <cmath>

#include "extreme/case.h"

namespace suite::extreme {

Outcome measure(const Case& c, const Numerics& numerics) {
  const auto start = std::chrono::steady_clock::now();
  Outcome o;
  o.error = c.error(numerics, c.sweep.from);
  o.held = o.error <= c.bound;  // false for NaN
  o.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return o;
}

double limit_of(const Case& c, const Numerics& numerics, bool& reaches_end) {
  reaches_end = false;
  const bool up = c.sweep.to > c.sweep.from;
  double last = 0;
  for (double x = c.sweep.from;; x = up ? x * c.sweep.factor : x / c.sweep.factor) {
    const bool beyond = up ? x > c.sweep.to * (1 + 1e-9) : x < c.sweep.to * (1 - 1e-9);
    if (beyond) {
      reaches_end = true;
      return last;
    }
    if (!(c.error(numerics, x) <= c.bound)) return last;
    last = x;
  }
}

std::vector<Case> all_cases() {
  std::vector<Case> all;
  for (auto* make : {quantity_cases, optics_cases, scene_cases, motion_cases, thermal_cases, media_cases, air_cases,
                     water_cases, heat_cases, polarisation_cases, lidar_cases, night_cases})
    for (Case& c : make()) all.push_back(std::move(c));
  return all;
}

}  // namespace suite::extreme
