#include "heat/audit_sun.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {

constexpr uint32_t kRouletteFrom = 2;  // surfaces

double between(const std::vector<double>& values, double x) {
  const auto k = std::min(static_cast<size_t>(x), values.size() - 2);
  return values[k] + (values[k + 1] - values[k]) * (x - static_cast<double>(k));
}

}  // namespace

AuditSun::AuditSun(const Tracer& tracer, const HeatOptics& optics, const WeatherLoads& weather, double ground_albedo)
    : tracer_(tracer),
      weather_(weather),
      ground_albedo_(ground_albedo),
      surface_(tracer, *optics.sun),
      W_(optics.sun->state().size()),
      w_(W_.size()),
      T_(W_.size()),
      knots_(optics.sun->state().knots.size()),
      walk_(optics.sun->state()) {}

AuditSun::Light AuditSun::light_at(double t) const {
  const std::vector<double>& moments = weather_.moments;
  const double x = std::clamp((t - moments.front()) / (moments.back() - moments.front()), 0.0, 1.0) *
                   static_cast<double>(moments.size() - 1);
  Light light;
  light.direct = between(weather_.direct, x), light.global = between(weather_.global, x);
  light.moment = static_cast<size_t>(std::lround(x));
  light.sun = Frame::around(weather_.course.towards(t));
  return light;
}

double AuditSun::absorbed(const Hit& hit, double side, double t, WalkNumbers& numbers) {
  const Light light = light_at(t);
  const bool beam = light.direct > 0 && light.sun.z.z > 0;
  if (!beam && !(light.global > 0)) return 0;
  const double u = numbers.uniform(), v = numbers.uniform();
  const double sum = beam ? straight(hit, side, t, light, disk_from_square({u, v})) : 0;
  return sum + scattered(hit, side, t, light, numbers);
}

bool AuditSun::sees_sun(const Hit& hit, Dir d, double t, uint32_t draw) {
  const Ray ray{tracer_.leave(hit, d), d, t, draw};
  const double reach = INFINITY;
  uint8_t blocked = 0;
  tracer_.occluded({&ray, 1}, {&reach, 1}, {&blocked, 1}, false, trace_);
  return !blocked;
}

double AuditSun::straight(const Hit& hit, double side, double t, const Light& light, Vec2 disk) {
  const Dir d = on_disk(light.sun, disk.x, disk.y, weather_.course.angular_radius);
  const double cosine = side * dot(d, hit.normal);
  if (!(cosine > 0)) return 0;
  surface_.interact(hit, d, at_, t);
  if (!at_.baked || !at_.baked->model) return 0;
  at_.baked->model->total(at_.frame.to_local(d), W_);
  double kept = 0;
  const std::vector<float>& beam = weather_.course.beam[light.moment];
  for (size_t i = 0; i < W_.size(); ++i) kept += double{beam[i]} * (1 - double{std::min(1.0f, W_[i])});
  return kept > 0 && sees_sun(hit, d, t, 0) ? light.direct * cosine * kept : 0;
}

// Of where a path leaves, W/(m2 sr).
double AuditSun::outside(Dir d, const Light& light) const {
  if (!(light.global > 0)) return 0;
  if (d.z > 0) return double{weather_.sky[light.moment][sky_patch(d)]};
  return ground_albedo_ * light.global / kPi;
}

// What a surface on the way sends back along `out` of the beam, weighed by the path's throughput.
double AuditSun::asked(const Hit& hit, Dir out, double t, const Light& light, WalkNumbers& numbers) {
  const double u = numbers.uniform(), v = numbers.uniform();
  const Vec2 disk = disk_from_square({u, v});
  const Dir d = on_disk(light.sun, disk.x, disk.y, weather_.course.angular_radius);
  at_.baked->model->eval(out, at_.frame.to_local(d), w_);
  double value = 0;
  const std::vector<float>& beam = weather_.course.beam[light.moment];
  for (size_t i = 0; i < T_.size(); ++i) value += double{T_[i]} * double{w_[i]} * double{beam[i]};
  return value > 0 && sees_sun(hit, d, t, numbers.next()) ? light.direct * value : 0;
}

double AuditSun::scattered(const Hit& from, double side, double t, const Light& light, WalkNumbers& numbers) {
  const bool beam = light.direct > 0 && light.sun.z.z > 0;
  const double first = numbers.uniform(), second = numbers.uniform();
  const Dir normal = from.normal * side;
  Ray ray{{}, normalized(Frame::around(normal).to_world(cosine_hemisphere({first, second}))), t, numbers.next()};
  surface_.interact(from, ray.direction, at_, t);
  if (!at_.baked || !at_.baked->model) return 0;
  at_.baked->model->total(at_.frame.to_local(ray.direction), W_);
  for (size_t i = 0; i < T_.size(); ++i) T_[i] = (1 - std::min(1.0f, W_[i])) * static_cast<float>(kPi);
  WalkDensities path;
  path.start(numbers.uniform(), knots_);
  ray.origin = tracer_.leave(from, ray.direction);
  double sum = 0;
  for (uint32_t n = 0; n < kMostReflections; ++n) {
    Hit hit;
    tracer_.nearest({&ray, 1}, {&hit, 1}, false, trace_);
    if (!hit.hit()) {
      double share = 0;
      for (size_t i = 0; i < T_.size(); ++i) share += double{T_[i]} * double{weather_.course.sky[i]};
      return sum + share * outside(ray.direction, light) * path.weight(knots_);
    }
    surface_.interact(hit, -ray.direction, at_, t);
    if (!at_.baked || !at_.baked->model) {
      ray.origin = tracer_.leave(hit, ray.direction);
      continue;
    }
    const Dir out = at_.frame.to_local(-ray.direction);
    if (beam) sum += asked(hit, out, t, light, numbers) * path.weight(knots_);
    const double a = numbers.uniform(), b = numbers.uniform(), c = numbers.uniform();
    const auto drawn = walk_.draw(*at_.baked->model, out, {a, b, c, 0}, path.knot);
    if (!drawn) return sum;
    const double most = walk_.take(path, T_);
    if (!(most > 0)) return sum;
    const double left = n < kRouletteFrom ? 1 : most * path.weight(knots_) / kPi;
    if (!SurfaceWalk::survives(T_, left, numbers.uniform())) return sum;
    ray.direction = at_.frame.to_world(drawn->in);
    ray.origin = tracer_.leave(hit, ray.direction);
  }
  return sum;
}

}  // namespace suite
