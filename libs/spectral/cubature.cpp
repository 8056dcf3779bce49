#include "spectral/cubature.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "spectral/least_squares.h"

namespace suite {

namespace {

constexpr size_t kNone = static_cast<size_t>(-1);

bool plain(const SpectralProducts::Product& p) { return p.factors[0] == SpectralProducts::kOne; }

// The fit of one band. Rows of its equations: that all shares add up to 1, then products and stretches as they are
// found wanting.
class BandFit {
 public:
  BandFit(const SpectralProducts& all, const BandCells& band)
      : all_(all), band_(band), means_(band_means(all, band)), columns_(band.share.size()), cells_(band.share.size()) {
    std::iota(cells_.begin(), cells_.end(), size_t{0});
    constexpr double kWhole = 10;  // held harder than the products
    add_row([](size_t) { return kWhole; }, kWhole);
    for (size_t i = 0; i < band.stretches.size(); ++i) demand(all.products.size() + i);
    for (size_t p = 0; p < all.products.size(); ++p)
      if (plain(all.products[p]) && means_[p].mean > 0) demand(p);
  }

  // Fits to cells of the band (numbered from its first); continues with `fit`. True: every product is within the
  // tolerance.
  bool reach(std::span<const size_t> candidates, const std::function<bool(size_t)>& preferred, double tolerance,
             size_t most, NonNegativeFit& fit) {
    const auto done = [&](const NonNegativeFit& f) {
      for (size_t r = 0; r < wanted_.size(); ++r) {
        double sum = -wanted_[r];
        for (size_t k = 0; k < f.chosen.size(); ++k) sum += f.x[k] * columns_[f.chosen[k]][r];
        if (!(std::fabs(sum) <= 0.5 * tolerance)) return false;
      }
      return true;
    };
    const auto column = [&](size_t j) { return std::span<const double>(columns_[j]); };
    for (;;) {
      fit_non_negative(candidates, column, wanted_, preferred, done, most, fit);
      if (!demand_worst(fit, tolerance)) return worst(fit).error <= tolerance;
    }
  }
  bool reach_all(const std::function<bool(size_t)>& preferred, double tolerance, size_t most, NonNegativeFit& fit) {
    return reach(cells_, preferred, tolerance, most, fit);
  }

  struct Worst {
    double error = 0;
    size_t row = 0;
  };
  Worst worst(const NonNegativeFit& fit) const {
    Worst w;
    const double sum = std::accumulate(fit.x.begin(), fit.x.end(), 0.0);
    if (!(sum > 0)) return {INFINITY, 0};
    for (size_t row = 0; row < all_.products.size() + band_.stretches.size(); ++row)
      if (const double e = error_of(fit, sum, row); e > w.error) w = {e, row};
    return w;
  }
  size_t first() const { return band_.first; }
  size_t size() const { return cells_.size(); }

