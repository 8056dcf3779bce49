#include "transport/surfaces_any.h"

#include <algorithm>
#include <cmath>

#include "transport/receiver.h"

namespace suite {

AnySurfaces::AnySurfaces(const Surface& surface, const Optics& optics, size_t width, bool keep_first)
    : surface_(surface),
      optics_(optics),
      knots_(optics.state().knots.size()),
      keep_first_(keep_first),
      current_(width),
      first_(keep_first ? width : 0),
      at_(width) {}

bool AnySurfaces::meet(uint32_t p, const Hit& hit, Dir out, double time, bool first) {
  at_[p] = first && keep_first_ ? &first_[p] : &current_[p];
  surface_.interact(hit, out, *at_[p], time);
  return at_[p]->baked && at_[p]->baked->model;
}

namespace {

// A surface that is not of the scene: without shading normals or maps.
void put(Interaction& at, const Hit& hit, uint32_t material, const BakedMaterial* baked) {
  at.position = hit.position;
  at.geometric_normal = hit.normal;
  at.frame = Frame::around(hit.normal);
  at.material = material;
  at.baked = baked;
}

}  // namespace

bool AnySurfaces::meet_earth(uint32_t p, const Hit& hit, uint32_t material, bool first) {
  at_[p] = first && keep_first_ ? &first_[p] : &current_[p];
  put(*at_[p], hit, material, &optics_.material(material));
  return at_[p]->baked->model;
}

void AnySurfaces::receive(uint32_t p, const Hit& hit, SensorRay::Receiver kind) {
  BakedMaterial& receiver = receivers_[kind == SensorRay::Receiver::sphere];
  if (!receiver.model) receiver = bake_receiver(kind, optics_.state());
  at_[p] = &current_[p];
  put(*at_[p], hit, kNone, &receiver);
}

LightReceiver AnySurfaces::receiver(uint32_t p, const Hit& hit, Dir out) const {
  const Interaction& at = *at_[p];
  const bool opaque = at.baked->model->opaque();
  const Dir n = at.frame.z;
  return {hit.position, opaque && dot(out, at.geometric_normal) < 0 ? -n : n, !opaque};
}

bool AnySurfaces::takes(uint32_t p, const Hit&, Dir out, Dir in) const {
  const Interaction& at = *at_[p];
  const double in_side = dot(in, at.geometric_normal);
  if (at.baked->model->opaque() && in_side * dot(out, at.geometric_normal) <= 0) return false;
  // Light may come in only from the side of the surface that the shading frame says it comes from.
  return in_side * dot(in, at.frame.z) > 0;
}

Factor AnySurfaces::evaluate(uint32_t p, Dir out, Dir in, std::span<float> dense) const {
  const Interaction& at = *at_[p];
  const ScatterModel& model = *at.baked->model;
  const Dir to = at.frame.to_local(out), from = at.frame.to_local(in);
  // Spectra of a material that maps have made here do not outlive the next surface.
  if (!local(p))
    if (const auto factored = model.factored(to, from)) return {factored->scale, factored->spectrum};
  model.eval(to, from, dense);
  return {1, dense.data()};
}

ScatterModel::Polarised AnySurfaces::mueller(uint32_t p, Dir out, Dir in, int lobe, int knot,
                                             std::span<Mueller> m) const {
  const Interaction& at = *at_[p];
  const Dir to = at.frame.to_local(out), from = at.frame.to_local(in);
  const ScatterModel& model = *at.baked->model;
  const auto of = lobe < 0 ? model.mueller(to, from, m) : model.delta_mueller(to, lobe, knot, m);
  for (Mueller& one : of.grey ? m.first(1) : m)
    if (one != Mueller::depolariser()) one = to_world(one, at.frame, out, in);
  return of;
}

void AnySurfaces::densities(uint32_t p, Dir out, Dir in, std::span<float> density) const {
  const Interaction& at = *at_[p];
  at.baked->model->pdf(at.frame.to_local(out), at.frame.to_local(in), density);
}

bool AnySurfaces::sample(size_t, uint32_t p, const Hit&, Dir out, Vec2 u, double lobe_u, int knot,
                         std::span<float> dense, Continuation& on) const {
  const Interaction& at = *at_[p];
  const ScatterModel& model = *at.baked->model;
  const Dir to = at.frame.to_local(out);
  const auto drawn = model.sample(to, u, lobe_u, knot);
  if (!drawn) return false;
  if (drawn->delta) return take_dirac(p, to, *drawn, knot, dense, on);
  on.in = at.frame.to_world(drawn->in);
  if (dot(on.in, at.geometric_normal) * drawn->in.z <= 0) return false;  // would leak through the real surface
  on.dirac = false;
  on.weight = {1, nullptr};
  if (!local(p))
    if (const auto factored = model.factored(to, drawn->in)) on.weight = {factored->scale, factored->spectrum};
  if (!on.weight.spectrum) {
    model.eval(to, drawn->in, dense);
    on.weight = {1, dense.data()};
  }
  model.pdf(to, drawn->in, {on.density, knots_});
  return true;
}

bool AnySurfaces::take_dirac(uint32_t p, Dir to, const ScatterModel::Sample& drawn, int knot, std::span<float> dense,
                             Continuation& on) const {
  const Interaction& at = *at_[p];
  on.in = at.frame.to_world(drawn.in);
  if (dot(on.in, at.geometric_normal) * drawn.in.z <= 0) return false;  // would leak through the real surface
  on.dirac = true;
  on.lobe = drawn.lobe;
  at.baked->model->delta_weight(to, drawn.lobe, knot, dense);
  at.baked->model->delta_probability(to, drawn.lobe, knot, {on.density, knots_});
  on.weight = {1, dense.data()};
  return true;
}

bool AnySurfaces::sample_either(uint32_t p, Dir out, int reflecting, double least, double lobe_u, int knot,
                                std::span<float> dense, Continuation& on) const {
  const Interaction& at = *at_[p];
  const Dir to = at.frame.to_local(out);
  float reflected[kMaxKnots];
  at.baked->model->delta_probability(to, reflecting, knot, {reflected, knots_});
  const auto chosen = [&](size_t k) {
    const double R = double{reflected[k]};
    return R > 0 && R < 1 ? std::clamp(R, least, 1 - least) : R;
  };
  const bool reflects = lobe_u < chosen(static_cast<size_t>(knot));
  const auto drawn = at.baked->model->sample(to, {0.5, 0.5}, reflects ? 0 : std::nextafter(1.0, 0.0), knot);
  if (!drawn || (drawn->lobe == reflecting) != reflects || !take_dirac(p, to, *drawn, knot, dense, on)) return false;
  for (size_t k = 0; k < knots_; ++k) {
    const double own = reflects ? double{reflected[k]} : 1 - double{reflected[k]};
    if (own > 0) on.density[k] *= static_cast<float>((reflects ? chosen(k) : 1 - chosen(k)) / own);
  }
  return true;
}

double AnySurfaces::mirrors(uint32_t p, Dir out, int mirror, int knot) const {
  float reflected[kMaxKnots];
  at_[p]->baked->model->delta_probability(at_[p]->frame.to_local(out), mirror, knot, {reflected, knots_});
  return double{reflected[knot]};
}

bool AnySurfaces::sample_way(uint32_t p, Dir out, int mirror, bool reflects, int knot, std::span<float> dense,
                             Continuation& on) const {
  const Interaction& at = *at_[p];
  const Dir to = at.frame.to_local(out);
  const auto drawn = at.baked->model->sample(to, {0.5, 0.5}, reflects ? 0 : std::nextafter(1.0, 0.0), knot);
  if (!drawn || (drawn->lobe == mirror) != reflects || !take_dirac(p, to, *drawn, knot, dense, on)) return false;
  for (size_t k = 0; k < knots_; ++k) on.density[k] = on.density[k] > 0 ? 1 : 0;
  return true;
}

// In an isothermal box all light is (B, 0, 0, 0): what a surface sends out and what it scatters add up to that.
ScatterModel::Polarised AnySurfaces::emission_mueller(uint32_t p, Dir out, Vec2 u, double lobe_u, int knot,
                                                      std::span<Mueller> m) const {
  const Interaction& at = *at_[p];
  // What the mixture's parts emit is weighed by their own radiance.
  const ScatterModel& model = at.baked->emitting ? *at.baked->emitting : *at.baked->model;
  const Dir to = at.frame.to_local(out);
  std::fill(m.begin(), m.end(), Mueller::depolariser());
  if (model.diffuse()) return {true, 0};
  const auto drawn = model.sample(to, u, lobe_u, knot);
  if (!drawn) return {true, 0};
  thread_local std::vector<float> w, W;
  thread_local std::vector<Mueller> scattered;
  w.resize(m.size()), W.resize(m.size()), scattered.resize(m.size());
  float density[kMaxKnots];
  ScatterModel::Polarised of;
  if (drawn->delta) {
    model.delta_weight(to, drawn->lobe, knot, w);
    model.delta_probability(to, drawn->lobe, knot, {density, knots_});
    of = model.delta_mueller(to, drawn->lobe, knot, scattered);
  } else {
    model.eval(to, drawn->in, w);
    model.pdf(to, drawn->in, {density, knots_});
    of = model.mueller(to, drawn->in, scattered);
  }
  if (!(density[knot] > 0)) return {true, 0};
  at.baked->model->total(to, W);
  const Dir in = at.frame.to_world(drawn->in);
  for (size_t b = 0; b < m.size(); ++b) {
    const double emissivity = 1 - double{W[b]};
    if (!(emissivity > 1e-6)) continue;
    const Mueller one = to_world(scattered[of.grey ? 0 : b], at.frame, out, in);
    for (int j = 1; j < 4; ++j) m[b](j, 0) = -one(j, 0) * w[b] / (density[knot] * emissivity);
  }
  return {false, of.unknown};
}

// Thermal emission: (1 - W) B(T), Kirchhoff's law for this side and direction.
AnySurfaces::Emission AnySurfaces::emission(uint32_t p, Dir out, std::span<float> dense) const {
  const Interaction& at = *at_[p];
  at.baked->model->total(at.frame.to_local(out), dense);
  for (float& e : dense) e = std::max(0.0f, 1 - e);
  if (!local(p)) return Emission{{1, dense.data()}, at.baked->blackbody.data()};
  for (size_t k = 0; k < dense.size(); ++k) dense[k] *= at.baked->blackbody[k];
  return Emission{{1, dense.data()}, nullptr};
}

}  // namespace suite
