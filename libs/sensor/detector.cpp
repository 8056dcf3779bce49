#include "sensor/detector.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "math/share.h"
#include "spectral/planck.h"

namespace suite {

double g_number(double f_number, double throughput, double obscuration) {
  return (1 + 4 * f_number * f_number) / (throughput * kPi * (1 - obscuration * obscuration));
}

Band photon_band(const Band& band, const Curve& quantum_efficiency, double& electrons) {
  // Knots of both curves, and between them enough points that the product's curvature does not count.
  std::set<double> knots;
  for (const double x : band.response.wavelength_um()) knots.insert(x);
  if (!quantum_efficiency.is_constant())
    for (const double x : quantum_efficiency.wavelength_um())
      if (x > band.low_um() && x < band.high_um()) knots.insert(x);
  std::vector<double> x(knots.begin(), knots.end()), value;
  const double widest = (band.high_um() - band.low_um()) / 512;
  std::vector<double> fine;
  for (size_t i = 0; i + 1 < x.size(); ++i) {
    const int n = std::max(1, static_cast<int>(std::ceil((x[i + 1] - x[i]) / widest)));
    for (int k = 0; k < n; ++k) fine.push_back(x[i] + (x[i + 1] - x[i]) * k / n);
  }
  fine.push_back(x.back());
  for (const double w : fine) value.push_back(band.response.at(w) * quantum_efficiency.at(w) * w);
  Band out = band;
  out.name = band.name + " electrons";
  out.response = Curve(fine, value, Outside::zero);
  electrons = out.response.integral(out.low_um(), out.high_um()) * 1e-6 / (kPlanckConstant * kSpeedOfLight);
  return out;
}

double normal(Pcg32& random) {
  const double u = random.uniform(), v = random.uniform();
  return std::sqrt(-2 * std::log1p(-u)) * std::cos(2 * kPi * v);
}

double poisson(double mean, Pcg32& random) {
  if (!(mean > 0)) return 0;
  if (mean < 30) {
    double p = std::exp(-mean), sum = p;
    const double u = random.uniform();
    int k = 0;
    for (; u > sum && k < 1000; sum += p) p *= mean / ++k;
    return k;
  }
  const double root = std::sqrt(mean), b = 0.931 + 2.53 * root, a = -0.059 + 0.02483 * b;
  const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4), log_mean = std::log(mean),
               squeeze = 0.9277 - 3.6224 / (b - 2);
  for (;;) {
    const double u = random.uniform() - 0.5, v = random.uniform(), us = 0.5 - std::fabs(u);
    const double k = std::floor((2 * a / us + b) * u + mean + 0.43);
    if (us >= 0.07 && v <= squeeze) return k;
    if (k < 0 || (us < 0.013 && v > us)) continue;
    if (std::log(v * inverse_alpha / (a / (us * us) + b)) <= k * log_mean - mean - std::lgamma(k + 1)) return k;
  }
}

Detector::Character Detector::character(uint64_t detector) const {
  Pcg32 random(hash_of(spec_.seed, 0x706978656cull), detector);
  Character c;
  const double kind = random.uniform();
  c.dead = kind < spec_.dead;
  c.hot = !c.dead && kind < spec_.dead + spec_.hot;
  c.response = std::max(0.0, 1 + spec_.nonuniformity * normal(random));
  c.dark = std::max(0.0, 1 + spec_.dark_nonuniformity * normal(random));
  return c;
}

Detector::Reading Detector::read(double electrons, double exposure, const Character& of, uint64_t read_out,
                                 double more) const {
  const double most = std::ldexp(1.0, spec_.bits) - 1;
  if (of.dead) return {};
  if (of.hot) return {static_cast<uint16_t>(most)};
  Pcg32 random(hash_of(spec_.seed, 0x6e6f697365ull), read_out);
  const double mean = std::max(0.0, electrons) * of.response + spec_.dark_current * of.dark * exposure;
  double charge = spec_.shot_noise ? poisson(mean, random) : mean;
  const bool full = spec_.full_well > 0 && charge > spec_.full_well;
  if (full) charge = spec_.full_well;
  if (spec_.read_noise > 0 || more > 0) charge += std::hypot(spec_.read_noise, more) * normal(random);
  const double counts = std::round(charge / spec_.gain + spec_.bias);
  return {static_cast<uint16_t>(std::clamp(counts, 0.0, most)), full || counts < 0 || counts > most};
}

