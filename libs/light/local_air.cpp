#include "light/local_air.h"

#include <algorithm>
#include <cmath>

#include "air/phase_grid.h"

namespace suite {

namespace {
constexpr double kLowest = 0.4, kNear = 0.01;  // cosines: of beams that are served, and how far off, relative
}

LocalAir::LocalAir(const AirColumn& column, std::span<const Beam> beams)
    : column_(column),
      beams_(beams.begin(), beams.end()),
      tables_(std::make_unique<Table[]>(beams.size() * column.layers())),
      keeps_scattering_(beams.size() * column.layers() * phase_cosines().size() * column.bins * sizeof(float) <=
                        kMostBytes) {
  const std::span<const double> heights = column.shells.heights();
  const size_t n = column.bins;
  std::vector<double> bottom(n), top(n), beside(n);
  for (const Beam& beam : beams_) {
    const double c = beam.direction.z;
    const bool served = c > kLowest && column.refractivity.empty();
    cosines_.push_back(served ? c : 0);
    std::vector<float>& rows = depths_.emplace_back();
    if (!served) continue;
    const auto from = [&](double height, double cosine, std::span<double> depth) {
      beam_depth(column.shells, heights.front(), column.extinction, column.shells.above_zero(height),
                 {std::sqrt(1 - cosine * cosine), 0, cosine}, depth);
    };
    rows.resize(column.layers() * 3 * n);
    const double aside = c * (1 - kNear), q = c / aside, bend = q * q * q - q;
    from(heights.front(), c, bottom);
    for (size_t l = 0; l < column.layers(); ++l) {
      float* const row = &rows[l * 3 * n];
      from(heights[l], aside, beside);
      from(heights[l + 1], c, top);
      for (size_t i = 0; i < n; ++i) {
        row[i] = static_cast<float>(bottom[i]);
        row[n + i] = static_cast<float>(top[i] - bottom[i]);
        row[2 * n + i] = static_cast<float>((bottom[i] * q - beside[i]) / bend);
      }
      std::swap(bottom, top);
    }
  }
}

std::optional<LocalAir::BeamDepth> LocalAir::depth(double height, double cosine) const {
  for (size_t b = 0; b < cosines_.size(); ++b) {
    const double c = cosines_[b];
    if (!(std::fabs(cosine - c) < kNear * c)) continue;
    const std::span<const double> heights = column_.shells.heights();
    const size_t layer = column_.shells.layer_of(height);
    if (layer == column_.layers()) return std::nullopt;
    const double share = (height - heights[layer]) / (heights[layer + 1] - heights[layer]), q = c / cosine;
    if (share < -1) return std::nullopt;  // the lowest layer goes on below
    const float* const row = &depths_[b][layer * 3 * column_.bins];
    return BeamDepth{row,
                     row + column_.bins,
                     row + 2 * column_.bins,
                     static_cast<float>(share),
                     static_cast<float>(q),
                     static_cast<float>(q - q * q * q)};
  }
  return std::nullopt;
}

void LocalAir::fill(size_t beam, size_t layer, std::vector<float>& rows) const {
  const std::span<const double> cosines = phase_cosines();
  const size_t n = column_.bins;
  rows.assign(cosines.size() * n, 0.0f);
  std::vector<float> phase(n);
  for (size_t a = 0; a < cosines.size(); ++a) {
    float* const row = &rows[a * n];
    for (const AirColumn::Kind& kind : column_.kinds) {
      const float* const scattering = &kind.scattering[layer * n];
      kind.phase->eval(cosines[a], kind.phase->spectrally_uniform() ? std::span(phase).first(1) : std::span(phase));
      if (kind.phase->spectrally_uniform()) std::fill(phase.begin(), phase.end(), phase[0]);
      for (size_t i = 0; i < n; ++i) row[i] += scattering[i] * phase[i];
    }
    for (size_t i = 0; i < n; ++i) row[i] *= beams_[beam].irradiance[i];
  }
}

LocalAir::Scattered LocalAir::scattered(size_t beam, size_t layer, double cosine) const {
  Table& table = tables_[beam * column_.layers() + layer];
  std::call_once(table.once, [&] { fill(beam, layer, table.rows); });
  const std::span<const double> cosines = phase_cosines();
  const auto above = static_cast<size_t>(std::upper_bound(cosines.begin(), cosines.end(), cosine) - cosines.begin());
  const size_t i = std::clamp<size_t>(above, 1, cosines.size() - 1);
  const double share = std::clamp((cosine - cosines[i - 1]) / (cosines[i] - cosines[i - 1]), 0.0, 1.0);
  return {&table.rows[(i - 1) * column_.bins], &table.rows[i * column_.bins], static_cast<float>(share)};
}

}  // namespace suite
