#include "sqt_fit/source_totals.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "sqt/portable_math.h"
#include "sqt/theta_grid.h"

namespace suite::sqt {

namespace {

// Where a leaf is asked: in its middle; the finest, which may hold a narrow lobe, where their values were asked.
struct SurveyedPoint {
  Dir direction;
  double area;
  ptrdiff_t node;
};
std::vector<SurveyedPoint> points_of(const AlignedLayout& layout, const std::vector<SurveyedLeaf>& leaves) {
  constexpr int kFine = 9;  // order
  std::vector<SurveyedPoint> points;
  points.reserve(leaves.size());
  for (const SurveyedLeaf& leaf : leaves) {
    const double area =
        cell_solid_angle(leaf.id.order()) * (layout.half_stored && mirrored(leaf.id) != leaf.id ? 2 : 1);
    if (leaf.id.order() < kFine)
      points.push_back({center_of(leaf.id), area, leaf.node});
    else
      for (int k = 0; k < 4; ++k)
        points.push_back({direction_in(leaf.id, {k & 1 ? 0.75 : 0.25, k & 2 ? 0.75 : 0.25}), 0.25 * area, leaf.node});
  }
  return points;
}

}  // namespace

void survey_totals(const Function& function, const AlignedLayout& layout,
                   const std::vector<std::vector<SurveyedLeaf>>& leaves,
                   const std::vector<AlignedSource::Impl::Sheet>& sheets, AlignedTotals& totals) {
  const size_t channels = layout.channels;
  const Function::Info& info = function.info();
  const ThetaGrid grid(layout.theta);
  std::vector<std::vector<SurveyedPoint>> points;
  for (const std::vector<SurveyedLeaf>& of_sheet : leaves) points.push_back(points_of(layout, of_sheet));
  std::vector<size_t> order(channels);
  for (size_t c = 0; c < channels; ++c)
    order[c] = static_cast<size_t>(
        std::lower_bound(totals.magnitude_um.begin(), totals.magnitude_um.end(), info.wavelength_um[c]) -
        totals.magnitude_um.begin());
  totals.magnitudes.assign(totals.theta.size() * totals.phi_count * totals.magnitude_um.size(), 0.0f);
  parallel_for(0, totals.theta.size() * totals.phi_count, 1, [&](size_t begin, size_t end) {
    std::vector<double> f(channels), sum(channels);
    for (size_t t = begin; t < end; ++t) {
      const double theta = totals.theta[t / totals.phi_count];
      const size_t j = t % totals.phi_count;
      const Dir out = dir_from_angles(theta, 2 * kPi * static_cast<double>(j) / static_cast<double>(totals.phi_count));
      const ThetaGrid::At at = grid.locate(theta);
      const size_t nearest = std::min(at.low + (at.t > 0.5 ? 1 : 0), grid.size() - 1) * layout.phi_count + j;
      std::fill(sum.begin(), sum.end(), 0.0);
      for (size_t s = 0; s < leaves.size(); ++s) {
        const LobeMap map(layout.frame, out, s == 1);
        for (const SurveyedPoint& leaf : points[s]) {
          const double area = leaf.area;
          const Dir d = leaf.direction;
          const double cosine = map.cosine(d);
          if (layout.upper_only && !(cosine > 0)) continue;
          function.value(out, map.incident(d), f);
          const double weight = area * map.stretch(d) * (layout.cosine_weighted ? std::fabs(cosine) : 1.0);
          const bool valid = std::all_of(f.begin(), f.end(), [](double v) { return std::isfinite(v); });
          const bool filled = !valid && leaf.node >= 0;
          if (!valid && !filled) continue;
          for (size_t c = 0; c < channels; ++c) {
            const double value =
                valid ? f[c] : std::exp2(sheets[s].data.value(static_cast<size_t>(leaf.node))[nearest * channels + c]);
            if (value > 0) sum[c] += weight * value;
          }
        }
      }
      for (size_t c = 0; c < channels; ++c)
        totals.magnitudes[t * totals.magnitude_um.size() + order[c]] = static_cast<float>(sum[c]);
    }
  });
}

std::vector<SurveyedLeaf> leaves_of(const AlignedLayout& layout, const AlignedSource::Impl::Sheet& sheet) {
  const size_t views = layout.views();
  std::vector<uint8_t> known(sheet.data.size(), 0);
  std::vector<SurveyedLeaf> leaves;
  for (size_t i = 0; i < sheet.data.size(); ++i) {
    const Lattice::Node& node = sheet.data.node(i);
    for (size_t v = 0; v < views && !known[i]; ++v) known[i] = sheet.valid[i * views + v];
    for (int k = 0; k < node.child_count; ++k) known[static_cast<size_t>(node.first_child + k)] = known[i];
    if (node.first_child < 0) leaves.push_back({node.id, known[i] ? static_cast<ptrdiff_t>(i) : -1});
  }
  return leaves;
}

void survey_dirac(const Function& function, const AlignedLayout& layout, AlignedTotals& totals) {
  totals.delta_kind = function.dirac();
  totals.delta_core = function.dirac_core();
  if (totals.delta_kind == Dirac::none) return;
  const size_t channels = layout.channels, rows = totals.theta.size() * totals.phi_count;
  totals.delta.assign(rows * channels, 0.0f);
  parallel_for(0, rows, 1, [&](size_t begin, size_t end) {
    std::vector<double> W(channels);
    for (size_t t = begin; t < end; ++t) {
      const double phi = 2 * kPi * static_cast<double>(t % totals.phi_count) / static_cast<double>(totals.phi_count);
      function.dirac_total(dir_from_angles(totals.theta[t / totals.phi_count], phi), W);
      for (size_t c = 0; c < channels; ++c)
        totals.delta[t * channels + c] = static_cast<float>(std::clamp(W[c], 0.0, 1.0));
    }
  });
}

int step_reference(const AlignedTotals& totals, const AlignedLayout& layout) {
  double sum = 0, norm = 0;
  const size_t m = totals.magnitude_um.size();
  for (size_t i = 0; i < totals.theta.size(); ++i)
    for (size_t k = 0; k < totals.phi_count * m; ++k) {
      const double w = std::sin(totals.theta[i]) + 0.05;
      sum += w * totals.magnitudes[i * totals.phi_count * m + k];
      norm += w;
    }
  const double area = layout.upper_only ? 2 * kPi : 4 * kPi;
  return static_cast<int>(
      std::clamp(std::floor(4 * portable_log2(std::max(1e-9, sum / norm / area)) + 0.5), -120.0, 120.0));
}

}  // namespace suite::sqt
