#include "heat/heat_balance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "heat/absorbed_sunlight.h"
#include "heat/heat_audit.h"
#include "heat/heat_notes.h"
#include "heat/lateral.h"
#include "heat/path_errors.h"
#include "heat/step_errors.h"
#include "spectral/planck.h"

namespace suite {

namespace {

double body(double kelvin) { return kStefanBoltzmann * kelvin * kelvin * kelvin * kelvin; }

// Mean of ln(sec zenith) over a ring, weighed as level ground receives: -ln(mu) 2 mu between its cosines.
double ring_logarithm(uint32_t ring) {
  const auto primitive = [](double mu) { return mu > 0 ? mu * mu * (0.5 - std::log(mu)) : 0; };
  const double low = std::sqrt(double{1} * ring / HeatFaces::kRings),
               high = std::sqrt(double{1} * (ring + 1) / HeatFaces::kRings);
  return (primitive(high) - primitive(low)) * HeatFaces::kRings;
}

// Temperature (K) of a material with one of its own, as a mean over its places.
std::function<double(double)> own_temperature(const Scene& scene, uint32_t m, TimeSpan span) {
  for (const PropertyBinding& b : scene.property_bindings) {
    const PropertyMap& map = scene.property_maps[b.property_map];
    if (b.material != m || map.kind != MapKind::temperature || map.values.empty()) continue;
    double sum = 0;
    size_t places = 0;
    for (const float v : map.values)
      if (!std::isnan(v)) sum += double{v}, ++places;
    if (!places) continue;
    return [mean = sum / static_cast<double>(places)](double) { return mean; };
  }
  for (const TemperatureBinding& t : scene.temperatures)
    if (t.material == m && !t.spec.model.empty()) {
      const auto field = std::make_shared<const SolvedField>(t.spec, span.begin, span.end);
      return [field](double time) { return field->kelvin({}, time); };
    }
  const double kelvin = scene.materials[m].temperature_k;
  if (!(kelvin > 0)) return {};
  return [kelvin](double) { return kelvin; };
}

// What the outsides emit: by outside and moment.
std::vector<double> outsides(const Tracer& tracer, const HeatFaces& faces, const WeatherLoads& loads,
                             const HeatSpec& spec) {
  const size_t moments = loads.moments.size();
  std::vector<double> out(faces.outsides() * moments);
  const auto first = static_cast<uint32_t>(faces.size());
  for (size_t k = 0; k < moments; ++k) {
    const double air = body(loads.air_kelvin[k]), emissivity = loads.longwave[k] / air;
    // Clouds are as warm everywhere: the less the sky emits of what the air would, the clearer it is.
    // A sky that hardly emits, as that of space, is even: no ring would be left with less than nothing.
    const double b = std::min(0.09 * std::clamp((1 - emissivity) / 0.25, 0.0, 1.0), 2 * emissivity);
    for (uint32_t r = 0; r < HeatFaces::kRings; ++r)
      out[(faces.outside_ring(r) - first) * moments + k] = (emissivity + b * (ring_logarithm(r) - 0.5)) * air;
    out[(faces.outside_below() - first) * moments + k] = air;
    out[(faces.outside_moving() - first) * moments + k] = air;
  }
  for (const uint32_t m : faces.materials()) {
    const auto kelvin = own_temperature(tracer.scene(), m, spec.span);
    for (size_t k = 0; k < moments; ++k)
      out[(faces.outside_material(m) - first) * moments + k] = kelvin ? body(kelvin(loads.moments[k])) : 0;
  }
  return out;
}

}  // namespace

std::vector<SurfaceGroup> surface_groups(const Elements& elements, const HeatFaces& faces, const HeatOptics& optics,
                                         const std::vector<double>& emissivity) {
  std::map<uint32_t, SurfaceGroup> by_material;
  for (uint32_t e = 0; e < elements.size(); ++e) {
    const HeatedMaterial& m = optics.heated[elements[e].material];
    SurfaceGroup& group = by_material[elements[e].material];
    if (group.front_rows.empty())
      group.name = optics.materials->materials[elements[e].material].id, group.layers = m.layers, group.front = m.front,
      group.back = m.back, group.behind = m.behind;
    group.front_rows.push_back(e);
    group.cosine_up.push_back(std::clamp(elements[e].normal.z, -1.0, 1.0));
    group.front_emissivity.push_back(emissivity[e]);
    if (!m.back_open) continue;
    group.back_rows.push_back(faces.back_of(e));
    group.back_emissivity.push_back(emissivity[faces.back_of(e)]);
  }
  std::vector<SurfaceGroup> groups;
  for (auto& [material, group] : by_material) groups.push_back(std::move(group));
  return groups;
}

double HeatResult::position(double t) const {
  const double length = span.end - span.begin;
  double s = t - span.begin;
  if (periodic) s -= std::floor(s / length) * length;
  return std::clamp(s / length, 0.0, 1.0) * static_cast<double>(moments - 1);
}

double HeatResult::kelvin_at(size_t face, double t) const {
  return between_moments({&kelvin[face * moments], moments}, t);
}

double HeatResult::between_moments(std::span<const float> row, double t) const {
  const double x = position(t);
  const auto k = std::min(static_cast<size_t>(x), moments - 2);
  return static_cast<double>(row[k] + (row[k + 1] - row[k]) * static_cast<float>(x - static_cast<double>(k)));
}

HeatErrors HeatResult::errors_at(size_t face, double t) const {
  const auto part = static_cast<size_t>(position(t) / static_cast<double>(moments - 1) * kHeatParts);
  const size_t at = face * kHeatParts + std::min<size_t>(part, kHeatParts - 1);
  return {double{path_error[at]}, double{size_error[at]}, double{step_error[at]}, std::hypot(sweep_error, past_error)};
}

double HeatResult::air_at(double t) const {
  const double x = position(t);
  const auto k = std::min(static_cast<size_t>(x), moments - 2);
  return static_cast<double>(air_kelvin[k]) +
         (static_cast<double>(air_kelvin[k + 1]) - static_cast<double>(air_kelvin[k])) * (x - static_cast<double>(k));
}

namespace {

// A span that does not repeat begins where its first day, repeated, would be.
SurfaceLoads first_day(const SurfaceLoads& loads, const WeatherLoads& weather, size_t faces, size_t outsides) {
  constexpr double kDay = 86400;
  size_t steps = 0;
  double length = 0;
  while (steps < loads.steps.size() && length + loads.steps[steps] / 2 < kDay) length += loads.steps[steps++];
  SurfaceLoads day;
  day.begin = loads.begin;
  day.steps.assign(loads.steps.begin(), loads.steps.begin() + static_cast<std::ptrdiff_t>(steps));
  const size_t all = loads.steps.size() + 1, moments = steps + 1;
  const auto cut = [&]<class Number>(const std::vector<Number>& from, size_t rows) {
    std::vector<Number> out;
    out.reserve(rows * moments);
    for (size_t r = 0; r < rows; ++r)
      for (size_t k = 0; k < moments; ++k) out.push_back(from[r * all + (k + 1 == moments ? 0 : k)]);
    return out;
  };
  for (std::vector<float> share : loads.shares) {
    share.resize(moments), share.back() = share.front();
    day.shares.push_back(std::move(share));
  }
  day.absorbed = CompactRows(faces, moments);
  std::vector<float> whole(all);
  for (size_t f = 0; f < faces; ++f) {
    loads.absorbed.get(f, whole);
    whole[steps] = whole[0];
    day.absorbed.set(f, {whole.data(), moments});
  }
  day.outside = cut(loads.outside, outsides);
  day.source = loads.source;
  const AirSeries& air = weather.air;
  for (size_t k = 0; k < air.times.size() && air.times[k] < loads.begin + length; ++k) {
    day.air.times.push_back(air.times[k]);
    day.air.kelvin.push_back(air.kelvin[k]), day.air.wind.push_back(air.wind[k]);
    day.air.vapour_pressure.push_back(air.vapour_pressure[k]);
  }
  day.air.times.push_back(loads.begin + length);
  for (auto* v : {&day.air.kelvin, &day.air.wind, &day.air.vapour_pressure}) v->push_back(v->front());
  day.air.pressure = air.pressure, day.air.repeat = true;
  return day;
}

// Of all faces over the span; by the rule of trapezoids between moments.
void sum_balance(const Elements& elements, const std::vector<SurfaceGroup>& groups, const SurfaceLoads& loads,
                 const SurfaceHistory& h, HeatResult& result) {
  const size_t moments = h.moments;
  const double length = result.span.end - result.span.begin;
  auto& b = result.balance;
  // Air as means around the moments, as what it took was averaged.
  std::vector<FaceWeather> air(moments);
  const auto fill = [&](const std::vector<double>& values, double FaceWeather::*to) {
    const AveragedTable table(loads.air.times, values, AveragedTable::Between::linear, loads.air.repeat);
    const double half = length / static_cast<double>(moments - 1) / 2;
    for (size_t k = 0; k < moments; ++k) {
      const double t = loads.begin + 2 * half * static_cast<double>(k);
      const double begin = std::max(t - half, loads.begin), end = std::min(t + half, loads.begin + length);
      air[k].*to = table.over(begin, end).mean();
    }
  };
  fill(loads.air.kelvin, &FaceWeather::air_kelvin), fill(loads.air.wind, &FaceWeather::wind);
  fill(loads.air.vapour_pressure, &FaceWeather::vapour_pressure);
  for (FaceWeather& w : air) w.pressure = loads.air.pressure;
  const auto add = [&](size_t face, const FaceTraits& traits, double source, double area) {
    for (size_t k = 0; k < moments; ++k) {
      const double weight = area * (k == 0 || k + 1 == moments ? 0.5 : 1) / static_cast<double>(moments - 1);
      const double kelvin = h.kelvin_at(face, k);
      b.sunlight += weight * loads.absorbed.at(face, k);
      b.infrared += weight * traits.emissivity * h.received.at(face, k);
      b.emitted += weight * traits.emissivity * body(kelvin);
      b.to_air += weight * loss_to_air(traits, air[k], kelvin);
      b.source += weight * source;
    }
  };
  for (const SurfaceGroup& group : groups) {
    double inside = 0;
    for (const SlabLayer& layer : group.layers) inside += layer.heat_generation * layer.thickness;
    for (size_t i = 0; i < group.front_rows.size(); ++i) {
      const uint32_t face = group.front_rows[i];
      const double area = elements[face].area;
      add(face, group.front_of(i), loads.source.empty() ? 0 : loads.source[face], area);
      if (!group.back_rows.empty()) add(group.back_rows[i], group.back_of(i), 0, area);
      b.source += area * inside;
      b.behind += area * h.behind[face] / length, b.stored += area * h.stored[face] / length;
    }
  }
}

// All that acts on the faces through the span, and how far paths and points may be off. Takes turns with what the
// sunlight has of them, which makes room.
SurfaceLoads face_loads(const HeatScene& scene, Sunlight& sun, const WeatherLoads& weather, const HeatSpec& spec,
                        LoadErrors& errors) {
  SurfaceLoads loads;
  loads.begin = spec.span.begin;
  for (size_t k = 0; k + 1 < weather.moments.size(); ++k)
    loads.steps.push_back(weather.moments[k + 1] - weather.moments[k]);
  loads.air = weather.air;
  loads.shares = interval_shares(scene.elements.rests(), weather.moments);
  absorb(sun, weather, spec.ground_albedo, loads.shares);
  const std::vector<float> uneven = uneven_sky(sun, weather, loads.shares, spec.paths / HeatSpec::kBlocks);
  sun.sky = {};
  loads.absorbed = std::move(sun.beam);
  errors = load_errors(sun, uneven, weather, loads.shares, spec.ground_albedo);
  for (size_t f = 0; f < scene.faces.size(); ++f)
    loads.source.push_back(
        scene.faces.is_back(f) ? 0 : scene.optics.heated[scene.elements[scene.faces.element(f)].material].source);
  loads.outside = outsides(scene.tracer, scene.faces, weather, spec);
  give_back_freed();
  return loads;
}

// Above this share plain sweeps over all histories are slow, below it they need one period each.
constexpr double kCavity = 0.8;

// Of what all faces emit, the share that ends on faces and not outside.
double enclosed(const ExchangePaths& exchange, size_t outsides) {
  double inside = 0, all = 0;
  for (size_t k = 0; k < exchange.ends.size(); ++k) {
    all += double{exchange.weights[k]};
    if (exchange.ends[k] < exchange.faces() || exchange.ends[k] >= exchange.faces() + outsides)
      inside += double{exchange.weights[k]};
  }
  return all > 0 ? inside / all : 0;
}

// What the result has of the parts that it was made from.
void keep(const SurfaceHistory& h, const SurfaceLoads& loads, const ExchangePaths& exchange, const Sunlight& sun,
          const WeatherLoads& weather, const HeatSpec& spec, HeatResult& result) {
  result.span = spec.span, result.periodic = spec.periodic, result.step = loads.steps.front();
  result.moments = h.moments;
  result.emissivity.assign(exchange.emissivity.begin(), exchange.emissivity.end());
  result.absorptance = sun.absorptance, result.sun_hours = sun.sun_hours;
  result.air_kelvin.assign(weather.air_kelvin.begin(), weather.air_kelvin.end());
  result.sweeps = h.coupling.sweeps, result.sweep_error = h.coupling.distance;
  result.rays = exchange.rays() + sun.rays(), result.unfinished = exchange.unfinished();
}

// Temperatures under the loads, from where a span that does not repeat begins.
SurfaceHistory balanced(const std::vector<SurfaceGroup>& groups, const SurfaceNeighbours& neighbours,
                        const ExchangePaths& exchange, size_t outside_count, const SurfaceLoads& loads,
                        const WeatherLoads& weather, const HeatSpec& spec, double& past_error) {
  const ExchangeMatrix matrix = exchange.matrix(outside_count);
  CoupledSurfaces surfaces(groups, {matrix, exchange}, neighbours);
  double mean_air = 0;
  for (const double T : weather.air_kelvin) mean_air += T / static_cast<double>(weather.air_kelvin.size());
  surfaces.start(mean_air);
  SurfaceOptions options;
  options.coupling.tolerance = spec.tolerance, options.past.tolerance = spec.tolerance;
  if (enclosed(exchange, outside_count) > kCavity) options.coupling.memory = 5;
  if (!spec.periodic) {
    past_error = surfaces.solve(first_day(loads, weather, exchange.faces(), outside_count), options).past_distance;
    options.periodic = false;
  }
  options.last = true;
  SurfaceHistory h = surfaces.solve(loads, options);
  if (spec.periodic) past_error = h.past_distance;
  return h;
}

// As floats, row by row.
std::vector<float> floats_of(const Histories& h) {
  std::vector<float> out;
  out.reserve(h.rows() * h.moments());
  for (size_t row = 0; row < h.rows(); ++row)
    for (size_t m = 0; m < h.moments(); ++m) out.push_back(static_cast<float>(h.at(row, m)));
  return out;
}

void begin(const HeatProgress& progress, const char* stage, double whole = 0, const char* unit = "") {
  if (progress.begin) progress.begin(stage, whole, unit);
}

void tell_done(const HeatProgress& progress, double more) {
  if (progress.done) progress.done(more);
}

}  // namespace

void check_surroundings(const HeatScene& scene, const HeatSpec& spec) {
  const std::vector<bool> used = used_materials(scene.tracer);
  const std::vector<Material>& materials = scene.tracer.scene().materials;
  for (const uint32_t m : scene.faces.materials())
    if (used[m] && !materials[m].surface.model.empty() && !own_temperature(scene.tracer.scene(), m, spec.span))
      throw Error("material '" + materials[m].id + "' has no temperature, and its surroundings' are to be found",
                  "give it 'temperature: {model: heat, ...}', or one of its own (temperature_k, a table)");
}

HeatResult solve_heat(const HeatScene& scene, HeatOperator&& found, const WeatherLoads& weather, const HeatSpec& spec,
                      const HeatProgress& progress) {
  const ExchangePaths& exchange = found.exchange;
  SUITE_CHECK(exchange.faces() == scene.faces.size() && found.sun.faces() == scene.faces.size());
  SUITE_CHECK_EQ(found.sun.moments, weather.moments.size());
  check_surroundings(scene, spec);
  begin(progress, "balance");
  const std::vector<SurfaceGroup> groups =
      surface_groups(scene.elements, scene.faces, scene.optics, exchange.emissivity);
  LoadErrors load_errors;
  SurfaceLoads loads = face_loads(scene, found.sun, weather, spec, load_errors);
  const LateralConduction lateral =
      spec.lateral ? lateral_conduction(scene.elements, scene.optics) : LateralConduction{};
  HeatResult result;
  SurfaceHistory h =
      balanced(groups, lateral.neighbours, exchange, scene.faces.outsides(), loads, weather, spec, result.past_error);
  give_back_freed();
  keep(h, loads, exchange, found.sun, weather, spec, result);
  result.assumed = scene.optics.assumed;
  result.notes = heat_notes(scene, found, !weather.humid);
  for (const std::string& note : {apart_note(lateral), visitors_note(scene, exchange, h), rests_note(scene, found)})
    if (!note.empty()) result.notes.push_back(note);
  sum_balance(scene.elements, groups, loads, h, result);
  give_back_freed();
  begin(progress, "errors");
  const SolvedSurfaces solved{exchange, found.sun, weather, groups, loads, h, spec.ground_albedo, lateral.neighbours};
  LinearErrors errors = linear_errors(solved, std::move(load_errors));
  result.path_error = std::move(errors.paths), result.size_error = std::move(errors.size);
  result.step_error = step_errors(solved);
  const bool audits = spec.audit > 0 && !stands_in_several_places(scene);
  if (spec.audit > 0 && !audits)
    result.notes.push_back("no audit is made: its walks do not go with what stands in several places");
  if (audits) {
    begin(progress, "audit", static_cast<double>(spec.audit), "probe");
    result.audit =
        audit_heat({scene.tracer, scene.elements, scene.faces, scene.optics, spec.periodic, spec.seed}, solved,
                   spec.audit, {}, [&](size_t more) { tell_done(progress, static_cast<double>(more)); });
  }
  found = {};
  give_back_freed();
  // Who touches whom takes room, in large meshes much: last.
  if (!spec.lateral)
    for (const std::string& note : lateral_notes(scene.tracer.scene(), scene.elements, scene.optics, h))
      result.notes.push_back(note);
  give_back_freed();
  result.absorbed = loads.absorbed.floats();
  loads.absorbed = {};
  result.received = h.received.floats();
  h.received = {};
  result.kelvin = floats_of(h.kelvin);
  return result;
}

HeatResult solve_heat(const Tracer& tracer, const Elements& elements, const HeatFaces& faces, const HeatOptics& optics,
                      const WeatherLoads& weather, const HeatSpec& spec, const HeatProgress& progress) {
  SUITE_CHECK(spec.paths % HeatSpec::kLeastPaths == 0 && spec.paths > 0);
  const HeatScene scene{tracer, elements, faces, optics};
  const auto done = [&](size_t more) { tell_done(progress, static_cast<double>(more)); };
  HeatOperator found;
  begin(progress, "exchange of infrared", static_cast<double>(faces.size()), "face");
  found.exchange = find_exchange(scene, path_options(spec), nullptr, done);
  begin(progress, "sunlight", static_cast<double>(faces.size()), "face");
  found.sun = find_sunlight(scene, weather.course, path_options(spec), nullptr,
                            [&](size_t more) { tell_done(progress, static_cast<double>(more) / kSunStages); });
  return solve_heat(scene, std::move(found), weather, spec, progress);
}

}  // namespace suite
