// An APD in linear mode with a discriminator in hardware: returns with times, no waveform.
#include <cmath>

#include "detection/front_end.h"

namespace suite {

namespace {

class LinearDetector : public LidarDetector {
 public:
  LinearDetector(const Params& p, const PulseShape& pulse)
      : pulse_(pulse), front_(read_front_end(p)), fwhm_(std::hypot(pulse.fwhm(), front_.receiver_fwhm)) {
    if (!(fwhm_ > 0)) throw p.error("an impulse through a receiver without a width has no edge", "receiver_fwhm_ns: 1");
    step_ = p.number_in("step_ns", 1e-4, 1e5, "ns", fwhm_ * 1e9 / 20) * 1e-9;
    check_step(p, step_, fwhm_);
    // Levels are currents: what they mean does not depend on the step.
    front_.amplifier_noise = p.number_in("amplifier_noise_e_per_ns", 0, 1e12, "electrons/ns", 0) * step_ * 1e9;
    const double deviation = std::hypot(pulse.deviation(), front_.receiver_fwhm / kFwhmOfDeviation);
    discriminator_ = read_discriminator(p, "e_per_ns", step_ * 1e9, deviation);
    if (discriminator_.by == Discriminator::By::none)
      throw p.error("a linear detector without returns records nothing",
                    "returns: {by: threshold, threshold_e_per_ns: 50}");
  }
  std::string sample_unit() const override { return {}; }
  bool counts_photons() const override { return false; }
  std::vector<PixelRecord> detect(const PulseLight& light, uint64_t key) const override {
    const SampleGrid grid = samples_for(light, step_);
    std::vector<PixelRecord> records;
    for (size_t p = 0; p < light.pixels.size(); ++p) {
      Pcg32 random = stream_of(key, 0, light.pulse, p);
      const PixelLight& pixel = light.pixels[p];
      const Voltage v =
          pass(front_, expect_electrons(pixel.arrivals, pixel.passive, pulse_, front_.rates, grid), random);
      PixelRecord r;
      r.grid = grid;
      r.returns = tell(v.noisy, v), r.ideal_returns = tell(v.ideal, v);
      records.push_back(std::move(r));
    }
    return records;
  }

 private:
  std::vector<LidarReturn> tell(std::vector<double> values, const Voltage& v) const {
    for (double& x : values) x -= v.level;
    std::vector<double> noise = v.noise;
    for (double& n : noise) n = std::max(n * std::sqrt(v.correlation), 1e-6);
    std::vector<LidarReturn> returns = tell_returns(discriminator_, values, noise, v.grid);
    for (LidarReturn& r : returns) r.amplitude /= step_ * 1e9, r.baseline /= step_ * 1e9;
    mark_signal(returns, v, fwhm_);
    return returns;
  }

  PulseShape pulse_;
  FrontEnd front_;
  Discriminator discriminator_;
  double fwhm_, step_ = 0;
};

}  // namespace

LidarDetectorRow linear_detector_row() {
  return {"linear", "APD in linear mode: returns by threshold, constant fraction or Gaussian decomposition", "",
          [](const Params& p, const PulseShape& pulse) { return std::make_unique<LinearDetector>(p, pulse); }};
}

}  // namespace suite
