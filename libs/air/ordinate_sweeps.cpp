// One azimuth order: modes and sources of every layer, then light joined from the ground up and found from the top
// down. With R and E the light going up below a level, as reflection and as emission of all that lies there,
//   down(l + 1) = (1 - r R)^-1 (t down(l) + r E + e-),  up(l + 1) = R down(l + 1) + E.
#include <algorithm>
#include <cmath>

#include "air/ordinate_state.h"
#include "air/small_matrices.h"
#include "base/error.h"
#include "math/vec.h"

namespace suite {

using namespace ordinates;
using namespace small;

namespace ordinates {

namespace {
constexpr int kCellsOfSweep = kMostRows * kMostRows;

template <class Number>
void grow(std::vector<Number>& v, size_t size) {
  if (v.size() < size) v.resize(size);
}
}  // namespace

void Order::resize(int m_now, int half, int layer_count) {
  m = m_now;
  n = half;
  streams = 2 * half;
  layers = layer_count;
  const size_t cells = static_cast<size_t>(n) * n, count = layers;
  grow(table, static_cast<size_t>(streams - m) * n);
  grow(beam_row, streams - m);
  grow(modes, count * (2 * cells + n));
  grow(sources, count * 3 * n);
  grow(matrices, count * 4 * cells);
  grow(below, (count + 1) * cells);
  grow(pivots, count * n);
  for (int f = 0; f < (m == 0 ? 2 : 1); ++f) grow(fields[f], (count + 1) * 2 * n);
}

}  // namespace ordinates

void DiscreteOrdinates::State::prepare_modes(Order& o, int l) {
  const ModesOf<double> modes = o.modes_of(l);
  if (layer[l].as_below && scatters(l + 1, o.m)) {
    const Modes below = o.modes_of(l + 1);
    std::copy(below.S, below.S + 2 * n * n + n, modes.S);
    return;
  }
  double a[kCellsOfSweep], b[kCellsOfSweep];
  std::fill(a, a + n * n, 0.0);
  std::fill(b, b + n * n, 0.0);
  const double* c = coefficient(l);
  for (int degree = o.m; degree < layer[l].terms; ++degree) {
    double* matrix = (degree - o.m) % 2 ? a : b;
    const double* y = o.row(degree);
    for (int i = 0; i < n; ++i) {
      const double f = 2 * c[degree] * y[i];
      for (int j = 0; j < n; ++j) matrix[i * n + j] -= f * y[j];
    }
  }
  for (int i = 0; i < n; ++i) {
    a[i * n + i] += 1 / rule.nodes[i];
    b[i * n + i] += 1 / rule.nodes[i];
  }
  if (!find_modes(a, b, o.m == 0 && layer[l].absorbed == 0, modes, n))
    throw Error(strf("layer %d of the air: its moments are of no phase function", l));
}

void DiscreteOrdinates::State::set_sources(Order& o, int l) const {
  const Modes modes = o.modes_of(l);
  const SourcesOf<double> sources = o.sources_of(l);
  double odd[kMostRows] = {}, even[kMostRows] = {};
  if (layer[l].beam > 0) {
    const double amplitude = layer[l].beam * (o.m == 0 ? 1 : 2) / kPi;
    for (int degree = o.m; degree < layer[l].terms; ++degree) {
      double* sum = (degree - o.m) % 2 ? odd : even;
      const double f = amplitude * coefficient(l)[degree] * o.beam_row[degree - o.m];
      for (int i = 0; i < n; ++i) sum[i] += f * o.row(degree)[i];
    }
  }
  apply_transposed(modes.D, odd, sources.p, n);
  apply_transposed(modes.S, even, sources.q, n);
  for (int i = 0; i < n; ++i) even[i] = o.m == 0 ? 2 * layer[l].absorbed * slope[i] : 0;
  apply_transposed(modes.S, even, sources.thermal, n);
}

void DiscreteOrdinates::State::prepare_layer(Order& o, int l) {
  prepare_modes(o, l);
  const Response at = o.response_of(l);
  layer_response(o.modes_of(l), layer[l].depth, at.r, at.t, n);
  multiply(at.r, at.R, at.factor, n);
  for (int i = 0; i < n * n; ++i) at.factor[i] = (i % (n + 1) == 0) - at.factor[i];
  factor_lu(at.factor, at.pivot, n);
  std::copy(at.t, at.t + n * n, at.pass);
  solve_lu(at.factor, at.pivot, at.pass, n, n);
  double product[kCellsOfSweep];
  double* above = o.below.data() + l * n * n;
  multiply(at.R, at.pass, product, n);
  multiply(at.t, product, above, n);
  for (int i = 0; i < n * n; ++i) above[i] += at.r[i];
}

void DiscreteOrdinates::State::prepare_absorber(Order& o, int l) {
  const double *t = through.data() + l * n, *R = o.response_of(l).R;
  double* above = o.below.data() + l * n * n;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) above[i * n + j] = t[i] * R[i * n + j] * t[j];
}

void DiscreteOrdinates::State::prepare_order(int m) {
  Order& o = order[m];
  o.resize(m, n, layers);
  grow(enter, static_cast<size_t>(layers) * n);
  grow(leave, static_cast<size_t>(layers + 1) * n);
  double values[2 * kMostRows];
  for (int i = 0; i < n; ++i) {
    associated_legendre(m, rule.nodes[i], {values, static_cast<size_t>(streams - m)});
    for (int degree = m; degree < streams; ++degree) o.table[(degree - m) * n + i] = values[degree - m] * slope[i];
  }
  std::fill_n(o.below.begin() + static_cast<size_t>(layers) * n * n, n * n, 0.0);
  for (int l = layers - 1; l >= 0; --l) {
    if (scatters(l, m))
      prepare_layer(o, l);
    else
      prepare_absorber(o, l);
  }
  if (m == 0) light(o, kGround);
}

