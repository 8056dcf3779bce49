#include "detection/front_end.h"

#include <algorithm>
#include <cmath>

namespace suite {

FrontEnd read_front_end(const Params& p) {
  FrontEnd f;
  f.rates.efficiency = p.number_in("quantum_efficiency", 0, 1, "electrons per photon");
  f.rates.dark = p.number_in("dark_rate_hz", 0, 1e15, "electrons/s", 0);
  f.gain = p.number_in("gain", 1, 1e6, "", 1);
  if (p.has("excess_noise") && p.has("ionisation_ratio"))
    throw p.error("excess_noise and ionisation_ratio say the same", "one of them");
  f.excess = p.number_in("excess_noise", 1, 1e4, "", 1);
  if (const auto k = p.find("ionisation_ratio")) f.excess = excess_noise(k->as_number_in(0, 1, ""), f.gain);
  f.receiver_fwhm = p.number_in("receiver_fwhm_ns", 0, 1e6, "ns", 0) * 1e-9;
  return f;
}

namespace {

// Shares of an electron's answer in the samples about its own; odd in number, sum 1.
std::vector<double> answer_of(double fwhm, double step) {
  if (!(fwhm > 0)) return {1};
  const PulseShape shape = PulseShape::gaussian(fwhm);
  const auto reach = static_cast<long>(std::min(1e5, std::ceil(shape.high() / step)));
  std::vector<double> shares;
  for (long j = -reach; j <= reach; ++j)
    shares.push_back(shape.before((static_cast<double>(j) + 0.5) * step) -
                     shape.before((static_cast<double>(j) - 0.5) * step));
  return shares;
}

std::vector<double> filtered(const std::vector<double>& in, const std::vector<double>& shares, bool squared) {
  if (shares.size() == 1) return in;
  const auto reach = static_cast<std::ptrdiff_t>(shares.size() / 2), n = static_cast<std::ptrdiff_t>(in.size());
  std::vector<double> out(in.size(), 0);
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    if (in[static_cast<size_t>(k)] == 0) continue;
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(0, k - reach); j <= std::min(n - 1, k + reach); ++j) {
      const double s = shares[static_cast<size_t>(j - k + reach)];
      out[static_cast<size_t>(j)] += in[static_cast<size_t>(k)] * (squared ? s * s : s);
    }
  }
  return out;
}

}  // namespace

Voltage pass(const FrontEnd& f, const Expected& e, Pcg32& random) {
  const std::vector<double> answer = answer_of(f.receiver_fwhm, e.grid.step);
  const size_t n = e.grid.count;
  Voltage v;
  v.grid = e.grid, v.level = e.background * f.gain;
  std::vector<double> mean(n), spread(n), electrons(n), paths(n), white(n, 0);
  for (size_t k = 0; k < n; ++k) {
    const double primaries = e.signal[k] + e.background;
    mean[k] = e.signal[k] * f.gain;
    spread[k] = primaries * f.gain * f.gain * f.excess;
    paths[k] = e.variance[k] * f.gain * f.gain;
    // Background is even: only what differs from it is passed through the filter, so that the ends have none.
    if (f.amplifier_noise > 0) white[k] = normal(random);
    electrons[k] = avalanche(poisson(primaries, random), f.gain, f.excess, random) - v.level;
  }
  v.signal = filtered(mean, answer, false);
  v.noisy = filtered(electrons, answer, false);
  const std::vector<double> squares = filtered(spread, answer, true), errors = filtered(paths, answer, true);
  double power = 0;  // of white noise that the receiver lets through
  for (const double s : answer) power += s * s;
  v.correlation = 1 / power;
  const std::vector<double> amplifier = filtered(white, answer, false);
  for (size_t k = 0; k < n; ++k) {
    v.ideal.push_back(v.signal[k] + v.level);
    v.error.push_back(std::sqrt(errors[k]));
    v.noise.push_back(std::sqrt(squares[k] + f.amplifier_noise * f.amplifier_noise));
    v.noisy[k] += v.level + f.amplifier_noise * amplifier[k] / std::sqrt(power);
  }
  return v;
}

Discriminator read_discriminator(const Params& params, const char* unit, double scale, double width) {
  Discriminator d;
  const auto p = params.find("returns");
  if (!p) return d;
  constexpr Discriminator::By kinds[] = {Discriminator::By::none, Discriminator::By::threshold,
                                         Discriminator::By::constant_fraction, Discriminator::By::gaussian};
  d.by = kinds[p->at("by").as_choice({"none", "threshold", "constant_fraction", "gaussian"})];
  if (d.by == Discriminator::By::none) return d;
  const std::string level = std::string("threshold_") + unit, hysteresis = std::string("hysteresis_") + unit;
  const double asked = p->number_in(level, 1e-9, 1e15, unit);
  d.threshold.level = asked * scale;
  d.threshold.most =
      static_cast<size_t>(p->integer("most", 1, 65535, d.by == Discriminator::By::gaussian ? 32 : 65535));
  if (d.by == Discriminator::By::gaussian) {
    if (d.threshold.most > 64) throw p->at("most").error("at most 64 Gaussians are fitted", "most: 16");
    d.decompose.least_amplitude = d.threshold.level, d.decompose.most = d.threshold.most;
    d.decompose.least_width = width * p->number_in("least_width", 0.5, 10, "of the system's width", 0.9);
    return d;
  }
  d.threshold.hysteresis = p->number_in(hysteresis, 0, asked, unit, 0) * scale;
  d.threshold.dead = p->number_in("dead_time_ns", 0, 1e9, "ns", 0) * 1e-9;
  if (d.by != Discriminator::By::constant_fraction) return d;
  d.fraction = p->number_in("fraction", 0.01, 0.99, "");
  d.delay = p->number_in("delay_ns", 1e-6, 1e6, "ns") * 1e-9;
  return d;
}

namespace {
constexpr size_t kMostDecomposed = 200000;  // samples: some seconds a waveform
}

std::vector<LidarReturn> tell_returns(const Discriminator& d, std::span<const double> values,
                                      std::span<const double> noise, const SampleGrid& grid) {
  switch (d.by) {
    case Discriminator::By::none:
      return {};
    case Discriminator::By::threshold:
      return leading_edges(values, grid, d.threshold);
    case Discriminator::By::constant_fraction:
      return constant_fractions(values, grid, {d.threshold, d.fraction, d.delay});
    case Discriminator::By::gaussian:
      return returns_of(decompose(values, noise, grid, d.decompose));
  }
  return {};
}

void mark_signal(std::vector<LidarReturn>& returns, const Voltage& v, double fwhm) {
  const double reach = std::max(fwhm, v.grid.step);
  for (LidarReturn& r : returns) {
    double signal = 0, samples = 0;
    const double first = std::floor((r.time - reach - v.grid.start) / v.grid.step),
                 last = std::floor((r.time + reach - v.grid.start) / v.grid.step);
    for (double k = std::max(0.0, first); k <= std::min(last, static_cast<double>(v.grid.count) - 1); ++k)
      signal += v.signal[static_cast<size_t>(k)], ++samples;
    r.signal = signal > samples * v.level;
  }
}

}  // namespace suite
