#include "water/waves.h"

#include <algorithm>
#include <cmath>

#include "math/sampling.h"

namespace suite {

namespace {

constexpr double kGravity = 9.80665, kCapillary = 370, kSlowest = 0.23;  // m/s2, rad/m, m/s: waves of least speed

double speed(double k) { return std::sqrt(kGravity / k * (1 + k * k / (kCapillary * kCapillary))); }

// dw / dk times S(w), gravity waves in deep water.
double from_frequency(double k, double of_frequency) { return of_frequency * 0.5 * std::sqrt(kGravity / k); }

double moskowitz(const SeaState& s, double k) {
  const double w0 = kGravity / (1.026 * s.wind_m_s), w = std::sqrt(kGravity * k);  // wind at 19.5 m
  return from_frequency(k, 8.1e-3 * kGravity * kGravity * std::pow(w, -5) * std::exp(-0.74 * std::pow(w0 / w, 4)));
}

double jonswap_peak(const SeaState& s) {
  return 22 * std::cbrt(kGravity * kGravity / (s.wind_m_s * s.fetch_m));  // rad/s
}
double jonswap(const SeaState& s, double k) {
  const double peak = jonswap_peak(s), w = std::sqrt(kGravity * k), width = w < peak ? 0.07 : 0.09;
  const double level = 0.076 * std::pow(s.wind_m_s * s.wind_m_s / (s.fetch_m * kGravity), 0.22);
  const double bump = std::exp(-0.5 * std::pow((w - peak) / (width * peak), 2));
  return from_frequency(
      k, level * kGravity * kGravity * std::pow(w, -5) * std::exp(-1.25 * std::pow(peak / w, 4)) * std::pow(3.3, bump));
}

// What the unified spectrum is made of (equations 30 to 57 of the paper).
struct Elfouhaily {
  double age, peak, friction;  // inverse wave age, rad/m, m/s
  explicit Elfouhaily(const SeaState& s) {
    const double k0 = kGravity / (s.wind_m_s * s.wind_m_s);
    age = 0.84 * std::pow(std::tanh(std::pow(k0 * s.fetch_m / 2.2e4, 0.4)), -0.75);
    peak = k0 * age * age;
    friction = s.wind_m_s * std::sqrt((0.8 + 0.065 * s.wind_m_s) * 1e-3);  // J. Wu, 1980
  }
  double at(double k) const {
    const double c = speed(k), root = std::sqrt(k / peak);
    const double width = 0.08 * (1 + 4 * std::pow(age, -3)), height = age <= 1 ? 1.7 : 1.7 + 6 * std::log10(age);
    const double bump = std::pow(height, std::exp(-0.5 * std::pow((root - 1) / width, 2)));
    const double onset = std::exp(-1.25 * std::pow(peak / k, 2)) * bump;
    const double low =
        0.5 * 6e-3 * std::sqrt(age) * speed(peak) / c * onset * std::exp(-age / std::sqrt(10.0) * (root - 1));
    const double ratio = std::log(friction / kSlowest), level = 0.01 * (1 + (ratio < 0 ? 1 : 3) * ratio);
    const double high =
        0.5 * std::max(0.0, level) * kSlowest / c * onset * std::exp(-0.25 * std::pow(k / kCapillary - 1, 2));
    return (low + high) / (k * k * k);
  }
  // D of the spreading (1 + D cos(2 a)) / (2 pi).
  double spreading(double k) const {
    const double c = speed(k);
    return std::tanh(0.25 * std::log(2.0) + 4 * std::pow(c / speed(peak), 2.5) +
                     0.13 * friction / kSlowest * std::pow(kSlowest / c, 2.5));
  }
};

// Heading, from that of the wind, with the share u of all headings below it, -pi / 2 to pi / 2: by bisection of
// (a + pi / 2 + d sin(2 a) / 2) / pi; d = 1 is cos^2.
double heading(double d, double u) {
  double low = -kPi / 2, high = kPi / 2;
  for (int step = 0; step < 50; ++step) {
    const double a = 0.5 * (low + high);
    ((a + kPi / 2 + 0.5 * d * std::sin(2 * a)) / kPi < u ? low : high) = a;
  }
  return 0.5 * (low + high);
}

// Of k^power times the spectrum, midpoints in the logarithm.
double moment(const SeaState& s, double low, double high, double power) {
  if (!(high > low)) return 0;
  constexpr int steps = 4000;
  const double step = std::log(high / low) / steps;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double k = low * std::exp((i + 0.5) * step);
    sum += wave_spectrum(s, k) * std::pow(k, power + 1) * step;
  }
  return sum;
}

}  // namespace

