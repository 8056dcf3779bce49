#include "transport/refracted_ray.h"

#include <algorithm>
#include <cmath>

namespace suite {

SmoothInterfaces::SmoothInterfaces(const Scene& scene, const Optics& optics)
    : index_(scene.materials.size()), lobe_(scene.materials.size(), {0, kNoLobe}) {
  const size_t knots = optics.state().knots.size();
  for (uint32_t i = 0; i < scene.materials.size(); ++i) {
    const BakedMaterial& material = optics.material(i);
    if (!material.model || (material.maps && material.maps->varies())) continue;
    if (material.model->has_delta() && !material.model->opaque() && probe(*material.model, i, knots)) any_ = true;
  }
  for (size_t k = 0; k < knots; ++k) {
    const auto alike = [&](size_t other) {
      return std::all_of(index_.begin(), index_.end(), [&](const auto& n) { return n.empty() || n[k] == n[other]; });
    };
    size_t first = 0;
    while (!alike(first)) ++first;
    set_of_.push_back(first);
  }
}

// Asks a model from the front, where there is no total reflection: it is an interface if it does nothing but reflect
// and transmit in one direction each, along Snell's law without losses.
bool SmoothInterfaces::probe(const ScatterModel& model, uint32_t material, size_t knots) {
  const Dir oblique{0.6, 0, 0.8};
  std::vector<double> index;
  std::vector<float> reflected(knots), passed(knots);
  for (size_t k = 0; k < knots; ++k) {
    const auto mirrored = model.sample(oblique, {0.5, 0.5}, 0, static_cast<int>(k)),
               through = model.sample(oblique, {0.5, 0.5}, std::nextafter(1.0, 0.0), static_cast<int>(k));
    if (!through || !through->delta || !(through->in.z < 0) || through->in.y != 0) return false;
    model.delta_probability(oblique, through->lobe, static_cast<int>(k), passed);
    double all = double{passed[k]};
    if (mirrored && mirrored->in.z > 0) {
      if (!mirrored->delta) return false;
      model.delta_probability(oblique, mirrored->lobe, static_cast<int>(k), reflected);
      all += double{reflected[k]};
      lobe_[material][1] = mirrored->lobe;
    }
    if (std::fabs(all - 1) > 1e-6) return false;
    index.push_back(oblique.x / -through->in.x);
    lobe_[material][0] = through->lobe;
  }
  index_[material] = std::move(index);
  return true;
}

BentRay BentRay::from(Vec3 origin, const Frame& across) { return {origin, across.z, {}, {across.x, across.y}}; }

namespace {

// The change of a ray's place on a surface that it meets with parameter i.
Vec3 moved_along(const BentRay& ray, const Hit& hit, int i) {
  const Vec3 dp = ray.d_origin[i] + ray.d_direction[i] * hit.distance;
  return dp - ray.direction * (dot(dp, hit.normal) / dot(ray.direction, hit.normal));
}

}  // namespace

bool bend(BentRay& ray, const Hit& hit, const Interaction& at, double index, const NormalTurn& turn) {
  const Dir d = ray.direction;
  const double slope = dot(d, hit.normal);
  if (slope == 0) return false;
  // Normal against the ray.
  const bool front = dot(d, at.frame.z) < 0;
  const double side = front ? 1 : -1, mu = front ? 1 / index : index;
  const Dir n = at.frame.z * side;
  const double c1 = -dot(d, n), rest = 1 - mu * mu * (1 - c1 * c1);
  if (!(c1 > 0) || !(rest > 0)) return false;
  const double c2 = std::sqrt(rest), along = mu * c1 - c2;
  const Dir on = normalized(d * mu + n * along);
  if (dot(on, hit.normal) * slope <= 0) return false;
  for (int i : {0, 1}) {
    const Vec3 moved = moved_along(ray, hit, i), dn = turn.over(moved) * side, dd = ray.d_direction[i];
    const double dc1 = -(dot(dd, n) + dot(d, dn)), dc2 = mu * mu * c1 * dc1 / c2;
    ray.d_origin[i] = moved;
    ray.d_direction[i] = dd * mu + n * (mu * dc1 - dc2) + dn * along;
  }
  ray.origin = hit.position;
  ray.direction = on;
  return true;
}

bool reflect(BentRay& ray, const Hit& hit, const Interaction& at, const NormalTurn& turn) {
  const Dir d = ray.direction, n = at.frame.z;
  const double slope = dot(d, hit.normal), along = dot(d, n);
  if (slope == 0) return false;
  const Dir on = normalized(d - n * (2 * along));
  if (dot(on, hit.normal) * slope >= 0) return false;
  for (int i : {0, 1}) {
    const Vec3 moved = moved_along(ray, hit, i), dn = turn.over(moved), dd = ray.d_direction[i];
    ray.d_origin[i] = moved;
    ray.d_direction[i] = dd - n * (2 * (dot(dd, n) + dot(d, dn))) - dn * (2 * along);
  }
  ray.origin = hit.position;
  ray.direction = on;
  return true;
}

std::optional<Dir> unbent(Dir beyond, Dir n, double ratio) {
  const double c = dot(beyond, n), rest = 1 - ratio * ratio * (1 - c * c);
  if (!(rest > 0)) return std::nullopt;
  return normalized((beyond - n * c) * ratio + n * std::copysign(std::sqrt(rest), c));
}

}  // namespace suite
