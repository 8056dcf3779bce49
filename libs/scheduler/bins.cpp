#include "scheduler/bins.h"

#include <algorithm>
#include <cmath>

#include "scheduler/air_bins.h"
#include "scheduler/products.h"

namespace suite {

namespace {

constexpr double kUsualError = 1e-3;    // judges even bins
constexpr size_t kMostCells = 1 << 16;  // of a state
constexpr size_t kMostOfABand = 512;    // bins
constexpr size_t kCellsAcross = 32;     // of the narrowest band, to begin with

// What a state's bins count in each band by its response, or by its shares.
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

// One state of a sensor and what it is looking at.
class StateBins {
 public:
  StateBins(const SpectralState& state, std::span<const Band> bands, const std::vector<SeenSpectra>& seen,
            bool white_light)
      : state_(state), bands_(bands), wanted_(state.choice.error > 0 ? state.choice.error : kUsualError) {
    double narrowest = INFINITY, support = 0;
    for (const Band& b : bands) narrowest = std::min(narrowest, b.high_um() - b.low_um());
    for (const Bin& b : whole_stretches().bins) support += b.high_um - b.low_um;
    cell_ = std::max(narrowest / kCellsAcross, 4 * support / kMostCells);
    SpectralState fine = make_state(bands, cell_, 0, 1);
    SpectralState probe = fine;
    const std::vector<Bin> between = places(fine).bins;
    probe.bins.insert(probe.bins.end(), between.begin(), between.end());
    recipe_ = ProductRecipe(seen, probe, white_light);
    refine(std::move(fine));
  }

  // The state with the fewest bins found.
  SpectralState choose() {
    const double room = std::max(wanted_ - unresolved_, 0.5 * wanted_);
    const double widest = state_.choice.widest_um;
    SpectralState whole = widest > 0 ? make_state(bands_, widest) : whole_stretches();
    if (judge(whole) <= room) return finished(std::move(whole));
    SpectralState some = sparse(room);
    const double of_some = error_, of_even = judge(state_);
    if (of_even <= std::max(room, of_some) && state_.size() <= some.size()) return finished(state_);
    error_ = std::max(of_some, judge(some));  // stretches count in the first
    return finished(std::move(some));
  }

  // The largest error of a state's bins, kept for the report.
  double judge(const SpectralState& state) {
    const SpectralProducts products = recipe_.over(state);
    const std::vector<BandCells> cells = cells_of(state, bands_);
    error_ = 0, band_ = 0, product_ = products.products.size();
    for (size_t b = 0; b < bands_.size(); ++b)
      for (size_t p = 0; p < products.products.size(); ++p) {
        if (!(means_[b][p].mean > 0)) continue;
        double value = 0;
        for (size_t k = 0; k < cells[b].share.size(); ++k)
          value += cells[b].share[k] * products.at(products.products[p], cells[b].first + k);
        if (const double e = means_[b][p].error(value); e > error_) error_ = e, band_ = b, product_ = p;
      }
    return error_;
  }

  BinReport report(const std::string& sensor, size_t bins) const {
    BinReport r{sensor, bands_.size(), bins, wanted_, error_ + unresolved_, cell_, {}, {}, state_.choice.error > 0};
    r.band = bands_[band_].name;
    r.under = recipe_.name_of(product_);
    return r;
  }

 private:
  using Means = std::vector<std::vector<BandMean>>;  // [band][product]

  // Halves the cells until no band of no product changes.
  void refine(SpectralState fine) {
    means_ = means_over(recipe_.over(fine), fine);
    for (;;) {
      cell_ /= 2;
      fine_ = make_state(bands_, cell_, 0, 1);
      products_ = recipe_.over(fine_);
      Means means = means_over(products_, fine_);
      const double change = difference(means_, means);
      means_ = std::move(means);
      // Lines that are much finer than the cells do not change by halving, but show at single places in the cells.
      // These are no better than a few times the error wanted, so that less does not count.
      const double hidden = difference(means_over(recipe_.over(places(fine_)), fine_), means_);
      const bool lines = hidden > 8 * wanted_;
      unresolved_ = lines ? hidden : change / 2;  // halving leaves a quarter: a third of the change
      if ((change <= wanted_ / 8 && !lines) || 2 * fine_.size() > kMostCells) return;
    }
  }

