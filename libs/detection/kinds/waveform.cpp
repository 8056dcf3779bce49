// A waveform digitiser behind an APD: counts of each sample, and returns told from them.
#include <algorithm>
#include <cmath>

#include "detection/front_end.h"

namespace suite {

namespace {

class WaveformDetector : public LidarDetector {
 public:
  WaveformDetector(const Params& p, const PulseShape& pulse)
      : pulse_(pulse), front_(read_front_end(p)), fwhm_(std::hypot(pulse.fwhm(), front_.receiver_fwhm)) {
    front_.amplifier_noise = p.number_in("amplifier_noise_e", 0, 1e9, "electrons of a sample", 0);
    step_ = p.number_in("sample_ns", 1e-4, 1e5, "ns") * 1e-9;
    check_step(p, step_, fwhm_);
    electrons_ = p.number_in("gain_e_per_dn", 1e-9, 1e12, "electrons a count");
    offset_ = p.number_in("offset_dn", 0, 65535, "counts", 0);
    full_ = static_cast<double>((1LL << p.integer("bits", 1, 16)) - 1);
    recovery_ = p.number_in("recovery_ns", 0, 1e6, "ns", 0) * 1e-9;
    const double deviation = std::hypot(pulse.deviation(), front_.receiver_fwhm / kFwhmOfDeviation);
    discriminator_ = read_discriminator(p, "dn", 1, std::hypot(deviation, step_ / std::sqrt(12.0)));
  }
  std::string sample_unit() const override { return "counts"; }
  bool counts_photons() const override { return false; }
  std::vector<PixelRecord> detect(const PulseLight& light, uint64_t key) const override {
    const SampleGrid grid = samples_for(light, step_);
    std::vector<PixelRecord> records;
    for (size_t p = 0; p < light.pixels.size(); ++p) {
      Pcg32 random = stream_of(key, 0, light.pulse, p);
      const PixelLight& pixel = light.pixels[p];
      records.push_back(
          digitise(pass(front_, expect_electrons(pixel.arrivals, pixel.passive, pulse_, front_.rates, grid), random)));
    }
    return records;
  }

 private:
  PixelRecord digitise(const Voltage& v) const {
    PixelRecord r;
    r.grid = v.grid;
    std::vector<double> above(v.grid.count), ideal(v.grid.count), noise(v.grid.count);
    const double base = offset_ + v.level / electrons_;
    double blinded_until = -1;
    for (size_t k = 0; k < v.grid.count; ++k) {
      double dn = std::round(offset_ + v.noisy[k] / electrons_);
      if (dn >= full_ && recovery_ > 0) blinded_until = v.grid.middle(k) + recovery_;
      if (v.grid.middle(k) < blinded_until) dn = full_;
      r.samples.push_back(std::clamp(dn, 0.0, full_));
      r.ideal_samples.push_back(offset_ + v.ideal[k] / electrons_);
      r.ideal_errors.push_back(v.error[k] / electrons_);
      above[k] = r.samples[k] - base, ideal[k] = r.ideal_samples[k] - base;
      noise[k] = std::hypot(v.noise[k] * std::sqrt(v.correlation) / electrons_, 1 / std::sqrt(12.0));
    }
    r.level = base;
    r.level_noise = std::hypot(*std::min_element(v.noise.begin(), v.noise.end()) / electrons_, 1 / std::sqrt(12.0));
    r.returns = tell_returns(discriminator_, above, noise, v.grid);
    r.ideal_returns = tell_returns(discriminator_, ideal, noise, v.grid);
    mark_signal(r.returns, v, fwhm_), mark_signal(r.ideal_returns, v, fwhm_);
    return r;
  }

  PulseShape pulse_;
  FrontEnd front_;
  Discriminator discriminator_;
  double fwhm_, step_ = 0, electrons_ = 1, offset_ = 0, full_ = 0, recovery_ = 0;
};

}  // namespace

LidarDetectorRow waveform_detector_row() {
  return {"waveform", "APD and digitiser: counts of every sample, and returns found in them", "counts",
          [](const Params& p, const PulseShape& pulse) { return std::make_unique<WaveformDetector>(p, pulse); }};
}

}  // namespace suite
