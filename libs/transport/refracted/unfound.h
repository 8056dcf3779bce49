// How much of a light no way through smooth interfaces (refracted/sight.h) brings from where a straight ray towards it
// leads: what interfaces pass or reflect to and fro in more than kMostEvents meetings, as if they were parallel, at the
// first knot. Where something else is in its way that is not known. What is lost so is estimated (lost_light.h).
#pragma once
#include <optional>
#include <vector>

#include "transport/refracted/sight.h"
#include "transport/trace_request.h"

namespace suite {

class UnfoundLight {
 public:
  void clear() { lines_.clear(), begun_ = false, read_ = 0; }
  // A straight ray that is to be followed, of `distance` m (infinity allowed). number: of the caller; ascending.
  void want(size_t number, const Ray& ray, double distance);
  // The next request, to be served before the next call; false when all is known.
  bool next(RefractedSight& sight, TraceRequest& request);
  // The share of light that is not found; 0 below kNothing; nothing where another surface is in its way. Of all numbers
  // that were wanted, in their order.
  static constexpr double kNothing = 1e-5;
  std::optional<double> share(size_t number);

 private:
  struct Line {
    size_t number;
    Ray from;
    double left;  // m
    StraightLeg leg;
    std::vector<double> reflected;  // of the interfaces so far
    bool stopped = false;           // by another surface
  };
  static bool advance(RefractedSight& sight, Line& line, Hit& hit);
  std::vector<Line> lines_;
  std::vector<uint32_t> waiting_;  // of them
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
  bool begun_ = false;  // hits_ are those of waiting_
  size_t read_ = 0;
};

}  // namespace suite
