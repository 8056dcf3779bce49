// Media, grids and sensors for tests of paths through volumes.
#pragma once
#include <cmath>

#include "math/stats.h"
#include "math/warps.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test {

inline ModelSpec hg(double g) { return {"hg", {}, {{"g", Curve::constant(g)}}, {}, nullptr}; }

inline Medium medium(Curve absorption, Curve scattering, ModelSpec phase = hg(0)) {
  Medium m;
  m.id = "medium";
  m.absorption = std::move(absorption);
  m.scattering = std::move(scattering);
  m.phase = std::move(phase);
  check_medium(m);
  return m;
}
// A surface that only bounds a medium.
inline Material boundary(uint32_t inside) {
  Material m;
  m.id = "boundary";
  m.inside = inside;
  return m;
}

inline void place(Scene& scene, PrimitiveKind kind, std::vector<double> parameters, uint32_t material,
                  const Affine3& where = {}) {
  scene.primitives.push_back({"primitive", kind, std::move(parameters), material});
  if (scene.groups.empty()) scene.groups.push_back({"root", {}});
  scene.groups[0].placements.push_back(
      {where, TargetKind::primitive, static_cast<uint32_t>(scene.primitives.size() - 1), kNone, kNone});
}

// All space between z = 0 and z = thickness, exactly: below lies a void of higher priority.
inline std::shared_ptr<Scene> slab_scene(const Medium& m, double thickness) {
  auto scene = std::make_shared<Scene>();
  Medium nothing;
  nothing.id = "void";
  nothing.priority = 1;
  scene->media = {m, nothing};
  scene->materials = {boundary(0), boundary(1)};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, thickness}));
  place(*scene, PrimitiveKind::plane, {0, 0}, 1);
  check_scene(*scene, "slab");
  return scene;
}

// A grid of equal cells whose densities `density(i, j, k)` gives.
template <class Density>
VoxelGrid grid_of(std::array<uint32_t, 3> cells, const Affine3& to_local, const Density& density, uint32_t medium = 0) {
  VoxelGrid g;
  g.name = "grid";
  g.cells = cells;
  g.to_local = to_local;
  g.media = {medium};
  for (uint32_t k = 0; k < cells[2]; ++k)
    for (uint32_t j = 0; j < cells[1]; ++j)
      for (uint32_t i = 0; i < cells[0]; ++i) g.density.push_back(static_cast<float>(density(i, j, k)));
  return g;
}
inline std::shared_ptr<Scene> scene_with(const Medium& m, VoxelGrid grid, const Affine3& to_world = {}) {
  auto scene = std::make_shared<Scene>();
  scene->groups.push_back({"root", {}});
  scene->media = {m};
  scene->grids.push_back(std::move(grid));
  scene->volumes.push_back({0, to_world});
  check_scene(*scene, "grid");
  return scene;
}

// Rays from fixed places in cosine-distributed directions around an axis: pi times the mean radiance is the flux.
class FluxSensor final : public RaySensor {
 public:
  using RaySensor::RaySensor;
  SensorRay ray(const RayRequest& r) const override {
    const Ray& axis = rays_[r.problem];
    return {{axis.origin, Frame::around(axis.direction).to_world(cosine_hemisphere({r.u[0], r.u[1]})), 0}, 1};
  }
};

// What the rays see in a scene that may repeat itself; no sample may fail.
inline CaptureResult render_cell(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources,
                                 std::vector<Ray> rays, uint32_t paths,
                                 const std::optional<Periodic>& cell = std::nullopt, uint64_t seed = 1) {
  JobOptions job;
  job.progress = false;
  job.periodic = cell;
  job.pipeline.seed = seed;
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<RaySensor>(std::move(rays), one_band(), paths));
  if (run_job(scene, sources, sensors, job).statistics.failures) throw Error("samples that failed");
  return std::move(static_cast<RaySensor&>(*sensors[0]).result);
}

// Mean and standard error over problems that all ask the same, from their own means: 64 independent numbers.
struct Repeated {
  double mean = 0, error = 0;
};
inline std::vector<Ray> repeated(const Ray& ray) { return std::vector<Ray>(64, ray); }
inline Repeated over_problems(const CaptureResult& r, size_t band) {
  RunningStats stats;
  for (size_t p = 0; p < r.problems(); ++p) stats.add(r.radiance[p * r.bands + band]);
  return {stats.mean(), stats.stderr_of_mean()};
}

}  // namespace suite::test
