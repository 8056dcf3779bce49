#include "scheduler/moments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "motion/time.h"

namespace suite {

double moment_of(const Capture& capture) { return 0.5 * (capture.window.begin + capture.window.end); }

double SourcesInTime::on_grid(double moment) const {
  if (!dated()) return 0;
  const SourceTime& dated = written_.sun && written_.sun->time ? *written_.sun->time : *written_.moon->disk.time;
  const Instant zero = instant_from_utc(parse_iso8601(dated.utc)), then = zero + moment;
  const auto steps = [](double seconds) { return std::floor(seconds / kMomentQuantum); };
  // Whole steps first: one moment of the grid is one number.
  const double whole = static_cast<double>(then.day - zero.day) * (86400 / kMomentQuantum) +
                       steps(then.seconds + 0.5 * kMomentQuantum) - steps(zero.seconds);
  return whole * kMomentQuantum - (zero.seconds - steps(zero.seconds) * kMomentQuantum);
}

const SourceSpecs& SourcesInTime::at(double moment) {
  if (!dated() && !written_.clear && !(written_.moon && written_.moon->by_phase)) return written_;
  if (!moment_)
    now_ = written_;
  else if (!dated() || *moment_ == moment)
    return now_;
  // Everything that is resolved begins anew from what was written; tables of other skies and lamps stay.
  now_.sun = written_.sun, now_.moon = written_.moon, now_.clear = written_.clear;
  if (written_.clear) now_.sky.reset();
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

// A clear sky is the sky of a sun that is up.
void check_clear(const SourceSpecs& written, const Scene& scene, const std::map<double, Named>& moments) {
  SourceSpecs bodies;
  bodies.sun = written.sun, bodies.dut1 = written.dut1;
  SourcesInTime suns(bodies, scene);
  for (const auto& [moment, who] : moments) {
    const double height = suns.at(suns.on_grid(moment)).sun->direction.z;
    if (height > 0) continue;
    throw Error(
        written.sun->time->where,
        strf("a clear sky needs the sun above the horizon; at %g s, when '%s' of sensor '%s' is taken, it stands "
             "%.2f degrees below",
             moment, who.capture->name.c_str(), who.sensor->name().c_str(), -std::asin(height) / kDegree),
        "leave out the captures at night, or render them with a `sky` or an `atmosphere`");
  }
}

constexpr double kUsualRadius = 0.00465;  // rad, of bodies that are taken as collimated

// How far a body goes during a capture, and what that does to the light on level ground.
LongExposure exposure(const std::string& body, const Capture& c, const SunSpec& begin, const SunSpec& middle,
                      const SunSpec& end, double reference_um) {
  LongExposure e{body,
                 c.name,
                 c.window.end - c.window.begin,
                 angle_between(begin.direction, end.direction),
                 middle.half_angle > 0 ? middle.half_angle : kUsualRadius,
                 0};
  auto level = [&](const SunSpec& s) {
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
    if (s.sun && s.sun->time) {
      s.sun->time.reset();
      s.sun->direction = dir_from_angles(zenith_deg * kDegree, 0);
    }
    if (s.moon && s.moon->disk.time) {
      s.moon->disk.time.reset();
      s.moon->disk.direction = Dir{0, 0, 1};
      s.moon->geometry.phase = s.moon->geometry.sun_longitude = 1.5 * zenith_deg * kDegree;
    }
    resolve_sources(s, scene, 0);
    all.push_back(std::move(s));
    if (!written.dated()) break;
  }
  return all;
}

std::vector<std::string> tell_sources(const SourceSpecs& written, const Scene& scene, Sensors sensors) {
  const std::map<double, Named> moments = written.dated() ? moments_of(sensors) : std::map<double, Named>{};
  if (written.clear && written.sun && written.sun->time) check_clear(written, scene, moments);
  SourceSpecs first = written;
  std::vector<std::string> said = resolve_sources(first, scene, moments.empty() ? 0 : moments.begin()->first);
  if (moments.size() < 2) return said;
  for (std::string& s : said) s = "first capture: " + s;
  SourceSpecs last = written;
  for (const std::string& s : resolve_sources(last, scene, moments.rbegin()->first))
    said.push_back("last capture: " + s);
  return said;
}

std::optional<LongExposure> long_exposure(const SourceSpecs& written, const Scene& scene, const Sensor& sensor) {
  if (!written.dated()) return std::nullopt;
  // Above the air: where a clear sky ends does not matter here.
  SourceSpecs bare;
  bare.sun = written.sun, bare.moon = written.moon, bare.dut1 = written.dut1;
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
      std::array<std::vector<SunSpec>, 2> bodies;  // sun, moon at the beginning, the middle and the end
      for (const double t : {c.window.begin, middle, c.window.end}) {
        const SourceSpecs& now = sources.at(t);
        if (now.sun && written.sun->time) bodies[0].push_back(*now.sun);
        if (now.moon && written.moon->disk.time) bodies[1].push_back(now.moon->disk);
      }
      for (size_t b = 0; b < 2; ++b) {
        if (bodies[b].size() < 3) continue;
        const bool up = std::any_of(bodies[b].begin(), bodies[b].end(), [](auto& s) { return s.direction.z > 0; });
        const LongExposure e = exposure(b ? "moon" : "sun", c, bodies[b][0], bodies[b][1], bodies[b][2], reference);
        if (up && excess(e) > 1 && (!worst || excess(e) > excess(*worst))) worst = e;
      }
    }
  return worst;
}

}  // namespace suite
