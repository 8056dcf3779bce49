#include <cmath>

#include "base/error.h"
#include "base/files.h"
#include "base/parallel.h"
#include "formats/merl/merl.h"

namespace suite {

std::vector<double> merl_raw(const sqt::Function& function, int phi_d_bins, double fraction) {
  SUITE_CHECK(function.info().wavelength_um.size() == 3 && function.info().isotropic);
  constexpr double scale[3] = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
  const size_t phis = static_cast<size_t>(phi_d_bins), n = size_t{90} * 90 * phis;
  std::vector<double> raw(3 * n, -1.0);
  parallel_for(0, 90, 1, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      for (size_t jk = 0; jk < 90 * phis; ++jk) {
        const MerlPair p = merl_bin_directions(static_cast<int>(i), static_cast<int>(jk / phis),
                                               static_cast<int>(jk % phis), phi_d_bins, fraction);
        if (!(p.in.z > 0 && p.out.z > 0)) continue;
        double f[3];
        function.value(p.out, p.in, f);
        if (!(f[0] >= 0 && f[1] >= 0 && f[2] >= 0)) continue;
        for (size_t c = 0; c < 3; ++c) raw[c * n + i * 90 * phis + jk] = f[c] / scale[c];
      }
  });
  return raw;
}

void write_merl(const std::string& path, const sqt::Function& function, int phi_d_bins, double fraction) {
  const std::vector<double> raw = merl_raw(function, phi_d_bins, fraction);
  const int32_t dims[3] = {90, 90, phi_d_bins};
  AtomicFile file(path);
  file.write(std::as_bytes(std::span(dims)));
  file.write(std::as_bytes(std::span(raw)));
  file.commit();
}

}  // namespace suite
