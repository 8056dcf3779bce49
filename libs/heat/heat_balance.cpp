#include "heat/heat_balance.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/parallel.h"
#include "heat/heat_walk.h"
#include "heat/path_errors.h"
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
    for (const float v : map.values) sum += double{v};
    return [mean = sum / static_cast<double>(map.values.size())](double) { return mean; };
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
  const std::vector<bool> used = used_materials(tracer);
  for (const uint32_t m : faces.materials()) {
    const Scene& scene = tracer.scene();
    const auto kelvin = own_temperature(scene, m, spec.span);
    if (!kelvin && used[m] && !scene.materials[m].surface.model.empty())
      throw Error("material '" + scene.materials[m].id + "' has no temperature, and its surroundings' are to be found",
                  "give it 'temperature: {model: heat, ...}', or one of its own (temperature_k, a table)");
    for (size_t k = 0; k < moments; ++k)
      out[(faces.outside_material(m) - first) * moments + k] = kelvin ? body(kelvin(loads.moments[k])) : 0;
  }
  return out;
}

// W/m2 by face and moment.
std::vector<double> absorbed(const Sunlight& sun, const WeatherLoads& loads, const HeatSpec& spec) {
  const size_t moments = loads.moments.size();
  std::vector<double> out(sun.faces() * moments);
  parallel_for(0, sun.faces(), 64, [&](size_t begin, size_t end) {
    for (size_t f = begin; f < end; ++f)
      for (size_t k = 0; k < moments; ++k) {
        double sum = double{sun.beam[f * moments + k]} * loads.direct[k];
        if (loads.global[k] > 0) {
          const float *takes = &sun.sky[f * kSkyPatches], *sky = loads.sky[k].data();
          double diffuse = 0;
          for (uint32_t p = 0; p < kSkyPatches; ++p) diffuse += double{takes[p] * sky[p]};
          sum += diffuse + double{sun.below[f]} * spec.ground_albedo * loads.global[k] / kPi;
        }
        out[f * moments + k] = sum;
      }
  });
  return out;
}

std::string share_text(double share) { return strf("%.0f %%", 100 * share); }

// Conduction along a surface evens out what lies nearer to each other than 3 sqrt(k d / h) (a fin's length, h as in a
// light wind with radiation; d no deeper than a day's warmth goes); elements that are smaller differ more than they
// should.
double evened_over(const std::vector<SlabLayer>& layers) {
  constexpr double kFilm = 12, kDay = 86400;  // W/(m2 K), s
  double sheet = 0;                           // W/K
  for (const SlabLayer& layer : layers) {
    const double k = layer.conductivity[0], deep = std::sqrt(k * kDay / (kPi * layer.density * layer.specific_heat[0]));
    sheet += k * std::min(layer.thickness, deep);
    if (layer.thickness > deep) break;
  }
  return 3 * std::sqrt(sheet / kFilm);
}

std::vector<std::string> lateral_notes(const Scene& scene, const Elements& elements, const HeatOptics& optics) {
  std::vector<size_t> small(scene.materials.size(), 0), all(scene.materials.size(), 0);
  std::vector<double> reach(scene.materials.size(), 0);
  for (size_t m = 0; m < reach.size(); ++m) reach[m] = evened_over(optics.heated[m].layers);
  for (size_t e = 0; e < elements.size(); ++e) {
    const uint32_t m = elements[e].material;
    ++all[m], small[m] += std::sqrt(elements[e].area) < reach[m];
  }
  std::vector<std::string> notes;
  for (size_t m = 0; m < reach.size(); ++m)
    if (small[m] > 0)
      notes.push_back(
          strf("material '%s': %zu of %zu elements are smaller than the %.2g m over which conduction along the "
               "surface evens temperatures out, which is left out: fewer elements show what is there",
               scene.materials[m].id.c_str(), small[m], all[m], reach[m]));
  return notes;
}

