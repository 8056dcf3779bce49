// Scenes whose temperatures follow from the balance of heat, made in code, and runs of that balance on them.
#pragma once
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "formats/weather/weather.h"
#include "heat/day_sun.h"
#include "heat/heat_balance.h"
#include "motion/track.h"
#include "support/heat_kit.h"
#include "support/radiometry_kit.h"

namespace suite::test {

// What a material says of its heat; without numbers of a layer it has no heat capacity. No air unless a law is named.
inline TemperatureSpec heat(std::map<std::string, double> numbers = {}, std::map<std::string, std::string> texts = {}) {
  TemperatureSpec spec;
  spec.model = "heat";
  spec.numbers = std::move(numbers);
  spec.texts = std::move(texts);
  spec.texts.emplace("convection", "none");
  return spec;
}
// A sheet that conducts so well, and is so thin, that it is as warm as what is behind it.
inline TemperatureSpec held_at(double kelvin) {
  return heat({{"thickness_m", 1e-4},
               {"density_kg_m3", 1000},
               {"specific_heat_j_kg_k", 1000},
               {"conductivity_w_m_k", 1e4},
               {"back_k", kelvin}},
              {{"back", "ground"}});
}

// A rectangle a x b, or an endless plane (0), facing up, around the origin; and what tilts and shifts it.
inline Affine3 shifted(Vec3 by) {
  Affine3 m;
  m.b = by;
  return m;
}
// Turns +z into the direction of x' cross y'.
inline Affine3 with_axes(Vec3 x, Vec3 y, Vec3 origin = {}) {
  const Vec3 z = cross(x, y);
  Affine3 m;
  m.a = {x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z};
  m.b = origin;
  return m;
}
inline Affine3 upside_down(Vec3 by) { return with_axes({1, 0, 0}, {0, -1, 0}, by); }

class HeatedScene {
 public:
  HeatedScene() { scene_->groups.emplace_back().name = "root"; }
  // Lambert surfaces of an emissivity (and absorptance) whose temperature is found; and some of their own.
  uint32_t heated(double emissivity, const TemperatureSpec& spec) { return heated(lambert(1 - emissivity), spec); }
  uint32_t heated(ModelSpec optics, const TemperatureSpec& spec) {
    const uint32_t m = add(std::move(optics), 0);
    scene_->temperatures.push_back({m, spec});
    return m;
  }
  uint32_t given(double emissivity, double kelvin) { return given(lambert(1 - emissivity), kelvin); }
  uint32_t given(ModelSpec optics, double kelvin) { return add(std::move(optics), kelvin); }

  void exact(PrimitiveKind kind, std::vector<double> parameters, uint32_t material, const Affine3& place = {}) {
    scene_->primitives.push_back({"exact", kind, std::move(parameters), material});
    put(TargetKind::primitive, scene_->primitives.size() - 1, place);
  }
  void plane(double a, double b, uint32_t material, const Affine3& place = {}) {
    exact(PrimitiveKind::plane, {a, b}, material, place);
  }
  void mesh(Mesh m, const Affine3& place = {}) {
    scene_->meshes.push_back(std::move(m));
    put(TargetKind::mesh, scene_->meshes.size() - 1, place);
  }
  // The last one is there for a part of the time only.
  void there(TimeSpan life) {
    Schedule s;
    s.name = "comes and goes", s.life = life;
    scene_->schedules.push_back(s);
    scene_->groups.front().placements.back().schedule = static_cast<uint32_t>(scene_->schedules.size() - 1);
  }
  // The last one moves.
  void moves(TrackPtr track) {
    scene_->tracks.push_back({"'mover'", std::move(track)});
    scene_->groups.front().placements.back().track = static_cast<uint32_t>(scene_->tracks.size() - 1);
  }
  std::shared_ptr<Scene> scene() { return scene_; }

