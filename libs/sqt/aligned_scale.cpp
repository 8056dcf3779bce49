// The scale that gives the decoded trees of the aligned method the totals of the data; see aligned.h.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "sqt/aligned.h"
#include "sqt/portable_math.h"
#include "sqt/theta_grid.h"

namespace suite::sqt {

std::vector<float> fit_scale(const AlignedLayout& layout, const std::vector<AlignedSheet>& sheets,
                             const AlignedTotals& totals, const std::vector<double>& wavelength_um) {
  const size_t channels = layout.channels, count = totals.theta.size() * totals.phi_count;
  const ThetaGrid grid(layout.theta);
  std::vector<float> scale(count * channels, 0.0f);
  parallel_for(0, count, 1, [&](size_t begin, size_t end) {
    std::vector<float> sum(channels);
    for (size_t t = begin; t < end; ++t) {
      const double phi = 2 * kPi * static_cast<double>(t % totals.phi_count) / static_cast<double>(totals.phi_count);
      const double theta = totals.theta[t / totals.phi_count];
      const ThetaGrid::At at = grid.locate(theta);
      const size_t next = std::min(at.low + 1, grid.size() - 1),
                   j = t % totals.phi_count;  // same azimuths in both grids
      const size_t low_view = at.low * layout.phi_count + j, high_view = next * layout.phi_count + j;
      const float w1 = static_cast<float>(at.t), w0 = 1 - w1;
      std::vector<double> integral(channels, 0.0);
      for (size_t s = 0; s < sheets.size(); ++s) {
        const LobeMap map(layout.frame, dir_from_angles(theta, phi), s == 1);
        for (size_t i = 0; i < sheets[s].leaves.size(); ++i) {
          const CellId id = sheets[s].leaves[i];
          // Near the horizon the cosine changes within a leaf, and what lies below does not count: look more closely.
          const double width = std::sqrt(cell_solid_angle(id.order()));
          const double above = layout.cosine_weighted ? map.cosine(direction_in(id, {0.5, 0.5})) : 1;
          if (layout.upper_only && above < -2 * width) continue;
          const int closer = std::clamp(static_cast<int>(6 * width / std::max(std::fabs(above), width)), 1, 4);
          const int usual = id.order() >= 7 ? 1 : id.order() == 6 ? 2 : 1 << std::max(2, 7 - id.order());
          const int side = closer * usual;
          const double area =
              cell_solid_angle(id.order()) / (side * side) * (layout.half_stored && mirrored(id) != id ? 2 : 1);
          const float* leaf = &sheets[s].plane[i * layout.width() * AlignedSheet::kStride];
          const float inverse_side = 1.0f / static_cast<float>(side);
          for (int k = 0; k < side * side; ++k) {
            const double ux = (k % side + 0.5) / side, uy = (k / side + 0.5) / side;
            const Dir d = direction_in(id, {ux, uy});
            const double cosine = map.cosine(d);
            if (layout.upper_only && !(cosine > 0)) continue;
            const double weight = area * map.stretch(d) * (layout.cosine_weighted ? std::fabs(cosine) : 1.0);
            const float dx = static_cast<float>(ux - 0.5), dy = static_cast<float>(uy - 0.5);
            for (size_t c = 0; c < channels; ++c) {
              const float* a = leaf + (low_view * channels + c) * AlignedSheet::kStride;
              const float* b = leaf + (high_view * channels + c) * AlignedSheet::kStride;
              const float gx = w0 * a[1] + w1 * b[1], gy = w0 * a[2] + w1 * b[2];
              integral[c] += weight * portable_exp2(w0 * a[0] + w1 * b[0] + dx * gx + dy * gy) *
                             mean_exp2(gx * inverse_side) * mean_exp2(gy * inverse_side);
            }
          }
        }
      }
      for (size_t c = 0; c < channels; ++c) {
        const size_t k = static_cast<size_t>(
            std::lower_bound(totals.magnitude_um.begin(), totals.magnitude_um.end(), wavelength_um[c]) -
            totals.magnitude_um.begin());
        const double W = totals.magnitudes[t * totals.magnitude_um.size() + k];
        scale[t * channels + c] = W > 0 && integral[c] > 0
                                      ? static_cast<float>(std::clamp(std::log2(W / integral[c]), -100.0, 100.0))
                                      : -100.0f;
      }
    }
  });
  return scale;
}

}  // namespace suite::sqt
