#include "transport/media/bodies.h"

#include <algorithm>
#include <cmath>

#include "scene/primitives.h"

namespace suite {

namespace {
constexpr int kMostCrossings = 1 << 20;  // of one probing ray; surfaces that lie in each other end it
// Rays go on behind a boundary along themselves, so that nothing shifts them over hundreds of boundaries; flatter ones
// than this cosine leave it along the normal for the rest.
constexpr double kFlattest = 0.05;
const Dir kUp = normalized(Vec3{0.0123, 0.0345, 1});  // of probing rays
}  // namespace

Bodies::Bodies(const Surface& surface) : surface_(surface) {
  const Scene& scene = surface.tracer().scene();
  for (uint32_t i = 0; i < scene.materials.size(); ++i) {
    const Material& m = scene.materials[i];
    rules_.push_back({{m.outside, surface.optics().medium_behind(i)}, m.is_boundary()});
    any_ = any_ || rules_.back().medium[0] != kNone || rules_.back().medium[1] != kNone;
    any_boundary_ = any_boundary_ || m.is_boundary();
  }
  surface.tracer().each(
      "surfaces without bounds",
      [&](const TracedObject& o) {
        return o.primitive != kNone && primitive_box(scene.primitives[o.primitive]).empty();
      },
      [&](uint32_t number, const TracedObject& o) {
        unbounded_.insert(o.instance);
        below_ = below_ || o.node != kNone || dot(surface.tracer().place(number).normal({0, 0, 1}), kUp) < 0;
      });
  below_ = below_ || (!unbounded_.empty() &&
                      std::any_of(rules_.begin(), rules_.end(), [](const Rule& r) { return r.medium[0] != kNone; }));
  alone_ = surface.tracer().object_count() < 2 && !surface.tracer().periodic();
}

Bodies::Sides Bodies::sides(const Hit& hit) const {
  const TracedObject object = surface_.tracer().object(hit.object);
  const Scene& scene = surface_.tracer().scene();
  BoundedSide bounded = BoundedSide::none;
  if (object.primitive != kNone) {
    bounded = bounded_side(scene.primitives[object.primitive]);
    if (bounded == BoundedSide::none && unbounded_.contains(object.instance)) return {Fills::half_spaces, true};
  } else if (object.mesh != kNone) {
    const auto known = of_meshes_.find(object.mesh);
    bounded = known != of_meshes_.end() ? known->second : bounded_side(scene.meshes[object.mesh]);
    of_meshes_[object.mesh] = bounded;
  }
  if (bounded == BoundedSide::none) return {Fills::shared_face, true};
  return {Fills::bounded_side, bounded == BoundedSide::behind};
}

void Bodies::cross(MediumStack& stack, const Hit& hit, uint32_t material, Dir direction) const {
  if (material == kNone || !hit.hit()) return;
  cross(stack, hit, rules_[material], dot(direction, hit.normal) < 0);
}

// To the side behind the surface, or from there. False when the medium of the side that is left was not held.
bool Bodies::cross(MediumStack& stack, const Hit& hit, const Rule& rule, bool behind) const {
  const uint32_t own = body(hit), left = rule.medium[!behind], entered = rule.medium[behind];
  if (rule.medium[0] == kNone) {
    const bool held = stack.leave(own, !behind, left) || (left != kNone && stack.leave_shared(left));
    stack.enter(own, behind, entered, priority(entered));
    return held || left == kNone;
  }
  const Sides sides = this->sides(hit);
  if (sides.fills == Fills::shared_face) {
    const bool held = stack.leave(own, !behind, left) || (left != kNone && stack.leave_any(left));
    stack.enter(own, behind, entered, priority(entered), true);
    return held || left == kNone;
  }
  const bool half = sides.fills == Fills::half_spaces;
  const auto fills = [&](bool side) { return half || side == sides.bounded; };
  const bool held = !fills(!behind) || stack.leave(own, !behind, left) || (left != kNone && stack.leave_shared(left));
  if (fills(behind)) stack.enter(own, behind, entered, priority(entered));
  return held || left == kNone;
}

Bodies::Onward Bodies::onward(const Hit& hit, Dir direction, double step) {
  const double slope = dot(direction, hit.normal), steep = std::fabs(slope);
  const double along = step / std::max(steep, kFlattest), aside = std::max(0.0, step - along * steep);
  const Vec3 off = direction * along + hit.normal * (slope < 0 ? -aside : aside);
  return {hit.position + off, dot(off, direction)};
}

// Fills beside_ with what lies at the hit of a ray, `run` m behind its start, and says how the ray goes on behind it
// all: a surface that lies there may be coarser than the one that was hit.
Bodies::Onward Bodies::look_beside(const Hit& hit, const Ray& ray, double run, TraceStatistics& statistics) {
  double step = double{hit.step};
  for (;;) {
    const Onward on = onward(hit, ray.direction, step);
    back_ = std::min(0.5 * on.gap, run);
    find_beside(hit, {hit.position - ray.direction * back_, ray.direction, ray.time, ray.draw}, back_, back_ + on.gap,
                statistics);
    double coarsest = step;
    for (const Hit& h : beside_) coarsest = std::max(coarsest, double{h.step});
    if (coarsest == step) return on;
    step = coarsest;
  }
}

void Bodies::settle(Hit& hit, const Ray& ray, double gap) const {
  if (!hit.hit()) return;
  Vec3 off = hit.position - (ray.origin + ray.direction * hit.distance);
  if (const auto& cell = surface_.tracer().periodic()) {
    off.x -= std::round(off.x / cell->size.x) * cell->size.x;
    off.y -= std::round(off.y / cell->size.y) * cell->size.y;
  }
  const double slope = dot(ray.direction, hit.normal);
  if (std::fabs(slope) >= kFlattest) {
    const double further = dot(off, hit.normal) / slope;
    hit.position -= off - ray.direction * further;
    hit.distance += further;
  }
  hit.distance += gap;
}

// Fills beside_ and materials_ with what lies on the way from `back` m before the hit to `length` m behind that; the
// hit itself is among it.
void Bodies::find_beside(const Hit& hit, const Ray& from, double back, double length, TraceStatistics& statistics) {
  surface_.tracer().all(from, length, beside_, statistics);
  const auto same = [&](const Hit& h) { return h.object == hit.object && h.triangle == hit.triangle; };
  if (std::none_of(beside_.begin(), beside_.end(), same)) {
    const auto at = std::find_if(beside_.begin(), beside_.end(), [&](const Hit& h) { return h.distance > back; });
    beside_.insert(at, hit)->distance = back;
  }
  materials_.clear();
  for (const Hit& h : beside_) materials_.push_back(surface_.material(h));
}

// The first surface of beside_ that is no boundary.
std::optional<size_t> Bodies::stop() const {
  for (size_t i = 0; i < beside_.size(); ++i)
    if (!is_boundary(materials_[i])) return i;
  return std::nullopt;
}

// Whether the ray changes the side of a body at beside_[i]. Two triangles at an edge are one crossing, and so are the
// surfaces of copies that meet at the side of a periodic cell; into a body and out of it again changes nothing.
bool Bodies::crosses(size_t i, Dir direction) const {
  if (!bounds(materials_[i])) return false;
  const uint32_t own = body(beside_[i]);
  const bool behind = dot(direction, beside_[i].normal) < 0;
  for (size_t k = 0; k < beside_.size(); ++k) {
    if (k == i || body(beside_[k]) != own) continue;
    if ((dot(direction, beside_[k].normal) < 0) != behind || k < i) return false;
  }
  return true;
}

void Bodies::transmit(MediumStack& stack, const Hit& hit, uint32_t material, Dir direction,
                      TraceStatistics& statistics) {
  cross(stack, hit, material, direction);
  if (alone_ || !any_boundary_ || !hit.hit()) return;
  const Dir n = dot(direction, hit.normal) < 0 ? -hit.normal : hit.normal;
  const double step = double{hit.step}, back = 0.5 * step;
  find_beside(hit, {hit.position - n * back, n, hit.time}, back, back + step, statistics);
  for (size_t i = 0; i < beside_.size(); ++i)
    if (body(beside_[i]) != body(hit) && is_boundary(materials_[i]) && crosses(i, n))
      cross(stack, beside_[i], materials_[i], n);
}

std::optional<Bodies::Onward> Bodies::pass(MediumStack& stack, Hit& hit, const Ray& ray, double run,
                                           TraceStatistics& statistics) {
  if (alone_) {
    cross(stack, hit, surface_.material(hit), ray.direction);
    return onward(hit, ray.direction, double{hit.step});
  }
  const Onward on = look_beside(hit, ray, run, statistics);
  const std::optional<size_t> end = stop();
  // Rays that leave the surface that stops this one start beyond what lies closer to it than this.
  double until = std::numeric_limits<double>::infinity();
  if (end) {
    const Hit& s = beside_[*end];
    until = s.distance - double{s.step} / std::max(std::fabs(dot(s.normal, ray.direction)), kFlattest);
  }
  for (size_t i = 0; i < beside_.size(); ++i)
    if (beside_[i].distance < until && crosses(i, ray.direction))
      cross(stack, beside_[i], materials_[i], ray.direction);
  if (!end) return on;
  const double distance = hit.distance - back_ + beside_[*end].distance;
  hit = beside_[*end];
  hit.distance = distance;
  return std::nullopt;
}

// Fills left_ with what a ray from `place` leaves without having entered it: it started in that. The nearest such
// surface is of the innermost body.
void Bodies::probe(Vec3 place, Dir direction, double time, TraceStatistics& statistics) {
  entered_.clear(), left_.clear();
  Ray ray{place, direction, time};
  for (int n = 0; n < kMostCrossings; ++n) {
    Hit hit;
    surface_.tracer().nearest({&ray, 1}, {&hit, 1}, false, statistics);
    if (!hit.hit()) break;
    const Onward on = look_beside(hit, ray, hit.distance, statistics);
    for (size_t i = 0; i < beside_.size(); ++i) {
      if (!crosses(i, ray.direction)) continue;
      const Hit& h = beside_[i];
      const Rule& rule = rules_[materials_[i]];
      const bool behind = dot(ray.direction, h.normal) < 0;
      if (cross(entered_, h, rule, behind)) continue;
      const Fills fills = sides(h).fills;
      left_.push_back(
          {body(h), rule.medium[!behind], !behind, fills == Fills::half_spaces, fills == Fills::shared_face});
    }
    ray.origin = on.start;
  }
}

const MediumStack& Bodies::around(Vec3 place, double time, TraceStatistics& statistics) {
  if (asked_ && place.x == place_.x && place.y == place_.y && place.z == place_.z && time == time_) return around_;
  asked_ = true;
  place_ = place, time_ = time;
  // Whether a place has to be asked for depends on what was asked before: its rays are no rays of the paths'.
  TraceStatistics asking;
  around_.clear();
  std::vector<Left> over;  // half-spaces that hold all that lies over the place
  if (below_) {
    probe(place, -kUp, time, asking);
    std::copy_if(left_.begin(), left_.end(), std::back_inserter(over), [](const Left& l) { return l.half_space; });
  }
  probe(place, kUp, time, asking);
  left_.insert(left_.end(), over.begin(), over.end());
  statistics.cycles += asking.cycles;
  for (size_t i = left_.size(); i-- > 0;)
    if (const Left& l = left_[i]; !around_.holds(l.body, l.side))
      around_.enter(l.body, l.side, l.medium, priority(l.medium), l.shared);
  return around_;
}

void Bodies::leave_scene(MediumStack& stack) const {
  if (!stack.empty()) stack.filter([&](uint32_t of) { return unbounded_.contains(of); });
}

}  // namespace suite
