// Diagnostics of where sensors stand and look: found by a few of their rays, without rendering.
#include <algorithm>
#include <cmath>

#include "optics/models.h"
#include "scene/primitives.h"
#include "scheduler/sensor_diagnostics.h"
#include "surface/material_lookup.h"

namespace suite {

namespace {

constexpr size_t kMostCaptures = 64, kMostProblems = 256;

// Middle rays of some problems of a capture.
std::vector<SensorRay> probes(const Sensor& sensor, const Capture& capture) {
  std::vector<SensorRay> rays;
  const size_t n = std::min(capture.problems(), kMostProblems);
  for (size_t i = 0; i < n; ++i)
    rays.push_back(middle_ray(sensor, capture, (2 * i + 1) * capture.problems() / (2 * n)));
  return rays;
}

std::string place(Vec3 p) { return strf("(%.6g, %.6g, %.6g) m", p.x, p.y, p.z); }

// Metres that look like the degrees of the scene's origin.
std::optional<SensorDiagnostic> degrees_as_metres(const Scene& scene, const Sensor& sensor, Vec3 at) {
  const GeodeticOrigin& o = scene.origin;
  constexpr double kNear = 0.5, kSmall = 2;  // degrees; small ones are ordinary metres
  if (!o.given || std::fabs(o.latitude_deg) < kSmall || std::fabs(o.longitude_deg) < kSmall) return std::nullopt;
  auto near = [](double a, double b) { return std::fabs(a - b) < kNear; };
  const bool straight = near(at.x, o.latitude_deg) && near(at.y, o.longitude_deg),
             swapped = near(at.x, o.longitude_deg) && near(at.y, o.latitude_deg);
  if (!straight && !swapped) return std::nullopt;
  return SensorDiagnostic{
      Dr::degrees_as_metres, sensor.name(),
      strf("it stands at %s east, north and up, which are the numbers of the scene's %s (%.4f, %.4f degrees)",
           place(at).c_str(), straight ? "latitude and longitude" : "longitude and latitude",
           straight ? o.latitude_deg : o.longitude_deg, straight ? o.longitude_deg : o.latitude_deg),
      "positions are metres in the scene's frame; degrees have keys of their own: {latitude_deg, longitude_deg, "
      "height_m} in the motion of a platform"};
}

// The side of the surface that a vertical ray meets from behind: looked at from inside the ground.
struct Vertical {
  bool met = false, behind = false;
  Hit hit;
};
Vertical look(const Tracer& tracer, Vec3 from, double up, double time) {
  const Ray ray{from, {0, 0, up}, time};
  Vertical v;
  TraceStatistics ignored;
  const FlushDenormals flush;
  tracer.nearest({&ray, 1}, {&v.hit, 1}, false, ignored);
  v.met = v.hit.hit();
  v.behind = v.met && v.hit.normal.z * up > 0;
  return v;
}

// Opaque ground over it, seen from behind, and nothing, or the same solid's other side from behind, below it.
std::optional<SensorDiagnostic> under_ground(const Tracer& tracer, const SourceSpecs& written, const Sensor& sensor,
                                             const SensorRay& ray, const SpectralState& state) {
  const Scene& scene = tracer.scene();
  const Vec3 at = ray.ray.origin;
  const std::string cure = "positions are metres in the scene's frame, up from its origin: raise it";
  if (written.earth && scene.origin.given) {
    const SceneFrame frame({scene.origin.latitude_deg, scene.origin.longitude_deg, scene.origin.ellipsoid_height_m});
    const double lowest = tracer.bounds().empty() ? 0 : std::min(0.0, tracer.bounds().low.z),
                 ground = written.earth->height.value_or(scene.origin.ellipsoid_height_m + lowest - 1),
                 deep = ground - frame.geodetic_from_enu(at).height_m;
    if (deep > 0)
      return SensorDiagnostic{Dr::sensor_below_ground, sensor.name(),
                              strf("it stands at %s, %.4g m inside the Earth", place(at).c_str(), deep), cure};
  }
  if (uses_media(scene)) return std::nullopt;  // under water is a place to be
  const Vertical over = look(tracer, at, 1, ray.ray.time);
  if (!over.behind) return std::nullopt;
  const Vertical below = look(tracer, at, -1, ray.ray.time);
  if (below.met && !below.behind) return std::nullopt;
  const uint32_t material = MaterialLookup(scene).at(tracer.object(over.hit.object), over.hit);
  if (material != kNone && !scene.materials[material].surface.model.empty() &&
      !bake(scene.materials[material].surface, state)->opaque())
    return std::nullopt;
  return SensorDiagnostic{
      Dr::sensor_below_ground, sensor.name(),
      strf("it stands at %s, %.4g m under the surface '%s' above it and with no ground below it", place(at).c_str(),
           over.hit.distance, material == kNone ? "" : scene.materials[material].id.c_str()),
      cure};
}

bool endless(const Tracer& tracer, const SourceSpecs& written) {
  const Scene& scene = tracer.scene();
  return written.earth || tracer.periodic() || uses_media(scene) || !scene.tracks.empty() || tracer.bounds().empty() ||
         std::any_of(scene.primitives.begin(), scene.primitives.end(), [](const Primitive& p) {
           return p.kind == PrimitiveKind::plane || p.kind == PrimitiveKind::sinusoid || primitive_box(p).empty();
         });
}

// True when every ray of the list passes the sphere around the scene further off than the rays are apart.
bool passes_by(const std::vector<SensorRay>& rays, const Box3& box) {
  const Vec3 center = (box.low + box.high) * 0.5;
  const double radius = 0.5 * length(box.high - box.low);
  double apart = 0, least = INFINITY;
  for (size_t i = 0; i < rays.size(); ++i) {
    if (rays[i].receiver != SensorRay::Receiver::none) return false;
    const Vec3 to = center - rays[i].ray.origin;
    const double distance = length(to);
    if (!(distance > radius)) return false;
    least = std::min(least, angle_between(normalized(to), rays[i].ray.direction) - std::asin(radius / distance));
    if (i) {
      const Vec3 shift = rays[i].ray.origin - rays[i - 1].ray.origin;
      apart = std::max(
          apart, angle_between(rays[i].ray.direction, rays[i - 1].ray.direction) + length(shift) / (distance - radius));
    }
  }
  return least > apart + 1e-3;
}

std::optional<SensorDiagnostic> looks_past(const Tracer& tracer, const SourceSpecs& written, const Sensor& sensor) {
  if (endless(tracer, written)) return std::nullopt;
  size_t captures = 0;
  for (const Task& task : sensor.tasks()) captures += task.captures.size();
  if (captures == 0 || captures > kMostCaptures) return std::nullopt;
  bool down = false;
  for (const Task& task : sensor.tasks())
    for (const Capture& c : task.captures) {
      const std::vector<SensorRay> rays = probes(sensor, c);
      if (!passes_by(rays, tracer.bounds())) return std::nullopt;
      down = down || std::any_of(rays.begin(), rays.end(), [](auto& r) { return r.ray.direction.z < 0; });
    }
  if (!down && written.any()) return std::nullopt;  // a picture of the sky
  const SensorRay first = middle_ray(sensor, sensor.tasks()[0].captures[0], 0);
  const Box3& box = tracer.bounds();
  return SensorDiagnostic{
      Dr::looks_past_scene, sensor.name(),
      strf("it looks past the scene: from %s towards (%.3f, %.3f, %.3f), and the scene lies between %s and %s",
           place(first.ray.origin).c_str(), first.ray.direction.x, first.ray.direction.y, first.ray.direction.z,
           place(box.low).c_str(), place(box.high).c_str()),
      "check where it stands and looks: metres east, north and up in the scene's frame"};
}

}  // namespace

std::vector<SensorDiagnostic> diagnose_views(const Tracer& tracer, const SourceSpecs& written, Sensors sensors) {
  std::vector<SensorDiagnostic> all;
  for (const auto& sensor : sensors) {
    if (sensor->tasks().empty() || sensor->tasks()[0].captures.empty()) continue;
    const Capture& c = sensor->tasks()[0].captures[0];
    const SensorRay ray = middle_ray(*sensor, c, c.problems() / 2);
    std::optional<SensorDiagnostic> found = degrees_as_metres(tracer.scene(), *sensor, ray.ray.origin);
    if (!found) found = under_ground(tracer, written, *sensor, ray, sensor->states()[c.state]);
    if (!found) found = looks_past(tracer, written, *sensor);
    if (found) all.push_back(*found);
  }
  return all;
}

}  // namespace suite
