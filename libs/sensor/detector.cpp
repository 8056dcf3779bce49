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

void read_light(const Params& p, const SensorContext& context, DetectorSpec& d) {
  const Params qe = p.at("quantum_efficiency");
  d.quantum_efficiency = context.curve(qe);
  if (!is_share(d.quantum_efficiency.min()) || !is_share(d.quantum_efficiency.max()))
    throw qe.error("the quantum efficiency leaves 0..1", "electrons per photon");
  d.fill_factor = p.number_in("fill_factor", 1e-6, 1, "(share of the pitch's area)", 1);
}

void read_pixels(const Params& p, const char* dark, DetectorSpec& d) {
  d.dark_current = p.number_in(dark, 0, kMostElectrons, "electrons/s", 0);
  d.nonuniformity = p.number_in("prnu", 0, 1, "(relative standard deviation)", 0);
  d.dark_nonuniformity = p.number_in("dark_nonuniformity", 0, 10, "(relative standard deviation)", 0);
  d.dead = p.number_in("dead_fraction", 0, 1, "(share of the detectors)", 0);
  d.hot = p.number_in("hot_fraction", 0, 1 - d.dead, "(share of the detectors)", 0);
  if (const auto bad = p.find("bad_pixels"))
    for (const Params& item : bad->items()) {
      const std::vector<double> at = item.as_numbers();
      if (at.size() != 2 || at[0] < 0 || at[1] < 0 || at[0] != std::floor(at[0]) || at[1] != std::floor(at[1]) ||
          at[0] > 1e9 || at[1] > 1e9)
        throw item.error("a bad pixel is [column, row], counted from 0");
      d.bad.push_back({static_cast<uint32_t>(at[0]), static_cast<uint32_t>(at[1])});
    }
  d.seed = static_cast<uint64_t>(p.integer("seed", 0, 1LL << 53, 1));
}

void read_converter(const Params& p, double bias, DetectorSpec& d) {
  d.gain = p.number_in("gain_e_per_dn", 1e-9, kMostElectrons, "electrons per count");
  d.full_well = p.number_in("full_well_e", 0, kMostElectrons, "electrons", 0);
  d.bias = p.number_in("bias_dn", 0, 65535, "counts", bias);
  d.bits = static_cast<int>(p.integer("bits", 1, 16, 16));
}

}  // namespace suite
