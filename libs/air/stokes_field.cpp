#include "air/stokes_field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "air/ordinate_angles.h"
#include "air/small_matrices.h"
#include "air/stokes_layer.h"
#include "base/error.h"
#include "math/share.h"

namespace suite {

namespace {

using Row = std::vector<double>;

// A layer as it is solved: without the forward peak.
struct Scaled {
  double depth = 0, albedo = 0, scale = 1, secant = 1;
  double whole = 0;    // albedo of all scattering, over the scaled depth
  double start = 0;    // irradiance of the beam at its top
  double above = 0;    // depth of all above
  GreekMatrix matrix;  // truncated
};

double element(const StokesMode& x, int s) { return s == 0 ? x.i : s == 1 ? x.q : s == 2 ? x.u : x.v; }
StokesMode unit(int s) { return {s == 0 ? 1.0 : 0.0, s == 1 ? 1.0 : 0.0, s == 2 ? 1.0 : 0.0, s == 3 ? 1.0 : 0.0}; }
// U and V of light that goes down are kept the other way round.
double turned(int s) { return s >= 2 ? -1 : 1; }
constexpr size_t kParts = 4;  // that light is kept in
int components_of(StokesField::Light light) {
  return light == StokesField::Light::intensity ? 1 : light == StokesField::Light::polarised ? 3 : 4;
}

}  // namespace

struct StokesField::State {
  const Light light;
  const int streams;
  Row mu, weight;  // nodes, then views; weights 0 for these
  int hemisphere;  // nodes of the quadrature
  StokesLayer layer;
  // Of the problem.
  std::vector<Scaled> layers;
  double cosine = 1, ground = 0, ground_beam = 0;
  int orders = 1;
  std::vector<std::vector<StokesFunctions>> up, down;  // [order][node]
  // Light at the levels: [order][level][node x 4], U and V as they are.
  std::vector<std::vector<Row>> rising, falling;
  // Of the order in hand: components that are not zero, rows, matrices.
  int components = 1, n = 0;
  struct Joint {       // at the bottom of a layer
    Row falls, below;  // E T; R of all below
    Row given, lit;    // E (R u + J-); what rises from below by itself, u
  };
  std::vector<Joint> joints;

  State(Light of, int count, std::vector<double> views)
      : light(of), streams(count), hemisphere(count / 2), layer(small::kMostRows) {
    const GaussRule rule = gauss_rule(hemisphere);
    mu = rule.nodes, weight = rule.weights;
    for (const double v : views) mu.push_back(v), weight.push_back(0);
  }
  int nodes() const { return static_cast<int>(mu.size()); }
  double mu_of(int i) const { return mu[static_cast<size_t>(i)]; }
  double weight_of(int i) const { return weight[static_cast<size_t>(i)]; }
  int levels() const { return static_cast<int>(layers.size()) + 1; }
  double steepest() const { return 1 / *std::min_element(mu.begin(), mu.end()); }

