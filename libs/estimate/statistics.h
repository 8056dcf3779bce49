// What running paths took.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "trace/tracer.h"

namespace suite {

// A sum of numbers 0 .. 2^20 that is the same in whatever order they are added: each is rounded to 2^-30, and the sum
// of these is exact up to 2^34. What is no such number counts as the nearest; NaN as 0.
class ExactSum {
 public:
  ExactSum& operator+=(double x) {
    constexpr double most = 0x1p20;
    if (x > 0) grains_ += static_cast<uint64_t>(std::min(x, most) * kGrains + 0.5);
    return *this;
  }
  ExactSum& operator+=(const ExactSum& o) {
    grains_ += o.grains_;
    return *this;
  }
  operator double() const { return static_cast<double>(grains_) / kGrains; }
  // The sum in units of 2^-30, to be stored or sent.
  uint64_t grains() const { return grains_; }
  static ExactSum of_grains(uint64_t grains) {
    ExactSum sum;
    sum.grains_ = grains;
    return sum;
  }
  bool operator==(const ExactSum&) const = default;

 private:
  static constexpr double kGrains = 0x1p30;
  uint64_t grains_ = 0;
};

// All but the cycles is a function of the paths that were run, not of the order in which statistics are merged.
struct RunStatistics {
  uint64_t paths = 0, nodes = 0, failures = 0;
  ExactSum truncated;  // sum over paths of the throughput cut at max_nodes
  ExactSum strayed;    // and of that which left bodies of media where they have no surface
  TraceStatistics trace;
  uint64_t cycles = 0;         // all cycles spent in run(), all threads; of these:
  uint64_t sensor_cycles = 0;  // asking the sensor for rays
  uint64_t path_cycles = 0;    // building paths, the ray tracer (trace.cycles) included
  uint64_t shade_cycles = 0;   // turning paths into radiance and truth, adding up
  void merge(const RunStatistics& o) {
    paths += o.paths;
    nodes += o.nodes;
    failures += o.failures;
    truncated += o.truncated;
    strayed += o.strayed;
    trace.rays += o.trace.rays;
    trace.cycles += o.trace.cycles;
    cycles += o.cycles;
    sensor_cycles += o.sensor_cycles;
    path_cycles += o.path_cycles;
    shade_cycles += o.shade_cycles;
  }
  // All but the cycles, to be stored or sent.
  static constexpr size_t kCounts = 6;
  std::array<uint64_t, kCounts> counts() const {
    return {paths, nodes, failures, truncated.grains(), trace.rays, strayed.grains()};
  }
  void add_counts(std::span<const uint64_t, kCounts> c) {
    paths += c[0], nodes += c[1], failures += c[2];
    truncated += ExactSum::of_grains(c[3]);
    trace.rays += c[4];
    strayed += ExactSum::of_grains(c[5]);
  }
};

}  // namespace suite