 private:
  template <class Value>
  void add_row(const Value& value, double wanted) {
    for (size_t j = 0; j < columns_.size(); ++j) columns_[j].push_back(value(j));
    wanted_.push_back(wanted);
  }
  void demand(size_t row) {
    if (std::find(rows_.begin(), rows_.end(), row) != rows_.end()) return;
    rows_.push_back(row);
    if (row < means_.size()) {
      const SpectralProducts::Product& p = all_.products[row];
      const BandMean& m = means_[row];
      add_row([&](size_t j) { return all_.at(p, band_.first + j) / m.scale; }, m.mean / m.scale);
    } else {
      const auto [low, high] = band_.stretches[row - means_.size()];
      add_row([&](size_t j) { return band_.first + j >= low && band_.first + j < high ? 1.0 : 0.0; },
              stretch_share(low, high));
    }
  }
  double stretch_share(size_t low, size_t high) const {
    double sum = 0;
    for (size_t j = std::max(low, band_.first); j < std::min(high, band_.first + band_.share.size()); ++j)
      sum += band_.share[j - band_.first];
    return sum;
  }
  double error_of(const NonNegativeFit& fit, double sum, size_t row) const {
    double value = 0;
    if (row >= means_.size()) {
      const auto [low, high] = band_.stretches[row - means_.size()];
      for (size_t k = 0; k < fit.chosen.size(); ++k)
        if (const size_t cell = band_.first + fit.chosen[k]; cell >= low && cell < high) value += fit.x[k];
      return std::fabs(value / sum - stretch_share(low, high));
    }
    if (!(means_[row].mean > 0)) return 0;
    for (size_t k = 0; k < fit.chosen.size(); ++k)
      value += fit.x[k] * all_.at(all_.products[row], band_.first + fit.chosen[k]);
    return means_[row].error(value / sum);
  }
  // Adds the worst of what is not within the tolerance to the equations; false when there is nothing to add.
  bool demand_worst(const NonNegativeFit& fit, double tolerance) {
    constexpr size_t kAtOnce = 4;
    const double sum = std::accumulate(fit.x.begin(), fit.x.end(), 0.0);
    if (!(sum > 0)) return false;
    std::vector<std::pair<double, size_t>> wanting;
    for (size_t row = 0; row < means_.size() + band_.stretches.size(); ++row)
      if (const double e = error_of(fit, sum, row);
          e > tolerance && std::find(rows_.begin(), rows_.end(), row) == rows_.end())
        wanting.emplace_back(-e, row);
    std::sort(wanting.begin(), wanting.end());
    for (size_t i = 0; i < std::min(kAtOnce, wanting.size()); ++i) demand(wanting[i].second);
    return !wanting.empty();
  }

  const SpectralProducts& all_;
  const BandCells& band_;
  std::vector<BandMean> means_;
  std::vector<std::vector<double>> columns_;  // [cell of the band][row]
  std::vector<double> wanted_;
  std::vector<size_t> rows_;  // what the rows after the first are: products, then stretches
  std::vector<size_t> cells_;
};

// The fits of all bands together.
class Choice {
 public:
  Choice(const SpectralProducts& all, std::span<const BandCells> bands, double tolerance, size_t most)
      : most_(most), used_(all.cells, 0) {
    for (const BandCells& band : bands) {
      BandFit& fit = bands_.emplace_back(all, band);
      NonNegativeFit& found = fits_.emplace_back();
      tolerances_.push_back(band.tolerance > 0 ? band.tolerance : tolerance);
      fit.reach_all([&](size_t j) { return used_[fit.first() + j] > 0; }, tolerances_.back(), most_, found);
      for (const size_t j : found.chosen) ++used_[fit.first() + j];
    }
  }

  // Drops cells that all their bands can do without, those that serve the fewest bands first.
  void thin() {
    constexpr size_t kMostTries = 2000;
    std::vector<std::pair<int, size_t>> order;
    for (size_t c = 0; c < used_.size(); ++c)
      if (used_[c]) order.emplace_back(used_[c], c);
    std::sort(order.begin(), order.end());
    for (size_t i = 0; i < std::min(kMostTries, order.size()); ++i) drop(order[i].second);
  }

  ChosenCells result() const {
    ChosenCells r;
    std::vector<size_t> place(used_.size(), kNone);
    for (size_t c = 0; c < used_.size(); ++c)
      if (used_[c]) place[c] = r.cells.size(), r.cells.push_back(c);
    r.shares.assign(bands_.size() * r.cells.size(), 0.0);
    for (size_t b = 0; b < bands_.size(); ++b) {
      const NonNegativeFit& fit = fits_[b];
      const double sum = std::accumulate(fit.x.begin(), fit.x.end(), 0.0);
      for (size_t k = 0; k < fit.chosen.size(); ++k)
        r.shares[b * r.cells.size() + place[bands_[b].first() + fit.chosen[k]]] = fit.x[k] / sum;
      if (const BandFit::Worst w = bands_[b].worst(fit); w.error > r.error)
        r.error = w.error, r.band = b, r.product = w.row;
    }
    return r;
  }

