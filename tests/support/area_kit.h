// Scenes in which every problem looks straight up or down at one square metre: rare events of known share, shadow
// edges, exchange between walls.
#pragma once
#include <cmath>
#include <memory>
#include <vector>

#include "math/sampling.h"
#include "tests/support/one_state_sensor.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test {

// Parallel rays, straight up or down, each problem over one square metre; one band.
class AreaSensor final : public OneStateSensor {
 public:
  AreaSensor(double z, Dir direction, uint32_t edge, Convergence goal, bool neighbours)
      : OneStateSensor("area", one_band(), make_state(one_band(), 0.02), {capture(edge, goal, neighbours)}),
        z_(z),
        direction_(direction) {}
  SensorRay ray(const RayRequest& r) const override {
    const auto [x, y] = place_of(r);
    return {{{x, y, z_}, direction_, 0}, 1};
  }
  void accept(CaptureResult&& r) override { result = std::move(r); }
  CaptureResult result;

 private:
  static Capture capture(uint32_t edge, Convergence goal, bool neighbours) {
    Capture c;
    c.columns = c.rows = edge;
    c.neighbours = neighbours;
    c.convergence = goal;
    return c;
  }
  double z_;
  Dir direction_;
};

inline constexpr uint32_t kEdge = 48;

// In every square metre a square of area `share` that differs from the rest, at a place of its own.
inline std::shared_ptr<Scene> squares(double share, bool holes) {
  const double side = std::sqrt(share);
  std::vector<Vec3> v;
  std::vector<uint32_t> few, rest;
  auto rectangle = [&](double x0, double y0, double x1, double y1, std::vector<uint32_t>& to) {
    const auto at = static_cast<uint32_t>(v.size());
    for (const Vec3 p : {Vec3{x0, y0, 0}, Vec3{x1, y0, 0}, Vec3{x1, y1, 0}, Vec3{x0, y1, 0}}) v.push_back(p);
    for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) to.push_back(at + i);
  };
  Pcg32 rng(17);
  for (uint32_t j = 0; j < kEdge; ++j)
    for (uint32_t i = 0; i < kEdge; ++i) {
      const double x = i + rng.uniform() * (1 - side), y = j + rng.uniform() * (1 - side);
      rectangle(i, j, i + 1, y, rest), rectangle(i, y + side, i + 1, j + 1, rest);
      rectangle(i, y, x, y + side, rest), rectangle(x + side, y, i + 1, y + side, rest);
      if (!holes) rectangle(x, y, x + side, y + side, few);
    }
  ModelSpec mirror{"mirror", {}, {{"reflectance", Curve::constant(1)}}, {}, nullptr};
  std::vector<Mesh> meshes{mesh_of(v, rest, 0)};
  if (!holes) meshes.push_back(mesh_of(v, few, 1));
  return scene_of(std::move(meshes), {material("black", lambert(0)), material("mirror", mirror)});
}

struct Place {
  const char* name;
  double share;
  bool holes;  // the sky through a canopy from below; else mirrors on a black floor from above
};
inline constexpr Place kGap{"canopy gap", 0.02, true}, kGlint{"glint", 0.005, false};

// A floor with a box on it, and a court of three walls: under sun and sky, noise from shadow edges and exchange.
inline Mesh wide_ground() {
  return mesh_of({{-50, -50, 0}, {98, -50, 0}, {98, 98, 0}, {-50, 98, 0}}, {0, 1, 2, 0, 2, 3}, 0);
}
inline std::shared_ptr<Scene> block() {
  return scene_of({wide_ground(), box({10, 10, 0}, {30, 26, 12}, 1, true)},
                  {material("ground", lambert(0.3)), material("wall", lambert(0.6))});
}
inline std::shared_ptr<Scene> court() {
  return scene_of({wide_ground(), box({-4, -4, 0}, {0, 52, 14}, 1, true), box({-4, -4, 0}, {52, 0, 14}, 1, true),
                   box({48, -4, 0}, {52, 52, 14}, 1, true)},
                  {material("ground", lambert(0.5)), material("wall", lambert(0.7))});
}

}  // namespace suite::test
