// The one-million-triangle terrain that the ray-tracing figures of the suite refer to:
// z = sum over k = 0..5 of a_k sin(1.3 f_k x + k) cos(f_k y + 1.7 k), a_0 = 40 m, f_0 = 0.006 /m, a halves and f grows
// by 2.1 per octave, over 1 km; Lambert 0.5, facet normals; collimated sun along (-0.5, 0.3, -0.8) with normal
// irradiance 3, constant sky 0.3.
#pragma once
#include <cmath>
#include <ctime>
#include <memory>

#include "light/kinds/lamps.h"
#include "light/kinds/sky.h"
#include "light/kinds/sun.h"
#include "math/sampling.h"
#include "scene/scene.h"
#include "scheduler/scheduler.h"

namespace suite::bench {

inline double terrain_height(double x, double y) {
  double z = 0, a = 40, f = 0.006;
  for (int k = 0; k < 6; ++k, a *= 0.5, f *= 2.1) z += a * std::sin(1.3 * f * x + k) * std::cos(f * y + 1.7 * k);
  return z;
}

// edge: vertices along one side; 708 gives 999 698 triangles.
inline std::shared_ptr<Scene> terrain_scene(uint32_t edge, double reflectance = 0.5) {
  auto scene = std::make_shared<Scene>();
  Mesh mesh;
  mesh.name = "terrain";
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  for (uint32_t j = 0; j < edge; ++j)
    for (uint32_t i = 0; i < edge; ++i) {
      const double x = -500 + 1000.0 * i / (edge - 1), y = -500 + 1000.0 * j / (edge - 1);
      for (const double c : {x, y, terrain_height(x, y)}) positions.push_back(static_cast<float>(c));
    }
  positions.push_back(0);
  for (uint32_t j = 0; j + 1 < edge; ++j)
    for (uint32_t i = 0; i + 1 < edge; ++i) {
      const uint32_t v = j * edge + i;
      for (const uint32_t index : {v, v + 1, v + edge + 1, v, v + edge + 1, v + edge}) indices.push_back(index);
    }
  mesh.positions = std::move(positions), mesh.indices = std::move(indices);
  mesh.parts.push_back({"terrain", 0, static_cast<uint32_t>(mesh.triangle_count()), 0});
  scene->meshes.push_back(std::move(mesh));
  Group root;
  root.placements.push_back({});
  scene->groups.push_back(root);
  Material ground;
  ground.id = "ground";
  ground.surface.model = "lambert";
  ground.surface.curves["reflectance"] = Curve::constant(reflectance);
  check_model(ground.surface);
  scene->materials.push_back(ground);
  return scene;
}

// half_angle: of the sun, rad.
inline SourceSpecs terrain_sources(double half_angle = 0) {
  SourceSpecs sources;
  sources.add(SunSpec{normalized(Vec3{0.5, -0.3, 0.8}), half_angle, Curve::constant(3)});
  sources.add(SkySpec{Curve::constant(0.3), {}, 0, 0, true});
  return sources;
}

// n lamps at random places 5 m over the terrain, of one power in all.
inline SourceSpecs lamps_over_terrain(int n) {
  LampSpec lamp;
  lamp.intensity = Curve::constant(100.0 / n);
  Pcg32 random(3);
  for (int i = 0; i < n; ++i) {
    const double x = 1000 * random.uniform() - 500, y = 1000 * random.uniform() - 500;
    lamp.positions.push_back({x, y, terrain_height(x, y) + 5});
  }
  SourceSpecs sources;
  sources.add(lamp);
  return sources;
}

// Camera at (0, -600, 500) m looking at the origin, 60 degrees, `edge` x `edge` pixels, `bands` narrow bands.
class TerrainCamera final : public Sensor {
 public:
  // captures: how often the same picture is taken.
  TerrainCamera(uint32_t edge, uint32_t paths, size_t bands = 1, size_t captures = 1) {
    for (size_t b = 0; b < bands; ++b)
      bands_.push_back(Band::rectangular("b" + std::to_string(b), 0.5 + 0.01 * static_cast<double>(b), 0.01));
    state_ = make_state(bands_, 0.01);
    Capture c;
    c.columns = c.rows = edge;
    pixel_ = 2 * 0.57735026918962576 / edge;
    c.convergence.min_paths = c.convergence.max_paths = paths;
    tasks_.push_back({"terrain", {}, std::vector<Capture>(captures, c)});
    forward_ = normalized(-position_);
    right_ = normalized(cross(forward_, Vec3{0, 0, 1}));
    down_ = cross(forward_, right_);
  }
  std::string name() const override { return "terrain camera"; }
  std::span<const SpectralState> states() const override { return {&state_, 1}; }
  std::span<const Band> bands(size_t) const override { return bands_; }
  std::span<const Task> tasks() const override { return tasks_; }
  SensorRay ray(const RayRequest& request) const override {
    const auto& [c, problem, u, spectral] = request;
    const auto n = static_cast<uint32_t>(problem);
    const double half = 0.57735026918962576, step = pixel_;  // tan 30 degrees
    const double x = (n % c.columns + u[0]) * step - half, y = (n / c.columns + u[1]) * step - half;
    const Vec3 d = forward_ + right_ * x + down_ * y;
    return {{position_, d * (1 / length(d)), 0}, 1};
  }
  void accept(CaptureResult&& r) override { result = std::move(r); }
  CaptureResult result;  // of the last capture

 private:
  std::vector<Band> bands_;
  SpectralState state_;
  std::vector<Task> tasks_;
  double pixel_ = 0;  // width at distance 1
  Vec3 position_{0, -600, 500}, forward_, right_, down_;
};

}  // namespace suite::bench