// Light that leaves a layer because of its sources. The particular solution has s = 0 at the faces for q and d = 0 for
// p, so that it vanishes with the depth; what it brings from outside is taken away again.
void DiscreteOrdinates::State::leaving(Order& o, int l, double* up, double* down) const {
  const ScaledLayer& at = layer[l];
  const Modes modes = o.modes_of(l);
  const SourcesOf<double> sources = o.sources_of(l);
  const bool emits = o.m == 0 && (at.planck_top > 0 || at.planck_bottom > 0);
  if (at.beam == 0 && !emits) {
    std::fill(up, up + n, 0.0);
    std::fill(down, down + n, 0.0);
    return;
  }
  double pu[kMostRows], pv[kMostRows], qu[kMostRows], qv[kMostRows];
  for (int j = 0; j < n; ++j) {
    EndIntegrals beam, linear;
    if (at.beam > 0) beam = beam_integrals(modes.k[j], at.secant, at.depth);
    if (emits) linear = linear_integrals(modes.k[j], at.depth);
    pu[j] = sources.p[j] * beam.top;
    pv[j] = sources.p[j] * beam.bottom;
    qu[j] =
        sources.q[j] * beam.top + sources.thermal[j] * (at.planck_top * linear.top + at.planck_bottom * linear.bottom);
    qv[j] = sources.q[j] * beam.bottom +
            sources.thermal[j] * (at.planck_top * linear.bottom + at.planck_bottom * linear.top);
  }
  double s0[kMostRows], s1[kMostRows], d0[kMostRows], d1[kMostRows];
  apply(modes.S, pu, s0, n);
  apply(modes.S, pv, s1, n);
  apply(modes.D, qu, d0, n);
  apply(modes.D, qv, d1, n);
  // At the top s = s0, d = d0, at the bottom s = -s1, d = -d1.
  double in_top[kMostRows], in_bottom[kMostRows];
  for (int i = 0; i < n; ++i) {
    in_top[i] = (s0[i] - d0[i]) / 2;
    in_bottom[i] = (-s1[i] - d1[i]) / 2;
  }
  const Response response = o.response_of(l);
  for (int i = 0; i < n; ++i) {
    double above = 0, below = 0;
    for (int j = 0; j < n; ++j) {
      const double rij = response.r[i * n + j], tij = response.t[i * n + j];
      above += rij * in_top[j] + tij * in_bottom[j];
      below += rij * in_bottom[j] + tij * in_top[j];
    }
    up[i] = (s0[i] + d0[i]) / 2 - above;
    down[i] = (d1[i] - s1[i]) / 2 - below;
  }
}

void DiscreteOrdinates::State::leaving_absorber(const Order& o, int l, double* up, double* down) const {
  const ScaledLayer& at = layer[l];
  for (int i = 0; i < n; ++i) {
    EndIntegrals part;
    if (o.m == 0 && at.depth > 0) part = emission_integrals(at.depth / rule.nodes[i]);
    const double f = at.absorbed * weight[i];
    up[i] = f * (at.planck_top * part.top + at.planck_bottom * part.bottom);
    down[i] = f * (at.planck_top * part.bottom + at.planck_bottom * part.top);
  }
}

void DiscreteOrdinates::State::light(Order& o, Field field) {
  double up[kMostRows] = {}, down[kMostRows] = {}, inside[kMostRows];
  for (int i = 0; i < n; ++i) leave[layers * n + i] = field == kGround ? weight[i] : 0;
  for (int l = layers - 1; l >= 0; --l) {
    const Response at = o.response_of(l);
    const double *E = leave.data() + (l + 1) * n, *t = through.data() + l * n;
    double *in = enter.data() + l * n, *out = leave.data() + l * n;
    const bool scattering = scatters(l, o.m);
    if (field == kAir) scattering ? leaving(o, l, up, down) : leaving_absorber(o, l, up, down);
    if (scattering) {
      apply(at.r, E, in, n);
      for (int i = 0; i < n; ++i) in[i] += down[i];
      solve_lu(at.factor, at.pivot, in, n, 1);
    } else {
      std::copy(down, down + n, in);
    }
    apply(at.R, in, inside, n);
    for (int i = 0; i < n; ++i) inside[i] += E[i];
    if (scattering)
      apply(at.t, inside, out, n);
    else
      for (int i = 0; i < n; ++i) out[i] = t[i] * inside[i];
    for (int i = 0; i < n; ++i) out[i] += up[i];
  }
  const LevelOf<double> top = o.level(field, 0);
  for (int i = 0; i < n; ++i) top.down[i] = field == kAir && o.m == 0 ? weight[i] * top_radiance : 0;
  for (int l = 0; l <= layers; ++l) {
    const LevelOf<double> at = o.level(field, l);
    apply(o.below.data() + l * n * n, at.down, at.up, n);
    for (int i = 0; i < n; ++i) at.up[i] += leave[l * n + i];
    if (l == layers) break;
    const LevelOf<double> next = o.level(field, l + 1);
    if (scatters(l, o.m))
      apply(o.response_of(l).pass, at.down, next.down, n);
    else
      for (int i = 0; i < n; ++i) next.down[i] = through[l * n + i] * at.down[i];
    for (int i = 0; i < n; ++i) next.down[i] += enter[l * n + i];
  }
}

void DiscreteOrdinates::State::light_order(int m) {
  Order& o = order[m];
  associated_legendre(m, -beam_cosine, std::span(o.beam_row).first(streams - m));
  for (int l = 0; l < layers; ++l)
    if (scatters(l, m)) set_sources(o, l);
  light(o, kAir);
}

}  // namespace suite
