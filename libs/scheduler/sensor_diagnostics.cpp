#include "scheduler/sensor_diagnostics.h"

#include <algorithm>
#include <cmath>

#include "math/sampling.h"
#include "motion/time.h"
#include "optics/models.h"
#include "scene/primitives.h"
#include "spectral/display_colour.h"
#include "surface/material_lookup.h"

namespace suite {

namespace {

// Some captures of a sensor, evenly chosen.
std::vector<const Capture*> some_captures(const Sensor& sensor, size_t most) {
  std::vector<const Capture*> all, some;
  for (const Task& task : sensor.tasks())
    for (const Capture& c : task.captures) all.push_back(&c);
  for (size_t i = 0; i < std::min(all.size(), most); ++i)
    some.push_back(all[i * all.size() / std::min(all.size(), most)]);
  return some;
}

bool glows(const Scene& scene) {
  return !scene.temperatures.empty() || uses_media(scene) ||
         std::any_of(scene.materials.begin(), scene.materials.end(), [](auto& m) { return m.temperature_k > 0; }) ||
         std::any_of(scene.property_maps.begin(), scene.property_maps.end(),
                     [](auto& m) { return m.kind == MapKind::temperature; });
}

bool set(const FarDisk& body) { return body.direction.z < -std::sin(body.half_angle); }

std::string when(const SourceTime* date, double moment) {
  return date ? " at " + to_iso8601(utc_from_instant(instant_from_utc(parse_iso8601(date->utc)) + moment), 0)
              : std::string();
}

// The first few of many names.
std::string named(const std::vector<std::string>& names) {
  constexpr size_t most = 5;
  std::string text;
  for (size_t i = 0; i < std::min(names.size(), most); ++i) text += (i ? ", " : "") + names[i];
  return names.size() > most ? text + strf(" and %zu more", names.size() - most) : text;
}

// Sun and Moon have set whenever the sensor looks, and nothing else shines.
std::optional<SensorDiagnostic> night(const SourceSpecs& written, const Scene& scene, const Sensor& sensor) {
  const bool others = std::any_of(written.lights.begin(), written.lights.end(), [](auto& l) { return !l->disk(); });
  if (!written.sun() || others || written.has_air() || glows(scene)) return std::nullopt;
  SourcesInTime sources(written, scene);
  double highest = -1, moment = 0;
  for (const Capture* c : some_captures(sensor, 64)) {
    const SourceSpecs& now = sources.at(moment_of(*c));
    for (const LightSpecPtr& light : now.lights)
      if (!set(*light->disk())) return std::nullopt;
    const double height = now.sun()->disk()->direction.z;
    if (height > highest) highest = height, moment = moment_of(*c);
  }
  return SensorDiagnostic{
      Dr::sun_below_horizon, sensor.name(),
      strf("the sun is %.1f degrees below the horizon%s and nothing else shines: the picture will be black",
           -std::asin(std::max(-1.0, highest)) / kDegree, when(written.sun()->date(), moment).c_str()),
      "give a time of day or a direction with the sun up, or a `sky`, a `moon` or `lamps`"};
}

// Under air the sun lights what a sensor sees from below the horizon, ever less.
std::optional<SensorDiagnostic> twilight(const SourceSpecs& written, const Scene& scene, const Sensor& sensor) {
  constexpr double kDusk = -6 * kDegree, kThermal = 3;  // the end of civil twilight; um
  const bool others = std::any_of(written.lights.begin(), written.lights.end(), [](auto& l) { return !l->disk(); });
  if (!written.sun() || others || !written.has_air()) return std::nullopt;
  std::vector<std::string> dark;
  for (size_t s = 0; s < sensor.states().size(); ++s)
    for (const Band& b : sensor.bands(s))
      if (b.center_um < kThermal) dark.push_back("'" + b.name + "'");
  if (dark.empty()) return std::nullopt;
  SourcesInTime sources(written, scene);
  double highest = -kPi, moment = 0;
  for (const Capture* c : some_captures(sensor, 64)) {
    const SourceSpecs& now = sources.at(moment_of(*c));
    for (const LightSpecPtr& light : now.lights) {
      const double rise = std::asin(std::clamp(normalized(light->disk()->direction).z, -1.0, 1.0));
      if (rise > highest) highest = rise, moment = moment_of(*c);
    }
  }
  if (highest > kDusk) return std::nullopt;
  return SensorDiagnostic{
      Dr::sun_below_horizon, sensor.name(),
      strf("the sun is %.1f degrees below the horizon%s and nothing else shines: band %s gets what is left of twilight",
           -highest / kDegree, when(written.sun()->date(), moment).c_str(), named(dark).c_str()),
      "give a time of day or a direction with the sun up, or a `moon` or `lamps`"};
}

// A flat plane without end is under the air of a round Earth, too: it shades all of it from a Sun that has set.
std::optional<SensorDiagnostic> shaded_twilight(const SourceSpecs& written, const Scene& scene, const Sensor& sensor) {
  const auto endless = std::find_if(scene.primitives.begin(), scene.primitives.end(), [](const Primitive& p) {
    return p.kind == PrimitiveKind::plane && primitive_box(p).empty();
  });
  if (endless == scene.primitives.end() || !written.air || !written.sun()) return std::nullopt;
  SourcesInTime sources(written, scene);
  for (const Capture* c : some_captures(sensor, 64)) {
    const FarDisk* sun = sources.at(moment_of(*c)).sun()->disk();
    if (!set(*sun)) continue;
    return SensorDiagnostic{
        Dr::no_twilight, sensor.name(),
        strf("the sun is %.1f degrees below the horizon%s, and the endless plane '%s' shades all air from it: "
             "there is no twilight",
             -std::asin(sun->direction.z) / kDegree, when(written.sun()->date(), moment_of(*c)).c_str(),
             endless->name.c_str()),
        "give the plane a size; `earth` goes on around it"};
  }
  return std::nullopt;
}

// Bands in which no source sends anything, of a scene that does not glow itself.
std::optional<SensorDiagnostic> dark_bands(const SourceSpecs& now, const Scene& scene, const Sensor& sensor) {
  if (!now.any() || glows(scene) || now.has_air()) return std::nullopt;
  std::vector<std::string> names;
  for (size_t s = 0; s < sensor.states().size(); ++s)
    for (const Band& b : sensor.bands(s)) {
      const bool lit = std::any_of(now.lights.begin(), now.lights.end(),
                                   [&](auto& light) { return light->shines(b.low_um(), b.high_um()); });
      const std::string name = strf("'%s' (%.3g um)", b.name.c_str(), b.center_um);
      if (!lit && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  if (names.empty()) return std::nullopt;
  return SensorDiagnostic{Dr::unlit_band, sensor.name(),
                          "no source sends light in band " + named(names) + " and nothing in the scene glows there",
                          "give the sources spectra that reach it, the scene temperatures, or the sensor other bands"};
}

// Bands beyond the tabulated ends of every spectrum of the scene, where only `outside` says what the surfaces are.
// Loading drops points far from the sensors' bands, so only the ends that are nearest to them are known here.
std::optional<SensorDiagnostic> unknown_bands(const Scene& scene, const Sensor& sensor) {
  double low = INFINITY, high = 0;
  const auto widen = [&](double from, double to) { low = std::min(low, from), high = std::max(high, to); };
  for (const Material& m : scene.materials) {
    if (m.surface.model.empty()) continue;
    bool tabulated = false;
    for (const auto& [name, curve] : m.surface.curves) {
      if (curve.is_constant()) continue;
      tabulated = true;
      widen(curve.low_um(), curve.high_um());
    }
    if (!tabulated) return std::nullopt;  // the same at all wavelengths
  }
  for (const PropertyMap& m : scene.property_maps) {
    for (const double w : m.wavelength_um) widen(w, w);
    for (const Curve& c : m.family) widen(c.low_um(), c.high_um());
  }
  for (size_t s = 0; s < sensor.states().size() && high > 0; ++s)
    for (const Band& b : sensor.bands(s))
      if (b.low_um() > high || b.high_um() < low)
        return SensorDiagnostic{
            Dr::band_beyond_spectra, sensor.name(),
            strf("band '%s' (%.3g um) lies beyond the ends of all spectra of the scene, of which the nearest is "
                 "at %.3g um: what is seen there is only what their `outside` says",
                 b.name.c_str(), b.center_um, b.low_um() > high ? high : low),
            "give the materials spectra that cover it, or the sensor other bands"};
  return std::nullopt;
}

// Bands where a display colour says nothing of the materials that have their spectra from one.
std::optional<SensorDiagnostic> guessed_bands(const Scene& scene, const Sensor& sensor) {
  size_t guessed = 0;
  std::string first;
  for (const Material& m : scene.materials)
    if (m.description.starts_with(kUplifted) && guessed++ == 0) first = m.id;
  if (!guessed) return std::nullopt;
  const double low = uplifted_wavelengths_um().front(), high = uplifted_wavelengths_um().back();
  std::vector<std::string> names;
  for (size_t s = 0; s < sensor.states().size(); ++s)
    for (const Band& b : sensor.bands(s)) {
      const std::string name = strf("'%s' (%.3g um)", b.name.c_str(), b.center_um);
      if ((b.low_um() < low - 1e-9 || b.high_um() > high + 1e-9) &&
          std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(name);
    }
  if (names.empty()) return std::nullopt;
  return SensorDiagnostic{
      Dr::guessed_bands, sensor.name(),
      "band " + named(names) +
          strf(" reaches beyond %g to %g um, where %zu materials have reflectances uplifted from display "
               "colours (the first is '%s'): the value at that end is held there, which is a guess",
               low, high, guessed, first.c_str()),
      "give these materials measured spectra where that matters", false};
}

std::optional<SensorDiagnostic> too_long(const SourceSpecs& written, const Scene& scene, const Sensor& sensor) {
  const std::optional<LongExposure> e = long_exposure(written, scene, sensor);
  if (!e) return std::nullopt;
  return SensorDiagnostic{
      Dr::long_exposure, sensor.name(),
      strf("capture '%s' lasts %.4g s, in which the %s moves by %.3g degrees (its radius is %.3g) and what it "
           "sends to level ground changes by %.2g %%; it is taken where it stands in the middle",
           e->capture.c_str(), e->seconds, e->body.c_str(), e->moved / kDegree, e->radius / kDegree,
           100 * e->irradiance_change),
      "divide it into shorter captures (lines_per_capture, tasks, integration times) where that matters", false};
}

}  // namespace

std::vector<SensorDiagnostic> diagnose_lights(const SourceSpecs& written, const Scene& scene, Sensors sensors) {
  std::vector<SensorDiagnostic> all;
  if (sensors.empty()) return all;
  const SourceSpecs first = first_sources(written, scene, sensors);
  for (const auto& sensor : sensors) {
    std::optional<SensorDiagnostic> found = night(written, scene, *sensor);
    if (!found) found = shaded_twilight(written, scene, *sensor);
    if (!found) found = twilight(written, scene, *sensor);
    if (!found) found = dark_bands(first, scene, *sensor);
    if (!found) found = unknown_bands(scene, *sensor);
    if (found) all.push_back(*found);
    if (auto guessed = guessed_bands(scene, *sensor)) all.push_back(*guessed);
    if (auto slow = too_long(written, scene, *sensor)) all.push_back(*slow);
  }
  return all;
}

void SensorOutcome::add(std::span<const Band> of, const CaptureResult& result, const RunStatistics& statistics) {
  paths += statistics.paths, nodes += statistics.nodes;
  for (size_t b = 0; b < result.bands && b < of.size(); ++b) {
    size_t i = static_cast<size_t>(std::find(bands.begin(), bands.end(), of[b].name) - bands.begin());
    if (i == bands.size()) bands.push_back(of[b].name), bright.push_back(false);
    for (size_t v = b; v < result.radiance.size() && !bright[i]; v += result.bands) bright[i] = result.radiance[v] > 0;
  }
}

std::optional<SensorDiagnostic> diagnose_outcome(const Sensor& sensor, const SensorOutcome& o, bool complete) {
  const size_t lit = static_cast<size_t>(std::count(o.bright.begin(), o.bright.end(), true));
  const bool missed = complete && o.paths > 0 && o.nodes == 0;
  if (missed && (lit == 0 || o.looks_down))
    return SensorDiagnostic{Dr::nothing_hit, sensor.name(),
                            lit ? "none of its paths met anything: the picture shows the sky alone"
                                : "none of its paths met anything: the picture is black",
                            "check where it stands and looks: metres east, north and up in the scene's frame"};
  if (o.bands.empty() || lit == o.bands.size()) return std::nullopt;
  if (lit == 0)
    return SensorDiagnostic{
        Dr::all_zero, sensor.name(), "every pixel of every band is zero: no light reaches what it sees",
        "check the sources (directions, spectra), the surfaces' reflectance in its bands and what shades them"};
  std::vector<std::string> names;
  for (size_t b = 0; b < o.bands.size(); ++b)
    if (!o.bright[b]) names.push_back("'" + o.bands[b] + "'");
  return SensorDiagnostic{Dr::band_zero, sensor.name(), "every pixel of band " + named(names) + " is zero",
                          "check the spectra of the sources and of the surfaces there"};
}

SensorRay middle_ray(const Sensor& sensor, const Capture& capture, size_t problem) {
  const std::vector<double> u(static_cast<size_t>(sensor.numbers()), 0.5);
  std::vector<float> weights(sensor.states()[capture.state].size());
  return sensor.ray({capture, problem, u, weights});
}

CaptureResult with_blind_flagged(const Sensor& sensor, const Capture& capture, CaptureResult result) {
  constexpr int kLooks = 64;
  const size_t values = result.values_per_problem();
  std::vector<double> u(static_cast<size_t>(sensor.numbers()));
  std::vector<float> weights(sensor.states()[capture.state].size());
  for (size_t i = 0; i < result.problems(); ++i) {
    const std::span<const double> light(&result.radiance[i * values], values);
    if (std::any_of(light.begin(), light.end(), [](double L) { return L != 0; })) continue;
    bool looks = false;
    Pcg32 rng(i);
    for (int k = 0; k < kLooks && !looks; ++k) {
      for (double& x : u) x = rng.uniform();
      looks = sensor.ray({capture, i, u, weights}).weight != 0;  // NaN: a sample that fails, which is counted
    }
    if (!looks) result.quality[i] |= quality_no_information;
  }
  return result;
}

}  // namespace suite