void add_notes(const Tracer& tracer, const Elements& elements, const HeatOptics& optics, const ExchangePaths& exchange,
               const Sunlight& sun, bool dry_air, HeatResult& result) {
  auto& notes = result.notes;
  if (elements.moving() > 0)
    notes.push_back(strf("%zu instances move: they give shade, and count as warm as the air", elements.moving()));
  if (sun.mirrors)
    notes.push_back(
        strf("surfaces that mirror or refract without scattering are there: the sunlight that they send on is "
             "found as that of a sun %.0f degrees wide",
             2 * kWideSun / kDegree));
  for (const std::string& sentence : lateral_notes(tracer.scene(), elements, optics)) notes.push_back(sentence);
  if (uses_media(tracer.scene())) notes.push_back("media are passed by: they neither shade nor warm anything here");
  if (exchange.unfinished > 1e-6)
    notes.push_back(
        strf("%.2g of the infrared was still being reflected after %u reflections and counts as absorbed there",
             exchange.unfinished, kMostReflections));
  if (sun.unfinished > 1e-6)
    notes.push_back(strf("%.2g of the light of paths was still being reflected after %u reflections, and is left out",
                         sun.unfinished, kMostReflections));
  if (elements.shared_cells() > 0)
    notes.push_back(
        strf("%zu cells hold several materials of class maps; one with less than %.1f %% of a cell may have no "
             "element there, and is then as warm as the largest of the others",
             elements.shared_cells(), 100.0 / Elements::kLooks));
  const auto is_wet = [](const HeatedMaterial& m) { return m.front.wetness > 0; };
  if (dry_air && std::any_of(optics.heated.begin(), optics.heated.end(), is_wet))
    notes.push_back("the weather has no humidity: wet surfaces evaporate into dry air");
  for (const HeatOptics::Assumed& a : optics.assumed) {
    if (a.sunlight < 0.01 && a.infrared < 0.01) continue;
    notes.push_back(
        "material '" + optics.materials->materials[a.material].id + "': beyond its curves lie " +
        share_text(a.sunlight) + " of sunlight and " + share_text(a.infrared) +
        " of a body's light at 300 K, for which the ends of the curves (in the infrared their mean from 8 to "
        "14 um) are held");
  }
}

}  // namespace

