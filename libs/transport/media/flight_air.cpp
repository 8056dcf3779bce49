#include "transport/media/flight_air.h"

#include <algorithm>
#include <cmath>

namespace suite {

FlightAir::FlightAir(const Atmosphere* air, const VolumeField& field, const Optics& optics,
                     std::span<const double> knot_probability)
    : air_(air), field_(field), optics_(optics), probability_(knot_probability.begin(), knot_probability.end()) {
  if (!air) return;
  const size_t bins = optics.state().size();
  before_.resize(optics.media().size()), there_.resize(optics.media().size());
  whole_.resize(bins), to_.resize(bins), c_.resize(bins);
  T_.resize(bins), S_.resize(bins), reference_.resize(bins), behind_.resize(bins);
}

std::span<const float> FlightAir::reference(double distance) {
  if (!emits_) air_->transmittance(live_->origin, live_->direction, distance, reference_);
  emits_ = true;
  return reference_;
}

// Do the media change W on the way?
bool FlightAir::dimmed(std::span<const double> depth) const {
  for (size_t m = 0; m < depth.size(); ++m) {
    const BakedMedium& medium = optics_.media()[m];
    if (!(depth[m] > 0)) continue;
    if (optics_.spectral_flights() && medium.scatters()) return true;
    if (std::any_of(medium.absorption.begin(), medium.absorption.end(), [](float a) { return a > 0; })) return true;
  }
  return false;
}

// What weakens a bin in a medium: absorption, and scattering where it depends on wavelength; 1/m at density 1.
double FlightAir::coefficient(size_t medium, size_t bin) const {
  const BakedMedium& m = optics_.media()[medium];
  return double{m.absorption[bin]} + (optics_.spectral_flights() ? double{m.scattering[bin]} : 0);
}
void FlightAir::depths_of_bins(std::span<const double> media, std::span<double> bins) const {
  std::fill(bins.begin(), bins.end(), 0.0);
  for (size_t m = 0; m < media.size(); ++m)
    if (media[m] > 0)
      for (size_t i = 0; i < bins.size(); ++i) bins[i] += media[m] * coefficient(m, i);
}

// sum P_k r_k exp(-t_k) = sum * exp(-offset), with the least t_k for an offset.
FlightAir::Mixture FlightAir::mixture(std::span<const double> media, std::span<const double> rates) const {
  if (!optics_.spectral_flights()) return {1, 0, 0};
  double t[kMaxKnots] = {}, rate[kMaxKnots] = {};
  const size_t knots = probability_.size();
  for (size_t k = 0; k < knots; ++k)
    for (size_t m = 0; m < media.size(); ++m) {
      const double s = optics_.media()[m].scattering[optics_.state().knots[k]];
      t[k] += media[m] * s;
      if (!rates.empty()) rate[k] += rates[m] * s;
    }
  Mixture mix{0, *std::min_element(t, t + knots), 0};
  for (size_t k = 0; k < knots; ++k) {
    const double share = probability_[k] * live_->relative[k] * std::exp(mix.offset - t[k]);
    mix.sum += share, mix.fall += share * rate[k];
  }
  mix.fall /= mix.sum;
  return mix;
}

void FlightAir::finish(double distance, std::span<const double> depth, uint32_t background, double time, double u,
                       std::span<float> beta, std::span<float> gathered) {
  air_->path(live_->origin, live_->direction, distance, behind_, S_);
  const size_t n = beta.size();
  if (!dimmed(depth)) {
    for (size_t i = 0; i < n; ++i) gathered[i] += beta[i] * S_[i], beta[i] *= behind_[i];
    return;
  }
  depths_of_bins(depth, whole_);
  const Mixture all = mixture(depth, {});
  for (size_t i = 0; i < n; ++i)
    gathered[i] += static_cast<float>(double{beta[i]} * S_[i] * std::exp(all.offset - whole_[i]) / all.sum);
  if (draw(distance, background, time, u)) add_place(beta, gathered);
  for (size_t i = 0; i < n; ++i) beta[i] *= behind_[i];
}

// A place where something weakens, into place_, before_ and there_; false when nothing does.
bool FlightAir::draw(double length, uint32_t background, double time, double u) {
  weakened_ = static_cast<size_t>(std::count_if(whole_.begin(), whole_.end(), [](double w) { return w > 0; }));
  if (weakened_ == 0) return false;
  // The bin whose depth chooses the place, and the depth.
  const double scaled = u * static_cast<double>(weakened_);
  size_t left = static_cast<size_t>(scaled), bin = 0;
  while (!(whole_[bin] > 0) || left-- > 0) ++bin;
  const double target = -std::log1p((scaled - std::floor(scaled)) * std::expm1(-whole_[bin]));
  std::fill(before_.begin(), before_.end(), 0.0);
  contents_.clear();
  walk_.start(field_, live_->origin, live_->direction, length, background, time);
  double passed = 0;
  for (bool here = false; !here && walk_.next();) {
    double rate = 0, way = std::min(walk_.end() - walk_.begin(), kEndless);
    for (const Constituent& c : walk_.contents()) rate += c.density * coefficient(c.medium, bin);
    here = rate > 0 && passed + rate * way >= target;
    if (here) way = std::min(way, (target - passed) / rate);
    for (const Constituent& c : walk_.contents()) before_[c.medium] += c.density * way;
    passed += rate * way;
    if (rate > 0) place_ = walk_.begin() + way, contents_ = walk_.contents();  // rounding may leave the last one short
  }
  return !contents_.empty();
}

void FlightAir::add_place(std::span<const float> beta, std::span<float> gathered) {
  const size_t n = beta.size();
  std::fill(there_.begin(), there_.end(), 0.0);
  for (const Constituent& c : contents_) there_[c.medium] += c.density;
  depths_of_bins(before_, to_);
  depths_of_bins(there_, c_);
  double density = 0;  // of the place, 1/m
  for (size_t i = 0; i < n; ++i)
    if (whole_[i] > 0) density += c_[i] * std::exp(-to_[i]) / -std::expm1(-whole_[i]);
  density /= static_cast<double>(weakened_);
  if (!(density > 0)) return;
  const Mixture all = mixture(before_, there_);
  air_->path(live_->origin, live_->direction, place_, T_, S_);
  for (size_t i = 0; i < n; ++i) {
    double emitted = 0;
    for (const Constituent& c : contents_) {
      const BakedMedium& m = optics_.media()[c.medium];
      emitted += c.density * double{m.absorption[i]} * field_.source(m, c.kelvin, i);
    }
    const double weight = std::exp(all.offset - to_[i]) / all.sum;
    const double dimmer = emits_ ? double{T_[i]} - reference_[i] : 0;
    gathered[i] += static_cast<float>(beta[i] * weight * (S_[i] * (c_[i] - all.fall) + dimmer * emitted) / density);
  }
}

}  // namespace suite
