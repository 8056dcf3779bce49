// Temperatures of a scene's elements through a span of time: what weather, sun and neighbours do to them, and the
// errors of all of it.
//
// Method: the exchange of infrared and the sunlight of every face are traced once (exchange_paths.h, sunlight.h);
// weather turns them into loads; the balance of all elements is solved over the whole span (surfaces.h). The standard
// error of the paths is what independent halves of them differ by (path_numbers.h), followed through the balance
// linearised about the solution.
//
// Assumes: the same weather all over the scene, on faces as it stands in the file; a grey sky whose infrared varies
// with the zenith angle after M. H. Unsworth & J. L. Monteith, Q. J. R. Meteorol. Soc. 101, 1975 (b = 0.09 in a clear
// sky); sunlight spread over the sky after Perez et al. 1993 (light/perez_sky.h); beyond the scene even ground as warm
// as the air. What moves, comes or goes is part of the exchange in intervals of rest (rests.h), and while it moves
// gives shade and is as warm as the air to others. Without such intervals what moves has no elements, and what comes
// and goes is part of the exchange for its share of the span, whenever that is. Media are passed by.
#pragma once
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "heat/audit_result.h"
#include "heat/elements.h"
#include "heat/exchange_paths.h"
#include "heat/heat_operator.h"
#include "heat/heat_optics.h"
#include "heat/surfaces.h"
#include "heat/weather.h"
#include "motion/scene_frame.h"

namespace suite {

struct HeatSpec {
  TimeSpan span;               // s of the simulation: what is solved
  double step = 600;           // s
  bool periodic = true;        // the span repeats for ever; else it goes on from its first day's periodic state
  size_t elements = 20000;     // about
  bool cut_by_sun = true;      // elements, where it differs within them (day_sun.h); else they are of about equal areas
  uint32_t paths = 64;         // of a face, for each of infrared and sunlight; a multiple of kLeastPaths
  double target = 0;           // K, by the paths: asks for as many (target_paths.h); 0 = the paths are given
  double tolerance = 0.01;     // K, of sweeps and of the past
  double ground_albedo = 0.2;  // of sunlight, beyond the scene
  bool lateral = false;        // elements conduct to their neighbours along the surface, too (lateral.h)
  uint64_t seed = 1;
  size_t audit = 0;       // probes of heat_audit.h; 0 = none
  size_t intervals = 24;  // of rest, at most; 1: none are looked for
  static constexpr uint32_t kBlocks = 8, kLeastPaths = 2 * kBlocks;
};

// Sun and weather in the simulation's time.
struct HeatWeather {
  const Weather& weather;
  std::function<double(double t)> clock;  // s of the weather's clock at s of the simulation
  std::function<SkyBody(double t)> sun;   // scene ENU, at s of the simulation
};

// Means over parts of the span, by face: [face][part].
inline constexpr uint32_t kHeatParts = Sunlight::kParts;

// How far a temperature may be off, K, each cause for itself: standard error by the paths; root of the mean square of
// what places differ from the mean of their element; by the steps in time; by ending sweeps and the past.
struct HeatErrors {
  double paths = 0, size = 0, steps = 0, sweeps = 0;
  double total() const { return std::sqrt(paths * paths + size * size + steps * steps + sweeps * sweeps); }
};

struct HeatResult {
  TimeSpan span;
  bool periodic = true;
  double step = 0;  // s
  size_t moments = 0;
  std::vector<float> kelvin;              // [face][moment]
  std::vector<float> path_error;          // K, standard error of the paths, [face][part]
  std::vector<float> size_error;          // K, of the elements' size, [face][part]: path_errors.h
  std::vector<float> step_error;          // K, of the steps, [face][part]: step_errors.h
  std::vector<float> absorbed, received;  // W/m2 of sunlight, of infrared that arrives; [face][moment]
  std::vector<float>
      straight;  // W/m2 absorbed straight from the sun, where points are to be told (point_heat.h), or empty
  std::vector<float> emissivity, absorptance, sun_hours;  // by face
  std::vector<float> air_kelvin;                          // by moment
  double past_error = 0, sweep_error = 0;                 // K
  int sweeps = 0;
  // Means over the span and all faces, W: what is absorbed of sunlight, of infrared, emitted, given to the air, and
  // what the balance lacks of what the elements store and conduct to their backs.
  struct Balance {
    double sunlight = 0, infrared = 0, emitted = 0, to_air = 0, source = 0, behind = 0, stored = 0;
    double residual() const { return sunlight + infrared + source - emitted - to_air - behind - stored; }
  } balance;
  double rays = 0, unfinished = 0;
  std::vector<std::string> notes;  // what a user should know, a sentence each
  std::vector<HeatOptics::Assumed> assumed;
  std::optional<HeatAudit> audit;

  // K at a time (s), straight between moments; a span that repeats goes on for ever, of others the nearer end holds.
  double kelvin_at(size_t face, double t) const;
  double air_at(double t) const;
  // The same of one row of values by moment.
  double between_moments(std::span<const float> row, double t) const;
  // K, of the part of the span.
  HeatErrors errors_at(size_t face, double t) const;

 private:
  double position(double t) const;  // of a time, in moments
};

// A day (or more) of weather as loads and air, on the moments of a span.
struct WeatherLoads {
  std::vector<double> moments;  // s
  AirSeries air;
  std::vector<double> direct, diffuse, global, longwave, air_kelvin;  // W/m2, K, by moment; light as means around it
  std::vector<std::vector<float>> sky;                                // by moment: radiance of each patch, W/(m2 sr)
  SunCourse course;
  bool humid = true;  // the file says how moist the air is; else it is dry
};
// Error: weather that does not cover the span, or lacks what is asked (with the line of the file).
WeatherLoads weather_loads(const HeatWeather& weather, const HeatSpec& spec);

// The elements of each material as a group, with the emissivity of every face.
std::vector<SurfaceGroup> surface_groups(const Elements& elements, const HeatFaces& faces, const HeatOptics& optics,
                                         const std::vector<double>& emissivity);

// The paths of a search.
inline PathOptions path_options(const HeatSpec& spec) {
  return {HeatSpec::kBlocks, spec.paths / HeatSpec::kBlocks, spec.seed};
}

// report: is told stages and shares that are done; may be empty. Error: as its parts.
struct HeatProgress {
  // whole: of `unit`, "face"; 0 of an empty unit where nothing is counted.
  std::function<void(const std::string& stage, double whole, const std::string& unit)> begin;
  std::function<void(double more)> done;
};
// Error: a material that is seen has no temperature, neither by heat nor of its own. To be asked before rays are
// traced.
void check_surroundings(const HeatScene& scene, const HeatSpec& spec);
// found: of all faces, for the sun of the loads. It is used up, as what is no longer needed makes room.
HeatResult solve_heat(const HeatScene& scene, HeatOperator&& found, const WeatherLoads& loads, const HeatSpec& spec,
                      const HeatProgress& progress = {});
// Finds that, too.
HeatResult solve_heat(const Tracer& tracer, const Elements& elements, const HeatFaces& faces, const HeatOptics& optics,
                      const WeatherLoads& loads, const HeatSpec& spec, const HeatProgress& progress = {});

}  // namespace suite
