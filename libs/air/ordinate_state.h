// What the discrete ordinates keep of a solved problem.
#pragma once
#include <vector>

#include "air/discrete_ordinates.h"
#include "air/layer_modes.h"
#include "air/ordinate_angles.h"

namespace suite::ordinates {

struct ScaledLayer {
  double depth = 0, albedo = 0, absorbed = 0;  // by delta-M; absorbed = 1 - albedo without its rounding
  double scale = 1, single = 0;                // scaled depth / depth; albedo / scale
  double planck_top = 0, planck_bottom = 0;
  double secant = 0, beam = 0;  // irradiance across the beam at the top
  double true_depth = 0, true_beam = 0;
  int terms = 0;          // moments from this one on are zero
  bool as_below = false;  // the same albedo and moments as the layer below
  double planck(double fraction) const { return planck_top + fraction * (planck_bottom - planck_top); }
};

// Light at a level: weighted radiances sqrt(mu_i w_i) I, n of each.
template <class Number>
struct LevelOf {
  Number *down = nullptr, *up = nullptr;
};

// Amplitudes of the sources of a layer: p, q of the beam at its top, q of a Planck radiance of 1.
template <class Number>
struct SourcesOf {
  Number *p = nullptr, *q = nullptr, *thermal = nullptr;
};

// What a layer does to light from outside: its r and t, the factor of 1 - r R over what lies below with its exchanged
// rows, (1 - r R)^-1 t, and R itself.
struct Response {
  double *r = nullptr, *t = nullptr, *factor = nullptr, *pass = nullptr;
  int* pivot = nullptr;
  double* R = nullptr;
};

enum Field { kAir, kGround };  // the air over a black ground; nothing but a ground of radiance 1

// One azimuth order. Vectors over layers or levels, used from the front and never shrunk.
struct Order {
  int m = 0, n = 0, streams = 0, layers = 0;
  std::vector<double> table;     // (streams - m) x n: Legendre functions times sqrt(w_i / mu_i)
  std::vector<double> beam_row;  // streams - m: Legendre functions of the beam's direction
  std::vector<double> modes, sources, fields[2];
  std::vector<double> matrices, below;  // per layer four matrices; per level R, the reflection of all below
  std::vector<int> pivots;
  void resize(int order, int half, int layer_count);
  const double* row(int degree) const { return table.data() + (degree - m) * n; }
  ModesOf<double> modes_of(int l) { return modes_at(modes.data(), l); }
  Modes modes_of(int l) const { return modes_at(modes.data(), l); }
  Response response_of(int l) {
    double* at = matrices.data() + static_cast<size_t>(l) * 4 * n * n;
    return {at, at + n * n, at + 2 * n * n, at + 3 * n * n, pivots.data() + l * n, below.data() + (l + 1) * n * n};
  }
  SourcesOf<double> sources_of(int l) { return sources_at(sources.data(), l); }
  SourcesOf<const double> sources_of(int l) const { return sources_at(sources.data(), l); }
  LevelOf<double> level(Field f, int l) { return level_at(fields[f].data(), l); }
  LevelOf<const double> level(Field f, int l) const { return level_at(fields[f].data(), l); }

 private:
  template <class Number>
  ModesOf<Number> modes_at(Number* all, int l) const {
    Number* at = all + static_cast<size_t>(l) * (2 * n * n + n);
    return {at, at + n * n, at + 2 * n * n};
  }
  template <class Number>
  SourcesOf<Number> sources_at(Number* all, int l) const {
    Number* at = all + static_cast<size_t>(l) * 3 * n;
    return {at, at + n, at + 2 * n};
  }
  template <class Number>
  LevelOf<Number> level_at(Number* all, int l) const {
    Number* at = all + static_cast<size_t>(l) * 2 * n;
    return {at, at + n};
  }
};

}  // namespace suite::ordinates

namespace suite {

struct DiscreteOrdinates::State {
  int streams = 0, n = 0, layers = 0, orders = 0;
  GaussRule rule;
  std::vector<double> weight, slope;  // sqrt(mu_i w_i), sqrt(w_i / mu_i)
  std::vector<ordinates::ScaledLayer> layer;
  std::vector<double> coefficients;  // per layer streams of (2 l + 1) chi_l albedo / 2, scaled
  std::vector<double> through;       // per layer n: exp(-depth / mu_i)
  std::vector<ordinates::Order> order;
  int prepared = 0;                  // orders whose matrices are known
  std::vector<double> enter, leave;  // per layer (1 - r R)^-1 (r E + e-), per level E: of one order and field
  double beam_irradiance = 0, beam_cosine = 1, top_radiance = 0, azimuth_tolerance = 0;
  double ground_albedo = 0, ground_emission = 0, ground_radiance = 0;
  double spherical_albedo = 0, transmittance = 0, black_irradiance = 0;

  const double* coefficient(int l) const { return coefficients.data() + l * streams; }
  // Scatters the layer in this order? Else it only attenuates and emits.
  bool scatters(int l, int m) const { return layer[l].depth > 0 && layer[l].terms > m; }

  void check(const DiffuseProblem& problem) const;
  void check_beam(const DiffuseBeam& beam) const;
  void scale(const DiffuseProblem& problem);
  void scale_layer(const DiffuseLayer& from, int l);
  void scale_beam(const DiffuseBeam& beam);
  void solve_orders();
  void couple_ground();

  // One order: what does not depend on the sun, and what does.
  void prepare_order(int m);
  void light_order(int m);
  void prepare_modes(ordinates::Order& o, int l);
  void prepare_layer(ordinates::Order& o, int l);
  void prepare_absorber(ordinates::Order& o, int l);
  void set_sources(ordinates::Order& o, int l) const;
  void leaving(ordinates::Order& o, int l, double* up, double* down) const;
  void leaving_absorber(const ordinates::Order& o, int l, double* up, double* down) const;
  void light(ordinates::Order& o, ordinates::Field field);
  double largest(int m) const;  // a bound of the order's source at the faces of the layers, over a black ground
};

}  // namespace suite
