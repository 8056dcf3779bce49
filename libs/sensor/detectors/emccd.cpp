// Electron-multiplying CCD: counts = (register(Poisson(signal + dark + clock-induced)) + Gauss(read noise)) / gain +
// bias. Noise: F^2 (signal + dark + clock-induced) + (read noise / G)^2 electrons^2 (Robbins & Hadwen 2003).
#include <algorithm>

#include "math/variates.h"
#include "sensor/detectors/detectors.h"
#include "sensor/detectors/register.h"

namespace suite {

namespace {

class MultiplyingCcd final : public ArrayDetector {
 public:
  MultiplyingCcd(const DetectorSpec& spec, const RegisterKeys& keys) : d_(spec), register_(keys) {}
  ArrayReading read(const ArrayLight& light) const override {
    ArrayReading out = empty_reading(light.size(), true, false);
    for (size_t i = 0; i < light.size(); ++i) {
      const Character c = character_of(d_, light.sites[i]);
      if (c.hot) out.dn[i] = most_counts(d_);
      if (c.dead || c.hot) continue;
      Pcg32 random(hash_of(d_.seed, kNoiseStream), light.key(i));
      double n = poisson(collected(d_, c, light.electrons[i], light.exposure) + register_.clock_induced, random);
      const bool full = d_.full_well > 0 && n > d_.full_well;
      if (full) n = std::floor(d_.full_well);
      const double charge = register_.charge(n, random);
      const bool overflows = register_.full_well > 0 && charge >= register_.full_well;
      const Converted converted = convert(d_, charge + register_.read_noise * normal(random));
      out.dn[i] = converted.counts;
      out.clipped[i] = full || overflows || converted.clipped;
    }
    return out;
  }
  DetectorNoise noise(double exposure, double) const override {
    const double f2 = register_.stages.excess(), G = register_.stages.gain(), read = register_.read_noise / G,
                 step = d_.gain / G;
    return {f2 * (d_.dark_current * exposure + register_.clock_induced) + read * read + step * step / 12, f2};
  }

 private:
  DetectorSpec d_;
  RegisterKeys register_;
};

}  // namespace

ArrayDetectorRow emccd_row() {
  return {"emccd", "electron-multiplying CCD: gain of a register, clock-induced charge (Robbins & Hadwen 2003)", "DN",
          [](const Params& p, DetectorSpec& d) {
            read_pixels(p, "dark_current_e_s", d);
            read_converter(p, kDarkBias, d);
            return std::make_shared<MultiplyingCcd>(d, read_register(p));
          }};
}

}  // namespace suite
