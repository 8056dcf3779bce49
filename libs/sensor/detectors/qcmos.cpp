// CMOS with a read noise far below one electron: counts are rounded to whole electrons. Of a read noise s a share
// erfc(1 / (2 sqrt(2) s)) is rounded to a wrong number.
// Based on: J. Ma, S. Masoodian, D. A. Starkey, E. R. Fossum, "Photon-number-resolving megapixel image sensor at room
// temperature without avalanche gain", Optica 4, 2017.
#include "sensor/detectors/cmos.h"
#include "sensor/detectors/detectors.h"

namespace suite {

ArrayDetectorRow qcmos_row() {
  return {"qcmos", "CMOS that resolves numbers of photoelectrons (Ma et al. 2017)", "DN, counts",
          [](const Params& p, DetectorSpec& d) {
            read_pixels(p, "dark_current_e_s", d);
            read_converter(p, kDarkBias, d);
            return make_cmos(d, read_cmos(p, 0.3), CmosProducts::dn_and_electrons);
          }};
}

}  // namespace suite