 private:
  uint32_t add(ModelSpec optics, double kelvin) {
    scene_->materials.push_back(material("m" + std::to_string(scene_->materials.size()), std::move(optics)));
    scene_->materials.back().temperature_k = kelvin;
    return static_cast<uint32_t>(scene_->materials.size() - 1);
  }
  void put(TargetKind kind, size_t target, const Affine3& place) {
    Placement p;
    p.to_parent = place;
    p.kind = kind, p.target = static_cast<uint32_t>(target);
    scene_->groups.front().placements.push_back(p);
  }
  std::shared_ptr<Scene> scene_ = std::make_shared<Scene>();
};

// A scene made ready for the balance.
struct HeatKit {
  std::shared_ptr<const Scene> scene;
  std::unique_ptr<const Tracer> tracer;
  HeatOptics optics;
  std::unique_ptr<const Elements> elements;
  std::unique_ptr<const HeatFaces> faces;

  // sun: towards it, where elements are to be cut by it. least: s, of what counts as a rest; 0 = none is looked for.
  HeatKit(HeatedScene made, size_t budget, TimeSpan span = {0, 86400}, const std::function<Dir(double)>& sun = {},
          double least = 0)
      : scene(made.scene()) {
    check_scene(*scene, "test scene");
    tracer = std::make_unique<const Tracer>(scene, std::nullopt, span);
    optics = heat_optics(*scene, used_materials(*tracer), {});
    const DaySun by = sun ? day_sun(*tracer, sun_moments(span, sun)) : DaySun{};
    const auto rests = least > 0 ? rest_intervals(*tracer, least) : std::vector<RestInterval>{};
    elements = std::make_unique<const Elements>(*tracer, optics.has_heat, budget, span.begin, sun ? &by : nullptr,
                                                std::span<const CellSplit>{}, rests);
    faces = std::make_unique<const HeatFaces>(*elements, optics);
  }
  ExchangePaths exchange(const PathOptions& options) const {
    return trace_exchange(*tracer, *elements, *faces, optics, options);
  }
  Sunlight sunlight(const SunCourse& course, const PathOptions& options) const {
    return trace_sunlight(*tracer, *elements, *faces, optics, course, options);
  }
  HeatResult solve(const WeatherLoads& loads, const HeatSpec& spec) const {
    return solve_heat(*tracer, *elements, *faces, optics, loads, spec);
  }
  double area(uint32_t material) const {
    double sum = 0;
    for (size_t e = 0; e < elements->size(); ++e) sum += (*elements)[e].material == material ? (*elements)[e].area : 0;
    return sum;
  }
};

// Standard error of a mean over blocks, from what the halves of each differ by over 2 (Sunlight::beam_of_block).
inline double error_of(const std::vector<double>& halves) {
  double squares = 0;
  for (const double half : halves) squares += half * half;
  return std::sqrt(squares) / static_cast<double>(halves.size());
}

// A sun that stands still, its spectrum even over the bins.
inline SunCourse still_sun(Dir towards, double angular_radius, const std::vector<double>& moments) {
  SunCourse course;
  course.moments = moments;
  course.towards = [towards](double) { return towards; };
  course.angular_radius = angular_radius;
  const size_t bins = sunlight_state().size();
  const std::vector<float> even(bins, 1 / static_cast<float>(bins));
  course.beam.assign(moments.size(), even);
  course.sky = even;
  return course;
}

inline std::vector<double> evenly(TimeSpan span, size_t steps) {
  std::vector<double> out;
  for (size_t k = 0; k <= steps; ++k)
    out.push_back(span.begin + (span.end - span.begin) * static_cast<double>(k) / static_cast<double>(steps));
  return out;
}

// The same at all times, W/m2, K, m/s: beam on a plane that faces the sun, an even sky, black longwave.
struct StillWeather {
  double direct = 0, diffuse = 0, longwave = 0, air_kelvin = 300, wind = 0;
  Dir sun{0, 0, 1};
  double angular_radius = 0;
};
inline WeatherLoads still_loads(const StillWeather& w, TimeSpan span, size_t steps) {
  WeatherLoads out;
  out.moments = evenly(span, steps);
  const size_t n = out.moments.size();
  out.air = {{span.begin, span.end}, {w.air_kelvin, w.air_kelvin}, {w.wind, w.wind}, {0, 0}, true};
  out.direct.assign(n, w.direct), out.diffuse.assign(n, w.diffuse), out.longwave.assign(n, w.longwave);
  out.global.assign(n, w.diffuse + w.direct * std::fmax(w.sun.z, 0)), out.air_kelvin.assign(n, w.air_kelvin);
  out.sky.assign(n, std::vector<float>(kSkyPatches, static_cast<float>(w.diffuse / kPi)));
  out.course = still_sun(w.sun, w.angular_radius, out.moments);
  return out;
}

// What faces absorb of the sun's beam, W/m2 at normal incidence.
inline CompactRows absorbed_of(const Sunlight& sun, double beam) {
  std::vector<float> all;
  for (const float takes : sun.beam.floats()) all.push_back(static_cast<float>(beam * double{takes}));
  return {all, sun.moments};
}

// Loads of CoupledSurfaces without air or sun: what the outsides emit, W/m2, at all times.
inline SurfaceLoads still_exchange(const HeatKit& kit, const std::vector<double>& outside, TimeSpan span,
                                   size_t steps) {
  SurfaceLoads loads;
  loads.begin = span.begin;
  loads.steps.assign(steps, (span.end - span.begin) / static_cast<double>(steps));
  loads.air = {{span.begin, span.end}, {300, 300}, {0, 0}, {0, 0}, true};
  loads.absorbed = CompactRows(kit.faces->size(), steps + 1);
  for (const double emitted : outside) loads.outside.insert(loads.outside.end(), steps + 1, emitted);
  return loads;
}
// What the outsides of a scene emit: sky, ground beyond and what moves as black bodies of one temperature, materials
// as theirs.
inline std::vector<double> outsides_at(const HeatKit& kit, double kelvin) {
  std::vector<double> out(kit.faces->outsides(), black(kelvin));
  const auto first = static_cast<uint32_t>(kit.faces->size());
  for (const uint32_t m : kit.faces->materials())
    out[kit.faces->outside_material(m) - first] = black(kit.scene->materials[m].temperature_k);
  return out;
}

// A summer day at 45 degrees north that repeats, in UTC on the zero meridian, as rows of 10 min.
inline Weather summer_weather(double wind = 2, double swing = 6) {
  std::string text =
      "site: 45 0 0\ntime_utc, air_temperature [K], relative_humidity [%], wind_speed [m/s], direct_normal [W/m2], "
      "diffuse [W/m2], longwave_down [W/m2]\n";
  for (int i = -36; i <= 180; ++i) {
    const double hour = i / 6.0, c = std::cos(2 * kPi * (hour - 15) / 24), up = std::cos(2 * kPi * (hour - 12) / 24);
    const int day = i < 0 ? 20 : i < 144 ? 21 : 22, minute = ((i + 144) % 144) * 10;
    text += strf("2020-06-%02dT%02d:%02dZ, %.3f, 50, %.2f, %.3f, %.3f, %.3f\n", day, minute / 60, minute % 60,
                 293 + swing * c, wind, std::fabs(hour - 12) < 6.5 ? 800 * std::fmax(0.0, up) : 0,
                 std::fabs(hour - 12) < 6.5 ? 90 * std::fmax(0.0, up) : 0, 330 + 15 * c);
  }
  return parse_weather(text, "summer.csv");
}
// Second 0 is midnight of the day.
inline WeatherLoads summer_loads(const Weather& weather, const HeatSpec& spec) {
  const double midnight = weather.clock().seconds(parse_iso8601("2020-06-21T00:00:00Z"));
  return weather_loads({weather, [midnight](double t) { return midnight + t; },
                        [&weather, midnight](double t) { return weather.sun(midnight + t); }},
                       spec);
}

}  // namespace suite::test
