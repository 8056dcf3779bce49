#include "radiometry/volume_bodies.h"

#include "scene/primitives.h"

namespace suite {

namespace {
constexpr int kMostCrossings = 4096;  // of one probing ray; surfaces that lie in each other end it
}  // namespace

Bodies::Bodies(const Surface& surface) : surface_(surface) {
  const Scene& scene = surface.tracer().scene();
  for (const Material& m : scene.materials) {
    rules_.push_back({{m.outside, m.inside}, m.is_boundary()});
    any_ = any_ || m.bounds_medium();
    any_boundary_ = any_boundary_ || m.is_boundary();
  }
  for (const TracedObject& o : surface.tracer().objects()) {
    if (o.instance >= unbounded_.size()) unbounded_.resize(o.instance + 1, false);
    unbounded_[o.instance] = o.primitive != kNone && primitive_box(scene.primitives[o.primitive]).empty();
  }
}

void Bodies::cross(MediumStack& stack, const Hit& hit, uint32_t material, Dir direction) const {
  if (material == kNone) return;
  const Rule& rule = rules_[material];
  const bool behind = dot(direction, hit.normal) < 0;
  stack.leave(body(hit), !behind);
  const uint32_t medium = rule.medium[behind];
  stack.enter(body(hit), behind, medium, priority(medium));
}

const MediumStack& Bodies::around(Vec3 place, double time, TraceStatistics& statistics) {
  if (asked_ && place.x == place_.x && place.y == place_.y && place.z == place_.z && time == time_) return around_;
  asked_ = true;
  place_ = place, time_ = time;
  around_.clear();
  // What the ray leaves without having entered it, it started in; the nearest such surface is the innermost body.
  MediumStack entered;
  std::vector<std::pair<Hit, uint32_t>> left;
  Ray ray{place, normalized(Vec3{0.0123, 0.0345, 1}), time};
  for (int n = 0; n < kMostCrossings; ++n) {
    Hit hit;
    surface_.tracer().nearest({&ray, 1}, {&hit, 1}, false, statistics);
    if (!hit.hit()) break;
    const uint32_t material = surface_.material(hit);
    if (material != kNone && (rules_[material].medium[0] != kNone || rules_[material].medium[1] != kNone)) {
      const bool side = dot(ray.direction, hit.normal) > 0;  // the side that the ray comes from: behind the surface
      if (rules_[material].medium[side] != kNone && !entered.holds(body(hit), side)) left.emplace_back(hit, material);
      cross(entered, hit, material, ray.direction);
    }
    ray.origin = surface_.tracer().leave(hit, ray.direction);
  }
  for (size_t i = left.size(); i-- > 0;) {
    const bool side = dot(ray.direction, left[i].first.normal) > 0;
    const uint32_t medium = rules_[left[i].second].medium[side];
    if (!around_.holds(body(left[i].first), side)) around_.enter(body(left[i].first), side, medium, priority(medium));
  }
  return around_;
}

void Bodies::leave_scene(MediumStack& stack) const {
  if (!stack.empty()) stack.filter([&](uint32_t of) { return unbounded_[of]; });
}

}  // namespace suite
