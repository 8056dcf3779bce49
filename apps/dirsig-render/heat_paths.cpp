#include "heat_paths.h"

#include <algorithm>

#include "base/files.h"
#include "base/outputs.h"
#include "base/progress.h"
#include "base/run_app.h"
#include "continued.h"
#include "formats/heat_hdf/operator_hdf.h"

namespace suite {

namespace {

// How scenes stand and move through the span, beside what is in their files.
std::string placements_of(const Simulation& sim, TimeSpan span) {
  constexpr int kTimes = 24;
  std::string text;
  const auto add = [&](const Affine3& a) {
    for (const double v : a.a) text += strf("%.12g ", v);
    text += strf("%.12g %.12g %.12g;", a.b.x, a.b.y, a.b.z);
  };
  for (const SimulationScene& s : sim.scenes) {
    text += strf("%.12g %.12g;", s.life.begin, s.life.end);
    if (s.placement) add(*s.placement);
    if (!s.motion) continue;
    const TimeSpan covered = s.motion->covered();
    const double begin = std::max(span.begin, covered.begin), end = std::min(span.end, covered.end);
    for (int k = 0; k <= kTimes && begin <= end; ++k) add(s.motion->at(begin + (end - begin) * k / kTimes).affine());
  }
  return text;
}

OperatorIdentity identity_of_search(const PreparedHeat& p, const SunCourse& course, const Simulation& sim) {
  const HeatSpec& spec = p.spec;
  return {{{"scene", sha256(hash_of_scenes(sim) + placements_of(sim, spec.span)).substr(0, 16)},
           {"set of elements",
            strf("%zu of %016llx", p.elements->size(), static_cast<unsigned long long>(p.elements->fingerprint()))},
           {"number of paths", strf("%u", spec.paths)},
           {"seed", strf("%llu", static_cast<unsigned long long>(spec.seed))},
           {"span", strf("%.3f to %.3f s", spec.span.begin, spec.span.end)}},
          digest_of(course),
          p.faces->ends()};
}

}  // namespace

HeatOperator operator_of(const PreparedHeat& p, const SunCourse& course, const Simulation& sim, const RenderOptions& o,
                         const std::string& folder, const HeatProgress& progress) {
  const HeatScene scene{*p.tracer, *p.elements, *p.faces, p.optics};
  const PathOptions paths = path_options(p.spec);
  const bool keeps = sim.heat->keep_operator && !folder.empty();
  const std::string own = keeps ? in_folder(folder, "heat_operator.h5") : "";
  const std::string pieces_folder = keeps ? in_folder(folder, "heat_operator.pieces") : "";
  const bool finished = keeps && file_exists(own);
  const std::string from = o.heat_operator.empty() && finished ? own : o.heat_operator;
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
    sunlight = stored.same_sun();
    if (sunlight) {
      found.sun = untraced_sunlight(*p.faces, course, paths);
      stored.read(found.sun);
    }
    note("heat: the exchange of infrared" + std::string(sunlight ? " and the sunlight are" : " is") + " that of " +
         from + (sunlight ? ": no new rays" : "; the sun is elsewhere than there, its light is found anew"));
  } else {
    progress.begin("exchange of infrared", count);
    found.exchange = find_exchange(scene, paths, pieces.get(), done);
  }
  if (!sunlight) {
    progress.begin("sunlight", count);
    found.sun = find_sunlight(scene, course, paths, pieces.get(), done);
  }
  if (!keeps) return found;
  if (!finished) write_operator(own, found, identity, command_line());
  if (finished && !sunlight) note("heat: " + own + " stays as it is");
  remove_pieces(pieces_folder);
  return found;
}

}  // namespace suite
