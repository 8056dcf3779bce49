#include "scheduler/moments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "motion/time.h"
#include "scheduler/sensor_diagnostics.h"

namespace suite {

double moment_of(const Capture& capture) { return 0.5 * (capture.window.begin + capture.window.end); }

double SourcesInTime::on_grid(double moment) const {
  if (!dated()) return 0;
  const Instant zero = instant_from_utc(parse_iso8601(written_.date()->utc)), then = zero + moment;
  const auto steps = [](double seconds) { return std::floor(seconds / kMomentQuantum); };
  // Whole steps first: one moment of the grid is one number.
  const double whole = static_cast<double>(then.day - zero.day) * (86400 / kMomentQuantum) +
                       steps(then.seconds + 0.5 * kMomentQuantum) - steps(zero.seconds);
  return whole * kMomentQuantum - (zero.seconds - steps(zero.seconds) * kMomentQuantum);
}

const SourceSpecs& SourcesInTime::at(double moment) {
  if (moment_ && (!dated() || *moment_ == moment)) return now_;
  now_ = written_;
  resolve_sources(now_, scene_, dated() ? moment : 0);
  moment_ = moment;
  return now_;
}

namespace {

// Moments of all captures, each with the first capture that has it.
struct Named {
  const Sensor* sensor;
  const Capture* capture;
};
std::map<double, Named> moments_of(Sensors sensors) {
  std::map<double, Named> all;
  for (const auto& sensor : sensors)
    for (const Task& task : sensor->tasks())
      for (const Capture& c : task.captures) all.try_emplace(moment_of(c), Named{sensor.get(), &c});
  return all;
}

// Lights that cannot be without the sun: it has to be up.
void check_sun_up(const SourceSpecs& written, const std::string& what, const Scene& scene,
                  const std::map<double, Named>& moments) {
  SourceSpecs bodies;
  bodies.lights = {written.sun()}, bodies.dut1 = written.dut1;
  SourcesInTime suns(bodies, scene);
  for (const auto& [moment, who] : moments) {
    const double height = suns.at(suns.on_grid(moment)).sun()->disk()->direction.z;
    if (height > 0) continue;
    throw Error(
        written.sun()->date()->where,
        strf("%s needs the sun above the horizon; at %g s, when '%s' of sensor '%s' is taken, it stands "
             "%.2f degrees below",
             what.c_str(), moment, who.capture->name.c_str(), who.sensor->name().c_str(), -std::asin(height) / kDegree),
        "leave out the captures at night, or render them with a `sky` or an `atmosphere`");
  }
}

// The night sky is that of the ground.
std::string above_airglow(const SourceSpecs& written, Sensors sensors) {
  constexpr double kLowestLayer = 87e3;  // m
  const auto is_night = [](const LightSpecPtr& light) { return light->key() == "night_sky"; };
  if (std::none_of(written.lights.begin(), written.lights.end(), is_night)) return {};
  for (const auto& sensor : sensors)
    for (const Task& task : sensor->tasks())
      for (const Capture& c : task.captures)
        if (middle_ray(*sensor, c, c.problems() / 2).ray.origin.z > kLowestLayer)
          return "night sky: sensor '" + sensor->name() +
                 "' stands above the layers of airglow (87 km), which it sees as from the ground: no layer below it, "
                 "no "
                 "limb";
  return {};
}

constexpr double kUsualRadius = 0.00465;  // rad, of bodies that are taken as collimated

// How far a body goes during a capture, and what that does to the light on level ground.
LongExposure exposure(const std::string& body, const Capture& c, const FarDisk& begin, const FarDisk& middle,
                      const FarDisk& end, double reference_um) {
  LongExposure e{body,
                 c.name,
                 c.window.end - c.window.begin,
                 angle_between(begin.direction, end.direction),
                 middle.half_angle > 0 ? middle.half_angle : kUsualRadius,
                 0};
  auto level = [&](const FarDisk& s) {
    return s.irradiance.covers(reference_um, reference_um)
               ? s.irradiance.at(reference_um) * std::max(0.0, s.direction.z)
               : std::max(0.0, s.direction.z);
  };
  const double here = level(middle);
  if (here > 0) e.irradiance_change = std::fabs(level(end) - level(begin)) / here;
  return e;
}

}  // namespace

SourceSpecs first_sources(const SourceSpecs& written, const Scene& scene, Sensors sensors) {
  const std::map<double, Named> moments = moments_of(sensors);
  SourceSpecs first = written;
  resolve_sources(first, scene, moments.empty() || !written.dated() ? 0 : moments.begin()->first);
  return first;
}

std::vector<SourceSpecs> sources_at_all_times(const SourceSpecs& written, const Scene& scene) {
  std::vector<SourceSpecs> all;
  for (const double zenith_deg : {0.0, 60.0, 85.0}) {
    SourceSpecs s = written;
    for (LightSpecPtr& light : s.lights)
      if (auto still = light->standing(zenith_deg * kDegree)) light = std::move(still);
    resolve_sources(s, scene, 0);
    all.push_back(std::move(s));
    if (!written.dated()) break;
  }
  return all;
}

std::vector<std::string> describe_sources(const SourceSpecs& written, const Scene& scene, Sensors sensors) {
  const std::map<double, Named> moments = written.dated() ? moments_of(sensors) : std::map<double, Named>{};
  if (written.sun() && written.sun()->date())
    for (const LightSpecPtr& light : written.lights)
      if (const std::string what = light->needs_sun_up(); !what.empty()) check_sun_up(written, what, scene, moments);
  SourceSpecs first = written;
  std::vector<std::string> said = resolve_sources(first, scene, moments.empty() ? 0 : moments.begin()->first);
  if (const std::string above = above_airglow(written, sensors); !above.empty()) said.push_back(above);
  if (moments.size() < 2) return said;
  for (std::string& s : said) s = "first capture: " + s;
  SourceSpecs last = written;
  for (const std::string& s : resolve_sources(last, scene, moments.rbegin()->first))
    said.push_back("last capture: " + s);
  return said;
}

std::optional<LongExposure> long_exposure(const SourceSpecs& written, const Scene& scene, const Sensor& sensor) {
  if (!written.dated()) return std::nullopt;
  // Above the air: what others make of a body does not matter here.
  SourceSpecs bare;
  for (const LightSpecPtr& light : written.lights)
    if (light->date() && light->disk()) bare.lights.push_back(light);
  bare.dut1 = written.dut1;
  SourcesInTime sources(bare, scene);
  std::optional<LongExposure> worst;
  auto excess = [](const LongExposure& e) {
    return std::max(e.moved / e.radius, e.irradiance_change / kExposureLimit);
  };
  for (const Task& task : sensor.tasks())
    for (const Capture& c : task.captures) {
      constexpr double kNever = 1;  // s, in which the sky turns by 15 arc seconds
      if (c.window.end - c.window.begin < kNever) continue;
      const double middle = moment_of(c), reference = sensor.states()[c.state].reference_um;
      std::array<std::vector<LightSpecPtr>, 3> at;  // the beginning, the middle and the end
      for (size_t i = 0; const double t : {c.window.begin, middle, c.window.end}) at[i++] = sources.at(t).lights;
      for (size_t b = 0; b < bare.lights.size(); ++b) {
        const auto body = [&](size_t i) -> const FarDisk& { return *at[i][b]->disk(); };
        const bool up = body(0).direction.z > 0 || body(1).direction.z > 0 || body(2).direction.z > 0;
        const LongExposure e = exposure(bare.lights[b]->key(), c, body(0), body(1), body(2), reference);
        if (up && excess(e) > 1 && (!worst || excess(e) > excess(*worst))) worst = e;
      }
    }
  return worst;
}

}  // namespace suite
