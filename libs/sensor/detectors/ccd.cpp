// counts = (Poisson(signal + dark) + Gauss(read noise)) / gain + bias.
// Based on: J. R. Janesick, "Photon Transfer", SPIE 2007.
#include "sensor/detectors/ccd.h"

#include <cmath>

#include "math/variates.h"
#include "sensor/detectors/detectors.h"

namespace suite {

namespace {

class ChargeDetector final : public ArrayDetector {
 public:
  explicit ChargeDetector(const DetectorSpec& spec) : d_(spec) {}
  ArrayReading read(const ArrayLight& light) const override {
    ArrayReading out = empty_reading(light.size(), true, false);
    for (size_t i = 0; i < light.size(); ++i) {
      const Character c = character_of(d_, light.sites[i]);
      if (c.hot) out.dn[i] = most_counts(d_);
      if (c.dead || c.hot) continue;
      Pcg32 random(hash_of(d_.seed, kNoiseStream), light.key(i));
      const double mean = collected(d_, c, light.electrons[i], light.exposure);
      double charge = d_.shot_noise ? poisson(mean, random) : mean;
      const bool full = d_.full_well > 0 && charge > d_.full_well;
      if (full) charge = d_.full_well;
      if (d_.read_noise > 0 || light.more > 0) charge += std::hypot(d_.read_noise, light.more) * normal(random);
      const Converted converted = convert(d_, charge);
      out.dn[i] = converted.counts;
      out.clipped[i] = full || converted.clipped;
    }
    return out;
  }
  DetectorNoise noise(double exposure, double) const override {
    const double dark = d_.shot_noise ? d_.dark_current * exposure : 0;
    return {dark + d_.read_noise * d_.read_noise + d_.gain * d_.gain / 12, d_.shot_noise ? 1.0 : 0.0};
  }

 private:
  DetectorSpec d_;
};

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

void read_charge_detector(const Params& p, double bias, DetectorSpec& d) {
  read_converter(p, bias, d);
  d.read_noise = p.number_in("read_noise_e", 0, kMostElectrons, "electrons", 0);
  d.shot_noise = p.boolean("shot_noise", true);
  if (const auto background = p.find("background_k")) d.background = background->as_number_in(20, 5000, "K");
  if (const auto netd = p.find("netd_k")) {
    d.netd = netd->as_number_in(1e-6, 100, "K");
    if (!(d.background > 0)) throw netd->error("a NETD is of a background", "background_k: 300");
  }
}

std::shared_ptr<const ArrayDetector> make_charge_detector(const DetectorSpec& d) {
  return std::make_shared<ChargeDetector>(d);
}

ArrayDetectorRow ccd_row() {
  return {"ccd", "CCD or CMOS: shot noise, dark current, read noise (Janesick 2007); the default", "DN",
          [](const Params& p, DetectorSpec& d) -> std::shared_ptr<const ArrayDetector> {
            if (!p.has("gain_e_per_dn")) {
              refuse_without_counts(p);
              return nullptr;
            }
            read_pixels(p, "dark_current_e_s", d);
            read_charge_detector(p, 0, d);
            return make_charge_detector(d);
          }};
}

}  // namespace suite
