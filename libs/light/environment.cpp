#include "light/environment.h"

#include <algorithm>
#include <cmath>

#include "light/kinds/solar_spectrum.h"
#include "motion/ephemeris.h"
#include "motion/time.h"

namespace suite {

namespace {

SceneFrame frame_of(const Scene& scene, const Where& where, const char* what) {
  if (!scene.origin.given)
    throw Error(where, std::string(what) + " needs a scene with a geodetic origin",
                "give the scene an origin, or directions as {zenith_deg, azimuth_deg}");
  return SceneFrame({scene.origin.latitude_deg, scene.origin.longitude_deg, scene.origin.ellipsoid_height_m});
}

Instant instant_of(const SourceTime& time) {
  try {
    return instant_from_utc(parse_iso8601(time.utc));
  } catch (const Error& e) {
    throw Error(time.where, e.message(), e.hint());
  }
}

std::string sentence(const char* name, const SourceTime& time, double seconds, const SkyBody& body,
                     const std::string& more) {
  const std::string utc = seconds == 0 ? time.utc : to_iso8601(utc_from_instant(instant_of(time) + seconds));
  return strf("%s at %s: %.3f degrees %s the horizon, %s", name, utc.c_str(), std::fabs(body.elevation) / kDegree,
              body.elevation < 0 ? "below" : "above", more.c_str());
}

void resolve_sun(SunSpec& sun, const Scene& scene, double seconds, double dut1, std::vector<std::string>& said) {
  if (!sun.time) return;
  const SkyBody body =
      sun_at(frame_of(scene, sun.time->where, "a sun by date"), {}, instant_of(*sun.time) + seconds, dut1);
  sun.direction = body.direction;
  if (sun.disk_by_time) sun.half_angle = body.angular_radius;
  const double au = body.distance / kAstronomicalUnit;
  if (sun.at_1_au) sun.irradiance = sun.irradiance.scaled(1 / (au * au));
  said.push_back(sentence("sun", *sun.time, seconds, body, strf("%.5f AU", au)));
  sun.time.reset();
}

void resolve_moon(MoonSpec& moon, const Scene& scene, double seconds, double dut1, std::vector<std::string>& said) {
  MoonGeometry& g = moon.geometry;
  if (moon.disk.time) {
    const SceneFrame frame = frame_of(scene, moon.disk.time->where, "a moon by date");
    const Instant instant = instant_of(*moon.disk.time) + seconds;
    const SkyBody body = moon_at(frame, {}, instant, dut1), sun = sun_at(frame, {}, instant, dut1);
    moon.disk.direction = body.direction;
    if (moon.disk.disk_by_time) moon.disk.half_angle = body.angular_radius;
    // Sun, Moon and observer in one triangle: phase and the Moon's distance from the Sun.
    const Vec3 to_sun = sun.direction * sun.distance - body.direction * body.distance;
    g.phase = angle_between(normalized(to_sun), -body.direction);
    g.sun_distance_au = length(to_sun) / kAstronomicalUnit;
    g.observer_distance = body.distance;
    // Waxing: the Sun stands west of the Moon as the hour circle turns. The fit's longitude of the Sun is the signed
    // phase.
    const double later = moon_phase_angle(instant + 3600), now = moon_phase_angle(instant);
    g.sun_longitude = later < now ? g.phase : -g.phase;
    said.push_back(sentence("moon", *moon.disk.time, seconds, body,
                            strf("phase angle %.2f degrees, %.0f km", g.phase / kDegree, body.distance * 1e-3)));
    moon.disk.time.reset();
  }
  if (moon.by_phase) {
    moon.disk.irradiance = moon_irradiance(g, solar_irradiance());
    moon.by_phase = false;
  }
}

}  // namespace

std::vector<std::string> resolve_sources(SourceSpecs& specs, const Scene& scene, double seconds) {
  std::vector<std::string> said;
  if (specs.sun) resolve_sun(*specs.sun, scene, seconds, specs.dut1, said);
  if (specs.moon) resolve_moon(*specs.moon, scene, seconds, specs.dut1, said);
  if (!specs.clear) return said;
  if (!specs.sun) throw Error("a clear sky needs a sun");
  if (specs.sky || specs.atmosphere) throw Error("a clear sky stands for sky and atmosphere alike", "drop one of them");
  ClearSky clear = clear_sky(*specs.clear, normalized(specs.sun->direction), specs.sun->irradiance);
  said.push_back(strf("clear sky: direct %.1f W/m2 facing the sun, diffuse %.1f W/m2 on the horizontal (0.3 to 4 um)",
                      clear.direct.integral(0.3, 4), clear.diffuse.integral(0.3, 4)));
  specs.sun->irradiance = std::move(clear.direct);
  specs.sky = std::move(clear.sky);
  specs.clear.reset();
  return said;
}

uint32_t earth_material(const EarthSpec& spec, const Scene& scene) {
  std::vector<std::string> names;
  for (uint32_t i = 0; i < scene.materials.size(); ++i) {
    if (scene.materials[i].id == spec.material && scene.materials[i].bounds_medium())
      throw Error(spec.where,
                  "the Earth: the material '" + spec.material + "' bounds a medium, and the Earth is no body",
                  "name a material without inside and outside");
    if (scene.materials[i].id == spec.material && !scene.materials[i].surface.model.empty()) return i;
    names.push_back(scene.materials[i].id);
  }
  throw Error(spec.where, "the Earth: the scene has no material '" + spec.material + "' with a model of its own",
              name_hint(spec.material, names));
}

namespace {

// Takes the place of the light with this number, or stands behind the last one.
template <class Kind>
const Kind* put(Environment& e, size_t index, std::shared_ptr<const Kind> light) {
  if (index == e.lights.size()) e.lights.emplace_back();
  const Kind* const kind = light.get();
  e.lights[index] = std::move(light);
  return kind;
}

// Sun and Moon are the first of the list.
void bake_bodies(Environment& e, const SourceSpecs& specs, const SpectralState& state) {
  size_t index = 0;
  if (specs.sun) e.sun = index, e.sun_disk = put(e, index++, std::make_shared<const Sun>(*specs.sun, state));
  if (specs.moon) e.moon_disk = put(e, index++, std::make_shared<const Sun>(specs.moon->disk, state));
}

// The sky follows them.
void bake_sky(Environment& e, const SourceSpecs& specs, const SpectralState& state) {
  const size_t index = size_t{specs.sun.has_value()} + size_t{specs.moon.has_value()};
  e.sky = put(e, index, std::make_shared<const Sky>(*specs.sky, state));
}

// The air scatters the beams of the bodies.
void bake_air(Environment& e, const SourceSpecs& specs, const SpectralState& state) {
  if (!specs.atmosphere) return;
  std::vector<Beam> beams;
  for (const auto& light : e.lights)
    if (const auto beam = light->beam()) beams.push_back(*beam);
  e.atmosphere = make_layered_atmosphere(*specs.atmosphere, state, std::move(beams));
}

}  // namespace

bool Environment::lamps_in_scene() const {
  return std::any_of(lights.begin(), lights.end(), [](const auto& light) { return !light->nature().far; });
}

void rebake_dated(Environment& environment, const SourceSpecs& written, const SourceSpecs& now,
                  const SpectralState& state) {
  if (!written.dated()) return;
  SUITE_CHECK(!now.clear);
  bake_bodies(environment, now, state);
  if (written.clear) bake_sky(environment, now, state);
  bake_air(environment, now, state);
}

Environment bake_environment(const SourceSpecs& specs, const Tracer& tracer, bool periodic,
                             const SpectralState& state) {
  SUITE_CHECK(!specs.clear);
  const Scene& scene = tracer.scene();
  Environment e;
  bake_bodies(e, specs, state);
  if (specs.sky) bake_sky(e, specs, state);
  if (!specs.lamps.empty())
    e.lamps = put(e, e.lights.size(), std::make_shared<const Lamps>(specs.lamps, tracer, state));
  bake_air(e, specs, state);
  if (specs.earth) {
    if (periodic) throw Error(specs.earth->where, "a scene that repeats itself has no Earth under it");
    const SceneFrame frame = frame_of(scene, specs.earth->where, "the Earth");
    const double lowest = tracer.bounds().empty() ? 0 : std::min(0.0, tracer.bounds().low.z);
    e.earth =
        std::make_shared<const Earth>(frame, specs.earth->height.value_or(scene.origin.ellipsoid_height_m + lowest - 1),
                                      earth_material(*specs.earth, scene));
  }
  return e;
}

}  // namespace suite
