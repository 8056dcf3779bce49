// Serves the requests of a path kernel with a tracer, as they come.
#pragma once
#include "transport/path_tracing.h"

namespace suite {

inline void serve(const Tracer& tracer, const TraceRequest& r, TraceStatistics& statistics) {
  if (r.kind == TraceRequest::Kind::nearest)
    tracer.nearest(r.rays, r.hits, r.coherent, statistics);
  else
    tracer.occluded(r.rays, r.distance, r.blocked, r.coherent, statistics);
}

// Takes all started paths to their ends.
inline void complete(PathTracing& kernel, const Tracer& tracer, TraceStatistics& statistics) {
  for (TraceRequest request; kernel.next(request);) serve(tracer, request, statistics);
  const TraceStatistics probing = kernel.take_statistics();
  statistics.rays += probing.rays, statistics.cycles += probing.cycles;
}

}  // namespace suite
