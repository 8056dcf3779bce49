#include "sqt_fit/spectra.h"

#include <algorithm>
#include <cmath>

#include "sqt_fit/source_means.h"
#include "sqt_fit/source_totals.h"

namespace suite::sqt {

namespace {

constexpr size_t kFewest = 8;         // channels that are worth it
constexpr size_t kMost = 64;          // rows
constexpr size_t kWork = 1000000000;  // products that the covariance may take
constexpr double kRest = 1e-3;        // of a step at quality 1: the smallest quality there is
constexpr int kSweeps = 40;

using Row = std::vector<double>;

double dot(const Row& a, const Row& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// Makes a row orthogonal to the rows before it, and of length 1; false when nothing is left of it.
bool orthonormalise(std::vector<Row>& rows, size_t k) {
  const double before = dot(rows[k], rows[k]);
  for (int twice = 0; twice < 2; ++twice)
    for (size_t j = 0; j < k; ++j) {
      const double along = dot(rows[k], rows[j]);
      for (size_t i = 0; i < rows[k].size(); ++i) rows[k][i] -= along * rows[j][i];
    }
  const double length = dot(rows[k], rows[k]);
  if (!(length > 1e-20 * before) || !(length > 0)) return false;
  for (double& x : rows[k]) x /= std::sqrt(length);
  return true;
}

// Covariance over channels of the differences in units of steps, [channel][channel].
struct Covariance {
  size_t channels;
  std::vector<double> sum;
  double count = 0;
  explicit Covariance(size_t n) : channels(n), sum(n * n, 0.0) {}
  void add(const float* spectrum, double weight) {
    for (size_t a = 0; a < channels; ++a)
      for (size_t b = 0; b <= a; ++b) sum[a * channels + b] += weight * spectrum[a] * spectrum[b];
    count += 1;
  }
  void finish() {
    for (size_t a = 0; a < channels; ++a)
      for (size_t b = 0; b <= a; ++b) sum[b * channels + a] = sum[a * channels + b] /= std::max(1.0, count);
  }
};

Covariance covariance_of(const AlignedLayout& asked, const AlignedTotals& totals,
                         const std::vector<AlignedSource::Impl::Sheet>& sheets) {
  AlignedLayout layout = asked;
  layout.quality = 1;
  const size_t channels = layout.channels, views = layout.views();
  const StepRule steps(layout, 0.25 * step_reference(totals, layout));
  NodeLevels levels(layout);
  size_t rows = 0;
  for (const auto& sheet : sheets) rows += sheet.details.size() / channels;
  const size_t stride = rows * channels * channels / kWork + 1;
  Covariance covariance(channels);
  for (const auto& sheet : sheets) {
    size_t next = 0;  // row that is looked at
    for (size_t i = 0; i < sheet.data.size(); ++i) {
      // Roots are differences from each other, the first from nothing: their spectra count as they are.
      const Lattice::Node& node = sheet.data.node(i);
      if (node.id.order() == Lattice::kRootOrder)
        for (size_t v = 0; v < views; ++v) covariance.add(&sheet.data.value(i)[v * channels], 1);
      if (node.first_child < 0) continue;
      const size_t end = (static_cast<size_t>(sheet.detail_index[i]) + 1) * 3 * views;
      if (next >= end) continue;
      levels.look(layout, sheet, i);
      const Dir d = center_of(node.id);
      const float* mean = layout.refined ? levels.mean.data() : levels.value.data();
      const double step = steps.step({static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)},
                                     node.id.order(), mean, 0);
      for (; next < end; next += stride) covariance.add(&sheet.details[next * channels], 1 / (step * step));
    }
  }
  covariance.finish();
  return covariance;
}

}  // namespace

std::vector<int16_t> choose_spectra(const AlignedLayout& layout, const AlignedTotals& totals,
                                    const std::vector<AlignedSource::Impl::Sheet>& sheets) {
  const size_t channels = layout.channels;
  if (channels < kFewest) return {};
  const Covariance covariance = covariance_of(layout, totals, sheets);
  const size_t count = std::min(channels, kMost);
  // Start from cosines; every sweep multiplies by the covariance and makes the rows orthonormal again.
  std::vector<Row> rows(count, Row(channels));
  for (size_t k = 0; k < count; ++k)
    for (size_t i = 0; i < channels; ++i)
      rows[k][i] =
          std::cos(kPi * static_cast<double>(k) * (static_cast<double>(i) + 0.5) / static_cast<double>(channels));
  double left = 0;
  for (size_t i = 0; i < channels; ++i) left += covariance.sum[i * channels + i];
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (size_t k = 0; k < rows.size(); ++k) {
      if (sweep > 0) {
        Row next(channels, 0.0);
        for (size_t a = 0; a < channels; ++a)
          for (size_t b = 0; b < channels; ++b) next[a] += covariance.sum[a * channels + b] * rows[k][b];
        rows[k] = std::move(next);
      }
      if (!orthonormalise(rows, k)) rows.resize(k);
    }
  std::vector<int16_t> spectra;
  for (const Row& row : rows) {
    if (left <= kRest * kRest * static_cast<double>(channels)) break;
    for (size_t a = 0; a < channels; ++a) {
      double along = 0;
      for (size_t b = 0; b < channels; ++b) along += covariance.sum[a * channels + b] * row[b];
      left -= along * row[a];
      spectra.push_back(static_cast<int16_t>(std::lround(AlignedLayout::kSpectrumUnit * static_cast<float>(row[a]))));
    }
  }
  return spectra;
}

}  // namespace suite::sqt
