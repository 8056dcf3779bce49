#include "radiometry/volume_flight.h"

#include <algorithm>
#include <cmath>

namespace suite {

Flights::Flights(const VolumeField& field, const Optics& optics, std::span<const double> knot_probability,
                 const Atmosphere* air)
    : field_(field),
      optics_(optics),
      media_(optics.media()),
      bins_of_knots_(optics.state().knots),
      probability_(knot_probability.begin(), knot_probability.end()),
      depth_(media_.size()),
      tau_(optics.state().size()),
      emission_(optics.state().size()),
      air_(air, field, optics, knot_probability) {
  for (const BakedMedium& m : media_) {
    any_emission_ = any_emission_ || !m.blackbody.empty();
    absorbs_.push_back(std::any_of(m.absorption.begin(), m.absorption.end(), [](float a) { return a > 0; }));
  }
  for (const VolumeField::Placed& p : field.placed()) any_emission_ = any_emission_ || p.emits;
}

double Flights::scattering_depth(size_t bin) const {
  double tau = 0;
  for (size_t m = 0; m < depth_.size(); ++m) tau += depth_[m] * double{media_[m].scattering[bin]};
  return tau;
}

bool Flights::emits(const Constituent& c) const {
  return absorbs_[c.medium] && (c.kelvin > 0 || !media_[c.medium].blackbody.empty());
}

void Flights::pass_run() {
  for (const Constituent& c : run_) depth_[c.medium] += c.density;
  run_.clear();
}

Flights::Arrival Flights::fly(LivePath& live, int knot, double length, uint32_t background, double time, Vec3 u,
                              std::span<float> beta, std::span<float> gathered) {
  const size_t own = bins_of_knots_[static_cast<size_t>(knot)];
  std::fill(depth_.begin(), depth_.end(), 0.0);
  run_.clear();
  normalise(live, beta);
  if (air_.any()) air_.begin(live);
  double left = -std::log1p(-u.x);
  Arrival arrival{false, length};
  walk_.start(field_, live.origin, live.direction, length, background, time);
  while (!arrival.scattered && walk_.next()) {
    const std::vector<Constituent>& contents = walk_.contents();
    double way = walk_.end() - walk_.begin(), rate = 0;
    for (const Constituent& c : contents) rate += c.density * double{media_[c.medium].scattering[own]};
    if (rate * way > left) {
      way = left / rate;
      arrival = {true, walk_.begin() + way};
    } else if (rate > 0) {
      left -= rate * way;
    }
    way = std::min(way, kEndless);
    // Stretches of one medium at one temperature make one run: emission needs only the mass passed.
    const bool same = run_.size() == 1 && contents.size() == 1 && run_[0] == contents[0];
    if (!same) {
      if (std::any_of(run_.begin(), run_.end(), [&](const Constituent& c) { return emits(c); }))
        emit(live, u.y, beta, gathered);
      pass_run();
      for (const Constituent& c : contents) run_.push_back({c.medium, 0, c.kelvin});
      run_begin_ = walk_.begin();
    }
    for (size_t c = 0; c < contents.size(); ++c) run_[c].density += contents[c].density * way;
  }
  if (any_emission_ && std::any_of(run_.begin(), run_.end(), [&](const Constituent& c) { return emits(c); }))
    emit(live, u.y, beta, gathered);
  pass_run();
  if (air_.any()) air_.finish(arrival.distance, depth_, background, time, u.z, beta, gathered);
  weigh(live, knot, arrival.scattered, beta);
  return arrival;
}

// What the run emits towards the start of the flight.
void Flights::emit(const LivePath& live, double u, std::span<const float> beta, std::span<float> gathered) {
  const size_t n = beta.size();
  // Optical depth of absorption in the run, and the source function that goes with it.
  std::fill(tau_.begin(), tau_.end(), 0.0f);
  std::fill(emission_.begin(), emission_.end(), 0.0f);
  for (const Constituent& c : run_) {
    const BakedMedium& m = media_[c.medium];
    const float amount = static_cast<float>(c.density);
    for (size_t i = 0; i < n; ++i) {
      const float tau = amount * m.absorption[i];
      tau_[i] += tau;
      emission_[i] += tau * field_.source(m, c.kelvin, i);
    }
  }
  const std::span<const float> dimmed = air_.any() ? air_.reference(run_begin_) : std::span<const float>{};
  const size_t knots = bins_of_knots_.size();
  double before[kMaxKnots] = {}, within[kMaxKnots] = {};
  if (optics_.spectral_flights())
    for (size_t k = 0; k < knots; ++k) {
      before[k] = scattering_depth(bins_of_knots_[k]);
      within[k] = 0;
      for (const Constituent& c : run_) within[k] += c.density * double{media_[c.medium].scattering[bins_of_knots_[k]]};
    }
  for (size_t i = 0; i < n; ++i) {
    if (!(emission_[i] > 0)) continue;
    const double tau = tau_[i], reached = -std::expm1(-tau);
    double absorbed = 0;
    for (size_t m = 0; m < depth_.size(); ++m) absorbed += depth_[m] * double{media_[m].absorption[i]};
    double ratio = 1;
    if (optics_.spectral_flights()) {
      const double share = std::min(1.0, -std::log1p(-u * reached) / tau);  // of the run, up to the place that emits
      double scattered = scattering_depth(i), mixture = 0;
      for (const Constituent& c : run_) scattered += share * c.density * double{media_[c.medium].scattering[i]};
      for (size_t k = 0; k < knots; ++k)
        mixture += probability_[k] * live.relative[k] * std::exp(scattered - before[k] - share * within[k]);
      ratio = 1 / mixture;
    }
    if (!dimmed.empty()) ratio *= dimmed[i];
    gathered[i] += static_cast<float>(double{beta[i]} * std::exp(-absorbed) * reached / tau * emission_[i] * ratio);
  }
}

// Weighs the path for the way in depth_: r_k, the spectrum, the densities that later sources share.
void Flights::weigh(LivePath& live, int knot, bool scattered, std::span<float> beta) {
  if (std::all_of(depth_.begin(), depth_.end(), [](double d) { return d == 0; })) return;
  const size_t knots = bins_of_knots_.size();
  double tau[kMaxKnots] = {}, rate[kMaxKnots] = {};
  for (size_t k = 0; k < knots; ++k) {
    tau[k] = scattering_depth(bins_of_knots_[k]);
    rate[k] = 0;
    if (scattered)
      for (const Constituent& c : walk_.contents())
        rate[k] += c.density * double{media_[c.medium].scattering[bins_of_knots_[k]]};
  }
  const double own = tau[knot], own_rate = scattered ? rate[knot] : 1;
  for (size_t k = 0; k < knots; ++k) live.relative[k] *= std::exp(own - tau[k]) * (scattered ? rate[k] / own_rate : 1);
  if (!scattered) live.last_density *= std::exp(-own);
  const bool absorbs = [&] {
    for (size_t m = 0; m < depth_.size(); ++m)
      if (depth_[m] > 0 && absorbs_[m]) return true;
    return false;
  }();
  if (absorbs || optics_.spectral_flights()) {
    // Scattering that is the same everywhere cancels exactly.
    const bool spectral = optics_.spectral_flights();
    const double offset = spectral ? own : 0;
    std::fill(tau_.begin(), tau_.end(), 0.0f);
    for (size_t m = 0; m < depth_.size(); ++m) {
      if (!(depth_[m] > 0)) continue;
      const float amount = static_cast<float>(depth_[m]);
      const float *absorption = media_[m].absorption.data(), *scattering = media_[m].scattering.data();
      for (size_t i = 0; i < tau_.size(); ++i)
        tau_[i] += amount * (spectral ? absorption[i] + scattering[i] : absorption[i]);
    }
    for (size_t i = 0; i < beta.size(); ++i) beta[i] *= static_cast<float>(std::exp(offset - tau_[i]) / own_rate);
    for (size_t k = 0; k < knots; ++k) live.throughput[k] *= std::exp(offset - tau_[bins_of_knots_[k]]) / own_rate;
  } else if (scattered) {
    for (float& b : beta) b = static_cast<float>(b / own_rate);
    for (size_t k = 0; k < knots; ++k) live.throughput[k] /= own_rate;
  }
  live.shares = 0;
  for (size_t k = 0; k < knots; ++k) live.shares += probability_[k] * live.relative[k];
  normalise(live, beta);
}

void Flights::normalise(LivePath& live, std::span<float> beta) const {
  if (live.shares == 1) return;
  const double factor = 1 / live.shares;
  for (size_t k = 0; k < bins_of_knots_.size(); ++k) live.relative[k] *= factor, live.throughput[k] *= factor;
  for (float& b : beta) b = static_cast<float>(b * factor);
  live.shares_before *= factor;
  live.shares = 1;
}

void Flights::add_depths(const Ray& ray, double length, uint32_t background, std::span<double> depth) {
  walk_.start(field_, ray.origin, ray.direction, length, background, ray.time);
  while (walk_.next())
    for (const Constituent& c : walk_.contents())
      depth[c.medium] += c.density * std::min(walk_.end() - walk_.begin(), kEndless);
}

bool Flights::transmittance(std::span<const double> depth, std::span<float> transmission) const {
  bool clear = true;
  for (size_t m = 0; m < depth.size(); ++m) {
    if (!(depth[m] > 0)) continue;
    const float amount = static_cast<float>(depth[m]);
    const BakedMedium& medium = media_[m];
    for (size_t i = 0; i < transmission.size(); ++i) {
      const float tau = amount * (medium.absorption[i] + medium.scattering[i]);
      transmission[i] = clear ? tau : transmission[i] + tau;
    }
    clear = false;
  }
  if (clear) return false;
  for (float& t : transmission) t = std::exp(-t);
  return true;
}

}  // namespace suite
