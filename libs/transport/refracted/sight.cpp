#include "transport/refracted/sight.h"

#include <algorithm>
#include <cmath>

#include "scene/primitives.h"

namespace suite {

namespace {

constexpr int kMostBoundaries = 4096;  // index-matched ones on one leg
constexpr size_t kMostObjects = 4096;  // beyond, starts take them all together
constexpr double kLongestTurn = 0.5;   // rad, of one of Newton's steps

// In the object's own frame; empty when there are no bounds.
Box3 own_bounds(const Scene& scene, const TracedObject& object) {
  if (object.primitive != kNone) return primitive_box(scene.primitives[object.primitive]);
  const Mesh& mesh = scene.meshes[object.mesh];
  if (mesh.stored) return mesh.stored->box;
  Box3 box;
  for (size_t i = 0; i < mesh.vertex_count(); ++i)
    box.grow(mesh.origin +
             Vec3{double{mesh.positions[3 * i]}, double{mesh.positions[3 * i + 1]}, double{mesh.positions[3 * i + 2]}});
  return box;
}

}  // namespace

Box3 RefractedSight::placed(const Box3& box, const Affine3& place) {
  Box3 world;
  if (box.empty()) return world;
  for (int i = 0; i < 8; ++i)
    world.grow(
        place.point({i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y, i & 4 ? box.high.z : box.low.z}));
  return world;
}

RefractedSight::RefractedSight(const Surface& surface, const Optics& optics)
    : surface_(surface), interfaces_(surface.tracer().scene(), optics), shares_(optics.state().knots.size()) {
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
  bool any_moves = false;
  uint32_t only_number = kNone;
  tracer.each("smooth refracting surfaces", refracts, [&](uint32_t number, const TracedObject& o) {
    const Box3 own = own_bounds(scene, o);
    const bool moves = o.node != kNone && !own.empty();
    objects_.push_back(moves ? Refractor{own, number} : Refractor{placed(own, tracer.place(number))});
    any_moves = any_moves || moves;
    only_number = number;
  });
  if (objects_.size() == 1) set_sheet(optics, only_number);
  if (objects_.size() <= kMostObjects) return;
  Box3 all;
  for (const Refractor& o : objects_)
    if (o.moves == kNone) all.grow(o.box);
  if (any_moves) all.grow(tracer.bounds());
  objects_.assign(1, {all});
}

bool RefractedSight::ends(StraightLeg& leg, Hit& hit, bool* veiled) const {
  if (!hit.hit()) return true;
  hit.distance += leg.before;
  const uint32_t material = surface_.material(hit);
  if (material == kNone || !passes_[material]) return true;
  if (veiled) *veiled = true;
  leg.before = hit.distance;
  leg.ray.origin = surface_.tracer().leave(hit, leg.ray.direction);
  return ++leg.boundaries == kMostBoundaries;
}

double RefractedSight::reflectance(const Hit& hit, const Ray& ray) {
  const uint32_t material = surface_.material(hit);
  surface_.interact(hit, ray.direction, at_, ray.time);
  const Dir to_light = at_.frame.to_local(ray.direction);
  const bool thin_in_front = interfaces_.index(material, 0) >= 1;
  const Dir out = (to_light.z > 0) == thin_in_front ? to_light : -to_light;
  at_.baked->model->delta_probability(out, interfaces_.lobe(material, false), 0, shares_);
  return 1 - double{shares_[0]};
}

bool RefractedSight::begin(RefractedSearch& s, const WayStart& node, const WayEnd& end, size_t knot, uint64_t seed) {
  const Vec3 way = end.place - node.place;
  s.what = RefractedSearch::For::all;
  s.node = node, s.end = end, s.knot = knot;
  s.distance = end.far ? std::numeric_limits<double>::infinity() : length(way);
  s.ways = 0, s.seed = seed, s.counter = 0;
  if (!(s.distance > 0)) return run(s, Turn::ended);
  s.straight = end.far ? end.direction : way / s.distance;
  return run(s, look_through_sheet(s));
}

bool RefractedSight::step(RefractedSearch& s, Hit& hit) {
  const bool straight = s.at == At::straight;
  if (!ends(s.leg, hit, straight ? nullptr : &s.of(s.into).veiled)) return true;
  return run(s, straight ? met_straight(s, hit) : met(s, hit));
}

bool RefractedSight::run(RefractedSearch& s, Turn turn) {
  while (turn == Turn::through || turn == Turn::stopped) turn = go_on(s, turn == Turn::through);
  if (turn == Turn::ended) s.at = At::done;
  return turn == Turn::waits;
}

// What the ray that has been taken through interfaces, or could not be, was shot for.
auto RefractedSight::go_on(RefractedSearch& s, bool through) -> Turn {
  switch (s.at) {
    case At::sheet:
      return through ? walk(s, Role::first) : miss_sheet(s);
    case At::through:
      return bend_straight(s, through);
    case At::start:
      if (!through) return next_start(s);
      return s.end.far ? started(s) : choose_end(s);
    case At::behind:
      return through ? started(s) : next_start(s);
    case At::step:
      return stepped(s, through);
    case At::whole:
      if (!through || s.of(Role::next).way.events != s.on.events) return walked(s, false);
      s.exchange(Role::next, s.found);
      return arrived(s);
    case At::straight:
    case At::done:
      break;
  }
  return Turn::ended;
}

// Begins to take a ray through a chain of interfaces.
auto RefractedSight::shoot(RefractedSearch& s, At at, Dir direction, const InterfaceChain& chain, Role into) -> Turn {
  s.at = at;
  const WayStart& node = s.node;
  if (node.hit && dot(direction, node.side) < 0) return Turn::stopped;
  s.chain = chain, s.into = into;
  s.across = Frame::around(direction);
  TracedWay& traced = s.of(into);
  RefractedWay& way = traced.way;
  way.origin = node.hit ? surface_.tracer().leave(*node.hit, direction) : node.place;
  way.direction = direction;
  way.events = 0;
  way.length = std::numeric_limits<double>::infinity();
  traced.open = traced.veiled = false, traced.may_end = 0;
  traced.end = BentRay::from(way.origin, s.across);
  s.leg.begin(way.origin, direction, node.time, node.draw);
  return Turn::waits;
}

// The ray has met `hit`, or nothing. Stopped: it has met no interface, or other ones than those of the chain, or one
// does not let it on.
auto RefractedSight::met(RefractedSearch& s, const Hit& hit) -> Turn {
  TracedWay& traced = s.of(s.into);
  RefractedWay& way = traced.way;
  const int wanted = s.chain.events, most = wanted > 0 ? wanted : RefractedWay::kMostEvents;
  const uint32_t found = material(hit);
  const bool last = way.events == most || !interfaces_.has(found);
  if (way.events > 0) arrive(s, hit, last, traced);
  if (!last) {
    if (!pass(s, hit, found, s.chain.mirrors >> way.events & 1, traced)) return Turn::stopped;
    if (!s.chain.blind || way.events < most) {
      traced.veiled = false;
      s.leg.begin(surface_.tracer().leave(hit, traced.end.direction), traced.end.direction, s.node.time, s.node.draw);
      return Turn::waits;
    }
  }
  if (way.events == 0 || (wanted > 0 && way.events != wanted)) return Turn::stopped;
  aim(s, traced);
  return Turn::through;
}

// The ray has left an interface, and `hit` is what it meets next. last: it goes on no further.
void RefractedSight::arrive(const RefractedSearch& s, const Hit& hit, bool last, TracedWay& traced) {
  constexpr double kNear = 1e-4;  // of the way: a lamp's surface may lie as far from where it was to be
  RefractedWay& way = traced.way;
  way.last = traced.end.origin;
  way.to = traced.end.direction;
  if (s.end.far) {
    traced.open = !hit.hit();
    return;
  }
  way.length = dot(s.end.place - way.last, way.to);
  if (!(way.length > 0)) return;
  const double behind = hit.hit() ? hit.distance - way.length : std::numeric_limits<double>::infinity();
  const double slack = kNear * way.length + 16 * double{hit.step};
  traced.open = s.end.surface ? std::fabs(behind) <= slack : behind >= -1e-9 * way.length;
  way.lamp = hit;
  if (last || behind > 0) traced.may_end |= 1u << way.events;
}

// Takes the ray on behind the interface at a hit; false where that is not possible.
bool RefractedSight::pass(const RefractedSearch& s, const Hit& hit, uint32_t material, bool reflected,
                          TracedWay& traced) {
  BentRay& bent = traced.end;
  surface_.interact(hit, -bent.direction, at_, s.node.time);
  RefractedEvent& at = traced.way.at[traced.way.events];
  at.out = -bent.direction;
  at.length = hit.distance;
  const NormalTurn turn = normal_turn(surface_, hit, at.out, at_, beside_);
  const bool on = reflected
                      ? interfaces_.lobe(material, true) != SmoothInterfaces::kNoLobe && reflect(bent, hit, at_, turn)
                      : bend(bent, hit, at_, interfaces_.index(material, s.knot), turn);
  if (!on) return false;
  at.hit = hit;
  at.in = bent.direction;
  at.out_local = at_.frame.to_local(at.out);
  at.material = material;
  at.model = at_.baked->model;
  at.reflected = reflected;
  ++traced.way.events;
  return true;
}

// How far the end is off, and where Newton's method would start next: it turns the end towards a far light on the
// shortest way, or moves it to the place on a lamp.
void RefractedSight::aim(const RefractedSearch& s, TracedWay& traced) {
  const BentRay& end = traced.end;
  const Frame at = Frame::around(end.direction);
  Vec3 change[2], miss = s.end.direction;
  for (int i : {0, 1})
    change[i] =
        s.end.far ? end.d_direction[i] : (end.d_origin[i] + end.d_direction[i] * traced.way.length) / s.distance;
  if (!s.end.far) miss = (s.end.place - end.origin) / s.distance;
  const double xx = dot(change[0], at.x), xy = dot(change[1], at.x), yx = dot(change[0], at.y),
               yy = dot(change[1], at.y), det = xx * yy - xy * yx;
  const double fx = dot(miss, at.x), fy = dot(miss, at.y), off = std::hypot(fx, fy);
  const bool away = dot(miss, end.direction) <= 0;
  traced.off = !away ? off : s.end.far ? 2 - off : 2;
  traced.det = det;
  traced.next = s.across.z;
  traced.inverse = INFINITY;
  if (det == 0) return;
  traced.inverse = std::sqrt(xx * xx + xy * xy + yx * yx + yy * yy) / std::fabs(det);
  if (off == 0) return;
  const double arc = std::asin(std::min(1.0, off)), further = s.end.far ? (away ? kPi - arc : arc) / off : 1;
  const double a = (yy * fx - xy * fy) / det * further, b = (xx * fy - yx * fx) / det * further;
  const double wanted = std::hypot(a, b), turn = std::min(wanted, kLongestTurn);
  traced.next = normalized(s.across.z * std::cos(turn) + (s.across.x * a + s.across.y * b) * (std::sin(turn) / wanted));
}

}  // namespace suite
