#include "transport/stokes_throughputs.h"

#include <algorithm>

namespace suite {

StokesThroughputs::StokesThroughputs(size_t width, size_t bins, size_t targets)
    : SpectralThroughputs(width, bins, targets),
      rows_(width * bins),
      grey_(width, 1),
      unknown_(width),
      spectrum_(4 * bins) {}

void StokesThroughputs::begin_rows(uint32_t p, const Mueller& sensor) {
  rows_[p * bins()] = sensor;
  grey_[p] = 1;
  unknown_[p] = 0;
}

void StokesThroughputs::keep(uint32_t p, float share, Kept& to) {
  SpectralThroughputs::keep(p, share, to);
  const auto rows = rows_.begin() + static_cast<std::ptrdiff_t>(p * bins());
  to.rows.assign(rows, rows + static_cast<std::ptrdiff_t>(grey_[p] ? 1 : bins()));
  to.unknown = unknown_[p];
}

void StokesThroughputs::resume(uint32_t p, const Kept& from) {
  SpectralThroughputs::resume(p, from);
  std::copy(from.rows.begin(), from.rows.end(), rows_.begin() + static_cast<std::ptrdiff_t>(p * bins()));
  grey_[p] = from.rows.size() == 1;
  unknown_[p] = from.unknown;
}

void StokesThroughputs::multiply(uint32_t p, const PolarisedEvent& event) {
  Mueller* const rows = &rows_[p * bins()];
  unknown_[p] = 1 - (1 - unknown_[p]) * (1 - event.unknown);
  if (event.matrices.size() > 1 && grey_[p]) {
    std::fill(rows + 1, rows + bins(), rows[0]);
    grey_[p] = 0;
  }
  const bool one = event.matrices.size() == 1;
  for (size_t b = 0; b < (grey_[p] ? 1 : bins()); ++b) rows[b] = rows[b] * event.matrices[one ? 0 : b];
}

Stokes StokesThroughputs::seen(const Contribution& c, size_t bin, const Stokes& light) const {
  const Mueller& rows = rows_[c.path * bins() + (grey_[c.path] ? 0 : bin)];
  if (!c.polarised) return rows * light;
  return rows * (c.polarised->matrices[c.polarised->matrices.size() == 1 ? 0 : bin] * light);
}

void StokesThroughputs::shine_stokes(const Contribution& c, float scale, const Targets& targets) {
  const uint32_t p = c.path;
  const Stokes light = c.source ? *c.source : Stokes{1, 0, 0, 0};
  const bool grey = grey_[p] && (!c.polarised || c.polarised->matrices.size() == 1);
  if (grey) {
    const Stokes s = seen(c, 0, light);
    for (size_t k = 0; k < 4; ++k)
      if (targets.of[k] != kNone && s[k] != 0)
        shine(p, c.factor, scale * static_cast<float>(s[k]), c.radiance, targets.of[k]);
    return;
  }
  for (size_t b = 0; b < bins(); ++b) {
    const Stokes s = seen(c, b, light);
    for (size_t k = 0; k < 4; ++k) spectrum_[k * bins() + b] = static_cast<float>(s[k]);
  }
  for (size_t k = 0; k < 4; ++k)
    if (targets.of[k] != kNone)
      shine_now(p, c.factor, scale, c.radiance, {&spectrum_[k * bins()], bins()}, targets.of[k]);
}

}  // namespace suite
