#include "radiometry/volume_air.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {
constexpr double kEndless = 1e30;  // as in volume_flight.cpp
}  // namespace

FlightAir::FlightAir(const Atmosphere* air, const VolumeField& field, const Optics& optics,
                     std::span<const double> knot_probability)
    : air_(air), field_(field), optics_(optics), probability_(knot_probability.begin(), knot_probability.end()) {
  if (!air) return;
  const size_t bins = optics.state().size();
  before_.resize(optics.media().size());
  whole_.resize(bins), to_.resize(bins), c_.resize(bins);
  T_.resize(bins), S_.resize(bins), reference_.resize(bins);
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

// Of what media of these densities weaken, per bin: absorption, and scattering where it depends on wavelength.
void FlightAir::depths_of_bins(std::span<const double> media, std::span<double> bins) const {
  std::fill(bins.begin(), bins.end(), 0.0);
  for (size_t m = 0; m < media.size(); ++m) {
    if (!(media[m] > 0)) continue;
    const BakedMedium& medium = optics_.media()[m];
    for (size_t i = 0; i < bins.size(); ++i)
      bins[i] += media[m] * (double{medium.absorption[i]} + (optics_.spectral_flights() ? medium.scattering[i] : 0));
  }
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
  air_->path(live_->origin, live_->direction, distance, T_, S_);
  const size_t n = beta.size();
  if (!dimmed(depth)) {
    for (size_t i = 0; i < n; ++i) gathered[i] += beta[i] * S_[i], beta[i] *= T_[i];
    return;
  }
  depths_of_bins(depth, whole_);
  const Mixture all = mixture(depth, {});
  for (size_t i = 0; i < n; ++i)
    gathered[i] += static_cast<float>(double{beta[i]} * S_[i] * std::exp(all.offset - whole_[i]) / all.sum);

  // The bin whose absorption chooses the place.
  const auto count = static_cast<double>(std::count_if(whole_.begin(), whole_.end(), [](double w) { return w > 0; }));
  if (count > 0) {
    size_t left = static_cast<size_t>(u * count), bin = 0;
    while (!(whole_[bin] > 0) || left-- > 0) ++bin;
    const double within = u * count - std::floor(u * count);
    const Place place = draw(bin, -std::log1p(within * std::expm1(-whole_[bin])), distance, background, time);
    if (!place.contents.empty()) add_place(place, beta, gathered);
  }
  air_->path(live_->origin, live_->direction, distance, T_, S_);
  for (size_t i = 0; i < n; ++i) beta[i] *= T_[i];
}

// Where the bin's depth reaches the target; before_ gets the media's up to there.
FlightAir::Place FlightAir::draw(size_t bin, double target, double length, uint32_t background, double time) {
  std::fill(before_.begin(), before_.end(), 0.0);
  Place place{0, {}};
  walk_.start(field_, live_->origin, live_->direction, length, background, time);
  double passed = 0;
  while (walk_.next()) {
    double rate = 0, way = std::min(walk_.end() - walk_.begin(), kEndless);
    for (const Constituent& c : walk_.contents()) {
      const BakedMedium& m = optics_.media()[c.medium];
      rate += c.density * (double{m.absorption[bin]} + (optics_.spectral_flights() ? m.scattering[bin] : 0));
    }
    const bool here = passed + rate * way >= target;
    if (here && rate > 0) way = std::min(way, std::max(0.0, (target - passed) / rate));
    for (const Constituent& c : walk_.contents()) before_[c.medium] += c.density * way;
    passed += rate * way;
    if (rate > 0) place = {walk_.begin() + way, walk_.contents()};  // rounding may leave the last one short of it
    if (here) break;
  }
  return place;
}

void FlightAir::add_place(const Place& place, std::span<const float> beta, std::span<float> gathered) {
  const size_t n = beta.size();
  std::vector<double> there(before_.size(), 0.0);
  for (const Constituent& c : place.contents) there[c.medium] += c.density;
  depths_of_bins(before_, to_);
  depths_of_bins(there, c_);
  double density = 0, count = 0;
  for (size_t i = 0; i < n; ++i) {
    if (!(whole_[i] > 0)) continue;
    density += c_[i] * std::exp(-to_[i]) / -std::expm1(-whole_[i]);
    ++count;
  }
  density /= count;
  if (!(density > 0)) return;
  const Mixture all = mixture(before_, there);
  air_->path(live_->origin, live_->direction, place.distance, T_, S_);
  for (size_t i = 0; i < n; ++i) {
    double emitted = 0;
    for (const Constituent& c : place.contents) {
      const BakedMedium& m = optics_.media()[c.medium];
      if (c.kelvin > 0)
        emitted += c.density * double{m.absorption[i]} * double{m.index_squared[i]} * field_.blackbody(i, c.kelvin);
      else if (!m.blackbody.empty())
        emitted += c.density * double{m.absorption[i]} * m.blackbody[i];
    }
    const double weight = std::exp(all.offset - to_[i]) / all.sum;
    const double dimmer = emits_ ? double{T_[i]} - reference_[i] : 0;
    gathered[i] += static_cast<float>(beta[i] * weight * (S_[i] * (c_[i] - all.fall) + dimmer * emitted) / density);
  }
}

}  // namespace suite
