// InGaAs photodiodes for 0.9 to 1.7 um: a charge detector whose dark current follows from its temperature.
// Based on: A. Rogalski, "Infrared Detectors", 2nd ed. 2010 (dark current of InGaAs by temperature).
#include <cmath>

#include "sensor/detectors/ccd.h"
#include "sensor/detectors/detectors.h"

namespace suite {

ArrayDetectorRow ingaas_row() {
  return {"ingaas", "InGaAs photodiodes: a dark current that doubles every few kelvin (Rogalski 2010)", "DN",
          [](const Params& p, DetectorSpec& d) {
            read_pixels(p, "dark_current_e_s", d);
            const double reference = p.number_in("dark_reference_k", 50, 400, "K", 293.15),
                         doubling = p.number_in("dark_doubling_k", 1, 100, "K", 7.5),
                         temperature = p.number_in("temperature_k", 50, 400, "K", reference);
            d.dark_current *= std::exp2((temperature - reference) / doubling);
            if (!(d.dark_current <= kMostElectrons))
              throw p.at("temperature_k")
                  .error(strf("a dark current of %.3g electrons/s", d.dark_current),
                         strf("at most %g: a lower temperature, or less dark current", kMostElectrons));
            read_charge_detector(p, kDarkBias, d);
            return make_charge_detector(d);
          }};
}

}  // namespace suite
