#include "transport/refracted_sight.h"

#include <algorithm>
#include <cmath>

#include "scene/primitives.h"

namespace suite {

namespace {

constexpr int kMostBoundaries = 4096;  // index-matched ones on one leg
constexpr int kMostSteps = 32, kMostHalvings = 8;
constexpr int kMostStarts = 8;         // until one meets an interface that it passes
constexpr double kArrived = 1e-9;      // rad
constexpr double kNearEnough = 2e-5;   // rad: where float places of meshes leave no better
constexpr double kSame = 1e-4;         // rad at the light: ways as near as this are one
constexpr size_t kMostObjects = 4096;  // beyond, starts take them all together
constexpr double kLongestTurn = 0.5;   // rad, of one of Newton's steps

// Bounds in ENU; empty when there are none.
Box3 bounds_of(const Tracer& tracer, uint32_t number, const TracedObject& object) {
  const Scene& scene = tracer.scene();
  Box3 local, world;
  if (object.primitive != kNone)
    local = primitive_box(scene.primitives[object.primitive]);
  else if (const Mesh& mesh = scene.meshes[object.mesh]; mesh.stored)
    local = mesh.stored->box;
  else
    for (size_t i = 0; i < mesh.vertex_count(); ++i)
      local.grow(mesh.origin + Vec3{double{mesh.positions[3 * i]}, double{mesh.positions[3 * i + 1]},
                                    double{mesh.positions[3 * i + 2]}});
  if (local.empty()) return local;
  const double begin = tracer.window() ? tracer.window()->begin : 0, end = tracer.window() ? tracer.window()->end : 0;
  for (const double time : {begin, 0.5 * (begin + end), end}) {
    const Affine3 place = tracer.to_world(number, time);
    for (int i = 0; i < 8; ++i)
      world.grow(place.point({i & 1 ? local.high.x : local.low.x, i & 2 ? local.high.y : local.low.y,
                              i & 4 ? local.high.z : local.low.z}));
  }
  return world;
}

}  // namespace

RefractedSight::RefractedSight(const Surface& surface, const Optics& optics)
    : surface_(surface), interfaces_(surface.tracer().scene(), optics) {
  const Tracer& tracer = surface.tracer();
  const Scene& scene = tracer.scene();
  for (const Material& m : scene.materials) passes_.push_back(!optics.media().empty() && m.is_boundary());
  if (!interfaces_.any()) return;
  const auto refracts = [&](const TracedObject& o) {
    if (o.material_override != kNone) return interfaces_.has(o.material_override);
    if (o.primitive != kNone) return interfaces_.has(scene.primitives[o.primitive].material);
    const auto& parts = scene.meshes[o.mesh].parts;
    return std::any_of(parts.begin(), parts.end(), [&](const Part& p) { return interfaces_.has(p.material); });
  };
  tracer.each("smooth refracting surfaces", refracts,
              [&](uint32_t number, const TracedObject& o) { objects_.push_back(bounds_of(tracer, number, o)); });
  if (objects_.size() <= kMostObjects) return;
  Box3 all;
  for (const Box3& box : objects_) all.grow(box);
  objects_.assign(1, all);
}

// The next surface on a ray that bounds more than a medium; its distance from the ray's origin. False: none.
bool RefractedSight::hit_next(Ray& ray, Hit& hit) {
  double before = 0;
  for (int n = 0; n < kMostBoundaries; ++n) {
    surface_.tracer().nearest({&ray, 1}, {&hit, 1}, false, statistics_);
    if (!hit.hit()) return false;
    hit.distance += before;
    const uint32_t material = surface_.material(hit);
    if (material == kNone || !passes_[material]) return true;
    before = hit.distance;
    ray.origin = surface_.tracer().leave(hit, ray.direction);
  }
  return true;
}

int RefractedSight::crossings(Ray ray) {
  for (int n = 0;; ++n) {
    Hit hit;
    if (!hit_next(ray, hit) || n > kMostCrossings) return n;
    if (!interfaces_.has(surface_.material(hit))) return kMostCrossings + 1;
    ray.origin = surface_.tracer().leave(hit, ray.direction);
  }
}

// One ray from the node through the interfaces that it meets. False when it meets none, or is totally reflected at one.
bool RefractedSight::trace(const Node& node, Dir direction, Dir light, size_t knot, Traced& traced) {
  const Tracer& tracer = surface_.tracer();
  if (node.hit && dot(direction, node.side) < 0) return false;
  const Frame start = Frame::around(direction);
  RefractedWay& way = traced.way;
  way.origin = node.hit ? tracer.leave(*node.hit, direction) : node.place;
  way.direction = direction;
  way.crossings = 0;
  traced.open = false;
  traced.end = BentRay::from(way.origin, start);
  BentRay& bent = traced.end;
  Ray ray{way.origin, direction, node.time, node.draw};
  while (true) {
    Hit hit;
    if (!hit_next(ray, hit)) {
      traced.open = way.crossings > 0;
      break;
    }
    const uint32_t material = surface_.material(hit);
    if (!interfaces_.has(material) || way.crossings == kMostCrossings) break;
    surface_.interact(hit, -bent.direction, at_, node.time);
    RefractedCrossing& at = way.at[way.crossings];
    at.out = -bent.direction;
    at.length = hit.distance;
    const NormalTurn turn = normal_turn(surface_, hit, at.out, at_, beside_);
    if (!bend(bent, hit, at_, interfaces_.index(material, knot), turn)) return false;
    at.hit = hit;
    at.in = bent.direction;
    at.out_local = at_.frame.to_local(at.out);
    at.material = material;
    at.model = at_.baked->model;
    ++way.crossings;
    ray.origin = way.last = tracer.leave(hit, bent.direction);
    ray.direction = bent.direction;
  }
  if (way.crossings == 0) return false;
  aim(light, traced, start);
  return true;
}

// How far the end is off, and where Newton's method would start next.
void RefractedSight::aim(Dir light, Traced& traced, const Frame& start) {
  const Frame to = Frame::around(light);
  const BentRay& end = traced.end;
  const double xx = dot(end.d_direction[0], to.x), xy = dot(end.d_direction[1], to.x),
               yx = dot(end.d_direction[0], to.y), yy = dot(end.d_direction[1], to.y), det = xx * yy - xy * yx;
  const double fx = dot(end.direction, to.x), fy = dot(end.direction, to.y);
  traced.off = dot(end.direction, light) > 0 ? std::hypot(fx, fy) : 2;
  traced.det = det;
  traced.next = start.z;
  traced.inverse = INFINITY;
  if (det == 0) return;
  traced.inverse = std::sqrt((xx * xx + xy * xy + yx * yx + yy * yy)) / std::fabs(det);
  double a = -(yy * fx - xy * fy) / det, b = -(xx * fy - yx * fx) / det;
  const double turn = std::hypot(a, b);
  if (turn > kLongestTurn) a *= kLongestTurn / turn, b *= kLongestTurn / turn;
  traced.next = normalized(start.z + start.x * a + start.y * b);
}

// Newton's method with halved steps. False where it does not end at a way that is open.
bool RefractedSight::walk(const Node& node, const Traced& start, Dir light, size_t knot, Traced& found) {
  found = start;
  for (int step = 0; step < kMostSteps && found.off > kArrived; ++step) {
    const Dir from = found.way.direction;
    bool nearer = false;
    double share = 1;
    for (int n = 0; n < kMostHalvings && !nearer; ++n, share *= 0.5) {
      Traced next;
      if (!trace(node, normalized(from + (found.next - from) * share), light, knot, next)) continue;
      nearer = next.off < found.off;
      if (nearer) found = next;
    }
    if (!nearer) break;
  }
  return found.off < kNearEnough && found.open && std::isfinite(found.inverse);
}

// A start from the straight line towards the light: itself where it leaves the second interface, else what a flat
// interface where it meets the first one would make of it. False when it meets none.
bool RefractedSight::guess(const Node& node, Dir light, size_t knot, Dir& direction) {
  const Tracer& tracer = surface_.tracer();
  Ray ray{node.hit ? tracer.leave(*node.hit, light) : node.place, light, node.time, node.draw};
  Hit hit;
  if (!hit_next(ray, hit)) return false;
  const uint32_t material = surface_.material(hit);
  if (!interfaces_.has(material)) return false;
  direction = light;
  Traced straight;
  if (trace(node, light, light, knot, straight) && straight.way.crossings == 2) return true;
  surface_.interact(hit, -light, at_, node.time);
  const double index = interfaces_.index(material, knot);
  // Met from behind: the light comes from the front, and the node lies in what is behind.
  const auto inside = unbent(light, at_.frame.z, dot(light, hit.normal) > 0 ? 1 / index : index);
  if (inside) direction = *inside;
  return true;
}

Dir RefractedSight::draw_at_object(const Node& node) {
  const auto which = static_cast<size_t>(random() * static_cast<double>(objects_.size()));
  const Box3& box = objects_[std::min(which, objects_.size() - 1)];
  const double how = random(), u = random(), v = random(), w = random();
  const auto evenly = [&](Dir axis, double least) {  // over a cone
    const double c = 1 - u * (1 - least), s = std::sqrt(std::max(0.0, 1 - c * c)), phi = 2 * kPi * v;
    return Frame::around(axis).to_world({s * std::cos(phi), s * std::sin(phi), c});
  };
  if (box.empty()) return evenly({0, 0, 1}, -1);
  const Vec3 size = box.size();
  if (how < 0.5) {
    const Vec3 way = box.low + Vec3{u * size.x, v * size.y, w * size.z} - node.place;
    const double len = length(way);
    if (len > 0) return way / len;
  }
  const Vec3 middle = box.center() - node.place;
  const double far = length(middle), radius = 0.5 * length(size);
  if (!(far > radius)) return evenly({0, 0, 1}, -1);
  return evenly(middle / far, std::sqrt(1 - (radius / far) * (radius / far)));
}

Dir RefractedSight::draw_start(const Node& node) {
  constexpr double kAsGuessed = 0.3, kAboutIt = 0.65, kDecades = 3;
  const double how = random();
  if (!guessed_ || how > kAboutIt) return draw_at_object(node);
  if (how < kAsGuessed) return *guessed_;
  const double width = std::pow(10.0, -kDecades * random()), r = width * std::sqrt(-2 * std::log(1 - random())),
               phi = 2 * kPi * random();
  const Frame about = Frame::around(*guessed_);
  return normalized(about.z + about.x * (r * std::cos(phi)) + about.y * (r * std::sin(phi)));
}

// A random start, and the way that it leads to.
bool RefractedSight::try_once(const Node& node, Dir light, size_t knot, Traced& found) {
  for (int n = 0; n < kMostStarts; ++n) {
    const Dir start = draw_start(node);
    Traced probe;
    if (trace(node, start, light, knot, probe)) return walk(node, probe, light, knot, found);
  }
  return false;
}

std::optional<RefractedWay> RefractedSight::find(const Node& node, Dir light, size_t knot, uint64_t seed) {
  seed_ = seed, counter_ = 0;
  Dir direction;
  guessed_.reset();
  if (guess(node, light, knot, direction)) guessed_ = direction;
  Traced first, again;
  if (!try_once(node, light, knot, first)) return std::nullopt;
  RefractedWay way = first.way;
  way.spreading = 1 / std::fabs(first.det);
  const auto same = [&] {
    const double near = std::max(kSame, 100 * (first.off + again.off)) * std::max(first.inverse, again.inverse);
    return again.way.crossings == way.crossings && again.det * first.det > 0 &&
           length(again.way.direction - way.direction) <= near;
  };
  while (!(try_once(node, light, knot, again) && same()))
    if (++way.trials >= kMostTrials) {
      way.doubtful = true;
      break;
    }
  return way;
}

}  // namespace suite
