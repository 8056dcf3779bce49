#include "formats/tape7/units.h"

namespace suite {

Tape7Scale tape7_scale(const std::string& column) {
  for (const char* radiance : {"PTH_THRML", "THRML_EM", "THRML_SCT", "SURF_EMIS", "SOL_SCAT", "MULT_SCAT", "SING_SCAT",
                               "SNGL_SCAT", "GRND_RFLT", "DRCT_RFLT", "TOTAL_RAD"})
    if (column == radiance) return {"W/(m2 sr um)", true};
  for (const char* irradiance : {"REF_SOL", "SOL@OBS", "TOA_SUN", "SOL_TR", "SOLAR"})
    if (column == irradiance) return {"W/(m2 um)", true};
  if (column.starts_with("BBODY_T")) return {"K", false};
  return {"1", false};
}

}  // namespace suite