 private:
  void drop(size_t cell) {
    std::vector<std::pair<size_t, NonNegativeFit>> others;  // fits of its bands without it
    for (size_t b = 0; b < bands_.size(); ++b) {
      NonNegativeFit fit = fits_[b];
      const size_t first = bands_[b].first();
      const auto at = std::find(fit.chosen.begin(), fit.chosen.end(), cell - first);
      if (cell < first || at == fit.chosen.end()) continue;
      fit.x.erase(fit.x.begin() + (at - fit.chosen.begin()));
      fit.chosen.erase(at);
      std::vector<size_t> candidates;
      for (size_t j = 0; j < bands_[b].size(); ++j)
        if (used_[first + j] && first + j != cell) candidates.push_back(j);
      if (candidates.empty()) return;
      const auto none = [](size_t) { return false; };
      if (!bands_[b].reach(candidates, none, tolerances_[b], most_, fit)) return;
      others.emplace_back(b, std::move(fit));
    }
    for (auto& [b, fit] : others) {
      for (const size_t j : fits_[b].chosen) --used_[bands_[b].first() + j];
      fits_[b] = std::move(fit);
      for (const size_t j : fits_[b].chosen) ++used_[bands_[b].first() + j];
    }
  }

  std::vector<double> tolerances_;  // [band]
  size_t most_;
  std::vector<int> used_;  // by how many bands, of each cell
  std::vector<BandFit> bands_;
  std::vector<NonNegativeFit> fits_;
};

}  // namespace

namespace {

// What gases have absorbed nearly all of is held to what there would be without them.
void raise_scales(const SpectralProducts& all, const BandCells& band, std::vector<BandMean>& means) {
  constexpr double kOwn = 0.01, kBrightest = 1e-3;
  if (all.unabsorbed.empty()) return;
  std::vector<double> bright(means.size(), 0.0);
  std::vector<double> of_light(all.spectra.size(), 0.0);
  double brightest = 0;
  for (size_t i = 0; i < means.size(); ++i) {
    const SpectralProducts::Product& p = all.products[i];
    if (!all.absorbed(p)) continue;
    for (size_t j = 0; j < band.share.size(); ++j) bright[i] += band.share[j] * all.unabsorbed_at(p, band.first + j);
    if (plain(p)) of_light[p.light] = bright[i], brightest = std::max(brightest, bright[i]);
  }
  for (size_t i = 0; i < means.size(); ++i) {
    const SpectralProducts::Product& p = all.products[i];
    if (!all.absorbed(p)) continue;
    const double alone = of_light[p.light], dimmed = alone > 0 ? bright[i] / alone : 1;
    means[i].scale = std::max({means[i].scale, kOwn * bright[i], kBrightest * brightest * dimmed});
  }
}

}  // namespace

std::vector<BandMean> band_means(const SpectralProducts& all, const BandCells& band) {
  constexpr double kDarkLight = 1e-6, kDarkFactor = 1e-6, kDarkFactors = 1e-4;
  std::vector<BandMean> means;
  std::vector<double> light(all.spectra.size() + 1, 0.0);  // mean of each alone; the last is of 1
  double brightest = 0;
  for (const SpectralProducts::Product& p : all.products) {
    double sum = 0;
    for (size_t j = 0; j < band.share.size(); ++j) sum += band.share[j] * all.at(p, band.first + j);
    means.push_back({sum, sum});
    if (!plain(p)) continue;
    light[p.light == SpectralProducts::kOne ? all.spectra.size() : p.light] = sum;
    brightest = std::max(brightest, sum);
  }
  for (size_t i = 0; i < means.size(); ++i) {
    const SpectralProducts::Product& p = all.products[i];
    const double of_light = light[p.light == SpectralProducts::kOne ? all.spectra.size() : p.light];
    const double dark = plain(p) ? 0 : p.factors[1] == SpectralProducts::kOne ? kDarkFactor : kDarkFactors;
    if (of_light > kDarkLight * brightest && means[i].mean > dark * of_light) continue;
    if (plain(p)) means[i].dark = means[i].mean;
    means[i].mean = 0;
  }
  raise_scales(all, band, means);
  for (size_t i = 0; i < means.size(); ++i)
    if (const uint32_t by = all.products[i].judged_by; by != SpectralProducts::kOne) means[i].scale = means[by].scale;
  return means;
}

ChosenCells choose_cells(const SpectralProducts& all, std::span<const BandCells> bands, double tolerance, size_t most) {
  Choice choice(all, bands, tolerance, most);
  choice.thin();
  return choice.result();
}

}  // namespace suite
