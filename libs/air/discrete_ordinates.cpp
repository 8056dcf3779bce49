// Checks, scaling by delta-M, the loop over azimuth orders, and the ground.
#include "air/discrete_ordinates.h"

#include <algorithm>
#include <cmath>

#include "air/ordinate_state.h"
#include "base/error.h"
#include "math/share.h"
#include "math/vec.h"

namespace suite {

using namespace ordinates;

DiscreteOrdinates::DiscreteOrdinates(int streams) {
  if (streams < 4 || streams > 64 || streams % 2) throw Error(strf("%d streams", streams), "an even number, 4 to 64");
  state_ = std::make_unique<State>();
  State& s = *state_;
  s.streams = streams;
  s.n = streams / 2;
  s.rule = gauss_rule(s.n);
  for (int i = 0; i < s.n; ++i) {
    s.weight.push_back(std::sqrt(s.rule.nodes[i] * s.rule.weights[i]));
    s.slope.push_back(std::sqrt(s.rule.weights[i] / s.rule.nodes[i]));
  }
}
DiscreteOrdinates::~DiscreteOrdinates() = default;
DiscreteOrdinates::DiscreteOrdinates(DiscreteOrdinates&&) noexcept = default;
DiscreteOrdinates& DiscreteOrdinates::operator=(DiscreteOrdinates&&) noexcept = default;

void DiscreteOrdinates::State::check(const DiffuseProblem& problem) const {
  const auto finite = [](double x) { return x >= 0 && x < 1e300; };
  if (problem.layers.empty()) throw Error("air without layers", "at least one, of depth 0 where there is none");
  if (!finite(problem.top_radiance)) throw Error("negative radiance from above the air");
  for (size_t l = 0; l < problem.layers.size(); ++l) {
    const DiffuseLayer& at = problem.layers[l];
    const auto fail = [&](const char* what, const char* hint) {
      throw Error(strf("layer %zu of the air: %s", l, what), hint);
    };
    if (!(at.depth >= 0 && at.depth <= 1e9)) fail("its depth is out of range", "0 to 1e9");
    if (!is_share(at.albedo)) fail("its albedo is out of range", "0 to 1");
    if (!finite(at.planck_top) || !finite(at.planck_bottom)) fail("negative emission", "0 or more");
    if (!at.moments.empty() && std::fabs(at.moments[0] - 1) > 1e-6) fail("its phase function is not 1", "chi_0 = 1");
    for (const double chi : at.moments)
      if (!(std::fabs(chi) <= 1)) fail("a moment of its phase function is out of range", "-1 to 1");
  }
}

void DiscreteOrdinates::State::check_beam(const DiffuseBeam& beam) const {
  if (!(beam.irradiance >= 0 && beam.irradiance < 1e300)) throw Error("a beam of negative irradiance");
  if (!(std::fabs(beam.cosine) <= 1)) throw Error("the cosine of the sun is not within -1 to 1");
  const size_t count = layer.size();
  if (!beam.secants.empty()) SUITE_CHECK_EQ(beam.secants.size(), count);
  if (!beam.tops.empty()) SUITE_CHECK_EQ(beam.tops.size(), count);
  if (beam.irradiance > 0 && beam.secants.empty() && !(beam.cosine > 0))
    throw Error("a sun that is not above the horizon, without secants of its beam");
  for (size_t l = 0; l < beam.secants.size(); ++l)
    if (!std::isfinite(beam.secants[l]) || beam.secants[l] * layer[l].true_depth < -100)
      throw Error(strf("layer %zu of the air: its secant of the beam is out of range", l),
                  "times the depth at least -100");
  for (size_t l = 0; l < beam.tops.size(); ++l)
    if (!(as_share(beam.tops[l]) <= 1))
      throw Error(strf("layer %zu of the air: its transmittance of the beam is out of range", l), "at most 1");
}

void DiscreteOrdinates::State::scale_layer(const DiffuseLayer& from, int l) {
  ScaledLayer& to = layer[l];
  const double known = static_cast<double>(from.moments.size()), albedo = as_share(from.albedo);
  const double forward = known > streams ? std::max(0.0, from.moments[streams]) : 0.0;
  to = {};
  to.true_depth = from.depth;
  to.scale = 1 - albedo * forward;
  to.depth = from.depth * to.scale;
  to.absorbed = 1;
  if (forward < 1 && to.scale > 0) {
    to.albedo = albedo * (1 - forward) / to.scale;
    to.absorbed = (1 - albedo) / to.scale;
    to.single = albedo / to.scale;
  }
  to.planck_top = from.planck_top;
  to.planck_bottom = from.planck_bottom;
  double* c = coefficients.data() + l * streams;
  for (int i = 0; i < streams; ++i) {
    const double chi = i == 0 ? 1 : i < known ? (from.moments[i] - forward) / (1 - forward) : -forward / (1 - forward);
    c[i] = to.albedo > 0 ? (2 * i + 1) * chi * to.albedo / 2 : 0;
    if (c[i] != 0) to.terms = i + 1;
  }
}

void DiscreteOrdinates::State::scale(const DiffuseProblem& problem) {
  layers = static_cast<int>(problem.layers.size());
  layer.resize(layers);
  coefficients.resize(static_cast<size_t>(layers) * streams);
  through.resize(static_cast<size_t>(layers) * n);
  top_radiance = problem.top_radiance;
  azimuth_tolerance = problem.azimuth_tolerance;
  for (int l = 0; l < layers; ++l) {
    scale_layer(problem.layers[l], l);
    for (int i = 0; i < n; ++i) through[l * n + i] = std::exp(-layer[l].depth / rule.nodes[i]);
    if (l > 0)
      layer[l - 1].as_below = layer[l].terms > 0 && layer[l - 1].absorbed == layer[l].absorbed &&
                              std::equal(coefficient(l), coefficient(l) + streams, coefficient(l - 1));
  }
}

void DiscreteOrdinates::State::scale_beam(const DiffuseBeam& from) {
  beam_irradiance = from.irradiance;
  beam_cosine = from.cosine;
  double beam = beam_irradiance, true_beam = beam_irradiance;
  for (int l = 0; l < layers; ++l) {
    ScaledLayer& to = layer[l];
    if (!from.tops.empty() && from.tops[l] >= 0) beam = true_beam = from.tops[l] * beam_irradiance;
    to.beam = beam;
    to.true_beam = true_beam;
    to.secant = beam_irradiance == 0 ? 0 : from.secants.empty() ? 1 / beam_cosine : from.secants[l];
    beam *= std::exp(-to.secant * to.depth);
    true_beam *= std::exp(-to.secant * to.true_depth);
  }
}

double DiscreteOrdinates::State::largest(int m) const {
  const Order& o = order[m];
  double most = 0;
  for (int l = 0; l < layers; ++l)
    for (int face = 0; face < 2 && scatters(l, m); ++face) {
      const LevelOf<const double> at = o.level(kAir, l + face);
      double sum = 0;
      for (int degree = m; degree < layer[l].terms; ++degree) {
        const double* y = o.row(degree);
        double moment = 0;
        for (int i = 0; i < n; ++i) moment += y[i] * (at.up[i] + ((degree - m) % 2 ? -1 : 1) * at.down[i]);
        sum += std::fabs(coefficient(l)[degree] * moment);
      }
      most = std::max(most, sum);
    }
  return most;
}

void DiscreteOrdinates::State::couple_ground() {
  ground_radiance = (ground_emission + ground_albedo * black_irradiance / kPi) / (1 - ground_albedo * spherical_albedo);
}

void DiscreteOrdinates::State::solve_orders() {
  int most = 1;
  if (beam_irradiance > 0 && std::fabs(beam_cosine) < 1 && std::isfinite(azimuth_tolerance))
    for (const ScaledLayer& at : layer) most = std::max(most, at.terms);
  if (static_cast<int>(order.size()) < most) order.resize(most);
  int small = 0;
  for (orders = 0; orders < most && small < 2;) {
    const int m = orders++;
    for (; prepared < orders; ++prepared) prepare_order(prepared);
    light_order(m);
    small = largest(m) <= azimuth_tolerance * largest(0) ? small + 1 : 0;
  }
  const Order& first = order[0];
  const LevelOf<const double> bottom = first.level(kAir, layers), lit = first.level(kGround, layers),
                              above = first.level(kGround, 0);
  const ScaledLayer& last = layer.back();
  black_irradiance = std::max(0.0, beam_cosine) * last.beam * std::exp(-last.secant * last.depth);
  spherical_albedo = transmittance = 0;
  for (int i = 0; i < n; ++i) {
    black_irradiance += 2 * kPi * weight[i] * bottom.down[i];
    spherical_albedo += 2 * weight[i] * lit.down[i];
    transmittance += 2 * weight[i] * above.up[i];
  }
}

void DiscreteOrdinates::solve(const DiffuseProblem& problem) {
  State& s = *state_;
  s.check(problem);
  s.scale(problem);
  s.prepared = 0;
  s.check_beam(problem.beam);
  s.scale_beam(problem.beam);
  s.solve_orders();
  set_ground(problem.ground_albedo, problem.ground_emission);
}

void DiscreteOrdinates::set_beam(const DiffuseBeam& beam) {
  state_->check_beam(beam);
  state_->scale_beam(beam);
  state_->solve_orders();
  state_->couple_ground();
}

void DiscreteOrdinates::set_ground(double albedo, double emission) {
  if (!is_share(albedo)) throw Error(strf("a ground of albedo %g", albedo), "0 to 1");
  if (!(emission >= 0 && emission < 1e300)) throw Error("a ground of negative emission");
  state_->ground_albedo = as_share(albedo);
  state_->ground_emission = emission;
  state_->couple_ground();
}

int DiscreteOrdinates::streams() const { return state_->streams; }
int DiscreteOrdinates::layers() const { return state_->layers; }
int DiscreteOrdinates::orders() const { return state_->orders; }
double DiscreteOrdinates::ground_radiance() const { return state_->ground_radiance; }
double DiscreteOrdinates::spherical_albedo() const { return state_->spherical_albedo; }
double DiscreteOrdinates::transmittance() const { return state_->transmittance; }
double DiscreteOrdinates::black_irradiance() const { return state_->black_irradiance; }
double DiscreteOrdinates::depth_scale(int layer) const { return state_->layer.at(layer).scale; }
double DiscreteOrdinates::single_albedo(int layer) const { return state_->layer.at(layer).single; }

}  // namespace suite