void check_sea_state(const SeaState& s, const Where& where) {
  const auto check = [&](const char* what, double value, double low, double high, const char* unit) {
    if (!(value >= low && value <= high))
      throw Error(where, strf("waves: %s %g", what, value), strf("%g to %g %s", low, high, unit), "SP101");
  };
  if (s.wind_m_s != 0) check("wind_m_s", s.wind_m_s, 0.5, 40, "m/s, or 0 for flat water");
  check("fetch_m", s.fetch_m, 100, 1e7, "m");
  check("depth_m", s.depth_m, 0.01, 12000, "m");
}

double wave_spectrum(const SeaState& s, double k) {
  if (!(k > 0) || k > kShortestWave || s.wind_m_s == 0) return 0;
  if (s.spectrum == WaveSpectrum::pierson_moskowitz) return moskowitz(s, k);
  return s.spectrum == WaveSpectrum::jonswap ? jonswap(s, k) : Elfouhaily(s).at(k);
}

double peak_wave_number(const SeaState& s) {
  if (s.wind_m_s == 0) return 0;
  if (s.spectrum == WaveSpectrum::elfouhaily) return Elfouhaily(s).peak;
  const double w = s.spectrum == WaveSpectrum::jonswap ? jonswap_peak(s)
                                                       : std::pow(0.8 * 0.74, 0.25) * kGravity / (1.026 * s.wind_m_s);
  return w * w / kGravity;
}

double wave_frequency(const SeaState& s, double k) { return k * speed(k) * std::sqrt(std::tanh(k * s.depth_m)); }

double height_variance(const SeaState& s, double low, double high) { return moment(s, low, high, 0); }
double slope_variance(const SeaState& s, double low, double high) { return moment(s, low, high, 2); }

Waves::Waves(const SeaState& s, double shortest, size_t count, uint64_t seed) {
  if (s.wind_m_s == 0) return;
  const double longest = 0.2 * peak_wave_number(s), step = std::log(shortest / longest) / static_cast<double>(count);
  const bool unified = s.spectrum == WaveSpectrum::elfouhaily;
  Pcg32 random(seed, 0x7761766573);
  const double turn = random.uniform();
  for (size_t i = 0; i < count; ++i) {
    const double low = longest * std::exp(step * static_cast<double>(i)), high = low * std::exp(step);
    const double k = low * std::exp(step * random.uniform());
    // Headings of neighbours in length are far apart: multiples of the golden ratio.
    const double u = std::fmod(turn + 0.6180339887498949 * static_cast<double>(i), 1.0);
    const double a = s.toward + heading(unified ? Elfouhaily(s).spreading(k) : 1, u);
    // The variance of the class, by three points.
    const double middle = std::sqrt(low * high);
    const double variance = step / 6 *
                            (low * wave_spectrum(s, low) + 4 * middle * wave_spectrum(s, middle) +
                             high * wave_spectrum(s, std::min(high, kShortestWave)));
    waves_.push_back(
        {k * std::cos(a), k * std::sin(a), wave_frequency(s, k), 2 * kPi * random.uniform(), std::sqrt(2 * variance)});
  }
}

double Waves::height(double x, double y, double time) const {
  double sum = 0;
  for (const Wave& w : waves_) sum += w.amplitude * std::cos(w.kx * x + w.ky * y - w.frequency * time + w.phase);
  return sum;
}

void Waves::row(double x, double y, double step, double time, std::span<float> heights) const {
  std::vector<double> sum(heights.size(), 0);
  for (const Wave& w : waves_) {
    // A pointer of the wave's length that turns by the same angle at every step.
    const double start = w.kx * x + w.ky * y - w.frequency * time + w.phase;
    const double turn_c = std::cos(w.kx * step), turn_s = std::sin(w.kx * step);
    double c = w.amplitude * std::cos(start), s = w.amplitude * std::sin(start);
    for (double& z : sum) {
      z += c;
      const double next = c * turn_c - s * turn_s;
      s = c * turn_s + s * turn_c;
      c = next;
    }
  }
  for (size_t i = 0; i < sum.size(); ++i) heights[i] = static_cast<float>(sum[i]);
}

double Waves::variance() const {
  double sum = 0;
  for (const Wave& w : waves_) sum += 0.5 * w.amplitude * w.amplitude;
  return sum;
}

}  // namespace suite
