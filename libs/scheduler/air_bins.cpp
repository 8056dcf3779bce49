#include "scheduler/air_bins.h"

#include <algorithm>
#include <cmath>

#include "air/column.h"

namespace suite {

namespace {

constexpr double kWidest = 0.01;       // um
constexpr double kWidestInWaves = 15;  // cm-1
constexpr double kFinest = 0.002;      // um: what intervals are put together from

double widest_at(double wavelength_um) {
  return std::max(kWidest, kWidestInWaves * wavelength_um * wavelength_um * 1e-4);
}

}  // namespace

AirBins bins_in_air(const AirSpec& air, const SpectralState& state, std::span<const Band> bands) {
  double narrowest = INFINITY;
  for (const Band& b : bands) narrowest = std::min(narrowest, b.high_um() - b.low_um());
  double limit = 0.5 * narrowest;
  if (state.choice.widest_um > 0) limit = std::min(limit, state.choice.widest_um);
  if (!(state.choice.error > 0))  // even bins of this width are wanted
    for (const Bin& b : state.bins) limit = std::min(limit, b.high_um - b.low_um);
  AirBins bins;
  SpectralState fine = make_state(bands, std::min({kFinest, limit}));
  bins.intervals = state;
  bins.intervals.shares.clear();
  bins.intervals.bins.clear();
  for (const Bin& b : fine.bins) {
    std::vector<Bin>& done = bins.intervals.bins;
    const bool touches = !done.empty() && b.low_um - done.back().high_um < 1e-3 * (b.high_um - b.low_um);
    if (touches && b.high_um - done.back().low_um <= std::min(limit, widest_at(b.low_um)) * (1 + 1e-9))
      done.back().high_um = b.high_um;
    else
      done.push_back(b);
  }
  place_knots(bins.intervals, state.choice.knots);
  bins.state = with_gas_points(air, bins.intervals);
  return bins;
}

}  // namespace suite
