// What a path kernel and its techniques ask of the tracer: rays out, hits in. Neither calls it, so that queues, packets
// and the order of rays are the business of serve.h. Media and contacts trace rays of their own (README.md says which).
#pragma once
#include <span>

#include "trace/tracer.h"

namespace suite {

struct TraceRequest {
  enum class Kind : uint8_t { nearest, occluded } kind = Kind::nearest;
  std::span<const Ray> rays;
  bool coherent = false;             // neighbours in the list run alongside each other
  std::span<Hit> hits;               // nearest: filled
  std::span<const double> distance;  // occluded: how far to look, m
  std::span<uint8_t> blocked;        // occluded: filled
};

}  // namespace suite
