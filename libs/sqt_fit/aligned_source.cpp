// Asking the function on an adaptive pyramid of cells; see aligned.h.
#include "sqt_fit/aligned_source.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "base/error.h"
#include "base/parallel.h"
#include "math/sampling.h"
#include "sqt_fit/families.h"
#include "sqt_fit/lobe_detection.h"
#include "sqt_fit/pole_mean.h"
#include "sqt_fit/source_means.h"
#include "sqt_fit/source_totals.h"
#include "sqt_fit/spectra.h"
#include "sqt_fit/view_placement.h"

namespace suite::sqt {

namespace {

constexpr double kMostNumbers = 3.2e7;  // of the pyramid's base

struct Cellful {
  std::vector<float> value;    // [view][channel] log2 average
  std::vector<uint8_t> valid;  // [view]
  bool divided = false;
};
using Pyramid = std::unordered_map<uint32_t, Cellful>;

// Asks one sheet of the function over one root cell and below.
class Surveyor {
 public:
  Surveyor(const Function& function, const AlignedLayout& layout, const AlignedSource::Options& options, int sheet,
           double floor, double whole)
      : function_(function),
        layout_(layout),
        options_(options),
        region_{layout.upper_only, layout.half_stored},
        floor_(floor),
        whole_(whole) {
    for (const double theta : layout.theta)
      for (size_t j = 0; j < layout.phi_count; ++j) {
        out_.push_back(
            dir_from_angles(theta, 2 * kPi * static_cast<double>(j) / static_cast<double>(layout.phi_count)));
        maps_.emplace_back(layout.frame, out_.back(), sheet == 1);
        view_weight_.push_back((std::sin(theta) + 0.02) / static_cast<double>(layout.phi_count));
      }
  }

  void survey(CellId id, Pyramid& into) const {
    if (into.count(id.code)) return;
    Cellful cell;
    bool divide = id.order() < options_.base_order;
    if (!divide) divide = ask(id, cell) > options_.detail * whole_ && id.order() < options_.max_order;
    if (divide) {
      gather(id, into, cell);
      cell.divided = true;
    }
    into[id.code] = std::move(cell);
  }

 private:
  // Averages over the children (all four count equally; see complete_values).
  void gather(CellId id, Pyramid& into, Cellful& cell) const {
    const size_t views = maps_.size(), channels = layout_.channels;
    const Cellful* child[4] = {};
    for (uint32_t k = 0; k < 4; ++k)
      if (region_.holds(id.child(k))) survey(id.child(k), into), child[k] = &into[id.child(k).code];
    cell.value.assign(views * channels, 0.0f);
    cell.valid.assign(views, 0);
    for (size_t v = 0; v < views; ++v) {
      unsigned present = 0;
      for (uint32_t k = 0; k < 4; ++k)
        if (child[k] && child[k]->valid[v]) present |= 1u << k;
      if (!present) continue;
      cell.valid[v] = 1;
      for (size_t c = 0; c < channels; ++c) {
        float f[4] = {};
        for (uint32_t k = 0; k < 4; ++k)
          if (present & (1u << k)) f[k] = child[k]->value[v * channels + c];
        complete_values(present, f);
        cell.value[v * channels + c] = 0.25f * (f[0] + f[1] + f[2] + f[3]);
      }
    }
  }

