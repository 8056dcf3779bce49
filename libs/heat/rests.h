// Intervals of rest: times through which all that moves, comes or goes rests where it is, so that what paths find of it
// holds through one. What moves in one, or has no rest that is long enough, takes no part in the exchange meanwhile.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "motion/time_span.h"
#include "trace/tracer.h"

namespace suite {

// span: s; those of all intervals follow each other. still: the part of it in which nothing begins or ends to rest.
struct RestInterval {
  TimeSpan span, still;
  bool operator==(const RestInterval&) const = default;
};

// What an object does in the tracer's window, one after the other: it is not there, is there and rests, or moves.
struct RestRun {
  enum class Kind { away, rests, moves } kind;
  TimeSpan span;
};
std::vector<RestRun> rest_runs(const Tracer& tracer, uint32_t object);

// Those of the tracer's window: they change where anything begins or ends a rest, or an absence, of `least` (s, > 0) or
// longer; changes closer than half of that are taken as one, in their middle. None when there are no such.
std::vector<RestInterval> rest_intervals(const Tracer& tracer, double least);

// Where an object stands in each of the intervals: the place of a time (s). Where it does not rest this is that of the
// rest before, or of the first one.
struct RestPlaces {
  std::vector<double> time;
  std::vector<bool> rests;
  size_t home = 0;  // the first interval in which it rests
};
// Nothing when it rests in none of them.
std::optional<RestPlaces> rest_places(const Tracer& tracer, uint32_t object, std::span<const RestInterval> intervals);
// Whether it is ever anywhere else.
bool changes_place(const Tracer& tracer, uint32_t object);

// For how much of a span an object is there, 0 to 1.
double share_there(const Tracer& tracer, uint32_t object, TimeSpan span);

// The interval of a time: the nearest one's of others.
size_t interval_of(std::span<const RestInterval> intervals, double time);
// How much of each moment is of an interval: of the hats by which values are straight between moments (s, ascending),
// [interval][moment]; they sum to 1 over the intervals. Of no intervals: one, of all.
std::vector<std::vector<float>> interval_shares(std::span<const RestInterval> intervals,
                                                const std::vector<double>& moments);

// What does not rest all the time, as sentences: what moves, from when until when. At most `most` things by name.
std::vector<std::string> motion_sentences(const Tracer& tracer, std::span<const RestInterval> intervals,
                                          size_t most = 5);

// Where things are that change: paths that do not pass there are the same in all intervals.
class ChangingRoom {
 public:
  ChangingRoom(const Tracer& tracer, std::span<const RestInterval> intervals);
  // Whether a ray is in it anywhere up to a distance (m, infinity allowed).
  bool meets(const Ray& ray, double distance) const;

 private:
  std::vector<Box3> boxes_;
  Box3 all_;
};

}  // namespace suite
