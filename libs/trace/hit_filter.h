// Lets surfaces have holes: whoever knows about materials decides whether a ray takes notice of what it meets.
#pragma once
#include "trace/tracer.h"

namespace suite {

// Asked in any order, from many threads, and perhaps twice for the same pair: the answer must be a function of the ray
// and the surface alone, so that nearest hits and visibility agree and no order of traversal shows.
class HitFilter {
 public:
  virtual ~HitFilter() = default;
  // Whether the object may have holes; the others are never asked about and cost nothing.
  virtual bool concerns(const TracedObject& object) const = 0;
  // hit: position, object, triangle, u and v are set, and of exact surfaces the normal (any length, either sense),
  // which tells where a ray goes in from where it comes out. False: the ray passes through.
  virtual bool keeps(const Ray& ray, const TracedObject& object, const Hit& hit) const = 0;
};

}  // namespace suite
