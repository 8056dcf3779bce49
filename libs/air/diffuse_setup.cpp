#include "air/diffuse_setup.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {

constexpr double kLowSun = 0.35;  // cosine: 70 degrees
// Of the table; 19 azimuths over a half circle are carried for 1300 bins in 60 layers, never fewer than 9 (18 around).
constexpr size_t kMostBytes = 256u << 20;

}  // namespace

DiffuseSource::Axes diffuse_axes(const AirColumn& column, std::span<const AirBeam> beams) {
  DiffuseSource::Axes axes;
  axes.cosines = {-1,    -0.9, -0.78, -0.65, -0.5, -0.36, -0.24, -0.14, -0.06, -0.015,
                  0.015, 0.06, 0.14,  0.24,  0.36, 0.5,   0.65,  0.78,  0.9,   1};
  if (beams.empty()) return axes;
  const size_t one = column.layers() * 2 * axes.cosines.size() * column.bins * sizeof(float);
  if (beams.size() == 1) axes.symmetric = azimuth(beams[0].direction);
  axes.azimuths = std::clamp<size_t>(kMostBytes / one, axes.symmetric ? 9 : 18, axes.symmetric ? 19 : 36);
  return axes;
}

std::vector<double> level_depths(const AirColumn& column, double cosine, const BeamTable& table) {
  std::vector<double> depths((column.layers() + 1) * column.bins);
  std::vector<float> row(column.bins);
  for (size_t level = 0; level <= column.layers(); ++level) {
    // The beam may have come to the top through the air below, where the sun is under the horizon.
    const double below = level == column.layers() ? 1e-3 : 0;
    const bool lit = table.spread_depth(column.shells.heights()[level] - below, cosine, row);
    for (size_t i = 0; i < column.bins; ++i) depths[level * column.bins + i] = lit ? row[i] : INFINITY;
  }
  return depths;
}

DiffuseBeam LayerBeam::through(const AirColumn& column, const std::vector<double>& of_levels, size_t bin, double cosine,
                               float irradiance) {
  const size_t count = column.layers() - column.ground;
  const std::span<const double> heights = column.shells.heights();
  depth.resize(count + 1);
  for (size_t n = 0; n <= count; ++n) depth[n] = of_levels[(column.layers() - n) * column.bins + bin];
  secants.assign(count, 1 / std::max(cosine, 0.05));
  tops.assign(count, -1);
  for (size_t n = 0; n < count; ++n) {
    const size_t l = column.layers() - 1 - n;
    const double own = double{column.extinction[l * column.bins + bin]} * (heights[l + 1] - heights[l]);
    const double fall = depth[n + 1] - depth[n];
    if (own > 1e-12 && std::isfinite(fall) && fall != 0) secants[n] = fall / own;
    if (!std::isfinite(depth[n])) tops[n] = 0;
  }
  if (std::isfinite(depth[0])) tops[0] = std::exp(-depth[0]);
  return {irradiance, cosine, secants, tops};
}

BeamDepths beam_depths(const AirColumn& column, std::span<const AirBeam> beams, std::span<const BeamTable> tables,
                       DiffuseSource& source) {
  BeamDepths depths;
  for (size_t b = 0; b < beams.size(); ++b)
    depths.of_beams.push_back(level_depths(column, beams[b].direction.z, tables[b]));
  // Only the light of a low sun changes along a limb; whether anyone looks there is not known here.
  if (beams.size() != 1 || column.shells.curvature() == 0 || beams[0].direction.z >= kLowSun) return depths;
  std::vector<double> zenith;
  for (const double off : {-8.0, -4.0, 0.0, 4.0, 8.0})
    zenith.push_back(std::acos(std::max(-1.0, beams[0].direction.z)) + off * kDegree);
  for (const double z : zenith) depths.of_suns.push_back(level_depths(column, std::cos(z), tables[0]));
  source.set_suns(std::move(zenith), beams[0].direction.z);
  return depths;
}

std::vector<float> beam_phases(const AirColumn& column, const AirBeam& beam, const DiffuseSource& source) {
  const std::vector<double>& cosines = source.axes().cosines;
  std::vector<float> phases(source.directions() * column.kinds.size() * column.bins);
  for (size_t c = 0; c < cosines.size(); ++c)
    for (size_t a = 0; a < source.axes().azimuths; ++a) {
      const double sine = std::sqrt(std::max(0.0, 1 - cosines[c] * cosines[c])), azimuth = source.azimuth(a);
      const Dir d{sine * std::cos(azimuth), sine * std::sin(azimuth), cosines[c]};
      for (size_t k = 0; k < column.kinds.size(); ++k) {
        const PhaseFunction& phase = *column.kinds[k].phase;
        const std::span<float> row{&phases[(source.direction(c, a) * column.kinds.size() + k) * column.bins],
                                   column.bins};
        const bool uniform = phase.spectrally_uniform();
        phase.eval(std::clamp(dot(beam.direction, d), -1.0, 1.0), uniform ? row.first(1) : row);
        if (uniform) std::fill(row.begin(), row.end(), row[0]);
      }
    }
  return phases;
}

RoundWays::RoundWays(const AirColumn& column, const std::vector<double>& cosines) {
  if (column.shells.curvature() == 0) return;
  const std::span<const double> heights = column.shells.heights();
  const AirNodes nodes(column.shells, column.ground);
  round = std::make_unique<const AirWays>(column.shells, column.ground, nodes, cosines);
  flat = std::make_unique<const AirWays>(Shells::flat({heights.begin(), heights.end()}), column.ground, nodes, cosines);
}

}  // namespace suite
