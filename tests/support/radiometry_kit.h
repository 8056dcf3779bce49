// Small scenes and sensors for tests of the radiometry core.
#pragma once
#include <memory>
#include <vector>

#include "light/kinds/sky.h"
#include "light/kinds/sun.h"
#include "optics/models.h"
#include "scene/scene.h"
#include "scheduler/scheduler.h"

namespace suite::test {

// A sensor whose problem i looks along rays[i]; one row, no neighbours.
class RaySensor : public Sensor {
 public:
  RaySensor(std::vector<Ray> rays, std::vector<Band> bands, uint32_t paths, double step_um = 0.01, size_t knots = 4)
      : rays_(std::move(rays)), bands_(std::move(bands)), state_(make_state(bands_, step_um, 0, knots)) {
    Capture c;
    c.columns = static_cast<uint32_t>(rays_.size());
    c.rows = 1;
    c.neighbours = false;
    c.convergence.min_paths = c.convergence.max_paths = paths;
    tasks_.push_back({"rays", {}, {c}});
  }
  std::string name() const override { return "rays"; }
  std::span<const SpectralState> states() const override { return {&state_, 1}; }
  std::span<const Band> bands(size_t) const override { return bands_; }
  std::span<const Task> tasks() const override { return tasks_; }
  SensorRay ray(const RayRequest& request) const override { return {rays_[request.problem], 1}; }
  void accept(CaptureResult&& r) override { result = std::move(r); }
  CaptureResult result;

 protected:
  void look_during(TimeWindow window) { tasks_[0].captures[0].window = window; }
  std::vector<Ray> rays_;

 private:
  std::vector<Band> bands_;
  SpectralState state_;
  std::vector<Task> tasks_;
};

inline std::vector<Band> one_band() { return {Band::rectangular("b", 0.55, 0.01)}; }

// Looks down at the origin from a height (m) at times spread evenly over its window (s).
class Exposure final : public RaySensor {
 public:
  Exposure(double height, TimeSpan window, uint32_t paths)
      : RaySensor({{{0, 0, height}, {0, 0, -1}, 0}}, one_band(), paths), window_(window) {
    look_during({window.begin, window.end});
  }
  SensorRay ray(const RayRequest& request) const override {
    Ray ray = rays_[0];
    ray.time = window_.begin + request.u[0] * (window_.end - window_.begin);
    return {ray, 1};
  }

 private:
  TimeSpan window_;
};

inline Material material(const std::string& id, ModelSpec spec) {
  check_model(spec);
  Material m;
  m.id = id;
  m.surface = std::move(spec);
  return m;
}
inline ModelSpec lambert(double reflectance, double transmittance = 0) {
  ModelSpec s;
  s.model = "lambert";
  s.numbers = {{"reflectance", reflectance}, {"transmittance", transmittance}};
  return s;
}

inline Mesh mesh_of(const std::vector<Vec3>& vertices, std::vector<uint32_t> indices, uint32_t material) {
  Mesh m;
  m.name = "mesh";
  std::vector<float> positions;
  for (const Vec3& v : vertices)
    for (int a = 0; a < 3; ++a) positions.push_back(static_cast<float>(v[a]));
  positions.push_back(0);
  m.positions = std::move(positions);
  m.indices = std::move(indices);
  m.parts.push_back({"part", 0, static_cast<uint32_t>(m.triangle_count()), material});
  return m;
}
// Horizontal square of the given half size at height z, facing up.
inline Mesh quad(double half, double z, uint32_t material) {
  return mesh_of({{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}}, {0, 1, 2, 0, 2, 3},
                 material);
}
// Axis-aligned box; outward: front sides point out, otherwise in.
inline Mesh box(Vec3 low, Vec3 high, uint32_t material, bool outward) {
  std::vector<Vec3> v;
  for (int i = 0; i < 8; ++i) v.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  std::vector<uint32_t> f{0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                          2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  if (!outward)
    for (size_t i = 0; i < f.size(); i += 3) std::swap(f[i + 1], f[i + 2]);
  return mesh_of(v, f, material);
}

// A scene of meshes placed where they are.
inline std::shared_ptr<Scene> scene_of(std::vector<Mesh> meshes, std::vector<Material> materials) {
  auto scene = std::make_shared<Scene>();
  Group root;
  root.name = "root";
  for (uint32_t i = 0; i < meshes.size(); ++i) {
    Placement p;
    p.target = i;
    root.placements.push_back(p);
  }
  scene->groups.push_back(std::move(root));
  scene->meshes = std::move(meshes);
  scene->materials = std::move(materials);
  check_scene(*scene, "test scene");
  return scene;
}

struct Rendered {
  CaptureResult result;
  JobReport report;
};
inline Rendered render(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources,
                       std::unique_ptr<RaySensor> sensor, PipelineOptions options = {}) {
  JobOptions job;
  job.pipeline = options;
  job.progress = false;
  std::vector<std::unique_ptr<Sensor>> sensors;
  RaySensor* raw = sensor.get();
  sensors.push_back(std::move(sensor));
  Rendered r;
  r.report = run_job(scene, sources, sensors, job);
  r.result = std::move(raw->result);
  return r;
}

inline SkySpec uniform_sky(double radiance, bool full_sphere) {
  return {Curve::constant(radiance), {}, 0, 0, full_sphere};
}

// A dome of 100 x 100 cells, `width` wide, sagging a twentieth of that: it cannot shadow itself.
inline Mesh dome(double width) {
  constexpr uint32_t n = 101;
  std::vector<Vec3> v;
  std::vector<uint32_t> f;
  for (uint32_t j = 0; j < n; ++j)
    for (uint32_t i = 0; i < n; ++i) {
      const double x = (i / 100.0 - 0.5) * width, y = (j / 100.0 - 0.5) * width;
      v.push_back({x, y, -(x * x + y * y) / (10 * width)});
    }
  for (uint32_t j = 0; j + 1 < n; ++j)
    for (uint32_t i = 0; i + 1 < n; ++i) {
      const uint32_t a = j * n + i;
      for (const uint32_t k : {a, a + 1, a + n + 1, a, a + n + 1, a + n}) f.push_back(k);
    }
  return mesh_of(v, f, 0);
}

}  // namespace suite::test
