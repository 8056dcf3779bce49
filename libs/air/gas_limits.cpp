#include "air/gas_limits.h"

#include "base/error.h"

namespace suite {

std::string GasLimit::text() const {
  std::string out = strf("from %.4g to %.4g um", low_um, high_um);
  if (transmittance.most > 0)
    out += strf(" transmittance is off by %.2g rms (mean %+.2g), up to %.2g;", transmittance.rms, bias,
                transmittance.most);
  if (kelvin_down.most > 0)
    out += strf(" brightness from space over a ground of 299 K is off by %.2g K rms, up to %.2g K, straight down",
                kelvin_down.rms, kelvin_down.most);
  if (kelvin_slanted.most > 0)
    out += strf(", by %.2g K rms, up to %.2g K, on slanted paths", kelvin_slanted.rms, kelvin_slanted.most);
  if (out.back() == ';') out.pop_back();
  if (!cause.empty()) out += " (" + cause + ")";
  return out;
}

}  // namespace suite
