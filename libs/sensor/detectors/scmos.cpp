// Scientific CMOS: read noise that differs from pixel to pixel (log-normal), telegraph steps, column and row noise.
// Based on: F. Huang et al., "Video-rate nanoscopy using sCMOS camera-specific single-molecule localization
// algorithms",
// Nature Methods 10, 2013 (noise by pixel); X. Wang et al., "Random telegraph signal in CMOS image sensor pixels", IEDM
// 2006 (telegraph steps).
#include "sensor/detectors/cmos.h"
#include "sensor/detectors/detectors.h"

namespace suite {

ArrayDetectorRow scmos_row() {
  return {"scmos", "scientific CMOS: read noise by pixel, telegraph steps, column noise (Huang et al. 2013)", "DN",
          [](const Params& p, DetectorSpec& d) {
            read_pixels(p, "dark_current_e_s", d);
            read_converter(p, kDarkBias, d);
            return make_cmos(d, read_cmos(p, 0), CmosProducts::dn);
          }};
}

}  // namespace suite
