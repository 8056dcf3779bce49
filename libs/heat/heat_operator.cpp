#include "heat/heat_operator.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/files.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "heat/sunlight_mirrored.h"

namespace suite {

namespace {

// trace(range) for all rows that are not there. of: the stage, if there are several.
template <class Found, class Trace, class... Of>
void find_missing(FaceRange rows, Found& found, HeatPieces* pieces, const std::function<void(size_t)>& progress,
                  const Trace& trace, Of... of) {
  const std::vector<FaceRange> there = pieces ? pieces->take(found, rows, of...) : std::vector<FaceRange>{};
  auto next = there.begin();
  // Pieces grow until one takes about as long as may be lost.
  size_t waves = pieces ? 2 * static_cast<size_t>(threads()) : rows.size();
  for (size_t at = rows.begin; at < rows.end;) {
    if (next != there.end() && next->begin == at) {
      if (progress) progress(next->size());
      at = next++->end;
      continue;
    }
    const size_t limit = next != there.end() ? next->begin : rows.end;
    const FaceRange range{at, waves < (limit - at) / Found::kTogether ? at + waves * Found::kTogether : limit};
    const PathCount before = found.count;
    const Stopwatch::time_point begun = Stopwatch::now();
    trace(range);
    const double took = seconds_since(begun);
    if (pieces) {
      pieces->keep(found, of..., range, found.count - before);
      if (took < pieces->seconds() / 2) waves *= 2;
      if (took > pieces->seconds() && waves > 2 * static_cast<size_t>(threads())) waves /= 2;
    }
    at = range.end;
  }
}

}  // namespace

ExchangePaths find_exchange(const HeatScene& s, const PathOptions& options, HeatPieces* pieces,
                            const std::function<void(size_t)>& progress) {
  ExchangePaths out = untraced_exchange(s.elements, s.faces, options);
  const auto find = [&](FaceRange rows, const std::function<void(size_t)>& told) {
    find_missing(rows, out, pieces, told, [&](FaceRange range) {
      trace_exchange(s.tracer, s.elements, s.faces, s.optics, options, range, out, told);
    });
  };
  find({0, s.faces.size()}, progress);
  out.make_more();
  if (out.rows.size() > s.faces.size()) find({s.faces.size(), out.rows.size()}, {});
  return out;
}

Sunlight find_sunlight(const HeatScene& s, const SunCourse& course, const PathOptions& options, HeatPieces* pieces,
                       const std::function<void(size_t)>& progress) {
  Sunlight out = untraced_sunlight(s.elements, s.faces, course, options);
  const auto find = [&](FaceRange rows, SunStage stage, const std::function<void(size_t)>& told) {
    find_missing(
        rows, out, pieces, told,
        [&](FaceRange range) {
          trace_sunlight(s.tracer, s.elements, s.faces, s.optics, course, options, kSunJoins, stage, range, out, told);
        },
        stage);
  };
  for (const SunStage stage : {SunStage::straight, SunStage::scattered}) find({0, s.faces.size()}, stage, progress);
  out.make_more();
  if (out.rows.size() > s.faces.size()) find({s.faces.size(), out.rows.size()}, SunStage::scattered, {});
  give_up(out.lit);
  add_mirrored_sunlight(s.tracer, s.elements, s.faces, s.optics, course, options, out);
  return out;
}

std::string digest_of(const SunCourse& course) {
  std::string text;
  const auto add = [&](const char* format, double v) { text += strf(format, v); };
  for (const double t : course.moments) {
    const Dir d = course.towards(t);
    add("%.6f ", t);
    for (int k = 0; k < 3; ++k) add("%.9f ", d[k]);
  }
  add("%.9g ", course.angular_radius);
  for (const std::vector<float>& spectrum : course.beam)
    for (const float v : spectrum) add("%.6f ", double{v});
  for (const float v : course.sky) add("%.6f ", double{v});
  return sha256(text);
}

}  // namespace suite