  // Values from a 2 x 2 subdivision; returns how much of the whole the variation inside the cell amounts to.
  double ask(CellId id, Cellful& cell) const {
    const size_t views = maps_.size(), channels = layout_.channels;
    const double area = cell_solid_angle(id.order());
    cell.value.assign(views * channels, 0.0f);
    cell.valid.assign(views, 0);
    Dir point[4];
    for (int k = 0; k < 4; ++k) point[k] = direction_in(id, {k & 1 ? 0.75 : 0.25, k & 2 ? 0.75 : 0.25});
    std::vector<double> f(4 * channels);
    double variation = 0;
    for (size_t v = 0; v < views; ++v) {
      double weight[4], sum_weight = 0;
      for (int k = 0; k < 4; ++k) {
        const Dir in = maps_[v].incident(point[k]);
        const double cosine = maps_[v].cosine(point[k]);
        weight[k] = 0;
        if (layout_.upper_only && !(cosine > 0)) continue;
        function_.value(out_[v], in, {&f[static_cast<size_t>(k) * channels], channels});
        bool fine = true;
        for (size_t c = 0; c < channels; ++c) fine &= std::isfinite(f[static_cast<size_t>(k) * channels + c]);
        if (!fine) continue;
        weight[k] = maps_[v].stretch(point[k]) * (layout_.cosine_weighted ? std::fabs(cosine) : 1.0);
        sum_weight += weight[k];
      }
      if (!(sum_weight > 0)) continue;
      cell.valid[v] = 1;
      for (size_t c = 0; c < channels; ++c) {
        double mean = 0, spread = 0;
        for (size_t k = 0; k < 4; ++k)
          if (weight[k] > 0) mean += weight[k] * std::max(floor_, f[k * channels + c]);
        mean /= sum_weight;
        for (size_t k = 0; k < 4; ++k)
          if (weight[k] > 0) spread += weight[k] * std::fabs(std::max(floor_, f[k * channels + c]) - mean);
        cell.value[v * channels + c] = static_cast<float>(std::log2(mean));
        variation += view_weight_[v] * spread * 0.25 * area;
      }
    }
    return variation;
  }

