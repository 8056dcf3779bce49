#include "transport/refracted_sight.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "scene/primitives.h"
#include "transport/parallel_faces.h"

namespace suite {

namespace {

constexpr int kMostBoundaries = 4096;  // index-matched ones on one leg
constexpr size_t kMostFaces = 4096;    // across a straight ray
constexpr int kMostSteps = 32, kMostHalvings = 8;
constexpr int kMostStarts = 8;     // of a trial
constexpr int kMostWalks = 3;      // of these: that pass an interface and run towards the light
constexpr double kArrived = 1e-9;  // rad
// rad, that Newton's next step would turn the start. Beside a fold of ways, where there is none, its steps end at small
// distances from the light but with an endless spreading; they would still be long.
constexpr double kSettled = 1e-4;
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

Box3 placed(const Box3& box, const Affine3& place) {
  Box3 world;
  if (box.empty()) return world;
  for (int i = 0; i < 8; ++i)
    world.grow(
        place.point({i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y, i & 4 ? box.high.z : box.low.z}));
  return world;
}

}  // namespace

uint32_t RefractedWay::mirrors() const {
  uint32_t bits = 0;
  for (int i = 0; i < events; ++i) bits |= uint32_t{at[i].reflected} << i;
  return bits;
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

bool RefractedSight::hit_any(const Ray& ray, Hit& hit) {
  surface_.tracer().nearest({&ray, 1}, {&hit, 1}, false, statistics_);
  return hit.hit();
}

// The next surface on a ray that bounds more than a medium; its distance from the ray's origin. False: none. passed:
// whether one that does not was passed.
bool RefractedSight::hit_next(Ray& ray, Hit& hit, bool* passed) {
  double before = 0;
  for (int n = 0; n < kMostBoundaries; ++n) {
    if (!hit_any(ray, hit)) return false;
    hit.distance += before;
    const uint32_t material = surface_.material(hit);
    if (material == kNone || !passes_[material]) return true;
    if (passed) *passed = true;
    before = hit.distance;
    ray.origin = surface_.tracer().leave(hit, ray.direction);
  }
  return true;
}

std::optional<double> RefractedSight::unfound(Ray ray, double distance) {
  crossed_.clear();
  Hit hit;
  const Ray from = ray;
  while (hit_next(ray, hit) && hit.distance < distance && crossed_.size() < kMostFaces) {
    if (!interfaces_.has(surface_.material(hit))) return std::nullopt;
    crossed_.push_back(hit);
    ray.origin = surface_.tracer().leave(hit, ray.direction);
    distance -= hit.distance;
  }
  if (crossed_.size() < 2) return 0;
  std::vector<double> reflected;
  for (const Hit& face : crossed_) reflected.push_back(reflectance(face, from));
  const double share = passed(reflected) - passed_within(reflected, RefractedWay::kMostEvents);
  return share > kNothing ? share : 0;
}

// Of an interface, from its thinner side, which the straight ray runs in as the light comes.
double RefractedSight::reflectance(const Hit& hit, const Ray& ray) {
  const uint32_t material = surface_.material(hit);
  surface_.interact(hit, ray.direction, at_, ray.time);
  const Dir to_light = at_.frame.to_local(ray.direction);
  const bool thin_in_front = interfaces_.index(material, 0) >= 1;
  const Dir out = (to_light.z > 0) == thin_in_front ? to_light : -to_light;
  at_.baked->model->delta_probability(out, interfaces_.lobe(material, false), 0, shares_);
  return 1 - double{shares_[0]};
}

// One ray from the node through a chain of interfaces. False when it meets none, or other ones, or one does not let it
// on.
bool RefractedSight::trace(const Search& s, Dir direction, const Chain& chain, Traced& traced) {
  const Tracer& tracer = surface_.tracer();
  const Node& node = s.node;
  if (node.hit && dot(direction, node.side) < 0) return false;
  const Frame start = Frame::around(direction);
  RefractedWay& way = traced.way;
  way.origin = node.hit ? tracer.leave(*node.hit, direction) : node.place;
  way.direction = direction;
  way.events = 0;
  traced.open = false, traced.may_end = 0;
  traced.end = BentRay::from(way.origin, start);
  const int most = chain.events > 0 ? chain.events : RefractedWay::kMostEvents;
  Ray ray{way.origin, direction, node.time, node.draw};
  while (!(chain.blind && way.events == most)) {
    Hit hit;
    traced.veiled = false;
    const bool met = hit_next(ray, hit, &traced.veiled);
    const uint32_t material = met ? surface_.material(hit) : kNone;
    const bool last = way.events == most || !interfaces_.has(material);
    if (way.events > 0) arrive(s, hit, last, traced);
    if (last) break;
    if (!pass(s, hit, material, chain.mirrors >> way.events & 1, traced)) return false;
    ray.origin = tracer.leave(hit, traced.end.direction);
    ray.direction = traced.end.direction;
  }
  if (way.events == 0 || (chain.events > 0 && way.events != chain.events)) return false;
  aim(s, traced, start);
  return true;
}

// The ray has left an interface, and `hit` is what it meets next. last: it goes on no further.
void RefractedSight::arrive(const Search& s, const Hit& hit, bool last, Traced& traced) {
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
bool RefractedSight::pass(const Search& s, const Hit& hit, uint32_t material, bool reflected, Traced& traced) {
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
void RefractedSight::aim(const Search& s, Traced& traced, const Frame& start) {
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
  traced.next = start.z;
  traced.inverse = INFINITY;
  if (det == 0) return;
  traced.inverse = std::sqrt(xx * xx + xy * xy + yx * yx + yy * yy) / std::fabs(det);
  if (off == 0) return;
  const double arc = std::asin(std::min(1.0, off)), further = s.end.far ? (away ? kPi - arc : arc) / off : 1;
  const double a = (yy * fx - xy * fy) / det * further, b = (xx * fy - yx * fx) / det * further;
  const double wanted = std::hypot(a, b), turn = std::min(wanted, kLongestTurn);
  traced.next = normalized(start.z * std::cos(turn) + (start.x * a + start.y * b) * (std::sin(turn) / wanted));
}

// Newton's method with halved steps. False where it does not end at a way that is open.
bool RefractedSight::walk(const Search& s, const Traced& start, const Chain& chain, Traced& found) {
  found = start;
  // Towards a far light it is enough to look behind the last interface in the end.
  Chain on = chain;
  if (s.end.far) on.events = start.way.events, on.blind = true;
  bool stepped = false;
  const auto settled = [&] { return found.off * found.inverse < kSettled; };
  for (int step = 0; step < kMostSteps && (found.off > kArrived || !settled()); ++step) {
    const Dir from = found.way.direction;
    bool nearer = false;
    double share = 1;
    for (int n = 0; n < kMostHalvings && !nearer; ++n, share *= 0.5) {
      Traced next;
      if (!trace(s, normalized(from + (found.next - from) * share), on, next)) continue;
      nearer = next.off < found.off;
      if (nearer) found = next, stepped = true;
    }
    if (!nearer) break;
  }
  if (on.blind && stepped && found.off < kNearEnough) {
    Traced whole;
    if (!trace(s, found.way.direction, chain, whole) || whole.way.events != on.events) return false;
    found = whole;
  }
  return found.off < kNearEnough && found.open && std::isfinite(found.inverse) && settled();
}

// A start from the straight line towards the light: itself where it leaves a second interface, else what a flat
// interface where it meets the first one would make of it. False when it meets none.
bool RefractedSight::guess(const Search& s, Dir& direction) {
  const Tracer& tracer = surface_.tracer();
  const Dir to = s.straight;
  Ray ray{s.node.hit ? tracer.leave(*s.node.hit, to) : s.node.place, to, s.node.time, s.node.draw};
  Hit hit;
  if (!hit_next(ray, hit) || hit.distance >= s.distance) return false;
  const uint32_t material = surface_.material(hit);
  if (!interfaces_.has(material)) return false;
  direction = to;
  Traced straight;
  if (trace(s, to, {}, straight) && straight.way.events > 1) return true;
  surface_.interact(hit, -to, at_, s.node.time);
  const double index = interfaces_.index(material, s.knot);
  // Met from behind: the light comes from the front, and the node lies in what is behind.
  const auto inside = unbent(to, at_.frame.z, dot(to, hit.normal) > 0 ? 1 / index : index);
  if (inside) direction = *inside;
  return true;
}

Dir RefractedSight::draw_at_object(const Node& node) {
  const auto which = static_cast<size_t>(random() * static_cast<double>(objects_.size()));
  const Refractor& object = objects_[std::min(which, objects_.size() - 1)];
  const Box3 box =
      object.moves == kNone ? object.box : placed(object.box, surface_.tracer().to_world(object.moves, node.time));
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
  constexpr double kAsGuessed = 0.2, kAboutIt = 0.75, kDecades = 2;
  const double how = random();
  if (!guessed_ || how > kAboutIt) return draw_at_object(node);
  if (how < kAsGuessed) return *guessed_;
  const double width = std::pow(10.0, -kDecades * random()), r = width * std::sqrt(-2 * std::log(1 - random())),
               phi = 2 * kPi * random();
  const Frame about = Frame::around(*guessed_);
  return normalized(about.z + about.x * (r * std::cos(phi)) + about.y * (r * std::sin(phi)));
}

// Chooses behind which interface the lamp comes; false where it can come behind none.
bool RefractedSight::choose_end(const Search& s, Dir direction, Chain& chain, Traced& probe) {
  int left = static_cast<int>(random() * std::popcount(probe.may_end));
  for (int i = 1; i <= RefractedWay::kMostEvents && chain.events == 0; ++i)
    if (probe.may_end >> i & 1 && left-- == 0) chain.events = i;
  return chain.events > 0 && (chain.events == probe.way.events || trace(s, direction, chain, probe));
}

// The way that one of a few random starts leads to.
bool RefractedSight::try_once(const Search& s, bool mirrored, Traced& found) {
  constexpr double kReflects = 0.4;
  int walks = 0;
  for (int n = 0; n < kMostStarts && walks < kMostWalks; ++n) {
    const Dir direction = draw_start(s.node);
    Chain chain;
    for (int i = 1; mirrored && i < RefractedWay::kMostEvents; ++i)
      chain.mirrors |= uint32_t{random() < kReflects} << i;
    Traced probe;
    if (!trace(s, direction, chain, probe)) continue;
    if (!s.end.far && !choose_end(s, direction, chain, probe)) continue;
    if (mirrored && probe.way.mirrors() == 0) return false;
    if (s.end.far && probe.off > 1) continue;  // runs away
    ++walks;
    if (walk(s, probe, chain, found) && (found.way.mirrors() != 0) == mirrored) return true;
  }
  return false;
}

// The share of the light that the interfaces send along a way.
double RefractedSight::share(const RefractedWay& way, size_t knot) {
  double all = 1;
  for (int i = 0; i < way.events; ++i) {
    const RefractedEvent& at = way.at[i];
    at.model->delta_probability(at.out_local, interfaces_.lobe(at.material, at.reflected), static_cast<int>(knot),
                                shares_);
    all *= double{shares_[knot]};
  }
  return all;
}

// Of the ways with or without reflections.
bool RefractedSight::find(const Search& s, bool mirrored, RefractedWay& way) {
  constexpr double kWorthIt = 0.01;  // less light is followed up as rarely as it is weaker
  Traced first, again;
  if (!try_once(s, mirrored, first)) return false;
  const double kept = mirrored ? std::min(1.0, share(first.way, s.knot) / kWorthIt) : 1;
  if (kept < 1 && !(random() < kept)) return false;
  set_way(s, first, way);
  const auto same = [&] {
    const double near = std::max(kSame, 100 * (first.off + again.off)) * std::max(first.inverse, again.inverse);
    return again.way.events == way.events && again.way.mirrors() == way.mirrors() && again.det * first.det > 0 &&
           length(again.way.direction - way.direction) <= near;
  };
  while (!(try_once(s, mirrored, again) && same()))
    if (++way.trials >= kMostTrials) {
      way.doubtful = true;
      break;
    }
  way.trials /= kept;
  return true;
}

std::span<const RefractedWay> RefractedSight::find(const Node& node, const WayEnd& end, size_t knot, uint64_t seed) {
  const Vec3 way = end.place - node.place;
  const double distance = end.far ? std::numeric_limits<double>::infinity() : length(way);
  if (!(distance > 0)) return {};
  const Search search{node, end, end.far ? end.direction : way / distance, distance, knot};
  seed_ = seed, counter_ = 0;
  if (const Found only = find_only(search, found_[0]); only != Found::unknown)
    return std::span(found_).first(only == Found::one ? 1 : 0);
  Dir direction;
  guessed_.reset();
  if (guess(search, direction)) guessed_ = direction;
  size_t n = 0;
  for (const bool mirrored : {false, true})
    if (find(search, mirrored, found_[n])) ++n;
  return std::span(found_).first(n);
}

}  // namespace suite
