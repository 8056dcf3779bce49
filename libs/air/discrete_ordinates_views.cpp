// Results of a solved problem at places and along directions.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "air/ordinate_views.h"
#include "base/error.h"
#include "math/vec.h"

namespace suite {

using namespace ordinates;

namespace {

void check_place(const DiscreteOrdinates::State& s, DiffusePlace place) {
  if (place.layer < 0 || place.layer >= s.layers || !(place.fraction >= 0 && place.fraction <= 1))
    throw Error(strf("place %g of layer %d of air with %d layers", place.fraction, place.layer, s.layers));
}

void check_direction(double mu, double least) {
  if (!(std::fabs(mu) >= least && std::fabs(mu) <= 1))
    throw Error(strf("a direction of cosine %g", mu), least > 0 ? strf("%g to 1 in size", least) : "-1 to 1");
}

// Air and ground together.
Ordinates light_at(const DiscreteOrdinates::State& s, int m, DiffusePlace place) {
  Ordinates light = ordinates_at(s, m, kAir, place);
  if (m > 0 || s.ground_radiance == 0) return light;
  const Ordinates ground = ordinates_at(s, 0, kGround, place);
  for (int i = 0; i < s.n; ++i) {
    light.s[i] += s.ground_radiance * ground.s[i];
    light.d[i] += s.ground_radiance * ground.d[i];
  }
  return light;
}

double moment(const Order& o, const Ordinates& light, int degree) {
  const double *y = o.row(degree), *part = (degree - o.m) % 2 ? light.d : light.s;
  double sum = 0;
  for (int i = 0; i < o.n; ++i) sum += y[i] * part[i];
  return sum;
}

// Coefficients of what the layer scatters, per degree from m on: times the Legendre functions of a direction the
// source.
void scattered(const DiscreteOrdinates::State& s, int m, int layer, const Ordinates& light, double* coefficients) {
  for (int degree = m; degree < s.layer[layer].terms; ++degree)
    coefficients[degree - m] = s.coefficient(layer)[degree] * moment(s.order[m], light, degree);
}

// One order of the multiply scattered radiance at a place; for order 0 emission and light from outside too.
double radiance_order(const DiscreteOrdinates::State& s, int m, Field field, DiffusePlace place, double mu) {
  const bool up = mu > 0;
  double sum = 0, left = 1;
  for (int l = place.layer; up ? l < s.layers : l >= 0; l += up ? 1 : -1) {
    const double from = up && l == place.layer ? place.fraction : 0, to = !up && l == place.layer ? place.fraction : 1;
    const double depth = (to - from) * s.layer[l].depth;
    if (depth <= 0) continue;
    sum += left * slant_source(s, m, field, l, from, to, mu);
    left *= std::exp(-depth / std::fabs(mu));
    if (left < 1e-300) return sum;
  }
  if (m > 0) return sum;
  if (field == kGround) return up ? sum + left : sum;
  return up ? sum : sum + left * s.top_radiance;
}

}  // namespace

DiffuseFluxes DiscreteOrdinates::fluxes(DiffusePlace place) const {
  const State& s = *state_;
  check_place(s, place);
  const Ordinates light = light_at(s, 0, place);
  const ScaledLayer& at = s.layer[place.layer];
  const double beam = this->beam(place),
               true_beam = at.true_beam * std::exp(-at.secant * place.fraction * at.true_depth);
  DiffuseFluxes result;
  double sum = 0;
  for (int i = 0; i < s.n; ++i) {
    result.up += kPi * s.weight[i] * (light.s[i] + light.d[i]);
    result.down += kPi * s.weight[i] * (light.s[i] - light.d[i]);
    sum += s.slope[i] * light.s[i];
  }
  result.direct = s.beam_cosine * true_beam;
  // Light of the forward peak travels with the scaled beam.
  const double peak = s.beam_cosine * (beam - true_beam);
  (peak > 0 ? result.down : result.up) += std::fabs(peak);
  result.mean_intensity = sum / 2 + beam / (4 * kPi);
  return result;
}

double DiscreteOrdinates::source(DiffusePlace place, double mu, double phi) const {
  const State& s = *state_;
  check_place(s, place);
  check_direction(mu, 0);
  double sum = 0;
  for (int m = 0; m < s.orders; ++m) {
    const int count = std::max(0, s.layer[place.layer].terms - m);
    double legendre[2 * small::kMostRows], coefficients[2 * small::kMostRows];
    associated_legendre(m, mu, {legendre, static_cast<size_t>(count)});
    scattered(s, m, place.layer, light_at(s, m, place), coefficients);
    sum += std::inner_product(legendre, legendre + count, coefficients, 0.0) * std::cos(m * phi);
  }
  return sum;
}

SourceAngles::SourceAngles(int streams, std::span<const double> mu)
    : streams_(streams), size_(static_cast<int>(mu.size())) {
  for (const double x : mu) check_direction(x, 0);
  for (int m = 0; m < streams; ++m) {
    const size_t count = streams - m;
    legendre_.emplace_back(mu.size() * count);
    for (size_t i = 0; i < mu.size(); ++i)
      associated_legendre(m, mu[i], std::span(legendre_[m]).subspan(i * count, count));
  }
}

void DiscreteOrdinates::sources(DiffusePlace place, const SourceAngles& angles, std::span<double> air,
                                std::span<double> ground) const {
  const State& s = *state_;
  check_place(s, place);
  SUITE_CHECK_EQ(angles.streams_, s.streams);
  SUITE_CHECK_EQ(air.size(), static_cast<size_t>(angles.size_) * s.orders);
  SUITE_CHECK(ground.empty() || ground.size() == static_cast<size_t>(angles.size_));
  double coefficients[2 * small::kMostRows];
  const auto fill = [&](int m, Field field, double* values, int stride) {
    scattered(s, m, place.layer, ordinates_at(s, m, field, place), coefficients);
    const int count = std::max(0, s.layer[place.layer].terms - m);
    for (int i = 0; i < angles.size_; ++i) {
      const double* legendre = angles.legendre_[m].data() + i * (s.streams - m);
      values[i * stride] = std::inner_product(legendre, legendre + count, coefficients, 0.0);
    }
  };
  for (int m = 0; m < s.orders; ++m) fill(m, kAir, air.data() + m, s.orders);
  if (!ground.empty()) fill(0, kGround, ground.data(), 1);
}

double DiscreteOrdinates::emission(DiffusePlace place) const {
  check_place(*state_, place);
  const ScaledLayer& at = state_->layer[place.layer];
  return at.absorbed * at.planck(place.fraction);
}

double DiscreteOrdinates::beam(DiffusePlace place) const {
  check_place(*state_, place);
  const ScaledLayer& at = state_->layer[place.layer];
  return at.beam * std::exp(-at.secant * place.fraction * at.depth);
}

void DiscreteOrdinates::moments(DiffusePlace place, int order, std::span<double> values) const {
  check_place(*state_, place);
  SUITE_CHECK(order >= 0 && order < state_->orders);
  SUITE_CHECK(values.size() <= static_cast<size_t>(state_->streams - order));
  const Ordinates light = light_at(*state_, order, place);
  for (size_t i = 0; i < values.size(); ++i)
    values[i] = moment(state_->order[order], light, order + static_cast<int>(i));
}

double DiscreteOrdinates::radiance(DiffusePlace place, double mu, double phi, std::span<const double> phase) const {
  const State& s = *state_;
  check_place(s, place);
  check_direction(mu, 1e-8);
  if (!phase.empty()) SUITE_CHECK_EQ(phase.size(), static_cast<size_t>(s.layers));
  double sum = 0;
  for (int m = 0; m < s.orders; ++m) sum += radiance_order(s, m, kAir, place, mu) * std::cos(m * phi);
  if (s.ground_radiance > 0) sum += s.ground_radiance * radiance_order(s, 0, kGround, place, mu);
  const bool up = mu > 0;
  double left = 1;
  for (int l = place.layer; up ? l < s.layers : l >= 0; l += up ? 1 : -1) {
    const double from = up && l == place.layer ? place.fraction : 0, to = !up && l == place.layer ? place.fraction : 1;
    sum += left * (slant_single(s.layer[l], from, to, mu, phase.empty() ? 0 : phase[l]) +
                   slant_emission(s.layer[l], from, to, mu));
    left *= std::exp(-(to - from) * s.layer[l].depth / std::fabs(mu));
  }
  return sum;
}

}  // namespace suite