std::vector<SurfaceGroup> surface_groups(const Elements& elements, const HeatFaces& faces, const HeatOptics& optics,
                                         const std::vector<double>& emissivity) {
  std::map<uint32_t, SurfaceGroup> by_material;
  for (uint32_t e = 0; e < elements.size(); ++e) {
    const HeatedMaterial& m = optics.heated[elements[e].material];
    SurfaceGroup& group = by_material[elements[e].material];
    if (group.front_rows.empty())
      group.layers = m.layers, group.front = m.front, group.back = m.back, group.behind = m.behind;
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
  const double x = position(t);
  const auto k = std::min(static_cast<size_t>(x), moments - 2);
  const float *row = &kelvin[face * moments + k], share = static_cast<float>(x - static_cast<double>(k));
  return static_cast<double>(row[0] + (row[1] - row[0]) * share);
}

double HeatResult::error_at(size_t face, double t) const {
  const auto part = static_cast<size_t>(position(t) / static_cast<double>(moments - 1) * kHeatParts);
  return double{path_error[face * kHeatParts + std::min<size_t>(part, kHeatParts - 1)]};
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
  const auto cut = [&](const std::vector<double>& from, size_t rows) {
    std::vector<double> out;
    for (size_t r = 0; r < rows; ++r)
      for (size_t k = 0; k < moments; ++k) out.push_back(from[r * all + (k + 1 == moments ? 0 : k)]);
    return out;
  };
  day.absorbed = cut(loads.absorbed, faces);
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
      b.sunlight += weight * loads.absorbed[face * moments + k];
      b.infrared += weight * traits.emissivity * h.received[face * moments + k];
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

// All that acts on the faces through the span.
SurfaceLoads face_loads(const Tracer& tracer, const Elements& elements, const HeatFaces& faces,
                        const HeatOptics& optics, const Sunlight& sun, const WeatherLoads& weather,
                        const HeatSpec& spec) {
  SurfaceLoads loads;
  loads.begin = spec.span.begin;
  for (size_t k = 0; k + 1 < weather.moments.size(); ++k)
    loads.steps.push_back(weather.moments[k + 1] - weather.moments[k]);
  loads.air = weather.air;
  loads.absorbed = absorbed(sun, weather, spec);
  for (size_t f = 0; f < faces.size(); ++f)
    loads.source.push_back(faces.is_back(f) ? 0 : optics.heated[elements[faces.element(f)].material].source);
  loads.outside = outsides(tracer, faces, weather, spec);
  return loads;
}

// Above this share plain sweeps over all histories are slow, below it they need one period each.
constexpr double kCavity = 0.8;

// Of what all faces emit, the share that ends on faces and not outside.
double enclosed(const ExchangePaths& exchange) {
  double inside = 0, all = 0;
  for (size_t k = 0; k < exchange.ends.size(); ++k) {
    all += double{exchange.weights[k]};
    if (exchange.ends[k] < exchange.faces()) inside += double{exchange.weights[k]};
  }
  return all > 0 ? inside / all : 0;
}

// What the result has of the parts that it was made from.
void keep(const SurfaceHistory& h, const SurfaceLoads& loads, const ExchangePaths& exchange, const Sunlight& sun,
          const WeatherLoads& weather, const HeatSpec& spec, HeatResult& result) {
  result.span = spec.span, result.periodic = spec.periodic, result.step = loads.steps.front();
  result.moments = h.moments;
  result.kelvin.assign(h.kelvin.begin(), h.kelvin.end());
  result.received.assign(h.received.begin(), h.received.end());
  result.absorbed.assign(loads.absorbed.begin(), loads.absorbed.end());
  result.step_error.assign(h.step_error.begin(), h.step_error.end());
  result.emissivity.assign(exchange.emissivity.begin(), exchange.emissivity.end());
  result.absorptance = sun.absorptance, result.sun_hours = sun.sun_hours;
  result.air_kelvin.assign(weather.air_kelvin.begin(), weather.air_kelvin.end());
  result.sweeps = h.coupling.sweeps, result.sweep_error = h.coupling.distance;
  if (spec.periodic) result.past_error = h.past_distance;
  result.rays = exchange.rays + sun.rays, result.unfinished = exchange.unfinished;
}

}  // namespace

HeatResult solve_heat(const Tracer& tracer, const Elements& elements, const HeatFaces& faces, const HeatOptics& optics,
                      const WeatherLoads& weather, const HeatSpec& spec, const HeatProgress& progress) {
  SUITE_CHECK(spec.paths % HeatSpec::kBlocks == 0 && spec.paths > 0);
  const auto stage = [&](const char* name, double whole) {
    if (progress.begin) progress.begin(name, whole);
  };
  const auto done = [&](size_t more) {
    if (progress.done) progress.done(static_cast<double>(more));
  };
  const PathOptions paths{HeatSpec::kBlocks, spec.paths / HeatSpec::kBlocks, spec.seed};
  const auto count = static_cast<double>(faces.size());
  stage("exchange of infrared", count);
  const ExchangePaths exchange = trace_exchange(tracer, elements, faces, optics, paths, done);
  stage("sunlight", count);
  const Sunlight sun = trace_sunlight(tracer, elements, faces, optics, weather.course, paths, 4, done);

  stage("balance", 1);
  const std::vector<SurfaceGroup> groups = surface_groups(elements, faces, optics, exchange.emissivity);
  const ExchangeMatrix matrix = exchange.matrix(faces.outsides());
  const SurfaceLoads loads = face_loads(tracer, elements, faces, optics, sun, weather, spec);

  CoupledSurfaces surfaces(groups, matrix);
  double mean_air = 0;
  for (const double T : weather.air_kelvin) mean_air += T / static_cast<double>(weather.air_kelvin.size());
  surfaces.start(mean_air);
  SurfaceOptions options;
  options.coupling.tolerance = spec.tolerance, options.past.tolerance = spec.tolerance;
  if (enclosed(exchange) > kCavity) options.coupling.memory = 5;
  HeatResult result;
  if (!spec.periodic) {
    const SurfaceHistory past = surfaces.solve(first_day(loads, weather, faces.size(), faces.outsides()), options);
    result.past_error = past.past_distance;
    options.periodic = false;
  }
  const SurfaceHistory h = surfaces.solve(loads, options);

  keep(h, loads, exchange, sun, weather, spec, result);
  result.assumed = optics.assumed;
  add_notes(tracer, elements, optics, exchange, sun, !weather.humid, result);
  sum_balance(elements, groups, loads, h, result);
  done(1);
  stage("errors", 1);
  result.path_error = path_errors({exchange, sun, weather, groups, loads, h, spec.ground_albedo});
  done(1);
  return result;
}

}  // namespace suite
