#include "heat/audit_walk.h"

#include <algorithm>
#include <cmath>

#include "spectral/planck.h"

namespace suite {

namespace {

double body(double kelvin) { return kStefanBoltzmann * kelvin * kelvin * kelvin * kelvin; }

// Draws of sunlight for every time that heat may leave by the face; between them what the element absorbs stands.
constexpr double kSunDraws = 4;
// Waits at a face are drawn for rates this much larger than those at their begin, and for some a step at least.
constexpr double kMajorant = 1.5, kWaitsOfStep = 4;

}  // namespace

AuditWalk::AuditWalk(const AuditedScene& scene, const SolvedSurfaces& solved, const AuditTables& tables)
    : scene_(scene),
      tables_(tables),
      sun_(scene.tracer, scene.optics, solved.weather, solved.ground_albedo),
      surface_(scene.tracer, *scene.optics.glow),
      bins_(scene.optics.glow->state()),
      W_(scene.optics.glow->state().size()) {}

AuditWalk::Found AuditWalk::follow(const Hit& hit, uint32_t face, double t, WalkNumbers& numbers) {
  t_ = t, weight_ = 1, sum_ = 0, more_ = 0;
  enter(face, hit);
  for (uint32_t n = 0; n < HeatAudit::kMostEvents; ++n) {
    const AuditTables::Column& column = tables_.column(column_.group);
    bool ended = false;
    if (column.capacity.empty())
      ended = massless(numbers);
    else if (node_ > 0 && node_ + 1 < column.capacity.size())
      within(numbers);
    else
      ended = at_surface(numbers);
    if (ended) return {tables_.reference() + sum_, more_};
  }
  ++cut_;
  return {tables_.reference() + sum_ + weight_ * (tables_.kelvin(face_of(false), t_) - tables_.reference()), more_};
}

void AuditWalk::enter(uint32_t face, const Hit& hit) {
  hit_ = hit, column_ = tables_.behind(face);
  const size_t nodes = tables_.column(column_.group).capacity.size();
  node_ = column_.back && nodes > 0 ? nodes - 1 : 0;
}

uint32_t AuditWalk::face_of(bool back) const {
  const SurfaceGroup& group = *tables_.column(column_.group).group;
  return (back ? group.back_rows : group.front_rows)[column_.element];
}

void AuditWalk::within(WalkNumbers& numbers) {
  const AuditTables::Column& c = tables_.column(column_.group);
  const double up = c.conductance[node_ - 1], down = c.conductance[node_];
  t_ = tables_.wrapped(t_ + std::log(1 - numbers.uniform()) * c.capacity[node_] / (up + down));
  sum_ += weight_ * c.source[node_] / (up + down);
  node_ = numbers.uniform() * (up + down) < up ? node_ - 1 : node_ + 1;
}

AuditWalk::Side AuditWalk::side(uint32_t face) const {
  Side s;
  s.face = face, s.found = tables_.kelvin(face, t_);
  s.radiation = 4 * body(s.found) / s.found;
  const FaceBalance b = balance_at(tables_.traits(face), tables_.air(t_), s.found);
  s.air = b.linear;
  if (b.linear > 0)
    s.air_kelvin = b.constant / b.linear;
  else
    s.constant = b.constant;
  return s;
}

// What acts on a face without asking its temperature. The element's sunlight stands for the place's, which is drawn now
// and then.
void AuditWalk::gather(const Side& s, double rates, WalkNumbers& numbers) {
  const double usual = tables_.absorbed(s.face, t_), share = std::min(1.0, kSunDraws * s.rate() / rates);
  sum_ += weight_ * (s.constant + tables_.source(s.face) + usual) / rates;
  if (!(numbers.uniform() < share)) return;
  const double side = tables_.behind(s.face).back ? -1 : 1;
  const double here = sun_.absorbed(hit_, side, t_, numbers) + tables_.mirrored(s.face, t_);
  const double more = weight_ * (here - usual) / (share * rates);
  sum_ += more, more_ += more;
}

bool AuditWalk::at_surface(WalkNumbers& numbers) {
  const AuditTables::Column& c = tables_.column(column_.group);
  const SurfaceGroup& group = *c.group;
  const bool bottom = node_ > 0, open = !bottom || !group.back_rows.empty();
  const double inward = c.conductance[bottom ? node_ - 1 : 0];
  const FaceBalance behind = open ? FaceBalance{} : back_balance(group.behind);
  const double fixed = inward + behind.linear, capacity = c.capacity[node_];
  double all = fixed;
  if (open) all += kMajorant * side(face_of(bottom)).rate() + kWaitsOfStep * capacity / tables_.step();
  t_ = tables_.wrapped(t_ + std::log(1 - numbers.uniform()) * capacity / all);
  Side now;
  if (open) {
    now = side(face_of(bottom));
    if (fixed + now.rate() > all) ++fast_, all = fixed + now.rate();
    gather(now, all, numbers);
  }
  sum_ += weight_ * (c.source[node_] + (behind.linear > 0 ? 0 : behind.constant)) / all;
  double u = numbers.uniform() * all;
  if ((u -= inward) < 0) {
    node_ = bottom ? node_ - 1 : node_ + 1;
    return false;
  }
  if ((u -= behind.linear) < 0) {
    sum_ += weight_ * (behind.constant / behind.linear - tables_.reference());
    return true;
  }
  return open && leave_by(now, u, numbers);
}

// Both faces at once, without a wait.
bool AuditWalk::massless(WalkNumbers& numbers) {
  const bool two = !tables_.column(column_.group).group->back_rows.empty();
  const Side front = side(face_of(false)), back = two ? side(face_of(true)) : Side{};
  const double all = front.rate() + back.rate();
  gather(front, all, numbers);
  if (two) gather(back, all, numbers);
  const double u = numbers.uniform() * all;
  return u < front.rate() ? leave_by(front, u, numbers) : leave_by(back, u - front.rate(), numbers);
}

// u: 0 to the face's rate; above it nothing happens.
bool AuditWalk::leave_by(const Side& s, double u, WalkNumbers& numbers) {
  if (u < s.radiation) return radiate(s, numbers);
  if (u < s.rate()) {
    sum_ += weight_ * (s.air_kelvin - tables_.reference());
    return true;
  }
  return false;
}

bool AuditWalk::radiate(const Side& s, WalkNumbers& numbers) {
  const Vec3 normal = tables_.behind(s.face).back ? -hit_.normal : hit_.normal;
  const double u = numbers.uniform(), v = numbers.uniform();
  Ray ray{{}, normalized(Frame::around(normal).to_world(cosine_hemisphere({u, v}))), t_, numbers.next()};
  ray.origin = scene_.tracer.leave(hit_, ray.direction);
  const size_t bin = std::min(W_.size() - 1, static_cast<size_t>(numbers.uniform() * static_cast<double>(W_.size())));
  surface_.interact(hit_, ray.direction, at_, t_);
  const bool seen = at_.baked && at_.baked->model;
  if (seen) at_.baked->model->total(at_.frame.to_local(ray.direction), W_);
  if (seen && numbers.uniform() < double{W_[bin]}) return false;  // it does not emit there
  double path_weight = 1;
  for (uint32_t n = 0; n < kMostReflections; ++n) {
    Hit hit;
    scene_.tracer.nearest({&ray, 1}, {&hit, 1}, false, trace_);
    if (!hit.hit()) {
      const uint32_t end = ray.direction.z > 0 ? scene_.faces.outside_ring(HeatFaces::ring(ray.direction))
                                               : scene_.faces.outside_below();
      return arrive(s, end, hit, path_weight);
    }
    surface_.interact(hit, -ray.direction, at_, t_);
    if (!at_.baked || !at_.baked->model) {
      ray.origin = scene_.tracer.leave(hit, ray.direction);
      continue;
    }
    const Dir out = at_.frame.to_local(-ray.direction);
    at_.baked->model->total(out, W_);
    const double kept = double{std::min(1.0f, W_[bin])};
    if (!(numbers.uniform() < kept))
      return arrive(s, scene_.faces.end_at(hit, ray.direction, at_.material), hit, path_weight);
    const double a = numbers.uniform(), b = numbers.uniform(), c = numbers.uniform();
    const auto in = bins_.reflect(*at_.baked->model, out, {a, b, c, 0}, bin);
    path_weight = in ? path_weight * in->weight / kept : 0;
    if (!in) break;
    ray.direction = at_.frame.to_world(in->direction);
    ray.origin = scene_.tracer.leave(hit, ray.direction);
  }
  return arrive(s, scene_.faces.outside_below(), {}, 0);
}

// With M = sigma T^4 and h its slope, both as found, what a path brings is M' + h' (T' - found') less M: as if the face
// touched something of the temperature found + (M' - M + h' (T' - found')) / h.
bool AuditWalk::arrive(const Side& s, uint32_t end, const Hit& hit, double path_weight) {
  const uint32_t face = scene_.faces.face_of(end);
  const double emitted = face != kNone ? body(tables_.kelvin(face, t_))
                                       : tables_.outside(end - static_cast<uint32_t>(scene_.faces.size()), t_);
  const double brought = path_weight * (emitted - body(s.found));
  sum_ += weight_ * (s.found - tables_.reference() + brought / s.radiation);
  more_ += weight_ * (brought - (tables_.received(s.face, t_) - body(s.found))) / s.radiation;
  if (face == kNone || path_weight == 0) return true;
  const double there = tables_.kelvin(face, t_);
  weight_ *= path_weight * 4 * body(there) / there / s.radiation;
  sum_ -= weight_ * (there - tables_.reference());
  enter(face, hit);
  return false;
}

}  // namespace suite
