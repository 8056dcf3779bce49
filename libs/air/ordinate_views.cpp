#include "air/ordinate_views.h"

#include <algorithm>
#include <cmath>

namespace suite::ordinates {

using namespace small;
using State = DiscreteOrdinates::State;

namespace {

// Amplitudes of every mode at a depth.
struct Amplitudes {
  double f[kMostRows], g[kMostRows];
};

Amplitudes project(const Modes& modes, const Ordinates& light, int n) {
  Amplitudes a;
  apply_transposed(modes.D, light.s, a.f, n);
  apply_transposed(modes.S, light.d, a.g, n);
  return a;
}

Ordinates at_face(const Order& o, Field field, int level) {
  Ordinates light;
  const LevelOf<const double> at = o.level(field, level);
  for (int i = 0; i < o.n; ++i) {
    light.s[i] = at.up[i] + at.down[i];
    light.d[i] = at.up[i] - at.down[i];
  }
  return light;
}

// The share of a beam that is left after `x` of the layer's depth.
double left_after(const ScaledLayer& at, double x) { return at.beam > 0 ? std::exp(-at.secant * x) : 0; }

// Integral of the beam against exp(-kappa x) over a part of the layer, x from where the ray leaves; no exponent grows.
double beam_along(const ScaledLayer& at, double from, double to, bool up, double kappa) {
  const double depth = (to - from) * at.depth, start = left_after(at, from * at.depth);
  if (up) return start * decay_integral(at.secant + kappa, depth);
  return start * std::exp(-std::min(kappa, at.secant) * depth) * decay_integral(std::fabs(at.secant - kappa), depth);
}

// Inside the layer from its faces, where both f'' = k^2 f - (q + p') and g'' = k^2 g - (k^2 p + q') are interpolated
// the same way, so that neither is the difference of the other's neighbours: `above` and `below` are the two parts, the
// slope is the same at the end of one as at the beginning of the other.
Amplitudes inside(const Modes& modes, const SourcesOf<const double>& sources, const ScaledLayer& at, Field field,
                  double fraction, const Amplitudes& top, const Amplitudes& bottom, int n) {
  const double above = fraction * at.depth, below = at.depth - above, share = left_after(at, above);
  const double slope = (at.planck_bottom - at.planck_top) / at.depth, planck = at.planck(fraction);
  Amplitudes a;
  for (int j = 0; j < n; ++j) {
    const double k = modes.k[j];
    const auto same = [&](double x) { return k * x > 1e-8 ? k / std::tanh(k * x) : 1 / x; };
    const auto other = [&](double x) { return k * x > 1e-8 ? (k * x < 700 ? k / std::sinh(k * x) : 0) : 1 / x; };
    double f = 0, g = 0;
    if (field == kAir) {
      if (at.beam > 0) {
        const double beam =
            beam_integrals(k, at.secant, above).bottom + share * beam_integrals(k, at.secant, below).top;
        f = (sources.q[j] - at.secant * sources.p[j]) * beam;
        g = (k * k * sources.p[j] - at.secant * sources.q[j]) * beam;
      }
      const EndIntegrals first = linear_integrals(k, above), second = linear_integrals(k, below);
      f += sources.thermal[j] *
           (at.planck_top * first.bottom + planck * (first.top + second.top) + at.planck_bottom * second.bottom);
      g += sources.thermal[j] * slope * (first.top + first.bottom + second.top + second.bottom);
    }
    const double first = other(above), second = other(below), sum = same(above) + same(below);
    a.f[j] = (f + first * top.f[j] + second * bottom.f[j]) / sum;
    a.g[j] = (g + first * top.g[j] + second * bottom.g[j]) / sum;
  }
  return a;
}

// One mode along a part of a layer: depth, values at its two ends, integrals of p and q against exp(-kappa x).
struct Stretch {
  double depth = 0, k = 0;
  double f[2], g[2], p[2], q[2], p_integral = 0, q_integral = 0;
};

struct SlantIntegrals {
  double f = 0, g = 0;
};

// From f' = g - p, g' = k^2 f - q by parts; a short part by the trapezoid with derivatives (Euler and Maclaurin).
SlantIntegrals integrals(const Stretch& s, double kappa, double fastest) {
  const double end = std::exp(-kappa * s.depth), k2 = s.k * s.k;
  if (fastest * s.depth < 0.01) {
    double f_slope[2], g_slope[2];
    for (int e = 0; e < 2; ++e) {
      f_slope[e] = s.g[e] - s.p[e] - kappa * s.f[e];
      g_slope[e] = k2 * s.f[e] - s.q[e] - kappa * s.g[e];
    }
    const double half = s.depth / 2, twelfth = s.depth * s.depth / 12;
    return {half * (s.f[0] + end * s.f[1]) + twelfth * (f_slope[0] - end * f_slope[1]),
            half * (s.g[0] + end * s.g[1]) + twelfth * (g_slope[0] - end * g_slope[1])};
  }
  const double a = s.f[0] - s.f[1] * end - s.p_integral, b = s.g[0] - s.g[1] * end - s.q_integral;
  const double scale = 1 / (kappa * kappa - k2);
  return {(kappa * a + b) * scale, (k2 * a + kappa * b) * scale};
}

}  // namespace

Ordinates ordinates_at(const State& state, int m, Field field, DiffusePlace place) {
  const Order& o = state.order[m];
  const ScaledLayer& at = state.layer[place.layer];
  const int n = state.n;
  if (place.fraction <= 0 || at.depth == 0) return at_face(o, field, place.layer);
  if (place.fraction >= 1) return at_face(o, field, place.layer + 1);
  Ordinates light;
  if (!state.scatters(place.layer, m)) {
    const LevelOf<const double> top = o.level(field, place.layer), bottom = o.level(field, place.layer + 1);
    for (int i = 0; i < n; ++i) {
      const double mu = state.rule.nodes[i];
      double down = top.down[i] * std::exp(-place.fraction * at.depth / mu),
             up = bottom.up[i] * std::exp(-(1 - place.fraction) * at.depth / mu);
      if (field == kAir && m == 0) {
        down += state.weight[i] * slant_emission(at, 0, place.fraction, -mu);
        up += state.weight[i] * slant_emission(at, place.fraction, 1, mu);
      }
      light.s[i] = up + down;
      light.d[i] = up - down;
    }
    return light;
  }
  const Modes modes = o.modes_of(place.layer);
  const Amplitudes a = inside(modes, o.sources_of(place.layer), at, field, place.fraction,
                              project(modes, at_face(o, field, place.layer), n),
                              project(modes, at_face(o, field, place.layer + 1), n), n);
  apply(modes.S, a.f, light.s, n);
  apply(modes.D, a.g, light.d, n);
  return light;
}

double slant_source(const State& state, int m, Field field, int l, double from, double to, double mu) {
  const ScaledLayer& at = state.layer[l];
  if (!state.scatters(l, m) || from >= to) return 0;
  const Order& o = state.order[m];
  const int n = state.n;
  const Modes modes = o.modes_of(l);
  const SourcesOf<const double> sources = o.sources_of(l);
  // What amplitudes scatter into the ray: even degrees of s, odd ones of d.
  double legendre[2 * kMostRows], even[kMostRows] = {}, odd[kMostRows] = {}, of_f[kMostRows], of_g[kMostRows];
  associated_legendre(m, mu, {legendre, static_cast<size_t>(state.streams - m)});
  for (int degree = m; degree < at.terms; ++degree) {
    double* sum = (degree - m) % 2 ? odd : even;
    const double c = state.coefficient(l)[degree] * legendre[degree - m];
    for (int i = 0; i < n; ++i) sum[i] += c * o.row(degree)[i];
  }
  apply_transposed(modes.S, even, of_f, n);
  apply_transposed(modes.D, odd, of_g, n);
  const Amplitudes end[2] = {project(modes, ordinates_at(state, m, field, {l, from}), n),
                             project(modes, ordinates_at(state, m, field, {l, to}), n)};
  // Along the ray backwards: x runs down for light going up. Upside down g, p and the secant change sign.
  const bool up = mu > 0;
  const double side = up ? 1 : -1, kappa = 1 / std::fabs(mu), depth = (to - from) * at.depth;
  const double place[2] = {up ? from : to, up ? to : from};
  const double share[2] = {left_after(at, place[0] * at.depth), left_after(at, place[1] * at.depth)};
  const auto source_integrals = [&](Stretch& s, int j, double slant) {
    const double beam = at.beam > 0 ? beam_along(at, from, to, up, slant) : 0;
    const EndIntegrals linear = emission_integrals(depth * slant);
    s.p_integral = side * sources.p[j] * beam;
    s.q_integral = sources.q[j] * beam + sources.thermal[j] / slant *
                                             (at.planck(place[0]) * linear.top + at.planck(place[1]) * linear.bottom);
  };
  double sum = 0;
  for (int j = 0; j < n; ++j) {
    Stretch s;
    s.depth = depth;
    s.k = modes.k[j];
    for (int e = 0; e < 2; ++e) {
      const Amplitudes& a = end[up ? e : 1 - e];
      s.f[e] = a.f[j];
      s.g[e] = side * a.g[j];
      s.p[e] = field == kAir ? side * sources.p[j] * share[e] : 0;
      s.q[e] = field == kAir ? sources.q[j] * share[e] + sources.thermal[j] * at.planck(place[e]) : 0;
    }
    const bool resonant = std::fabs(kappa - s.k) < 1e-4 * kappa;
    for (int part = 0; part < (resonant ? 2 : 1); ++part) {
      const double slant = resonant ? kappa * (1 + (part == 0 ? 1e-4 : -1e-4)) : kappa;
      if (field == kAir) source_integrals(s, j, slant);
      const SlantIntegrals i = integrals(s, slant, std::max({s.k, kappa, std::fabs(at.secant)}));
      sum += kappa * (of_f[j] * i.f + side * of_g[j] * i.g) / (resonant ? 2 : 1);
    }
  }
  return sum;
}

double slant_single(const ScaledLayer& at, double from, double to, double mu, double phase) {
  if (at.beam == 0 || phase == 0) return 0;
  const double kappa = 1 / std::fabs(mu);
  return at.single * phase * at.beam * kappa * beam_along(at, from, to, mu > 0, kappa);
}

double slant_emission(const ScaledLayer& at, double from, double to, double mu) {
  const double near = at.planck(mu > 0 ? from : to), far = at.planck(mu > 0 ? to : from);
  if (near == 0 && far == 0) return 0;
  const EndIntegrals part = emission_integrals((to - from) * at.depth / std::fabs(mu));
  return at.absorbed * (near * part.top + far * part.bottom);
}

}  // namespace suite::ordinates
