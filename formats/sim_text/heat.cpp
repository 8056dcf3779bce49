#include "formats/sim_text/heat.h"

#include <array>

#include "formats/weather/weather.h"

namespace suite {

namespace {

Weather read_the_weather(const Params& p) {
  const bool map = p.kind() == Params::Kind::map;
  WeatherOptions options;
  if (map) {
    if (const auto model = p.find("longwave"))
      options.longwave =
          std::array{LongwaveModel::dilley_obrien, LongwaveModel::clark_allen,
                     LongwaveModel::brutsaert}[model->as_choice({"dilley_obrien", "clark_allen", "brutsaert"})];
    if (const auto year = p.find("year")) options.year = static_cast<int>(year->as_integer(1972, 2199));
    if (const auto offset = p.find("utc_offset_h")) options.utc_offset = 3600 * offset->as_number_in(-14, 14, "h");
    if (const auto date = p.find("date")) options.date = parse_iso8601(date->as_text());
    if (const auto site = p.find("site")) {
      const std::vector<double> v = site->as_numbers();
      if (v.size() != 3) throw site->error("a site is [latitude, longitude, height m]");
      options.site = Geodetic{v[0], v[1], v[2]};
      try {
        check_geodetic(*options.site);
      } catch (const Error& e) {
        throw site->error(e.message(), e.hint());
      }
    }
  }
  return read_weather(map ? p.at("file").as_path() : p.as_path(), options);
}

// What is kept, what is left out, and what is looked at.
void read_what_is_kept(const Params& heat, HeatRequest& out) {
  if (const auto keep = heat.find("keep")) {
    if (keep->as_text() != "operator")
      throw keep->error("the balance of heat cannot keep '" + keep->as_text() + "'", "keep: operator");
    out.keep_operator = true;
    out.save_every = heat.number_in("save_every_s", 0, 86400, "s", out.save_every);
  }
  if (const auto least = heat.find("influence_cutoff_k")) {
    out.leave_out = least->as_number_in(0, 10, "K");
    if (out.leave_out > 0 && out.keep_operator)
      throw least->error("paths of all elements are kept, and some are to be left out",
                         "drop 'influence_cutoff_k' or 'keep'");
  }
  if (const auto probes = heat.find("probes"))
    for (const std::string& name : probes->keys()) {
      const std::vector<double> v = probes->at(name).as_numbers();
      if (v.size() != 3) throw probes->at(name).error("a probe stands at three numbers: east, north, up");
      out.probes.emplace_back(name, Vec3{v[0], v[1], v[2]});
    }
}

// What follows each element for itself alone cannot go with it.
void read_lateral(const Params& heat, HeatRequest& out) {
  const auto lateral = heat.find("lateral_conduction");
  if (!lateral) return;
  out.spec.lateral = lateral->as_bool();
  if (!out.spec.lateral) return;
  for (const auto& [given, name] : {std::pair{out.spec.audit > 0, "random_walks"},
                                    {out.final_gather, "final_gather"},
                                    {out.leave_out > 0, "influence_cutoff_k"}})
    if (given)
      throw lateral->error(std::string("conduction along the surface is not known to '") + name + "'",
                           "drop one of them");
}

void read_points(const Params& heat, HeatRequest& out) {
  const auto gather = heat.find("final_gather");
  if (!gather) return;
  out.final_gather = gather->as_bool();
  if (out.final_gather && !out.spec.periodic)
    throw gather->error("points differ from their elements in a span that repeats alone",
                        "'repeats: true', or no final_gather");
}

}  // namespace

std::optional<HeatRequest> read_heat_request(const Params& root, const Simulation& sim, const SensorContext& context) {
  const auto heat = root.find("heat");
  const auto weather = root.find("weather");
  if (!heat && !weather) return std::nullopt;
  if (!heat) throw weather->error("weather is there for the balance of heat, which is not asked for", "add 'heat: {}'");
  if (!weather)
    throw heat->error("the balance of heat needs weather", "add 'weather: FILE' (EPW, TMY3, SURFRAD, BSRN, .wth, CSV)");
  if (!sim.epoch)
    throw heat->error("weather is dated, and second 0 of the simulation is not",
                      "give 'epoch: DATE', or the sun a date");
  if (sim.periodic)
    throw heat->error("the temperatures of a scene that repeats itself are not found", "drop one of them");
  HeatRequest out;
  out.where = heat->where();
  out.weather = std::make_shared<const Weather>(read_the_weather(*weather));
  HeatSpec& s = out.spec;
  s.elements = static_cast<size_t>(heat->integer("elements", 1, 10'000'000, 20000));
  if (const auto by = heat->find("elements_by")) s.cut_by_sun = by->as_choice({"sun", "area"}) == 0;
  s.paths = static_cast<uint32_t>(heat->integer("paths", HeatSpec::kBlocks, 1 << 16, 64));
  s.paths = (s.paths + HeatSpec::kLeastPaths - 1) / HeatSpec::kLeastPaths * HeatSpec::kLeastPaths;
  if (const auto target = heat->find("target_error_k")) {
    if (heat->find("paths"))
      throw target->error("paths are given, and are to be chosen for a target", "drop one of them");
    s.target = target->as_number_in(1e-3, 10, "K");
  }
  s.step = heat->number_in("step_s", 1, 3600, "s", 600);
  s.tolerance = heat->number_in("tolerance_k", 1e-7, 1, "K", 0.01);
  s.ground_albedo = heat->number_in("ground_albedo", 0, 1, "", 0.2);
  s.audit = static_cast<size_t>(heat->integer("random_walks", 0, 100'000'000, 0));
  if (s.audit == 1)
    throw heat->at("random_walks").error("one probe has no error", "two at least, thousands for tenths of a kelvin");
  s.intervals = static_cast<size_t>(heat->integer("geometry_intervals", 1, 1000, static_cast<long long>(s.intervals)));
  s.seed = sim.pipeline.seed;
  read_what_is_kept(*heat, out);
  const auto from = heat->find("from"), to = heat->find("to");
  if (static_cast<bool>(from) != static_cast<bool>(to))
    throw heat->error("a span of time has 'from' and 'to'", "give both, or none: the day of the captures");
  if (from) {
    out.span = TimeSpan{context.time(*from), context.time(*to)};
    if (out.span->end < out.span->begin)
      throw to->error(strf("'to' is %.4g hours before 'from'", (out.span->begin - out.span->end) / 3600),
                      "a span over midnight ends on the next date");
    if (!(out.span->end - out.span->begin >= kHeatParts * s.step))
      throw to->error(strf("the span of %g s is shorter than %u steps", out.span->end - out.span->begin, kHeatParts),
                      "a later 'to' or a smaller step_s");
  }
  const double length = out.span ? out.span->end - out.span->begin : 86400;
  s.periodic = heat->boolean("repeats", length <= 90000);
  read_points(*heat, out);
  read_lateral(*heat, out);
  if (!s.periodic && length < 86400)
    throw heat->error("a span that does not repeat begins with a whole day",
                      "make it a day or longer, or 'repeats: true'");
  return out;
}

}  // namespace suite
