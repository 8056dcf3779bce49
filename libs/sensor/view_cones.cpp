#include "sensor/view_cones.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "math/vec.h"

namespace suite {

namespace {

constexpr uint32_t kLooks = 5;  // along each side of a tile

struct Looks {
  std::vector<Ray> rays;
  bool everywhere = false;
};

// u of a pixel's corners and of the begin and end of what else is drawn.
void look(const Sensor& sensor, const Capture& capture, size_t problem, Looks& looks) {
  const size_t bins = sensor.states()[capture.state].size();
  std::vector<float> spectral(bins, 1.0f);
  const auto numbers = static_cast<size_t>(sensor.numbers());
  for (const double x : {0.0, 0.999999})
    for (const double y : {0.0, 0.999999})
      for (const double more : {0.0, 0.5, 0.999999}) {
        std::array<double, 8> u;
        u.fill(more);
        u[0] = x;
        if (numbers > 1) u[1] = y;
        const SensorRay ray = sensor.ray({capture, problem, {u.data(), numbers}, spectral});
        looks.everywhere |= ray.receiver != SensorRay::Receiver::none;
        if (ray.weight > 0) looks.rays.push_back(ray.ray);
      }
}

ViewCone around(const Looks& looks) {
  ViewCone cone;
  Vec3 axis{}, apex{};
  for (const Ray& r : looks.rays) axis += r.direction, apex += r.origin;
  cone.apex = apex / static_cast<double>(looks.rays.size());
  const double size = length(axis);
  cone.axis = size > 0 ? axis / size : Dir{0, 0, -1};
  cone.angle = size > 0 ? 0 : kPi;
  for (const Ray& r : looks.rays) {
    cone.angle = std::max(cone.angle, angle_between(r.direction, cone.axis));
    cone.reach = std::max(cone.reach, length(r.origin - cone.apex));
  }
  cone.angle = looks.everywhere ? kPi : std::min(kPi, cone.angle * (1 + 1.0 / (kLooks - 1)) + 1e-6);
  cone.reach *= 1 + 1.0 / (kLooks - 1);
  return cone;
}

}  // namespace

bool ViewCone::touches(Vec3 centre, double radius) const {
  const Vec3 to = centre - apex;
  const double distance = length(to), ball = radius + reach;
  if (angle >= kPi || distance <= ball) return true;
  return angle_between(to / distance, axis) <= angle + std::asin(ball / distance);
}

std::vector<ViewCone> view_cones(const Sensor& sensor, size_t most) {
  std::vector<ViewCone> out;
  for (const Task& task : sensor.tasks())
    for (const Capture& c : task.captures) {
      const double tiles = static_cast<double>(c.problems()) / static_cast<double>(most);
      const auto side = std::max(8u, static_cast<uint32_t>(std::ceil(std::sqrt(tiles))));
      for (uint32_t row = 0; row < c.rows; row += side)
        for (uint32_t column = 0; column < c.columns; column += side) {
          const uint32_t high = std::min(side, c.rows - row) - 1, wide = std::min(side, c.columns - column) - 1;
          Looks looks;
          for (uint32_t i = 0; i < kLooks; ++i)
            for (uint32_t j = 0; j < kLooks; ++j) {
              const size_t r = row + high * i / (kLooks - 1), k = column + wide * j / (kLooks - 1);
              look(sensor, c, r * c.columns + k, looks);
            }
          if (!looks.rays.empty()) out.push_back(around(looks));
        }
    }
  return out;
}

}  // namespace suite
