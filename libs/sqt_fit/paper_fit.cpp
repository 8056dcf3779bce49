// Asking a function densely and building one tree per view and channel; see paper_fit.h.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "sqt_fit/paper_fit.h"
#include "sqt_fit/pole_mean.h"

namespace suite::sqt {

namespace {

// The slice's data on a regular subdivision of every cell: leaves per channel, and totals before reduction.
void fit_view(const Function& function, const PaperOptions& options, Dir out, std::vector<PaperLeaf>* leaves,
              float* totals) {
  const Function::Info& info = function.info();
  const size_t channels = info.wavelength_um.size();
  const int side = options.samples_per_cell_side;
  const bool weighted = info.quantity == Quantity::bsdf;
  std::vector<Builder> builders(channels, Builder(options.order, info.domain));
  std::vector<double> f(channels), sum(channels, 0.0);
  const double solid_angle = cell_solid_angle(options.order) / (side * side);
  for (uint32_t cell = 0; cell < cell_count(options.order); ++cell)
    for (int k = 0; k < side * side; ++k) {
      const Dir in = direction_in(CellId::of(options.order, cell), {(k % side + 0.5) / side, (k / side + 0.5) / side});
      if (info.domain == Domain::hemisphere && in.z <= 0) continue;
      function.value(out, in, f);
      for (size_t c = 0; c < channels; ++c) {
        builders[c].insert(in, f[c]);
        if (std::isfinite(f[c]) && f[c] > 0) sum[c] += f[c] * (weighted ? std::fabs(in.z) : 1.0) * solid_angle;
      }
    }
  for (size_t c = 0; c < channels; ++c) {
    leaves[c] = builders[c].reduce(options.threshold);
    totals[c] = static_cast<float>(sum[c]);
  }
}

}  // namespace

PaperData fit_paper(const Function& asked, const PaperOptions& options, const std::function<void(double)>& progress) {
  const PoleMean mean(asked);
  const Function& function = mean.function();
  PaperData data;
  data.function = function.info();
  data.magnitude_um = data.function.wavelength_um;
  std::sort(data.magnitude_um.begin(), data.magnitude_um.end());
  const bool one_view = data.function.quantity != Quantity::bsdf;
  const size_t polar = one_view ? 1 : options.views;
  data.phi_count = data.function.isotropic || one_view ? 1 : 16;
  for (size_t i = 0; i < polar; ++i)
    for (size_t j = 0; j < data.phi_count; ++j)
      data.views.push_back({polar == 1 ? 0 : 89.9 * kDegree * static_cast<double>(i) / static_cast<double>(polar - 1),
                            2 * kPi * static_cast<double>(j) / static_cast<double>(data.phi_count)});
  const size_t channels = data.function.wavelength_um.size();
  data.slices.resize(data.views.size() * channels);
  data.magnitudes.resize(data.views.size() * channels);
  parallel_for(0, data.views.size(), 1, [&](size_t begin, size_t end) {
    for (size_t v = begin; v < end; ++v) {
      std::vector<float> totals(channels);
      fit_view(function, options, dir_from_angles(data.views[v].theta, data.views[v].phi), &data.slices[v * channels],
               totals.data());
      for (size_t c = 0; c < channels; ++c) {
        const auto k =
            std::lower_bound(data.magnitude_um.begin(), data.magnitude_um.end(), data.function.wavelength_um[c]) -
            data.magnitude_um.begin();
        data.magnitudes[v * channels + static_cast<size_t>(k)] =
            one_view ? totals[c] : std::min(totals[c], 1.0f);  // no surface returns more than it receives
      }
      if (progress) progress(1.0 / static_cast<double>(data.views.size()));
    }
  });
  return data;
}

}  // namespace suite::sqt
