#include "scheduler/air_limits.h"

#include <algorithm>
#include <cmath>

#include "scene/primitives.h"
#include "scheduler/moments.h"
#include "scheduler/scattered_once.h"
#include "scheduler/sensor_diagnostics.h"
#include "scheduler/techniques.h"

namespace suite {

namespace {

constexpr double kMeasuredTwilight = 92.05 * kDegree;  // zenith angle of the lowest sun of glow_from_below

bool endless(const Scene& scene) {
  return scene.bounds.empty() || std::any_of(scene.primitives.begin(), scene.primitives.end(),
                                             [](const Primitive& p) { return primitive_box(p).empty(); });
}

std::string even_ground(const AirSpec& air) {
  if (air.ground_of_scene || air.ground_of_any_scene) return "an even ground (as bright as the scene in the mean)";
  return strf("an even ground (albedo %.3g to %.3g)", air.ground_albedo.min(), air.ground_albedo.max());
}

// Where single places are followed: what stands for the ground that the scene has not got.
std::optional<std::string> beyond(const AirSpec& air, const SourceSpecs& written, const Scene& scene,
                                  const JobOptions& job) {
  if (written.earth || job.periodic || endless(scene)) return std::nullopt;
  const Vec3 size = scene.bounds.size();
  const double reach = 0.5 * std::min(size.x, size.y), share = share_from_beyond(reach);
  if (share < kMostFromBeyond) return std::nullopt;
  return strf(
      "air: beyond the scene, which reaches %.3g km from its middle, %s goes on; of the light that molecules receive "
      "from the ground over the middle some %.0f %% come from there (less of what lies lower)",
      reach * 1e-3, even_ground(air).c_str(), 100 * share);
}

// The lowest of sun and moon over all captures: degrees from the zenith.
struct Lowest {
  double zenith = 0;
  std::string body;
};
Lowest lowest_body(const SourceSpecs& written, const Scene& scene, Sensors sensors) {
  SourceSpecs bodies;
  for (const LightSpecPtr& light : written.lights)
    if (light->disk() || light->date()) bodies.lights.push_back(light);
  bodies.dut1 = written.dut1;
  SourcesInTime in_time(bodies, scene);
  Lowest lowest;
  for (const auto& sensor : sensors)
    for (const Task& task : sensor->tasks())
      for (const Capture& c : task.captures)
        for (const LightSpecPtr& light : in_time.at(in_time.on_grid(moment_of(c))).lights)
          if (const FarDisk* disk = light->disk()) {
            const double zenith = angle_between(normalized(disk->direction), {0, 0, 1});
            if (zenith > lowest.zenith) lowest = {zenith, light->key()};
          }
  return lowest;
}

// Traced air goes on below where no matter ends it.
std::optional<std::string> open_below(const SourceSpecs& written, const Scene& scene, Sensors sensors,
                                      const JobOptions& job) {
  if (written.earth || job.periodic || endless(scene)) return std::nullopt;
  const Vec3 size = scene.bounds.size();
  const double reach = 0.5 * std::min(size.x, size.y);
  if (share_from_beyond(reach) < kMostFromBeyond) return std::nullopt;
  const Lowest body = lowest_body(written, scene, sensors);
  std::string text = strf(
      "air: the scene reaches %.3g km from its middle; beyond it nothing ends the lowest air, which goes on downwards "
      "and sends light back as a bright ground would: over a dark scene up to %.2g %% of what is seen near the "
      "horizon, "
      "%s in the zenith (0.55 um, visibility 23 km)",
      reach * 1e-3, 100 * glow_from_below(reach, body.zenith), body.zenith > 0.5 * kPi ? "as much" : "a third of that");
  if (body.zenith > kMeasuredTwilight)
    text += strf("; with the %s at %.3g degrees from the zenith, lower than 92, it may be all of it", body.body.c_str(),
                 body.zenith / kDegree);
  return text + ": lay `earth` or a plane without end under it";
}

// Light that is scattered more than once, seen from space against another program
// (tests/physics/light/air_views_test.cpp).
std::string low(const Lowest& body) {
  const double degrees = body.zenith / kDegree;
  std::string text = strf(
      "air: the %s stands up to %.3g degrees from the zenith; light that is scattered more than once has sources that "
      "are the same all round at a height, but for how low the sun stands over them: ",
      body.body.c_str(), degrees);
  if (degrees < 88.1) return text + "seen from space up to 1.6 % too bright (0.55 um, through haze)";
  return text + "how much that is wrong has not been measured with the sun below 2 degrees";
}

// Whether a ray from high up goes down into the air and out of it again.
bool along_limb(const Shells& shells, const Ray& ray) {
  constexpr double kHigh = 1e4;  // m
  const double lowest = shells.lowest_height(ray.origin, ray.direction, std::numeric_limits<double>::infinity());
  return shells.height(ray.origin) > kHigh && dot(shells.up(ray.origin), ray.direction) < 0 &&
         lowest > shells.heights().front() && lowest < shells.heights().back();
}

bool looks_along_limb(const Sensor& sensor, const Shells& shells) {
  for (const Task& task : sensor.tasks())
    for (const Capture& c : task.captures) {
      const size_t across = c.columns - 1, along = c.rows - 1;
      for (const size_t column : {size_t{0}, across / 2, across})
        for (const size_t row : {size_t{0}, along / 2, along}) {
          const SensorRay ray = middle_ray(sensor, c, row * c.columns + column);
          if (ray.receiver == SensorRay::Receiver::none && along_limb(shells, ray.ray)) return true;
        }
    }
  return false;
}

// The bands of a sensor that meet a range: each, or the first and the last of many.
std::string bands_within(const Sensor& sensor, const GasLimit& limit) {
  std::vector<std::string> names;
  for (size_t s = 0; s < sensor.states().size(); ++s)
    for (const Band& band : sensor.bands(s))
      if (band.high_um() > limit.low_um && band.low_um() < limit.high_um) names.push_back("'" + band.name + "'");
  if (names.empty()) return {};
  constexpr size_t kEach = 4;
  std::string text;
  if (names.size() > kEach) text = strf("%s to %s (%zu)", names.front().c_str(), names.back().c_str(), names.size());
  if (names.size() <= kEach)
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text + " of '" + sensor.name() + "'";
}

// Bands that lie where gases are less sure than in general, range by range.
void report_gas_limits(const GasProvider& gases, Sensors sensors, std::vector<Diagnostic>& found) {
  for (const GasLimit& limit : gases.limits()) {
    std::string names;
    for (const auto& sensor : sensors)
      if (const std::string bands = bands_within(*sensor, limit); !bands.empty())
        names += (names.empty() ? "" : ", ") + bands;
    if (!names.empty()) found.push_back({Dr::gas_limits, "gases: " + limit.text() + "; bands there: " + names});
  }
}

// Sensors that look from within the haze of the ground where particles scatter most.
std::optional<std::string> within_haze(const AirSpec& air, Sensors sensors) {
  constexpr double kBoundary = 2000, kLow = 0.35, kHigh = 1.1;  // m, um
  if (!air.aerosol || air.aerosol->boundary.data || air.aerosol->boundary.name == "desert") return std::nullopt;
  const double ground = air.height_of_ground() - air.height_of_scene();
  std::string names;
  for (const auto& sensor : sensors) {
    if (sensor->tasks().empty() || sensor->tasks()[0].captures.empty()) continue;
    const Capture& c = sensor->tasks()[0].captures[0];
    const auto bands = sensor->bands(c.state);
    if (!std::any_of(bands.begin(), bands.end(),
                     [](const Band& b) { return b.center_um > kLow && b.center_um < kHigh; }))
      continue;
    const SensorRay ray = middle_ray(*sensor, c, (c.rows / 2) * c.columns + c.columns / 2);
    if (ray.ray.origin.z - ground < kBoundary) names += (names.empty() ? "'" : ", '") + sensor->name() + "'";
  }
  if (names.empty()) return std::nullopt;
  return "air: " + names + " look from within haze of '" + air.aerosol->boundary.name +
         "' particles, whose light differs from MODTRAN's: scattered once by up to 12 % (rural, 0.55 um), whose stored "
         "phase functions are means of several models; in its runs with azimuths averaged (no DISAZM) the haze is "
         "brighter by up to 37 % on level ways at the ground (0.4 to 0.7 um, visibility 23 km; 52 % for 5 km), 2 % "
         "from "
         "24 km";
}

constexpr double kLowLimb = 85 * kDegree;

bool sees_sunlight(const Sensor& sensor) {
  constexpr double kThermal = 4;  // um
  const auto states = sensor.states();
  return std::any_of(states.begin(), states.end(), [](const SpectralState& state) {
    return std::any_of(state.bins.begin(), state.bins.end(), [](const Bin& b) { return b.low_um < kThermal; });
  });
}

void diagnose_low_bodies(const SourceSpecs& written, const Scene& scene, Sensors sensors, const AirSpec& air,
                         std::vector<Diagnostic>& found) {
  const Lowest body = lowest_body(written, scene, sensors);
  if (body.zenith > kLowSun) found.push_back({Dr::low_sun, low(body)});
  if (body.body.empty()) return;
  const double radius = air.radius + air.height_of_scene();
  const Shells shells = Shells::round(
      {0, 0, -radius}, radius,
      {air.height_of_ground() - air.height_of_scene(), air.profile.levels.back().height - air.height_of_scene()});
  for (const auto& sensor : sensors)
    if (body.zenith > kLowLimb && sees_sunlight(*sensor) && looks_along_limb(*sensor, shells))
      found.push_back({Dr::limb_low_sun,
                       "air: sensor '" + sensor->name() +
                           "' looks along the limb under a sun lower than any that was compared (84 degrees from the "
                           "zenith: within 1 %, 0.55 um through haze, lowest points from 5 to 60 km)"});
}

}  // namespace

double share_from_beyond(double reach, double scale) {
  // Middles of equal shares of what scatters.
  constexpr int kParts = 256;
  double sum = 0;
  for (int i = 0; i < kParts; ++i) {
    const double height = -scale * std::log((i + 0.5) / kParts);
    sum += height / std::hypot(height, reach);
  }
  return sum / kParts;
}

double glow_from_below(double reach, double sun) {
  constexpr double kHaze = 2000;  // m: scale height of what the horizon's light is scattered by
  constexpr double kUp = 1.3, kDown = 1.6;
  return std::min(1.0, (sun > 0.5 * kPi ? kDown : kUp) * share_from_beyond(reach, kHaze));
}

std::vector<Diagnostic> diagnose_air(const SourceSpecs& written, const Scene& scene, Sensors sensors,
                                     const JobOptions& job) {
  if (written.atmosphere) return diagnose_scattered_once(written, scene, sensors);
  std::vector<Diagnostic> found;
  if (!written.air) return found;
  if (written.air->gases) report_gas_limits(*written.air->gases, sensors, found);
  if (written.sun())
    if (const auto sentence = within_haze(*written.air, sensors)) found.push_back({Dr::within_haze, *sentence});
  if (written.air->scattering == AirScattering::traced)
    if (const auto sentence = open_below(written, scene, sensors, job))
      found.push_back({Dr::air_open_below, *sentence});
  if (written.air->scattering != AirScattering::diffuse) return found;
  SourceSpecs first = written;
  resolve_sources(first, scene);
  const AirSpec& air = *first.air;
  const TechniqueFacts facts = technique_facts(scene, written, job.pipeline);
  if (air.adjacency) {
    if (!uses(ListedTechnique::adjacency, facts))
      found.push_back(
          {Dr::no_adjacency,
           "air: this estimator goes back to no place in the air: light between ground and air is that of " +
               even_ground(air) + "; what single places send into it (adjacency) and shadows in it are left out"});
    else if (const auto sentence = beyond(air, written, scene, job))
      found.push_back({Dr::even_ground_beyond, *sentence});
  }
  if (air.round) diagnose_low_bodies(written, scene, sensors, air, found);
  return found;
}

}  // namespace suite