  static double difference(const Means& a, const Means& b) {
    double most = 0;
    for (size_t i = 0; i < a.size(); ++i)
      for (size_t p = 0; p < a[i].size(); ++p)
        if (a[i][p].mean > 0 && b[i][p].mean > 0) most = std::max(most, b[i][p].error(a[i][p].mean));
    return most;
  }
  // One bin for bands that overlap or touch.
  SpectralState whole_stretches() const { return make_state(bands_, state_.high_um - state_.low_um); }
  // A place near the middle of every bin, as narrow as Planck's function allows. Not the middle itself: there even
  // combs of lines may all have their mean.
  static SpectralState places(SpectralState state) {
    for (Bin& b : state.bins) {
      const double width = b.high_um - b.low_um, place = b.low_um + 0.4571 * width,
                   half = std::min(1e-7 * place, width / 128);
      b = {place - half, place + half};
    }
    return state;
  }
  Means means_over(const SpectralProducts& products, const SpectralState& state) const {
    Means means;
    for (const BandCells& cells : cells_of(state, bands_)) means.push_back(band_means(products, cells));
    return means;
  }

  // Some of the fine cells.
  SpectralState sparse(double tolerance) {
    std::vector<BandCells> cells = cells_of(fine_, bands_);
    if (state_.choice.widest_um > 0)
      for (BandCells& band : cells) band.stretches = stretches_of(band);
    const ChosenCells chosen = choose_cells(products_, cells, tolerance, kMostOfABand);
    SpectralState state = state_;
    state.bins.clear();
    for (const size_t c : chosen.cells) state.bins.push_back(fine_.bins[c]);
    state.shares = chosen.shares;
    error_ = chosen.error;
    return state;
  }

  // The cells of a band in steps of the widest bin.
  std::vector<std::array<size_t, 2>> stretches_of(const BandCells& band) const {
    std::vector<std::array<size_t, 2>> stretches;
    const size_t end = band.first + band.share.size();
    for (size_t begin = band.first; begin < end;) {
      size_t next = begin + 1;
      while (next < end && fine_.bins[next].high_um - fine_.bins[begin].low_um <= state_.choice.widest_um) ++next;
      stretches.push_back({begin, next});
      begin = next;
    }
    return stretches;
  }

  SpectralState finished(SpectralState s) const {
    s.low_um = state_.low_um, s.high_um = state_.high_um, s.reference_um = state_.reference_um;
    s.choice = state_.choice;
    place_knots(s, state_.choice.knots);
    return s;
  }

  const SpectralState state_;
  std::span<const Band> bands_;
  double wanted_, cell_ = 0, unresolved_ = 0;
  ProductRecipe recipe_;
  SpectralState fine_;
  SpectralProducts products_;  // over the fine cells
  Means means_;                // over the fine cells; 0 = does not matter
  double error_ = 0;
  size_t band_ = 0, product_ = 0;  // whose it is
};

}  // namespace

std::string BinReport::text() const {
  const char* what = g_points > 0 ? "interval" : "bin";
  return strf("sensor '%s': %zu band%s in %zu %s%s%s, within %.2g %% of bins of %.3g nm", sensor.c_str(), bands,
              bands == 1 ? "" : "s", bins, what, bins == 1 ? "" : "s",
              g_points > 0 ? strf(" and %zu g-points of gases", g_points).c_str() : "", 100 * reached, 1000 * cell_um) +
         (under.empty() ? "" : " (farthest: band '" + band + "', " + under + ")");
}

std::vector<BinReport> choose_bins(const Scene& scene, std::span<const SourceSpecs> sources, Sensor& sensor) {
  bool white_light = false;
  for (const Task& t : sensor.tasks())
    for (const Capture& c : t.captures) white_light = white_light || c.bin_by == Capture::BinBy::sun;
  std::vector<BinReport> reports;
  for (size_t s = 0; s < sensor.states().size(); ++s) {
    const SpectralState state = sensor.states()[s];
    StateBins bins(state, sensor.bands(s), spectra_of(scene, sources, sensor.bands(s)), white_light);
    if (!sources.empty() && sources[0].air) {
      AirBins in_air = bins_in_air(*sources[0].air, state, sensor.bands(s));
      bins.judge(in_air.intervals);
      reports.push_back(bins.report(sensor.name(), in_air.intervals.size()));
      reports.back().g_points = in_air.state.size();
      sensor.take_state(s, std::move(in_air.state));
    } else if (state.choice.error > 0) {
      SpectralState chosen = bins.choose();
      reports.push_back(bins.report(sensor.name(), chosen.size()));
      sensor.take_state(s, std::move(chosen));
    } else {
      bins.judge(state);
      reports.push_back(bins.report(sensor.name(), state.size()));
    }
  }
  return reports;
}

}  // namespace suite
