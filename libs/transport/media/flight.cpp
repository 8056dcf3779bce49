#include "transport/media/flight.h"

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

Flights::Result Flights::fly(LivePath& live, double length, uint32_t background, Vec3 u, std::span<float> through,
                             std::span<float> emitted) {
  const size_t own = bins_of_knots_[static_cast<size_t>(live.knot)];
  std::fill(depth_.begin(), depth_.end(), 0.0);
  run_.clear();
  result_ = {false, length};
  if (air_.any()) {
    air_.begin(live);
    std::fill(through.begin(), through.end(), 1.0f);
    result_.dense = true;
  }
  double left = -std::log1p(-u.x);
  walk_.start(field_, live.origin, live.direction, length, background, live.time);
  while (!result_.scattered && walk_.next()) {
    const std::vector<Constituent>& contents = walk_.contents();
    double way = walk_.end() - walk_.begin(), rate = 0;
    for (const Constituent& c : contents) rate += c.density * double{media_[c.medium].scattering[own]};
    if (rate * way > left) {
      way = left / rate;
      result_.scattered = true, result_.distance = walk_.begin() + way;
    } else if (rate > 0) {
      left -= rate * way;
    }
    way = std::min(way, kEndless);
    // Stretches of one medium at one temperature make one run: emission needs only the mass passed.
    const bool same = run_.size() == 1 && contents.size() == 1 && run_[0] == contents[0];
    if (!same) {
      end_run(live, u.y, emitted);
      for (const Constituent& c : contents) run_.push_back({c.medium, 0, c.kelvin});
      run_begin_ = walk_.begin();
    }
    for (size_t c = 0; c < contents.size(); ++c) run_[c].density += contents[c].density * way;
  }
  end_run(live, u.y, emitted);
  if (air_.any()) {
    clear_emitted(emitted);
    air_.finish(result_.distance, depth_, background, live.time, u.z, through, emitted);
  }
  weigh(live, through);
  return result_;
}

void Flights::clear_emitted(std::span<float> emitted) {
  if (!result_.emits) std::fill(emitted.begin(), emitted.end(), 0.0f);
  result_.emits = true;
}

void Flights::end_run(const LivePath& live, double u, std::span<float> emitted) {
  if (any_emission_ && std::any_of(run_.begin(), run_.end(), [&](const Constituent& c) { return emits(c); })) {
    clear_emitted(emitted);
    emit(live, u, emitted);
  }
  pass_run();
}

// What the run emits towards the start of the flight.
void Flights::emit(const LivePath& live, double u, std::span<float> emitted) {
  const size_t n = emitted.size();
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
    emitted[i] += static_cast<float>(std::exp(-absorbed) * reached / tau * emission_[i] * ratio);
  }
}

// Weighs the path for the way in depth_: r_k, the spectrum, the densities that later sources share.
void Flights::weigh(LivePath& live, std::span<float> through) {
  if (std::all_of(depth_.begin(), depth_.end(), [](double d) { return d == 0; })) return;
  const size_t knots = bins_of_knots_.size();
  const size_t own_bin = bins_of_knots_[static_cast<size_t>(live.knot)];
  const double own = scattering_depth(own_bin);
  double own_rate = 1;
  if (result_.scattered) {
    own_rate = 0;
    for (const Constituent& c : walk_.contents()) own_rate += c.density * double{media_[c.medium].scattering[own_bin]};
  }
  const double shares = join_knots(live, result_.scattered, own_rate);
  if (!result_.scattered) live.last_density *= std::exp(-own);
  result_.scale = 1 / (own_rate * shares);
  for (size_t k = 0; k < knots; ++k) live.throughput[k] *= result_.scale;
  const bool spectral = optics_.spectral_flights();
  bool absorbs = false;
  for (size_t m = 0; m < depth_.size(); ++m) absorbs = absorbs || (depth_[m] > 0 && absorbs_[m]);
  if (!absorbs && !spectral) return;
  // Scattering that is the same everywhere cancels exactly.
  std::fill(tau_.begin(), tau_.end(), 0.0f);
  for (size_t m = 0; m < depth_.size(); ++m) {
    if (!(depth_[m] > 0)) continue;
    const float amount = static_cast<float>(depth_[m]);
    const float *absorption = media_[m].absorption.data(), *scattering = media_[m].scattering.data();
    for (size_t i = 0; i < tau_.size(); ++i)
      tau_[i] += amount * (spectral ? absorption[i] + scattering[i] : absorption[i]);
  }
  const double offset = spectral ? own : 0;
  for (size_t k = 0; k < knots; ++k) live.throughput[k] *= std::exp(offset - tau_[bins_of_knots_[k]]);
  for (size_t i = 0; i < through.size(); ++i) {
    const float t = static_cast<float>(std::exp(offset - tau_[i]));
    through[i] = result_.dense ? through[i] * t : t;
  }
  result_.dense = true;
}

// Brings r_k to the end of the way, divided by A; returns A.
double Flights::join_knots(LivePath& live, bool scattered, double own_rate) {
  const size_t knots = bins_of_knots_.size();
  const double own = scattering_depth(bins_of_knots_[static_cast<size_t>(live.knot)]);
  double shares = 0;
  for (size_t k = 0; k < knots; ++k) {
    double rate = own_rate;
    if (scattered) {
      rate = 0;
      for (const Constituent& c : walk_.contents())
        rate += c.density * double{media_[c.medium].scattering[bins_of_knots_[k]]};
    }
    live.relative[k] *= std::exp(own - scattering_depth(bins_of_knots_[k])) * (rate / own_rate);
    shares += probability_[k] * live.relative[k];
  }
  for (size_t k = 0; k < knots; ++k) live.relative[k] /= shares;
  live.before /= shares;
  return shares;
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
