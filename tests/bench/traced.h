// Rays sent through a tracer in batches, as a path loop sends them, and what they took.
#pragma once
#include <span>
#include <vector>

#include "support/cpu_clock.h"
#include "trace/tracer.h"

namespace suite::bench {

struct Seen {
  double seconds = 0, distance = 0;  // of processor time; sum over the hits, m
  size_t hits = 0;
};

inline Seen trace(const Tracer& tracer, std::span<const Ray> rays, bool coherent) {
  const FlushDenormals flush;
  Seen seen;
  TraceStatistics statistics;
  std::vector<Hit> hits(64);
  const double start = test::cpu_seconds();
  for (size_t i = 0; i < rays.size(); i += 64) {
    tracer.nearest(rays.subspan(i, 64), hits, coherent, statistics);
    for (const Hit& h : hits)
      if (h.hit()) ++seen.hits, seen.distance += h.distance;
  }
  seen.seconds = test::cpu_seconds() - start;
  return seen;
}

}  // namespace suite::bench
