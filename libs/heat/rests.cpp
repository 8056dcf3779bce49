#include "heat/rests.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"

namespace suite {

namespace {

constexpr double kStill = 1e-6;  // m, and turns and stretches as shares: what rests may differ by
constexpr size_t kFewPieces = 64, kManyLooks = 16, kFewLooks = 4;

bool same_place(const Affine3& a, const Affine3& b) {
  for (size_t k = 0; k < 9; ++k)
    if (!(std::fabs(a.a[k] - b.a[k]) <= kStill)) return false;
  return length(a.b - b.b) <= kStill;
}

// Times within a piece: no turning body is seen in one place by all of them.
double look_at(TimeSpan piece, size_t look) {
  const double golden = (std::sqrt(5.0) - 1) / 2;
  return piece.begin + (piece.end - piece.begin) * std::fmod(golden * static_cast<double>(look + 1), 1.0);
}

struct Piece {
  RestRun run;
  Affine3 place;  // of what rests
};

Piece piece_of(const Tracer& tracer, uint32_t object, TimeSpan span, size_t looks) {
  using Kind = RestRun::Kind;
  Piece out{{Kind::rests, span}, {}};
  size_t there = 0;
  for (size_t k = 0; k < looks; ++k) {
    const double t = look_at(span, k);
    if (!tracer.there(object, t)) continue;
    const Affine3 place = tracer.to_world(object, t);
    if (there++ == 0)
      out.place = place;
    else if (!same_place(place, out.place))
      out.run.kind = Kind::moves;
  }
  if (there == 0) out.run.kind = Kind::away;
  return out;
}

// One object of each frame that does not rest all the time.
std::vector<uint32_t> one_of_each_frame(const Tracer& tracer) {
  std::map<uint32_t, uint32_t> of_node;
  tracer.each(
      "things that move, come or go", [](const TracedObject& o) { return o.node != kNone; },
      [&](uint32_t number, const TracedObject& o) { of_node.emplace(o.node, number); });
  std::vector<uint32_t> out;
  for (const auto& [node, number] : of_node) out.push_back(number);
  return out;
}

}  // namespace

std::vector<RestRun> rest_runs(const Tracer& tracer, uint32_t object) {
  const std::optional<TimeSpan> window = tracer.window();
  if (!window || tracer.object(object).node == kNone) return {{RestRun::Kind::rests, window.value_or(kAlways)}};
  std::vector<double> times = tracer.changes(object);
  times.insert(times.begin(), window->begin), times.push_back(window->end);
  const size_t looks = times.size() > kFewPieces ? kFewLooks : kManyLooks;
  std::vector<RestRun> runs;
  Affine3 last;
  for (size_t k = 0; k + 1 < times.size(); ++k) {
    const Piece piece = piece_of(tracer, object, {times[k], times[k + 1]}, looks);
    const bool goes_on = !runs.empty() && runs.back().kind == piece.run.kind &&
                         (piece.run.kind != RestRun::Kind::rests || same_place(piece.place, last));
    goes_on ? void(runs.back().span.end = times[k + 1]) : runs.push_back(piece.run);
    last = piece.place;
  }
  return runs;
}

std::vector<RestInterval> rest_intervals(const Tracer& tracer, double least) {
  SUITE_CHECK(least > 0);
  const std::optional<TimeSpan> window = tracer.window();
  if (!window || !(window->end > window->begin)) return {};
  std::vector<double> breaks;
  for (const uint32_t object : one_of_each_frame(tracer))
    for (const RestRun& run : rest_runs(tracer, object))
      if (run.kind != RestRun::Kind::moves && run.span.end - run.span.begin >= least)
        breaks.insert(breaks.end(), {run.span.begin, run.span.end});
  std::ranges::sort(breaks);
  const double close = least / 2;
  std::vector<RestInterval> out;
  RestInterval now{*window, *window};
  for (size_t k = 0; k < breaks.size();) {
    const double first = breaks[k];
    double end = first;
    for (; k < breaks.size() && breaks[k] - first < close; ++k) end = breaks[k];
    if (first - window->begin < close) {
      now.still.begin = end;
      continue;
    }
    if (window->end - end < close) {
      now.still.end = first;
      break;
    }
    now.span.end = (first + end) / 2, now.still.end = first;
    out.push_back(now);
    now = {{now.span.end, window->end}, {end, window->end}};
  }
  if (out.empty()) return {};
  out.push_back(now);
  return out;
}

std::optional<RestPlaces> rest_places(const Tracer& tracer, uint32_t object, std::span<const RestInterval> intervals) {
  const std::vector<RestRun> runs = rest_runs(tracer, object);
  RestPlaces out{std::vector<double>(intervals.size()), std::vector<bool>(intervals.size()), intervals.size()};
  for (size_t k = 0; k < intervals.size(); ++k) {
    const TimeSpan still = intervals[k].still;
    out.rests[k] = std::ranges::any_of(runs, [&](const RestRun& run) {
      return run.kind == RestRun::Kind::rests && run.span.begin <= still.begin && still.end <= run.span.end;
    });
    if (out.rests[k] && out.home == intervals.size()) out.home = k;
  }
  if (out.home == intervals.size()) return std::nullopt;
  size_t from = out.home;
  for (size_t k = 0; k < intervals.size(); ++k) {
    if (out.rests[k]) from = k;
    out.time[k] = (intervals[from].still.begin + intervals[from].still.end) / 2;
  }
  return out;
}

bool changes_place(const Tracer& tracer, uint32_t object) {
  std::optional<Affine3> place;
  for (const RestRun& run : rest_runs(tracer, object)) {
    if (run.kind == RestRun::Kind::moves) return true;
    if (run.kind == RestRun::Kind::away) continue;
    const Piece piece = piece_of(tracer, object, run.span, kFewLooks);
    if (place && !same_place(piece.place, *place)) return true;
    place = piece.place;
  }
  return false;
}

double share_there(const Tracer& tracer, uint32_t object, TimeSpan span) {
  if (!(span.end > span.begin)) return tracer.there(object, span.begin) ? 1 : 0;
  std::vector<double> times{span.begin};
  for (const double t : tracer.changes(object))
    if (t > span.begin && t < span.end) times.push_back(t);
  times.push_back(span.end);
  const size_t looks = times.size() > kFewPieces ? kFewLooks : kManyLooks;
  double there = 0;
  for (size_t k = 0; k + 1 < times.size(); ++k)
    for (size_t look = 0; look < looks; ++look)
      if (tracer.there(object, look_at({times[k], times[k + 1]}, look)))
        there += (times[k + 1] - times[k]) / static_cast<double>(looks);
  return std::min(1.0, there / (span.end - span.begin));
}

size_t interval_of(std::span<const RestInterval> intervals, double time) {
  size_t k = 0;
  while (k + 1 < intervals.size() && time >= intervals[k].span.end) ++k;
  return k;
}

std::vector<std::vector<float>> interval_shares(std::span<const RestInterval> intervals,
                                                const std::vector<double>& moments) {
  const size_t n = moments.size();
  if (intervals.empty()) return {std::vector<float>(n, 1.0f)};
  // Integral of the hat of a moment from its foot to a time.
  const auto until = [&](size_t m, double t) {
    double sum = 0;
    if (m > 0) {
      const double width = moments[m] - moments[m - 1], x = std::clamp(t - moments[m - 1], 0.0, width);
      sum += x * x / (2 * width);
    }
    if (m + 1 < n) {
      const double width = moments[m + 1] - moments[m], x = std::clamp(t - moments[m], 0.0, width);
      sum += x - x * x / (2 * width);
    }
    return sum;
  };
  std::vector<std::vector<float>> out(intervals.size(), std::vector<float>(n));
  for (size_t m = 0; m < n; ++m) {
    const double whole = until(m, moments.back());
    for (size_t k = 0; k < intervals.size(); ++k) {
      const double begin = k == 0 ? moments.front() : intervals[k].span.begin,
                   end = k + 1 == intervals.size() ? moments.back() : intervals[k].span.end;
      out[k][m] = static_cast<float>(std::clamp((until(m, end) - until(m, begin)) / whole, 0.0, 1.0));
    }
  }
  return out;
}

std::vector<std::string> motion_sentences(const Tracer& tracer, std::span<const RestInterval> intervals, size_t most) {
  std::vector<std::string> out;
  size_t more = 0;
  for (const uint32_t object : one_of_each_frame(tracer)) {
    std::string when;
    for (const RestRun& run : rest_runs(tracer, object))
      if (run.kind == RestRun::Kind::moves)
        when += strf("%s%.6g to %.6g s", when.empty() ? "" : ", ", run.span.begin, run.span.end);
    if (when.empty()) continue;
    const bool rests = rest_places(tracer, object, intervals).has_value();
    if (out.size() < most)
      out.push_back(strf("%s moves (%s)%s", tracer.motion_name(object).c_str(), when.c_str(),
                         rests ? "" : " and does not rest long enough to take part"));
    else
      ++more;
  }
  if (more > 0) out.push_back(strf("%zu more things move", more));
  return out;
}

namespace {

constexpr size_t kMostBoxes = 64;
constexpr int kLooksOfWay = 33;  // at what moves

double look_along(TimeSpan span, int k) { return span.begin + (span.end - span.begin) * (k + 0.5) / kLooksOfWay; }

Box3 placed(const Box3& local, const Affine3& place) {
  Box3 out;
  for (int corner = 0; corner < 8; ++corner)
    out.grow(place.point({corner & 1 ? local.high.x : local.low.x, corner & 2 ? local.high.y : local.low.y,
                          corner & 4 ? local.high.z : local.low.z}));
  return out;
}

Box3 grown(const Box3& box, double by) { return {box.low - Vec3{by, by, by}, box.high + Vec3{by, by, by}}; }

// Where an object is while it moves. It is looked at so often that the boxes of two looks, grown by half of the way
// between them and a tenth, hold it in between.
void add_way(const Tracer& tracer, uint32_t object, const Box3& local, TimeSpan span, std::vector<Box3>& boxes) {
  std::optional<Box3> last;
  for (int k = 0; k < kLooksOfWay; ++k) {
    const double t = look_along(span, k);
    if (!tracer.there(object, t)) continue;
    const Box3 now = placed(local, tracer.to_world(object, t));
    Box3 both = now;
    if (last) both.grow(*last);
    const double way = last ? length(now.center() - last->center()) : 0;
    boxes.push_back(grown(both, way / 2 + 0.1 * length(now.size())));
    last = now;
  }
}

// All places in which an object may be met while things rest: of its rests, and of what moves through an interval.
void add_places(const Tracer& tracer, uint32_t object, const std::vector<RestRun>& runs,
                std::span<const RestInterval> intervals, std::vector<Box3>& boxes) {
  const Box3 local = tracer.local_box(object);
  if (local.empty()) {
    boxes.push_back({{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}});
    return;
  }
  for (const RestRun& run : runs) {
    if (run.kind == RestRun::Kind::rests) {
      double t = look_at(run.span, 0);
      for (size_t k = 1; k < kManyLooks && !tracer.there(object, t); ++k) t = look_at(run.span, k);
      if (tracer.there(object, t))
        boxes.push_back(grown(placed(local, tracer.to_world(object, t)), 2 * kStill * (1 + length(local.size()))));
    }
    if (run.kind == RestRun::Kind::moves && std::ranges::any_of(intervals, [&](const RestInterval& r) {
          return run.span.begin < r.still.end && r.still.begin < run.span.end;
        }))
      add_way(tracer, object, local, run.span, boxes);
  }
}

}  // namespace

ChangingRoom::ChangingRoom(const Tracer& tracer, std::span<const RestInterval> intervals) {
  std::vector<Box3> boxes;
  tracer.each(
      "things that move, come or go", [](const TracedObject& o) { return o.node != kNone; },
      [&](uint32_t number, const TracedObject&) {
        const std::vector<RestRun> runs = rest_runs(tracer, number);
        if (runs.size() > 1 || runs.front().kind == RestRun::Kind::moves)
          add_places(tracer, number, runs, intervals, boxes);
      });
  const size_t together = (boxes.size() + kMostBoxes - 1) / kMostBoxes;
  for (size_t k = 0; k < boxes.size(); ++k) {
    if (k % together == 0) boxes_.emplace_back();
    boxes_.back().grow(boxes[k]), all_.grow(boxes[k]);
  }
}

bool ChangingRoom::meets(const Ray& ray, double distance) const {
  const auto in = [&](const Box3& box) {
    double near = 0, far = distance;
    for (int axis = 0; axis < 3; ++axis) {
      const double d = ray.direction[axis], from = ray.origin[axis];
      if (d == 0) {
        if (from < box.low[axis] || from > box.high[axis]) return false;
        continue;
      }
      const double a = (box.low[axis] - from) / d, b = (box.high[axis] - from) / d;
      near = std::max(near, std::min(a, b)), far = std::min(far, std::max(a, b));
    }
    return near <= far;
  };
  return !boxes_.empty() && in(all_) && (boxes_.size() == 1 || std::ranges::any_of(boxes_, in));
}

}  // namespace suite
