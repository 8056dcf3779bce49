#include "transport/gloss_turn.h"

#include <algorithm>
#include <cmath>

#include "math/sampling.h"
#include "math/warps.h"
#include "surface/surface_walk.h"

namespace suite {

namespace {

// Of the turns those that are drawn as paths would be that come the other way; the others are even: surfaces as
// measured may not be reciprocal, and light is what a path finds that goes against the photon's way.
constexpr double kOwn = 0.8;

}  // namespace

std::optional<GlossTurn::Turn> GlossTurn::draw(const ScatterModel& model, Dir to, const std::array<double, 4>& u) {
  Turn turn;
  float density[kMaxKnots] = {};
  if (u[3] < kOwn) {
    const auto drawn = draw_reflection(model, to, u, 0, spectrum_, {density, state_.knots.size()});
    if (!drawn) return std::nullopt;
    if (drawn->delta) return mirrored(to, *drawn, density[0]);
    turn.in = drawn->in;
  } else {
    turn.in = cosine_hemisphere({u[0], u[1]});
    if (to.z < 0) turn.in.z = -turn.in.z;
    model.pdf(to, turn.in, {density, state_.knots.size()});
  }
  const double even = turn.in.z * to.z > 0 ? std::fabs(turn.in.z) / kPi : 0;
  const double p = kOwn * double{density[0]} + (1 - kOwn) * even;
  const double brdf = value(model, turn.in, to) / std::fabs(to.z);
  if (!(brdf > 0) || !(p > 0)) return std::nullopt;
  model.total(to, spectrum_);
  turn.narrow = kPi * brdf > kNarrow * at_reference(spectrum_);
  turn.weight = brdf * std::fabs(turn.in.z) / p;
  return turn;
}

std::optional<GlossTurn::Turn> GlossTurn::mirrored(Dir to, const ScatterModel::Sample& drawn, float probability) const {
  const double weight = at_reference(spectrum_) / (kOwn * double{probability});
  if (drawn.in.z * to.z < 0 || !(weight > 0)) return std::nullopt;
  return Turn{drawn.in, true, true, weight};
}

// w(out, in) at the reference bin.
double GlossTurn::value(const ScatterModel& model, Dir out, Dir in) {
  if (const auto factored = model.factored(out, in))
    return double{factored->scale} * double{factored->spectrum[state_.knots[0]]};
  model.eval(out, in, spectrum_);
  return at_reference(spectrum_);
}

bool GlossTurn::is_glossy(const BakedMaterial& m) {
  if (m.model && is_glossy(*m.model)) return true;
  if (!m.maps) return false;
  const auto& maps = *m.maps;
  if (maps.cube) return is_glossy(maps.cube->low()) || is_glossy(maps.cube->high());
  return std::any_of(maps.variants.begin(), maps.variants.end(), [&](const auto& v) { return v && is_glossy(*v); }) ||
         std::any_of(maps.parts.begin(), maps.parts.end(), [&](const auto* part) { return part && is_glossy(*part); });
}

bool GlossTurn::is_glossy(const ScatterModel& model) {
  if (model.diffuse()) return false;
  constexpr int kDraws = 8;
  for (const double cosine : {0.95, 0.6, 0.2, -0.95, -0.6, -0.2}) {
    if (cosine < 0 && model.opaque()) break;
    const Dir to{std::sqrt(1 - cosine * cosine), 0, cosine};
    for (uint64_t k = 0; k < kDraws; ++k) {
      const auto u = [k](uint64_t n) { return unit_double(hash_of(0x74726965ull, k, n)); };
      if (const auto turn = draw(model, to, {u(0), u(1), u(2), 0}); turn && turn->narrow) return true;
    }
  }
  return false;
}

}  // namespace suite
