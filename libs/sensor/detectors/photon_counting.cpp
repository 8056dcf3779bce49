// An electron-multiplying CCD behind a threshold: a pixel counts one in each of several short frames in which its
// charge, with read noise, is above it. Of n electrons a frame, P = 1 - exp(-n) for a threshold that all pass.
// Based on: A. G. Basden, C. A. Haniff, C. D. Mackay, "Photon counting strategies with low-light-level CCDs", MNRAS
// 345, 2003.
#include "base/interrupt.h"
#include "math/variates.h"
#include "sensor/detectors/detectors.h"
#include "sensor/detectors/register.h"

namespace suite {

namespace {

struct Threshold {
  double electrons = 0;  // behind the register
  uint32_t frames = 1;   // that share the exposure
};

constexpr double kGrace = 0.5;  // s, that a read-out may take to its end when a signal came

class CountingCcd final : public ArrayDetector {
 public:
  CountingCcd(const DetectorSpec& spec, const RegisterKeys& keys, Threshold threshold)
      : d_(spec), register_(keys), threshold_(threshold) {}
  ArrayReading read(const ArrayLight& light) const override {
    ArrayReading out = empty_reading(light.size(), false, true);
    for (size_t i = 0; i < light.size(); ++i) {
      if (i % 1024 == 0) stop_point(kGrace);
      const Character c = character_of(d_, light.sites[i]);
      if (c.hot) out.counts[i] = threshold_.frames;
      if (c.dead || c.hot) continue;
      Pcg32 random(hash_of(d_.seed, kNoiseStream), light.key(i));
      const double mean = collected(d_, c, light.electrons[i], light.exposure) / threshold_.frames;
      for (uint32_t f = 0; f < threshold_.frames; ++f)
        if (above(poisson(mean + register_.clock_induced, random), random)) ++out.counts[i];
    }
    return out;
  }
  // What counts say at a low rate; where frames saturate the noise is larger.
  DetectorNoise noise(double exposure, double) const override {
    return {d_.dark_current * exposure + threshold_.frames * register_.clock_induced, 1};
  }

 private:
  bool above(double electrons, Pcg32& random) const {
    const double charge = register_.charge(electrons, random);
    const double noise = register_.read_noise > 0 ? register_.read_noise * normal(random) : 0;
    return charge + noise > threshold_.electrons;
  }
  DetectorSpec d_;
  RegisterKeys register_;
  Threshold threshold_;
};

}  // namespace

ArrayDetectorRow photon_counting_row() {
  return {"photon_counting", "electron-multiplying CCD behind a threshold (Basden, Haniff & Mackay 2003)", "counts",
          [](const Params& p, DetectorSpec& d) {
            read_pixels(p, "dark_current_e_s", d);
            Threshold t;
            t.electrons = p.number_in("threshold_e", 0, 1e9, "electrons behind the register");
            t.frames = static_cast<uint32_t>(p.integer("frames", 1, 4096, 1));
            return std::make_shared<CountingCcd>(d, read_register(p), t);
          }};
}

}  // namespace suite
