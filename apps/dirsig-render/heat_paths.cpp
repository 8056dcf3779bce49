#include "heat_paths.h"

#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "base/memory.h"
#include "base/outputs.h"
#include "base/progress.h"
#include "base/run_app.h"
#include "continued.h"
#include "formats/heat_hdf/operator_hdf.h"

namespace suite {

namespace {

constexpr int kTimes = 24;  // of the span, at which what moves is looked at

void add(std::string& text, const Affine3& a) {
  for (const double v : a.a) text += strf("%.12g ", v);
  text += strf("%.12g %.12g %.12g;", a.b.x, a.b.y, a.b.z);
}

// What of a scene comes, goes and moves within the span: its own dates may lie elsewhere on another day.
std::string motions_of(const Scene& scene, TimeSpan span) {
  std::string text;
  for (const Schedule& s : scene.schedules) {
    text += strf("%.6f;%.6f;", std::clamp(s.life.begin, span.begin, span.end),
                 std::clamp(s.life.end, span.begin, span.end));
    s.when.over(span, [&](std::optional<size_t> row, TimeSpan part) {
      text += strf("%d %.6f %.6f;", row ? static_cast<int>(*row) : -1, part.begin, part.end);
    });
  }
  for (const SceneTrack& t : scene.tracks) {
    const TimeSpan covered = t.track->covered();
    text += strf("%.6f %.6f;", std::clamp(covered.begin, span.begin, span.end),
                 std::clamp(covered.end, span.begin, span.end));
    for (int k = 0; k <= kTimes; ++k)
      if (const double at = span.begin + (span.end - span.begin) * k / kTimes; at >= covered.begin && at < covered.end)
        add(text, t.track->at(at).affine());
  }
  return text;
}

// How scenes stand and move through the span, beside what is in their files.
std::string placements_of(const Simulation& sim, TimeSpan span) {
  std::string text;
  for (const SimulationScene& s : sim.scenes) {
    text += strf("%.12g %.12g;", s.life.begin, s.life.end);
    if (s.placement) add(text, *s.placement);
    if (!s.motion) continue;
    const TimeSpan covered = s.motion->covered();
    const double begin = std::max(span.begin, covered.begin), end = std::min(span.end, covered.end);
    for (int k = 0; k <= kTimes && begin <= end; ++k)
      add(text, s.motion->at(begin + (end - begin) * k / kTimes).affine());
  }
  return text;
}

std::string text_of(const std::vector<RestInterval>& rests) {
  std::string text;
  for (const RestInterval& r : rests)
    text += strf("%.6f %.6f %.6f %.6f;", r.span.begin, r.span.end, r.still.begin, r.still.end);
  return text;
}

OperatorIdentity identity_of_search(const PreparedHeat& p, const SunCourse& course, const Simulation& sim) {
  const HeatSpec& spec = p.spec;
  return {
      {{"scene", sha256(hash_of_scenes(sim) + placements_of(sim, spec.span) + motions_of(p.tracer->scene(), spec.span))
                     .substr(0, 16)},
       {"set of elements",
        strf("%zu of %016llx", p.elements->size(), static_cast<unsigned long long>(p.elements->fingerprint()))},
       {"number of paths", strf("%u", spec.paths)},
       {"seed", strf("%llu", static_cast<unsigned long long>(spec.seed))},
       {"span", strf("%.3f to %.3f s", spec.span.begin, spec.span.end)},
       {"set of intervals of rest", sha256(text_of(p.elements->rests())).substr(0, 16)}},
      digest_of(course),
      p.faces->ends(),
      path_of(course),
      p.cut};
}

std::string kept_file(const Simulation& sim, const std::string& folder) {
  return sim.heat->keep_operator && !folder.empty() ? in_folder(folder, "heat_operator.h5") : "";
}

// The sunlight of a file, if its sun is near enough. Tells what is taken, and why not more.
bool take_stored(const StoredOperator& stored, const std::string& from, const OperatorIdentity& identity,
                 Sunlight& out) {
  const std::string exchange = "heat: the exchange of infrared", those = " those of " + from;
  if (stored.same_sun()) {
    stored.read(out);
    note(exchange + " and the sunlight are" + those + ": no new rays");
    return true;
  }
  const SunNear near = near_path(stored.sun_path(), identity.path);
  const double degrees = near.off * 180 / kPi;
  if (near.fits) {
    stored.read(out);
    move_along(out, near);
    note(
        exchange + " and the sunlight are" + those +
        strf(
            ": no new rays; the sun is at most %.2f degrees beside its path of then, and %.0f s earlier or later there",
            degrees, near.late));
    return true;
  }
  note(exchange + " is" +
       strf(" that of %s; the sun is elsewhere than there (%s), its light is computed again", from.c_str(),
            std::isfinite(near.off)
                ? strf("by %.2g degrees, %.2g are too few to matter", degrees, kNearSun * 180 / kPi).c_str()
                : "in other steps, of another size or with other spectra"));
  return false;
}

}  // namespace

std::string operator_file(const Simulation& sim, const RenderOptions& o, const std::string& folder) {
  if (!o.heat_operator.empty() || !sim.heat) return o.heat_operator;
  const std::string own = kept_file(sim, folder);
  return !own.empty() && file_exists(own) ? own : "";
}

HeatOperator operator_of(const PreparedHeat& p, const SunCourse& course, const Simulation& sim, const RenderOptions& o,
                         const std::string& folder, const HeatProgress& progress) {
  const HeatScene scene{*p.tracer, *p.elements, *p.faces, p.optics};
  const PathOptions paths = path_options(p.spec);
  const std::string own = kept_file(sim, folder);
  const bool keeps = !own.empty();
  const std::string pieces_folder = keeps ? in_folder(folder, "heat_operator.pieces") : "";
  const bool finished = keeps && file_exists(own);
  const std::string from = operator_file(sim, o, folder);
  OperatorIdentity identity;
  if (keeps || !from.empty()) identity = identity_of_search(p, course, sim);

  HeatOperator found;
  std::unique_ptr<HeatPieces> pieces;
  if (keeps) pieces = pieces_in(pieces_folder, identity, sim.heat->save_every);
  if (keeps) make_folders_of({own});
  const auto done = [&](size_t more) { progress.done(static_cast<double>(more)); };
  const auto count = static_cast<double>(p.faces->size());
  bool sunlight = false;
  if (!from.empty()) {
    const StoredOperator stored(from, identity);
    found.exchange = untraced_exchange(*p.elements, *p.faces, paths);
    stored.read(found.exchange);
    found.sun = untraced_sunlight(*p.elements, *p.faces, course, paths);
    sunlight = take_stored(stored, from, identity, found.sun);
    if (sunlight) give_up(found.sun.lit);
  } else {
    progress.begin("exchange of infrared", count, "face");
    found.exchange = find_exchange(scene, paths, pieces.get(), done);
  }
  if (!sunlight) {
    progress.begin("sunlight", count, "face");
    found.sun = find_sunlight(scene, course, paths, pieces.get(),
                              [&](size_t more) { progress.done(static_cast<double>(more) / kSunStages); });
  }
  if (!keeps) return found;
  if (!finished) write_operator(own, found, identity, command_line());
  if (finished && !sunlight) note("heat: " + own + " stays as it is");
  remove_pieces(pieces_folder);
  return found;
}

}  // namespace suite
