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

// Put together from fine ones, none wider than `limit`.
std::vector<Bin> joined(std::span<const Band> bands, double limit) {
  std::vector<Bin> done;
  for (const Bin& b : make_state(bands, std::min(kFinest, limit)).bins) {
    const bool touches = !done.empty() && b.low_um - done.back().high_um < 1e-3 * (b.high_um - b.low_um);
    if (touches && b.high_um - done.back().low_um <= std::min(limit, widest_at(b.low_um)) * (1 + 1e-9))
      done.back().high_um = b.high_um;
    else
      done.push_back(b);
  }
  return done;
}

// Whether each band responds in all of a bin alike, but for its edges, or nowhere in it.
bool evenly_seen(const Bin& bin, std::span<const Band> bands) {
  constexpr int kParts = 8;
  constexpr double kSlight = 1e-4;
  const double part = (bin.high_um - bin.low_um) / kParts;
  return std::all_of(bands.begin(), bands.end(), [&](const Band& band) {
    if (band.high_um() <= bin.low_um || band.low_um() >= bin.high_um) return true;
    const double mean = band.response.integral(bin.low_um, bin.high_um) / kParts;
    for (int i = 0; i < kParts; ++i) {
      const double low = bin.low_um + part * i, here = band.response.integral(low, low + part);
      if (std::fabs(here - mean) > kSlight * part * band.response.max()) return false;
    }
    return true;
  });
}

// Those that the user wants; divided evenly where they are wider than `limit`, unless gases are alike in them or no
// band asks where in them light lies.
std::vector<Bin> divided(const AirSpec& air, SpectralState even, std::span<const Band> bands, double limit) {
  even.shares.clear();
  std::vector<bool> whole;
  for (const Bin& b : even.bins) whole.push_back(b.high_um - b.low_um <= limit * (1 + 1e-9) || evenly_seen(b, bands));
  if (std::find(whole.begin(), whole.end(), false) != whole.end()) {
    const SpectralState points = with_gas_points(air, even);
    for (size_t i = 0, at = 0; i < even.size(); ++i) {
      const size_t first = at++;
      while (at < points.size() && points.bins[at].g > 0) ++at;
      if (at == first + 1) whole[i] = true;
    }
  }
  std::vector<Bin> done;
  for (size_t i = 0; i < even.size(); ++i) {
    const Bin& b = even.bins[i];
    const double width = b.high_um - b.low_um, most = std::min(whole[i] ? width : limit, widest_at(b.low_um));
    const auto n = static_cast<size_t>(std::max(1.0, std::ceil(width / most * (1 - 1e-9))));
    const auto edge = [&](size_t k) { return k == n ? b.high_um : b.low_um + width * static_cast<double>(k) / n; };
    for (size_t k = 0; k < n; ++k) done.push_back({edge(k), edge(k + 1)});
  }
  return done;
}

}  // namespace

void check_gases_known(const AirSpec& air, const SpectralState& state, std::span<const Band> bands) {
  if (!air.gases) return;
  const double low = air.gases->low_um(), high = air.gases->high_um();
  const auto beyond = [&](const Band& band) {
    return std::any_of(state.bins.begin(), state.bins.end(), [&](const Bin& b) {
      return (b.low_um < low || b.high_um > high) && b.high_um > band.low_um() && b.low_um < band.high_um();
    });
  };
  std::string names;
  for (const Band& band : bands)
    if (beyond(band))
      names +=
          strf("%s'%s' (%.4g to %.4g um)", names.empty() ? "" : ", ", band.name.c_str(), band.low_um(), band.high_um());
  if (!names.empty())
    throw Error(
        air.where,
        strf("gases are known from %.4g to %.4g um, and these bands reach beyond: %s", low, high, names.c_str()),
        "other bands, a table that has them, or `gases: none`, which leaves gases out");
}

AirBins bins_in_air(const AirSpec& air, const SpectralState& state, std::span<const Band> bands) {
  check_gases_known(air, state, bands);
  double narrowest = INFINITY;
  for (const Band& b : bands) narrowest = std::min(narrowest, b.high_um() - b.low_um());
  double limit = 0.5 * narrowest;
  if (state.choice.widest_um > 0) limit = std::min(limit, state.choice.widest_um);
  AirBins bins;
  bins.intervals = state;
  bins.intervals.shares.clear();
  bins.intervals.bins = state.choice.error > 0 ? joined(bands, limit) : divided(air, state, bands, limit);
  place_knots(bins.intervals, state.choice.knots);
  bins.state = with_gas_points(air, bins.intervals);
  return bins;
}

}  // namespace suite