  const Function& function_;
  const AlignedLayout& layout_;
  const AlignedSource::Options& options_;
  Region region_;
  double floor_, whole_;
  std::vector<Dir> out_;
  std::vector<LobeMap> maps_;
  std::vector<double> view_weight_;
};

// Whether any view looks at a root from above the horizon.
bool seen(const AlignedLayout& layout, CellId root) {
  for (const double theta : layout.theta)
    for (size_t j = 0; j < layout.phi_count; ++j) {
      const LobeMap map(
          layout.frame,
          dir_from_angles(theta, 2 * kPi * static_cast<double>(j) / static_cast<double>(layout.phi_count)), false);
      for (uint32_t k = 0; k < 64; ++k)
        if (!layout.upper_only || map.cosine(center_of(CellId::of(root.order() + 3, (root.index() << 6) + k))) > 0.02)
          return true;
    }
  return false;
}

// Roots that are seen but of which nothing is known take the mean of the others. (Those below the horizon are
// nobody's.)
void level_unknown_roots(const AlignedLayout& layout, AlignedSource::Impl::Sheet& sheet) {
  const size_t views = layout.views(), roots = sheet.data.size();
  std::vector<float> mean(layout.width(), 0.0f);
  std::vector<size_t> unknown;
  size_t known = 0;
  for (size_t i = 0; i < roots; ++i) {
    const auto first = sheet.valid.begin() + static_cast<ptrdiff_t>(i * views);
    if (std::find(first, first + static_cast<ptrdiff_t>(views), 1) == first + static_cast<ptrdiff_t>(views)) {
      if (seen(layout, sheet.data.node(i).id)) unknown.push_back(i);
      continue;
    }
    ++known;
    for (size_t j = 0; j < mean.size(); ++j) mean[j] += sheet.data.value(i)[j];
  }
  if (!known) return;
  for (const size_t i : unknown)
    for (size_t j = 0; j < mean.size(); ++j) sheet.data.value(i)[j] = mean[j] / static_cast<float>(known);
}

// The pyramid in the lattice's order, with slopes.
AlignedSource::Impl::Sheet assemble(const AlignedLayout& layout, const Pyramid& pyramid) {
  AlignedSource::Impl::Sheet sheet{Lattice({layout.upper_only, layout.half_stored}, layout.width()), {}, {}, {}, {}};
  Lattice& data = sheet.data;
  std::vector<ptrdiff_t> parent(data.size(), -1);
  size_t begin = 0;
  while (begin < data.size()) {
    const size_t end = data.size();
    for (size_t i = begin; i < end; ++i) {
      const Cellful& cell = pyramid.at(data.node(i).id.code);
      std::vector<float> value = cell.value;
      std::vector<int> known(cell.valid.begin(), cell.valid.end());
      fill_unknown(layout, known, value, 1);
      if (std::find(known.begin(), known.end(), 1) == known.end() && parent[i] >= 0)
        std::copy_n(data.value(static_cast<size_t>(parent[i])).begin(), value.size(), value.begin());
      std::copy(value.begin(), value.end(), data.value(i).begin());
      sheet.valid.insert(sheet.valid.end(), cell.valid.begin(), cell.valid.end());
    }
    if (begin == 0) level_unknown_roots(layout, sheet);
    data.compute_slopes(begin, end);
    for (size_t i = begin; i < end; ++i)
      if (pyramid.at(data.node(i).id.code).divided)
        data.divide(i), parent.resize(data.size(), static_cast<ptrdiff_t>(i));
    begin = end;
  }
  return sheet;
}

LogScale scale_of(const std::vector<AlignedSource::Impl::Sheet>& sheets) {
  float low = std::numeric_limits<float>::max(), high = -low;
  for (const auto& sheet : sheets)
    for (size_t i = 0; i < sheet.data.size(); ++i)
      for (const float v : sheet.data.value(i)) low = std::min(low, v), high = std::max(high, v);
  return LogScale::of(low, high);
}

// Cosine-weighted relative l1 between a function and the mean of its two mirror images.
double cost_of_folding(const Function& function) {
  const size_t channels = function.info().wavelength_um.size();
  std::vector<double> left(channels), right(channels);
  double difference = 0, sum = 0;
  const SampleStream points(11, 0, 0);
  for (uint32_t i = 0; i < 4096; ++i) {
    const auto u = points.draw(i, 0);
    const Dir out = dir_from_angles(80 * kDegree * u[2], 0), in = dir_from_angles(std::acos(1 - u[0]), 2 * kPi * u[1]);
    function.value(out, in, left);
    function.value(out, {in.x, -in.y, in.z}, right);
    for (size_t c = 0; c < channels; ++c) {
      if (!std::isfinite(left[c]) || !std::isfinite(right[c])) continue;
      difference += 0.5 * std::fabs(left[c] - right[c]) * in.z;
      sum += 0.5 * (left[c] + right[c]) * in.z;
    }
  }
  return sum > 0 ? difference / sum : 0;
}

}  // namespace

AlignedSource::AlignedSource(const Function& data, const Options& asked, const std::function<void(double)>& progress)
    : impl_(new Impl) {
  const PoleMean mean(data);
  const Function& function = mean.function();
  Impl& m = *impl_;
  Options options = asked;
  m.function = function.info();
  AlignedLayout& layout = m.layout;
  const bool surface = m.function.quantity == Quantity::bsdf;
  layout.channels = m.function.wavelength_um.size();
  SUITE_CHECK(layout.channels > 0);
  layout.cosine_weighted = surface;
  layout.upper_only = surface;
  layout.frame = options.frame                            ? *options.frame
                 : surface                                ? detect_frame(function)
                 : m.function.quantity == Quantity::phase ? LobeFrame::forward
                                                          : LobeFrame::direct;
  layout.half_stored = m.function.isotropic && m.function.bilateral &&
                       (options.fold_error >= 1 || cost_of_folding(function) <= options.fold_error);
  layout.sheets = surface && m.function.domain == Domain::sphere ? 2 : 1;
  layout.theta = surface ? place_views(function, layout.frame, options.views, options.most_views, 89.9 * kDegree,
                                       options.view_error)
                         : std::vector<double>{0};
  layout.phi_count = !surface || m.function.isotropic ? 1
                     : options.azimuths               ? options.azimuths
                                                      : count_azimuths(function, layout.frame, options.view_error);
  // Some hundred wavelengths or views at many azimuths: coarser cells, so that the pyramid stays below a GiB.
  const double cells_of_sphere = (layout.upper_only ? 0.5 : 1) * (layout.half_stored ? 0.5 : 1) * layout.sheets;
  while (options.base_order > 3 &&
         cell_count(options.base_order) * cells_of_sphere * static_cast<double>(layout.width()) > kMostNumbers)
    --options.base_order;
  options.detail *= std::max(1.0, static_cast<double>(layout.width()) / 2000);
  m.totals.phi_count = layout.phi_count;
  m.totals.magnitude_um = m.function.wavelength_um;
  std::sort(m.totals.magnitude_um.begin(), m.totals.magnitude_um.end());
  m.totals.theta = total_angles(layout.theta);

  // A first look at order 4 gives the whole (mean total) and the floor below which values count as dark.
  const Region region{layout.upper_only, layout.half_stored};
  std::vector<std::vector<SurveyedLeaf>> coarse(static_cast<size_t>(layout.sheets));
  for (auto& cells : coarse)
    for (uint32_t i = 0; i < cell_count(4); ++i)
      if (region.holds(CellId::of(4, i))) cells.push_back({CellId::of(4, i), -1});
  survey_totals(function, layout, coarse, {}, m.totals);
  double whole = 0, norm = 0;
  for (size_t i = 0; i < m.totals.magnitudes.size(); ++i) whole += m.totals.magnitudes[i], norm += 1;
  whole = whole / norm * static_cast<double>(layout.channels);
  const double floor = std::max(1e-12, 1e-4 * whole / static_cast<double>(layout.channels) / kPi);
  double weight = 0;
  for (const double theta : layout.theta) weight += std::sin(theta) + 0.02;

  std::vector<std::vector<SurveyedLeaf>> leaves;
  for (int s = 0; s < layout.sheets; ++s) {
    const Surveyor surveyor(function, layout, options, s, floor, std::max(1e-9, whole * weight));
    std::vector<CellId> roots;
    for (uint32_t i = 0; i < cell_count(3); ++i)
      if (region.holds(CellId::of(3, i))) roots.push_back(CellId::of(3, i));
    std::vector<Pyramid> parts(roots.size());
    parallel_for(0, roots.size(), 1, [&](size_t begin, size_t end) {
      for (size_t r = begin; r < end; ++r) {
        surveyor.survey(roots[r], parts[r]);
        if (progress) progress(0.8 / static_cast<double>(roots.size() * static_cast<size_t>(layout.sheets)));
      }
    });
    for (size_t r = 1; r < parts.size(); ++r) parts[0].merge(parts[r]);
    for (uint32_t i = 0; i < cell_count(Lattice::kRootOrder); ++i)
      if (region.holds(CellId::of(Lattice::kRootOrder, i)))
        surveyor.survey(CellId::of(Lattice::kRootOrder, i), parts[0]);
    m.sheets.push_back(assemble(layout, parts[0]));
    leaves.push_back(leaves_of(layout, m.sheets.back()));
    find_means(layout, m.sheets.back());
    find_details(layout, m.sheets.back());
  }
  m.scale = scale_of(m.sheets);
  survey_totals(function, layout, leaves, m.sheets, m.totals);
  layout.refined = needs_finer_steps(layout, m.totals, m.sheets);
  layout.spectra = choose_spectra(layout, m.totals, m.sheets);
  for (Impl::Sheet& sheet : m.sheets) transform_details(layout, sheet);
  survey_dirac(function, layout, m.totals);
  if (surface)  // no surface returns more than it receives
    for (size_t t = 0; t < m.totals.theta.size() * m.totals.phi_count; ++t)
      for (size_t k = 0; k < layout.channels; ++k) {
        const size_t c = static_cast<size_t>(
            std::find(m.function.wavelength_um.begin(), m.function.wavelength_um.end(), m.totals.magnitude_um[k]) -
            m.function.wavelength_um.begin());
        float& W = m.totals.magnitudes[t * layout.channels + k];
        W = std::min(W, 1 - (m.totals.delta.empty() ? 0.0f : m.totals.delta[t * layout.channels + c]));
      }
  if (progress) progress(0.2);
}

AlignedSource::~AlignedSource() = default;
const Function::Info& AlignedSource::function() const { return impl_->function; }
const AlignedLayout& AlignedSource::layout() const { return impl_->layout; }
const AlignedTotals& AlignedSource::totals() const { return impl_->totals; }

}  // namespace suite::sqt
