// Ways through what fills space that are asked for rather than flown: of light that interfaces bend, of chains.
#include <algorithm>
#include <cmath>
#include <limits>

#include "transport/media/space_field.h"

namespace suite {

void FieldSpace::begin_way(uint32_t p, bool event, const Hit& hit, uint32_t material, Dir out, Dir in) {
  way_ = stacks_[p];
  if (!event && dot(in, hit.normal) * dot(out, hit.normal) < 0) bodies_.transmit(way_, hit, material, in, statistics_);
}

template <class Stretch>
double FieldSpace::run(MediumStack& stack, Ray ray, double length, bool to_surface, const Stretch& stretch) {
  constexpr double kShort = 1 - 1e-9;  // of a way to a surface, which itself is not met
  double left = length, gone = 0, gap = 0;
  while (true) {
    Hit hit;
    if (to_surface || bodies_.any_boundary()) surface_.tracer().nearest({&ray, 1}, {&hit, 1}, false, statistics_);
    if (gap > 0) bodies_.settle(hit, ray, gap);
    const bool met = hit.hit() && hit.distance < left * kShort,
               passed = met && bodies_.is_boundary(surface_.material(hit));
    const double way = passed || (met && to_surface) ? hit.distance : left;
    if (!passed && !to_surface && left == std::numeric_limits<double>::infinity()) bodies_.leave_scene(stack);
    ray.origin -= ray.direction * gap;
    stretch(ray, way);
    gone += way;
    if (!passed) return gone;
    const auto onward = bodies_.pass(stack, hit, ray, way - gap, statistics_);
    if (!onward) return gone;
    left -= way;
    gap = onward->gap;
    ray.origin = onward->start;
  }
}

double FieldSpace::free_way(const Ray& ray) {
  MediumStack stack = way_;
  double within = 0;
  layers_.clear();
  const double way = run(stack, ray, std::numeric_limits<double>::infinity(), true, [&](const Ray&, double m) {
    layers_.push_back({m, stack.medium(ambient_)});
    if (std::isfinite(m)) within += m;
  });
  if (std::isfinite(way)) return way;
  MediumStack outside = stack;
  bodies_.leave_scene(outside);
  return outside.medium(ambient_) == stack.medium(ambient_) ? way : within;
}

double FieldSpace::depth_of_way(double most, size_t knot) const {
  double depth = 0, left = most;
  for (const Layer& s : layers_) {
    depth += std::min(s.length, left) * scattering_in(s.medium, knot);
    if ((left -= s.length) <= 0) break;
  }
  return depth;
}

double FieldSpace::share_of_way(double share, double most, size_t knot) const {
  const double depth = layers_.size() > 1 ? depth_of_way(most, knot) : 0;
  if (!(depth > 0)) return share;
  double left = share * depth, gone = 0;
  for (const Layer& s : layers_) {
    const double length = std::min(s.length, most - gone), rate = scattering_in(s.medium, knot);
    if (rate * length >= left && rate > 0) return std::min(1.0, (gone + left / rate) / most);
    left -= rate * length, gone += length;
  }
  return 1;
}

auto FieldSpace::share_of_depth(double way, double most, size_t knot) const -> DepthShare {
  const double depth = layers_.size() > 1 ? depth_of_way(most, knot) : 0;
  if (!(depth > 0)) return {way, 1};
  double left = way * most, passed = 0, rate = 0;
  for (const Layer& s : layers_) {
    rate = scattering_in(s.medium, knot);
    passed += rate * std::min(s.length, left);
    if ((left -= s.length) <= 0) break;
  }
  return {passed / depth, rate * most / depth};
}

uint32_t FieldSpace::mean_of_way(const Ray& ray, double length) {
  ScatterPlace& e = events_[mean_event()];
  e.contents.clear();
  MediumStack stack = way_;
  run(stack, ray, length, false, [&](const Ray&, double m) {
    const uint32_t medium = stack.medium(ambient_);
    if (medium == kNone) return;
    const auto known =
        std::find_if(e.contents.begin(), e.contents.end(), [&](const Constituent& c) { return c.medium == medium; });
    if (known == e.contents.end())
      e.contents.push_back({medium, m / length, 0});
    else
      known->density += m / length;
  });
  set_rates(e);
  return mean_event();
}

uint32_t FieldSpace::stand_on_way() {
  ScatterPlace& e = events_[mean_event() + 1];
  stand(e, way_);
  return mean_event() + 1;
}

double FieldSpace::follow_way(const Ray& from, double length, std::span<float> through, std::span<float> scratch) {
  const double delay = delay_of(way_.medium(ambient_));
  const bool airless = is_airless(way_.medium(ambient_));
  depths_.assign(optics_.media().size(), 0);
  run(way_, from, length, false,
      [&](const Ray& ray, double way) { flights_.add_depths(ray, way, way_.medium(ambient_), depths_); });
  const auto weaken = [&] {
    for (size_t i = 0; i < through.size(); ++i) through[i] *= scratch[i];
  };
  if (flights_.transmittance(depths_, scratch)) weaken();
  if (air_ && !airless) air_->transmittance(from.origin, from.direction, length, scratch), weaken();
  return delay;
}

}  // namespace suite
