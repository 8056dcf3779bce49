#include "sensor/detectors/register.h"

#include <algorithm>
#include <cmath>

#include "math/variates.h"

namespace suite {

double Register::gain_of(int stages) const { return std::exp(stages * std::log1p(p_)); }

double Register::pass(double electrons, int left, Pcg32& random) const {
  double n = electrons;
  while (n > 0 && n < kMany && left > 0 && p_ > 0) {
    // Stages in which none of n doubles are a geometric variate.
    const double none = n * std::log1p(-p_), skipped = std::floor(std::log(1 - random.uniform()) / none);
    if (skipped >= left) return n;
    left -= static_cast<int>(skipped) + 1;
    // Of those that double in the next one, at least one: a binomial variate, by inversion.
    double share = std::exp(none), sum = share;
    const double wanted = sum + random.uniform() * (1 - sum);
    double doubled = 0;
    while (wanted > sum && doubled < n) {
      share *= (n - doubled) / (doubled + 1) * p_ / (1 - p_);
      sum += share;
      ++doubled;
    }
    n += std::max(1.0, doubled);
  }
  if (!(n > 0) || left == 0 || p_ == 0) return n;
  const double spread = spread_of(left);
  return gamma_variate(n / spread, gain_of(left) * spread, random);
}

double RegisterKeys::charge(double electrons, Pcg32& random) const {
  double charge = stages.multiply(electrons, random);
  for (double k = poisson(serial_clock_induced, random); k > 0; --k) {
    const int left = static_cast<int>(random.uniform() * stages.stages());
    charge += stages.from_stage(left, random);
  }
  return full_well > 0 ? std::min(charge, full_well) : charge;
}

double RegisterKeys::serial_gain() const {
  // Mean of (1 + p)^k over k = 0 ... N - 1.
  const double p = std::pow(stages.gain(), 1.0 / stages.stages()) - 1;
  return p > 0 ? (stages.gain() - 1) / (p * stages.stages()) : 1;
}

RegisterKeys read_register(const Params& p) {
  RegisterKeys r;
  const auto stages = static_cast<int>(p.integer("stages", 1, 100000, 604));
  if (p.has("em_gain") && p.has("stage_probability"))
    throw p.at("stage_probability").error("em_gain and stage_probability say the same", "one of them");
  double probability = 0;
  if (const auto of_stage = p.find("stage_probability")) {
    probability = of_stage->as_number_in(0, 0.5, "(of one stage)");
  } else {
    const Params gain = p.at("em_gain");
    probability = std::expm1(std::log(gain.as_number_in(1, 1e5, "(electrons for one)")) / stages);
    if (probability > 0.5)
      throw gain.error(strf("%d stages make at most a gain of %.3g", stages, std::pow(1.5, stages)), "more stages");
  }
  r.stages = Register(stages, probability);
  if (!(r.stages.gain() <= 1e5))
    throw p.at("stage_probability").error(strf("a gain of %.3g", r.stages.gain()), "at most 1e5");
  r.clock_induced = p.number_in("clock_induced_e", 0, 1e4, "electrons a read-out", 0);
  r.serial_clock_induced = p.number_in("serial_clock_induced_e", 0, 100, "electrons a read-out", 0);
  r.full_well = p.number_in("register_full_well_e", 0, 1e12, "electrons", 0);
  r.read_noise = p.number_in("read_noise_e", 0, 1e12, "electrons", 0);
  return r;
}

}  // namespace suite
