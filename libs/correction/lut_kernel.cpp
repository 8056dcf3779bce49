#include "correction/lut_kernel.h"

#include <cmath>

#include "light/kinds/solar_spectrum.h"

namespace suite {

namespace {

// Means over bands by response and sunlight.
class Sunlit {
 public:
  Sunlit(const SpectralState& bins, std::span<const Band> bands)
      : sun_(bins.sample(solar_irradiance())), to_(bins, bands) {
    light_ = mean(std::vector<double>(bins.size(), 1.0));
  }
  std::vector<double> operator()(const std::vector<double>& values) const {
    std::vector<double> m = mean(values);
    for (size_t b = 0; b < m.size(); ++b) m[b] /= light_[b];
    return m;
  }

 private:
  std::vector<double> mean(const std::vector<double>& values) const {
    std::vector<double> lit(values.size()), m(to_.bands());
    for (size_t i = 0; i < lit.size(); ++i) lit[i] = double{sun_[i]} * values[i];
    to_.apply(lit, m);
    return m;
  }
  std::vector<float> sun_;
  BandProjection to_;
  std::vector<double> light_;
};

// Mean and standard error of the mean of numbers of batches.
struct Mean {
  double sum = 0, squares = 0;
  void add(double x) { sum += x, squares += x * x; }
  double mean() const { return sum / static_cast<double>(kKernelBatches); }
  double error() const {
    const auto n = static_cast<double>(kKernelBatches);
    return std::sqrt(std::max(0.0, squares / n - mean() * mean()) / (n - 1));
  }
};

LutKernel of_height(const AirKernel& kernel, const Sunlit& sunlit, size_t radii) {
  const std::vector<double> direct = sunlit(kernel.direct);
  const size_t bands = direct.size();
  std::vector<std::vector<double>> batches[kKernelBatches];  // [ring][band], running sums
  std::vector<Mean> total(bands);
  for (size_t n = 0; n < kKernelBatches; ++n) {
    for (const std::vector<double>& ring : kernel.rings[n]) {
      batches[n].push_back(sunlit(ring));
      for (size_t b = 0; b < bands && batches[n].size() > 1; ++b)
        batches[n].back()[b] += batches[n][batches[n].size() - 2][b];
    }
    for (size_t b = 0; b < bands; ++b) total[b].add(batches[n].back()[b]);
  }
  LutKernel out;
  for (size_t b = 0; b < bands; ++b) {
    out.total.push_back(total[b].mean()), out.total_error.push_back(total[b].error());
    out.around.push_back(out.total[b] / (out.total[b] + direct[b]));
  }
  for (size_t r = 0; r < radii; ++r) {
    std::vector<double>&within = out.within.emplace_back(), &error = out.within_error.emplace_back();
    for (size_t b = 0; b < bands; ++b) {
      // Linearised: a batch's part within, less the mean share of the batch's whole.
      double sum = 0;
      for (const auto& batch : batches) sum += batch[r][b];
      const double whole = out.total[b] * static_cast<double>(kKernelBatches), share = whole > 0 ? sum / whole : 0;
      Mean rest;
      for (const auto& batch : batches) rest.add(batch[r][b] - share * batch.back()[b]);
      within.push_back(share), error.push_back(out.total[b] > 0 ? rest.error() / out.total[b] : 0);
    }
  }
  return out;
}

}  // namespace

std::vector<LutKernel> lut_kernel(const AirSpec& air, const LutTable& table, size_t state, const LutFineness& fineness,
                                  const KernelSpec& spec) {
  AirSpec here = air_of_state(air, table, state);
  const SpectralState bins = lut_bins(here, table, fineness);
  std::vector<double> heights;
  for (const double km : table.axes[static_cast<size_t>(LutAxisOf::height)].values) heights.push_back(1e3 * km);
  const Sunlit sunlit(bins, table.bands);
  std::vector<LutKernel> out;
  for (const AirKernel& kernel : air_kernel(here, bins, heights, spec))
    out.push_back(of_height(kernel, sunlit, spec.radii.size()));
  return out;
}

}  // namespace suite
