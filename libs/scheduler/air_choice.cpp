#include "scheduler/air_choice.h"

#include <algorithm>
#include <cmath>

#include "air/column.h"

namespace suite {

namespace {

constexpr double kWidestCell = 0.0005, kWidestCellInWaves = 1;  // um, cm-1
constexpr double kBinsAcross = 24;                              // of a band
constexpr double kMostIntervals = 20000;
constexpr size_t kMostBinsOfABand = 512;  // bins

std::vector<SeenSpectra> both(std::vector<SeenSpectra> a, std::vector<SeenSpectra> b) {
  std::move(b.begin(), b.end(), std::back_inserter(a));
  return a;
}

}  // namespace

SpectralState air_cells(std::span<const Band> bands) {
  const std::vector<Bin> stretches = make_state(bands, 1e3, 0, 1).bins;
  const auto width_at = [&](double um) {
    double width = std::max(kWidestCell, kWidestCellInWaves * 1e-4 * um * um);
    for (const Band& b : bands)
      if (um >= b.low_um() && um <= b.high_um()) width = std::min(width, (b.high_um() - b.low_um()) / kBinsAcross);
    return width;
  };
  SpectralState state = make_state(bands, 1e3, 0, 1);
  for (double wider = 1;; wider *= 2) {
    state.bins.clear();
    for (const Bin& stretch : stretches)
      for (double low = stretch.low_um; low < stretch.high_um;) {
        const double width = wider * width_at(low);
        const double high = stretch.high_um - low < 1.5 * width ? stretch.high_um : low + width;
        state.bins.push_back({low, high});
        low = high;
      }
    if (static_cast<double>(state.size()) <= kMostIntervals) break;
  }
  place_knots(state, 1);
  return state;
}

std::vector<BandCells> cells_of(const SpectralState& state, std::span<const Band> bands) {
  const BandProjection projection(state, bands);
  std::vector<BandCells> all;
  for (size_t b = 0; b < bands.size(); ++b) {
    BandCells& cells = all.emplace_back();
    while (projection.weight(b, cells.first) == 0) ++cells.first;
    for (size_t k = cells.first; k < state.size(); ++k) cells.share.push_back(projection.weight(b, k));
    while (cells.share.back() == 0) cells.share.pop_back();
  }
  return all;
}

void place_transparent_knots(SpectralState& state, size_t knot_count, std::span<const float> gas_depth) {
  constexpr double kNear = 0.02;  // of a wavelength
  place_knots(state, knot_count);
  for (size_t k = 0; k < state.knots.size(); ++k) {
    const double um = state.bins[state.knots[k]].center_um();
    for (size_t i = 0; i < state.size(); ++i) {
      const bool taken = std::find(state.knots.begin(), state.knots.end(), i) != state.knots.end();
      if (!taken && std::fabs(state.bins[i].center_um() - um) <= kNear * um &&
          gas_depth[i] < 0.9f * gas_depth[state.knots[k]] - 0.01f)
        state.knots[k] = i;
    }
  }
}

AirChoice::AirChoice(const AirSpec& air, const AirPaths& paths, const std::vector<SeenSpectra>& seen,
                     const SpectralState& state, std::span<const Band> bands, bool white_light)
    : paths_(paths),
      wanted_(state),
      bands_(bands),
      intervals_(air_cells(bands)),
      fine_(with_gas_points(air, intervals_)) {
  training_ = ProductRecipe(both(seen, paths.spectra(PathSet::training)), fine_, white_light);
  held_out_ = ProductRecipe(both(seen, paths.spectra(PathSet::held_out)), fine_, white_light);
  products_ = training_.over(fine_);
  cells_ = cells_of(fine_, bands);
  const SpectralProducts held = held_out_.over(fine_);
  for (const BandCells& band : cells_) {
    means_.push_back(band_means(held, band));
    double brightest = 0;
    for (const SpectralProducts::Product& p : held.products) {
      if (!held.absorbed(p) || p.factors[0] != SpectralProducts::kOne) continue;
      double bright = 0;
      for (size_t j = 0; j < band.share.size(); ++j) bright += band.share[j] * held.unabsorbed_at(p, band.first + j);
      brightest = std::max(brightest, bright);
    }
    floors_.push_back(0.01 * brightest);
  }
}

SpectralState AirChoice::state_of(const ChosenCells& chosen) const {
  SpectralState s = wanted_;
  s.bins.clear();
  for (const size_t c : chosen.cells) s.bins.push_back(fine_.bins[c]);
  s.shares = chosen.shares;
  s.knots = {0};
  const std::vector<float> depth = paths_.gas_depth(s);
  place_transparent_knots(s, wanted_.choice.knots, depth);
  return s;
}

SpectralState AirChoice::choose(double tolerance) const {
  constexpr int kRounds = 4;
  std::vector<BandCells> cells = cells_;
  for (BandCells& band : cells) band.tolerance = 0.7 * tolerance;
  SpectralState best;
  for (int round = 0; round < kRounds; ++round) {
    best = state_of(choose_cells(products_, cells, tolerance, kMostBinsOfABand));
    const std::vector<Worst> worst = judge(best);
    bool met = true;
    for (size_t b = 0; b < cells.size(); ++b)
      if (worst[b].error > tolerance)
        cells[b].tolerance *= std::clamp(0.7 * tolerance / worst[b].error, 0.2, 0.6), met = false;
    if (met) break;
  }
  return best;
}

std::vector<AirChoice::Worst> AirChoice::judge(const SpectralState& state) const {
  const SpectralProducts products = held_out_.over(state);
  const std::vector<BandCells> cells = cells_of(state, bands_);
  std::vector<Worst> worst(bands_.size());
  for (size_t b = 0; b < bands_.size(); ++b) {
    size_t farthest = products.products.size();
    for (size_t p = 0; p < products.products.size(); ++p) {
      if (!(means_[b][p].mean > 0 || means_[b][p].dark > 0)) continue;
      double value = 0;
      for (size_t k = 0; k < cells[b].share.size(); ++k)
        value += cells[b].share[k] * products.at(products.products[p], cells[b].first + k);
      if (means_[b][p].dark > 0)
        worst[b].of_dark = std::max(worst[b].of_dark, std::fabs(value - means_[b][p].dark));
      else if (const double e = means_[b][p].error(value); e > worst[b].error)
        worst[b].error = e, farthest = p;
    }
    worst[b].under = held_out_.name_of(farthest);
  }
  return worst;
}

}  // namespace suite