  void scale(const StokesProblem& p);
  void take_functions();
  void solve_order(int m);
  void matrices(int m, const Scaled& l, Row& X, Row& Y) const;
  void beam_light(int m, const Scaled& l, Row& up_source, Row& down_source) const;
  void keep(int m, int level, const Row& up_light, const Row& down_light);
};

namespace {

constexpr double kMostSecant = 1e100;  // its square is finite

void check(const StokesProblem& p) {
  if (p.layers.empty()) throw Error("air without layers", "give at least one");
  const auto refuse = [](size_t layer, const char* what) {
    throw Error(strf("layer %zu of the air: its %s is out of range", layer, what), "see stokes_field.h");
  };
  for (size_t l = 0; l < p.layers.size(); ++l) {
    const StokesAirLayer& layer = p.layers[l];
    if (!(layer.depth >= 0 && layer.depth <= 1e9)) refuse(l, "depth");
    if (!is_share(layer.albedo)) refuse(l, "albedo");
    if (layer.matrix && (layer.matrix->degrees.empty() || std::fabs(layer.matrix->degrees[0].a1 - 1) > 1e-6))
      refuse(l, "scattering matrix, of which a1_0 is not 1");
    if (!p.beam.secants.empty()) {
      const double secant = p.beam.secants[l];
      if (!(std::fabs(secant) <= kMostSecant && secant * layer.depth >= -100)) refuse(l, "secant");
    }
  }
  if (!p.beam.secants.empty() && p.beam.secants.size() != p.layers.size())
    throw Error("secants of the beam are not as many as layers", "one a layer, or none");
  if (!p.beam.tops.empty() && p.beam.tops.size() != p.layers.size())
    throw Error("transmittances of the beam are not as many as layers", "one a layer, or none");
  if (!(std::fabs(p.beam.cosine) <= 1)) throw Error("the cosine of the beam is not within -1..1", "a cosine");
  if (!(p.beam.cosine > 0) && p.beam.secants.empty())
    throw Error("a beam from below without secants", "give its secants in the layers");
  if (!(p.beam.irradiance >= 0)) throw Error("the irradiance of the beam is negative", "0 or more");
  if (!is_share(p.ground_albedo)) throw Error(strf("ground albedo %g", p.ground_albedo), "0 to 1");
  if (p.orders < 1) throw Error(strf("%d azimuth orders", p.orders), "1 or more");
}

// Without the peak f: what is left of the degrees below `count`, over 1 - f.
GreekMatrix truncated(const GreekMatrix& whole, size_t count, double& f) {
  f = 0;
  if (whole.degrees.size() > count)
    f = std::clamp(whole.degrees[count].a1 / static_cast<double>(2 * count + 1), 0.0, 1.0);
  if (f > 1 - 1e-6) f = 0;
  GreekMatrix g;
  for (size_t l = 0; l < std::min(count, whole.degrees.size()); ++l) {
    GreekMatrix::Degree d = whole.degrees[l];
    const double peak = f * static_cast<double>(2 * l + 1);
    d.a1 -= peak, d.a4 -= peak;
    if (l >= 2) d.a2 -= peak, d.a3 -= peak;
    const double k = 1 / (1 - f);
    g.degrees.push_back({k * d.a1, k * d.a2, k * d.a3, k * d.a4, k * d.b1, k * d.b2});
  }
  return g;
}

}  // namespace

void StokesField::State::scale(const StokesProblem& p) {
  static const GreekMatrix even = GreekMatrix::depolarising(std::array{1.0});
  layers.clear();
  cosine = p.beam.cosine, ground = as_share(p.ground_albedo);
  double beam = p.beam.irradiance, above = 0;
  size_t degrees = 1;
  for (size_t l = 0; l < p.layers.size(); ++l) {
    const StokesAirLayer& from = p.layers[l];
    Scaled& to = layers.emplace_back();
    double f = 0;
    to.matrix = truncated(from.matrix ? *from.matrix : even, static_cast<size_t>(streams), f);
    const double albedo = as_share(from.albedo);
    to.scale = 1 - f * albedo;
    to.depth = from.depth * to.scale;
    to.whole = to.scale > 0 ? albedo / to.scale : 0;
    to.albedo = to.whole * (1 - f);
    to.secant = p.beam.secants.empty() ? 1 / p.beam.cosine : p.beam.secants[l];
    if (!p.beam.tops.empty() && p.beam.tops[l] >= 0) beam = p.beam.irradiance * p.beam.tops[l];
    to.start = beam, to.above = above;
    beam *= std::exp(-to.secant * to.depth);
    above += to.depth;
    if (to.albedo > 0) degrees = std::max(degrees, to.matrix.degrees.size());
  }
  ground_beam = beam;
  orders = std::min(p.orders, static_cast<int>(degrees));
}

void StokesField::State::take_functions() {
  up.clear(), down.clear();
  for (int m = 0; m < orders; ++m) {
    auto& rises = up.emplace_back();
    auto& falls = down.emplace_back();
    for (const double c : mu) {
      rises.emplace_back(m, c, static_cast<size_t>(streams));
      falls.emplace_back(m, -c, static_cast<size_t>(streams));
    }
  }
}

// X and Y of a layer.
void StokesField::State::matrices(int m, const Scaled& l, Row& X, Row& Y) const {
  const auto& rises = up[static_cast<size_t>(m)];
  const auto& falls = down[static_cast<size_t>(m)];
  for (int j = 0; j < nodes(); ++j)
    for (int s = 0; s < components; ++s)
      for (int i = 0; i < nodes(); ++i) {
        const double w = l.albedo / 2 * weight_of(j) / mu_of(i);
        const auto a = static_cast<size_t>(i), b = static_cast<size_t>(j);
        const bool any = weight_of(j) > 0;
        const StokesMode along = any ? scattered(l.matrix, rises[a], rises[b], unit(s)) : StokesMode{},
                         back = any ? scattered(l.matrix, rises[a], falls[b], turned(s) * unit(s)) : StokesMode{};
        for (int r = 0; r < components; ++r) {
          const bool same = i == j && r == s;
          const auto at = static_cast<size_t>((i * components + r) * n + j * components + s);
          const double alpha = (same ? 1 / mu_of(i) : 0) - w * element(along, r), beta = w * element(back, r);
          X[at] = alpha - beta, Y[at] = alpha + beta;
        }
      }
}

// What a layer makes of the beam at its top, over the cosines.
void StokesField::State::beam_light(int m, const Scaled& l, Row& up_source, Row& down_source) const {
  const StokesFunctions of_sun(m, -cosine, static_cast<size_t>(streams));
  for (int i = 0; i < nodes(); ++i) {
    const auto a = static_cast<size_t>(i), o = static_cast<size_t>(m);
    const StokesMode rises = of_beam(l.matrix, m, up[o][a], of_sun), falls = of_beam(l.matrix, m, down[o][a], of_sun);
    for (int s = 0; s < components; ++s) {
      const auto at = static_cast<size_t>(i * components + s);
      up_source[at] = l.albedo * l.start / mu_of(i) * element(rises, s);
      down_source[at] = l.albedo * l.start / mu_of(i) * element(falls, s) * turned(s);
    }
  }
}

void StokesField::State::keep(int m, int level, const Row& up_light, const Row& down_light) {
  const auto o = static_cast<size_t>(m), v = static_cast<size_t>(level);
  Row &up_to = rising[o][v], &down_to = falling[o][v];
  up_to.assign(kParts * static_cast<size_t>(nodes()), 0), down_to = up_to;
  for (int i = 0; i < nodes(); ++i)
    for (int s = 0; s < components; ++s) {
      const auto from = static_cast<size_t>(i * components + s),
                 to = kParts * static_cast<size_t>(i) + static_cast<size_t>(s);
      up_to[to] = up_light[from], down_to[to] = down_light[from] * turned(s);
    }
}

namespace {

void add_product(const Row& a, const Row& x, Row& y, int n) {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      y[static_cast<size_t>(i)] += a[static_cast<size_t>(i * n + j)] * x[static_cast<size_t>(j)];
}

}  // namespace

void StokesField::State::solve_order(int m) {
  components = m == 0 ? std::min(2, components_of(light)) : components_of(light);
  n = nodes() * components;
  const auto rows = static_cast<size_t>(n), cells = rows * rows;
  Row X(cells), Y(cells), E(cells), product(cells), q_up(rows), q_down(rows), J_up(rows), J_down(rows);
  Row below(cells, 0.0), lit(rows, 0.0);
  for (int i = 0; m == 0 && i < nodes(); ++i) {
    lit[static_cast<size_t>(i * components)] = ground / kPi * std::max(0.0, cosine) * ground_beam;
    for (int j = 0; j < nodes(); ++j)
      below[static_cast<size_t>(i * components * n + j * components)] = 2 * ground * weight_of(j) * mu_of(j);
  }
  joints.resize(layers.size());
  std::vector<int> pivot(rows);
  for (size_t l = layers.size(); l-- > 0;) {
    matrices(m, layers[l], X, Y);
    layer.set(X.data(), Y.data(), n, layers[l].depth, steepest());
    beam_light(m, layers[l], q_up, q_down);
    layer.respond(q_up.data(), q_down.data(), layers[l].secant, J_up.data(), J_down.data());
    const Row R(layer.reflection(), layer.reflection() + cells), T(layer.transmission(), layer.transmission() + cells);
    Joint& at = joints[l];
    at.below = below, at.lit = lit;
    small::multiply(R.data(), below.data(), E.data(), n);
    for (size_t i = 0; i < cells; ++i) E[i] = (i % (rows + 1) == 0 ? 1 : 0) - E[i];
    small::factor_lu(E.data(), pivot.data(), n);
    at.falls = T, at.given = J_down;
    add_product(R, lit, at.given, n);
    small::solve_lu(E.data(), pivot.data(), at.falls.data(), n, n);
    small::solve_lu(E.data(), pivot.data(), at.given.data(), n, 1);
    // All of it, as seen from its top.
    add_product(below, at.given, lit, n);
    Row risen = J_up;
    add_product(T, lit, risen, n);
    lit = risen;
    small::multiply(below.data(), at.falls.data(), product.data(), n);
    small::multiply(T.data(), product.data(), below.data(), n);
    for (size_t i = 0; i < cells; ++i) below[i] += R[i];
  }
  Row falls(rows, 0.0);
  keep(m, 0, lit, falls);
  for (size_t l = 0; l < layers.size(); ++l) {
    Row next = joints[l].given, rises = joints[l].lit;
    add_product(joints[l].falls, falls, next, n);
    add_product(joints[l].below, next, rises, n);
    falls = next;
    keep(m, static_cast<int>(l) + 1, rises, falls);
  }
}

StokesField::StokesField(Light light, int streams, std::vector<double> views) {
  if (streams < 4 || streams > 40 || streams % 2 != 0) throw Error(strf("%d streams", streams), "4, 6, ... 40");
  for (const double v : views)
    if (!(v > 0 && v <= 1)) throw Error(strf("a view of cosine %g", v), "above 0, at most 1");
  const int components = components_of(light);
  const size_t rows = (static_cast<size_t>(streams) / 2 + views.size()) * static_cast<size_t>(components);
  if (rows > small::kMostRows)
    throw Error(strf("%d streams and %zu views are too many at once", streams, views.size()),
                strf("together %d a hemisphere", small::kMostRows / components));
  state_ = std::make_unique<State>(light, streams, std::move(views));
}
StokesField::~StokesField() = default;
StokesField::StokesField(StokesField&&) noexcept = default;
StokesField& StokesField::operator=(StokesField&&) noexcept = default;

void StokesField::solve(const StokesProblem& problem) {
  check(problem);
  State& s = *state_;
  s.scale(problem);
  s.take_functions();
  const std::vector<Row> levels(static_cast<size_t>(s.levels()));
  s.rising.assign(static_cast<size_t>(s.orders), levels), s.falling = s.rising;
  for (int m = 0; m < s.orders; ++m) s.solve_order(m);
}

int StokesField::orders() const { return state_->orders; }
double StokesField::depth_scale(int layer) const { return state_->layers[static_cast<size_t>(layer)].scale; }
double StokesField::single_albedo(int layer) const { return state_->layers[static_cast<size_t>(layer)].albedo; }
double StokesField::beam(int level) const {
  const State& s = *state_;
  return level + 1 < s.levels() ? s.layers[static_cast<size_t>(level)].start : s.ground_beam;
}

DiffuseFluxes StokesField::fluxes(int level) const {
  const State& s = *state_;
  const Row &rises = s.rising[0][static_cast<size_t>(level)], &falls = s.falling[0][static_cast<size_t>(level)];
  DiffuseFluxes f;
  for (int i = 0; i < s.hemisphere; ++i) {
    const double area = 2 * kPi * s.weight_of(i) * s.mu_of(i);
    const double rise = rises[kParts * static_cast<size_t>(i)], fall = falls[kParts * static_cast<size_t>(i)];
    f.up += area * rise, f.down += area * fall;
    f.mean_intensity += s.weight_of(i) / 2 * (rise + fall);
  }
  f.direct = s.cosine * beam(level);
  f.mean_intensity += beam(level) / (4 * kPi);
  return f;
}

StokesMode StokesField::source(int layer, End end, int order, const StokesFunctions& direction) const {
  const State& s = *state_;
  const Scaled& l = s.layers[static_cast<size_t>(layer)];
  const auto o = static_cast<size_t>(order), level = static_cast<size_t>(layer + (end == End::top ? 0 : 1));
  const Row &rises = s.rising[o][level], &falls = s.falling[o][level];
  StokesMode sum;
  for (size_t d = o; d < l.matrix.degrees.size(); ++d) {
    StokesMode moment;
    for (size_t i = 0; i < static_cast<size_t>(s.hemisphere); ++i) {
      const double* const r = &rises[kParts * i];
      const double* const f = &falls[kParts * i];
      moment += s.weight[i] * s.up[o][i].times(d, {r[0], r[1], r[2], r[3]});
      moment += s.weight[i] * s.down[o][i].times(d, {f[0], f[1], f[2], f[3]});
    }
    sum += direction.times(d, StokesFunctions::scattered(l.matrix.degrees[d], moment));
  }
  return l.albedo / 2 * sum;
}

namespace {

// Integral of exp(-a t) over t in 0..x, over c: a slant way lit by a beam.
double lit_way(double a, double x, double c) {
  const double ax = a * x;
  return (std::fabs(ax) < 1e-9 ? x : -std::expm1(-ax) / a) / c;
}

}  // namespace

Stokes StokesField::radiance(int level, size_t view, Way way, double phi, std::span<const Stokes> single) const {
  const State& s = *state_;
  const size_t node = static_cast<size_t>(s.hemisphere) + view;
  Stokes sum{};
  for (int m = 0; m < s.orders; ++m) {
    const auto& of = way == Way::up ? s.rising : s.falling;
    const double* const x = &of[static_cast<size_t>(m)][static_cast<size_t>(level)][kParts * node];
    sum[0] += x[0] * std::cos(m * phi), sum[1] += x[1] * std::cos(m * phi);
    sum[2] += x[2] * std::sin(m * phi), sum[3] += x[3] * std::sin(m * phi);
  }
  if (single.empty()) return sum;
  // Upright, phi says which meridian is meant.
  const double c = s.mu[node], sine = std::max(1e-6, std::sqrt(1 - c * c)), sun = std::sqrt(1 - s.cosine * s.cosine);
  const Dir out{sine * std::cos(phi), sine * std::sin(phi), way == Way::up ? c : -c}, in{sun, 0, -s.cosine};
  const Scaled* const here = level + 1 < s.levels() ? &s.layers[static_cast<size_t>(level)] : nullptr;
  const double depth = here ? here->above : s.layers.back().above + s.layers.back().depth;
  for (size_t l = 0; l < s.layers.size(); ++l) {
    const Scaled& from = s.layers[l];
    const bool above = static_cast<int>(l) < level;
    if (above == (way == Way::up)) continue;
    const PlaneBlocks cut = from.matrix.at(dot(out, in));
    const Stokes of_cut = scattered_once(cut * (1 / (4 * kPi)), out, in);
    const double lit = way == Way::up
                           ? std::exp(-(from.above - depth) / c) * lit_way(from.secant + 1 / c, from.depth, c)
                           : std::exp(-(depth - from.above - from.depth) / c - from.depth / c) *
                                 lit_way(from.secant - 1 / c, from.depth, c);
    for (size_t k = 0; k < 3; ++k) sum[k] += from.start * lit * (from.whole * single[l][k] - from.albedo * of_cut[k]);
  }
  return sum;
}

}  // namespace suite