NoiseAtBackground noise_at_background(const DetectorSpec& d, double signal, double slope, double exposure) {
  if (!(slope > 0) || !(signal > 0))
    throw Error(strf("a background of %g K, of which a band sees nothing", d.background),
                "a warmer background_k, or a detector of thermal bands alone");
  NoiseAtBackground n;
  n.slope = slope;
  const double shot = d.shot_noise ? signal + d.dark_current * exposure : 0;
  n.own = std::sqrt(shot + d.read_noise * d.read_noise + d.gain * d.gain / 12);
  const double wanted = d.netd * slope;
  if (d.netd > 0 && wanted < n.own)
    throw Error(strf("a NETD of %g K at %g K, where shot noise, read noise and quantisation make %.3g K", d.netd,
                     d.background, n.own / slope),
                "a larger netd_k, or a detector with more light or less noise");
  if (d.netd > 0) n.more = std::sqrt(wanted * wanted - n.own * n.own);
  return n;
}

namespace {

// Without a step of the converter there is nothing that noise and limits could be seen in.
void refuse_without_counts(const Params& p) {
  for (const char* key :
       {"dark_current_e_s", "read_noise_e", "full_well_e", "bias_dn", "bits", "shot_noise", "prnu",
        "dark_nonuniformity", "dead_fraction", "hot_fraction", "bad_pixels", "seed", "background_k", "netd_k"})
    if (p.has(key))
      throw Error(p.where(key), std::string("'") + key + "' shows in counts alone, and there are none",
                  "gain_e_per_dn, electrons per count");
}

}  // namespace

std::optional<DetectorSpec> read_detector(const Params& params, const SensorContext& context) {
  const auto p = params.find("detector");
  if (!p) return std::nullopt;
  DetectorSpec d;
  const Params qe = p->at("quantum_efficiency");
  d.quantum_efficiency = context.curve(qe);
  if (!is_share(d.quantum_efficiency.min()) || !is_share(d.quantum_efficiency.max()))
    throw qe.error("the quantum efficiency leaves 0..1", "electrons per photon");
  constexpr double many = 1e12;
  d.fill_factor = p->number_in("fill_factor", 1e-6, 1, "(share of the pitch's area)", 1);
  d.gain = p->number_in("gain_e_per_dn", 1e-9, many, "electrons per count", 0);
  if (!d.counts()) {
    refuse_without_counts(*p);
    return d;
  }
  d.dark_current = p->number_in("dark_current_e_s", 0, many, "electrons/s", 0);
  d.read_noise = p->number_in("read_noise_e", 0, many, "electrons", 0);
  d.full_well = p->number_in("full_well_e", 0, many, "electrons", 0);
  d.bias = p->number_in("bias_dn", 0, 65535, "counts", 0);
  d.bits = static_cast<int>(p->integer("bits", 1, 16, 16));
  d.shot_noise = p->boolean("shot_noise", true);
  d.nonuniformity = p->number_in("prnu", 0, 1, "(relative standard deviation)", 0);
  d.dark_nonuniformity = p->number_in("dark_nonuniformity", 0, 10, "(relative standard deviation)", 0);
  d.dead = p->number_in("dead_fraction", 0, 1, "(share of the detectors)", 0);
  d.hot = p->number_in("hot_fraction", 0, 1 - d.dead, "(share of the detectors)", 0);
  if (const auto bad = p->find("bad_pixels"))
    for (const Params& item : bad->items()) {
      const std::vector<double> at = item.as_numbers();
      if (at.size() != 2 || at[0] < 0 || at[1] < 0 || at[0] != std::floor(at[0]) || at[1] != std::floor(at[1]) ||
          at[0] > 1e9 || at[1] > 1e9)
        throw item.error("a bad pixel is [column, row], counted from 0");
      d.bad.push_back({static_cast<uint32_t>(at[0]), static_cast<uint32_t>(at[1])});
    }
  d.seed = static_cast<uint64_t>(p->integer("seed", 0, 1LL << 53, 1));
  if (const auto background = p->find("background_k")) d.background = background->as_number_in(20, 5000, "K");
  if (const auto netd = p->find("netd_k")) {
    d.netd = netd->as_number_in(1e-6, 100, "K");
    if (!(d.background > 0)) throw netd->error("a NETD is of a background", "background_k: 300");
  }
  return d;
}

}  // namespace suite
