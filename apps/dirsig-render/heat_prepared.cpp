#include "heat_prepared.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "base/progress.h"
#include "base/run_app.h"
#include "heat/day_sun.h"
#include "heat_left_out.h"
#include "motion/scene_frame.h"
#include "motion/ut1.h"
#include "surface/cut_out.h"

namespace suite {

namespace {

// Tiles are built when a ray comes to them.
const TileLimit kNoTiles{uint64_t{1} << 62, {}};

// From the first capture's begin to the last one's end.
TimeSpan captured(const Simulation& sim) {
  TimeSpan span{INFINITY, -INFINITY};
  for (const auto& sensor : sim.sensors)
    for (const Task& task : sensor->tasks())
      for (const Capture& c : task.captures)
        span = {std::min(span.begin, c.window.begin), std::max(span.end, c.window.end)};
  return span;
}

// Seconds of the simulation at the midnight of the sun before a time: where the hour angle is half a turn.
double midnight_before(double t, double longitude_deg, const Clock& clock) {
  const Utc utc = clock.utc(t);
  const double local = utc.hour * 3600.0 + utc.minute * 60.0 + utc.second + longitude_deg * 240;
  return t - (local - std::floor(local / 86400) * 86400);
}

// Whole minutes, so that the same day is the same span.
TimeSpan span_of(const Simulation& sim, double longitude_deg) {
  const HeatRequest& heat = *sim.heat;
  const TimeSpan seen = captured(sim);
  if (heat.span) {
    if (!heat.spec.periodic && (seen.begin < heat.span->begin || seen.end > heat.span->end))
      throw Error(heat.where,
                  strf("temperatures are found from %g to %g s, captures are taken from %g to %g s", heat.span->begin,
                       heat.span->end, seen.begin, seen.end),
                  "let 'from' and 'to' cover them");
    return *heat.span;
  }
  const double begin = std::round(midnight_before(seen.begin, longitude_deg, Clock(*sim.epoch)) / 60) * 60;
  const double midnight = begin + 86400, taken = seen.end - seen.begin;
  if (seen.end <= midnight) return {begin, midnight};
  const auto date = [clock = Clock(*sim.epoch)](double t) { return to_iso8601(clock.utc(t), 0); };
  if (taken > 86400)
    throw Error(heat.where,
                strf("the captures take %.4g hours, which are more than one day of temperatures", taken / 3600),
                strf("give heat a span that holds them: 'from: %s, to: %s'", date(begin).c_str(),
                     date(begin + 86400 * std::ceil((seen.end - begin) / 86400)).c_str()));
  // Any day that holds the captures will do; that they lie in its middle is as good as it gets.
  const double from = std::round((seen.begin + seen.end) / 2 / 60) * 60 - 43200;
  throw Error(heat.where,
              strf("temperatures are found from one midnight of the sun to the next, and the captures (%s to %s) lie "
                   "on both sides of one, at %s",
                   date(seen.begin).c_str(), date(seen.end).c_str(), date(midnight).c_str()),
              strf("give heat another day, for which the weather is there: 'from: %s, to: %s'", date(from).c_str(),
                   date(from + 86400).c_str()));
}

}  // namespace

HeatWeather weather_of(const Simulation& sim, const Scene& scene) {
  const Weather& weather = *sim.heat->weather;
  const Clock clock(*sim.epoch);
  const GeodeticOrigin& o = scene.origin;
  const auto series = std::make_shared<const SunSeries>(
      SceneFrame(o.given ? Geodetic{o.latitude_deg, o.longitude_deg, o.ellipsoid_height_m} : weather.site()), Vec3{});
  return {weather, [&weather, clock](double t) { return weather.clock().seconds(clock.at(t)); },
          [series, clock, dut1 = sim.dut1](double t) {
            return series->at(clock.at(t), dut1_at(clock.at(t), clock.at(0), dut1));
          }};
}

namespace {

std::vector<RestInterval> rests_of(const Tracer& tracer, const Simulation& sim) {
  const HeatSpec& spec = sim.heat->spec;
  if (spec.intervals == 1) return {};
  std::vector<RestInterval> rests = rest_intervals(tracer, spec.step);
  if (rests.size() <= spec.intervals) return rests;
  throw Error(sim.heat->where,
              strf("what moves, comes or goes rests in %zu intervals of the span, and %zu are the most", rests.size(),
                   spec.intervals),
              strf("'geometry_intervals: %zu' (rays and memory grow with it), a longer step_s, or 'geometry_intervals: "
                   "1': what moves then "
                   "leaves the exchange, and what comes and goes is in it for its share of the span",
                   rests.size()));
}

// Places of other times would be those of other elements.
void check_rests(const PreparedHeat& p, const Simulation& sim) {
  if (p.cut.rests.empty()) return;
  const TimeSpan of{p.cut.rests.front().span.begin, p.cut.rests.back().span.end};
  if (of != p.spec.span)
    throw Error(
        sim.heat->where,
        strf("the file has temperatures of things that move from %g to %g s, the simulation asks for %g to %g s",
             of.begin, of.end, p.spec.span.begin, p.spec.span.end),
        "ask for that span with 'from' and 'to', or solve for them again");
}

}  // namespace

PreparedHeat prepare(const std::shared_ptr<const Scene>& scene, const Simulation& sim, const JobOptions& job,
                     const std::optional<HeatCut>& cut, bool rays) {
  PreparedHeat p;
  p.spec = sim.heat->spec;
  const Geodetic site = sim.heat->weather->site();
  p.spec.span = span_of(sim, scene->origin.given ? scene->origin.longitude_deg : site.longitude_deg);
  p.tracer =
      std::make_unique<const Tracer>(scene, std::nullopt, p.spec.span, cut_out(*scene), rays ? job.tiles : kNoTiles);
  p.optics = heat_optics(*scene, used_materials(*p.tracer), warn);
  const HeatWeather weather = weather_of(sim, *scene);
  p.cut = cut.value_or(HeatCut{p.spec.elements, p.spec.cut_by_sun, {}, {}, {}});
  if (!cut) p.cut.rests = rests_of(*p.tracer, sim);
  check_rests(p, sim);
  if (!cut && p.cut.by_sun) p.cut.sun = sun_moments(p.spec.span, [&](double t) { return weather.sun(t).direction; });
  const DaySun sun = day_sun(*p.tracer, p.cut.sun);
  p.elements = std::make_shared<Elements>(*p.tracer, p.optics.has_heat, p.cut.elements, p.spec.span.begin,
                                          p.cut.by_sun ? &sun : nullptr, p.cut.splits, p.cut.rests);
  p.cut.splits = p.elements->splits();
  p.faces = std::make_unique<HeatFaces>(*p.elements, p.optics);
  check_surroundings({*p.tracer, *p.elements, *p.faces, p.optics}, p.spec);
  if (const std::vector<uint32_t> kept = p.cut.kept; !kept.empty()) {
    check_kept(*p.elements, sim, kept);
    keep_elements(p, kept);
  }
  return p;
}

double moments_of(const PreparedHeat& p) { return std::round((p.spec.span.end - p.spec.span.begin) / p.spec.step) + 1; }

// A few faces, spread over all, are traced.
double seeing_changes(const PreparedHeat& p) {
  constexpr size_t kLooks = 8;
  constexpr uint32_t kMostPaths = 8;  // in each block
  if (p.elements->rests().empty()) return 0;
  PathOptions paths = path_options(p.spec);
  paths.paths = std::min(paths.paths, kMostPaths);
  ExchangePaths exchange = untraced_exchange(*p.elements, *p.faces, paths);
  const size_t n = p.faces->size(), waves = (n + ExchangePaths::kTogether - 1) / ExchangePaths::kTogether,
               looks = std::min(kLooks, waves);
  double seeing = 0, faces = 0;
  for (size_t k = 0; k < looks; ++k) {
    const size_t begin = waves * k / looks * ExchangePaths::kTogether,
                 end = std::min(n, begin + ExchangePaths::kTogether);
    trace_exchange(*p.tracer, *p.elements, *p.faces, p.optics, paths, {begin, end}, exchange);
    for (size_t f = begin; f < end; ++f) seeing += exchange.rows.changing[f], ++faces;
  }
  return seeing / faces;
}

double bytes_of(const PreparedHeat& p) {
  constexpr double kNodes = 4 * 30 * 8;
  const double moments = moments_of(p), paths = p.spec.paths;
  const double rows = HeatSpec::kBlocks + Sunlight::kContrasts;  // of parts, for errors
  // In two bytes a number, with two floats a row (compact_rows.h); a byte for every moment with the sun up.
  const double tracing =
      3 * moments + 2 * kSkyPatches + rows * (2 * kHeatParts + 8) + HeatSpec::kBlocks * (2 * kSkyShapes + 8 + 4) + 28;
  const double kept = 2 * moments + rows * (2 * kHeatParts + 8), making = kept + paths * 8 * 3;
  const double balance = kept + paths * 8 * 2 + 4 * moments + kNodes;
  // Elements that conduct to each other are followed at once: what they receive and emit, and the vectors of nodes of
  // the search for what solves their equations.
  const double lateral = p.spec.lateral ? 8 * moments * 2 + kNodes * 4 : 0;
  const double errors = kept + paths * 8 / HeatSpec::kBlocks * 3 + 6 * moments + 4.0 * 5 * kHeatParts;
  // Of later intervals of rest: rows of what is traced, and of the matrices.
  const double more = seeing_changes(p) * static_cast<double>(std::max<size_t>(1, p.elements->rests().size()) - 1);
  const double later_tracing = more * (paths * 8 + 2 * moments + 2 * kSkyPatches +
                                       HeatSpec::kBlocks * (2 * kHeatParts + 8 + 2 * kSkyShapes + 8 + 4)),
               later_balance = more > 0 ? paths * 8 * 4 + more * paths * 8 * 3 : 0;
  const double reported = 4 * moments * 4 + 4.0 * 3 * kHeatParts;  // as the result has it, in place of the paths
  return static_cast<double>(p.faces->size()) *
         std::max({paths * 8 + std::max({tracing + later_tracing, making, balance + lateral + later_balance,
                                         errors + lateral + later_balance}),
                   reported});
}

void check_size(const PreparedHeat& p, const Simulation& sim) {
  const double there = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  const double paths = static_cast<double>(p.faces->size()) * p.spec.paths;
  if (bytes_of(p) > there || paths >= 4294967295.0)
    throw Error(sim.heat->where,
                strf("%zu faces of elements with %u paths each take %s, and this machine has %s", p.faces->size(),
                     p.spec.paths, human_bytes(bytes_of(p)).c_str(), human_bytes(there).c_str()),
                "fewer elements or paths (2^32 paths at most), or a larger step_s");
}

}  // namespace suite
