#include "sqt/aligned_codec.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "sqt/portable_math.h"

namespace suite::sqt {

namespace {

// Orthonormal DCT-II matrix, [frequency][index].
std::vector<double> cosine_matrix(size_t n) {
  std::vector<double> m(n * n);
  for (size_t k = 0; k < n; ++k)
    for (size_t i = 0; i < n; ++i)
      m[k * n + i] = std::sqrt((k ? 2.0 : 1.0) / static_cast<double>(n)) *
                     portable_cos_pi(static_cast<long long>(k * (2 * i + 1)), static_cast<long long>(2 * n));
  return m;
}

// Orthonormal real Fourier matrix for a periodic index: 1, cos 1, sin 1, cos 2, ...
std::vector<double> fourier_matrix(size_t n) {
  std::vector<double> m(n * n);
  for (size_t k = 0; k < n; ++k) {
    const long long wave = static_cast<long long>((k + 1) / 2), count = static_cast<long long>(n);
    const bool plain = k == 0 || (n % 2 == 0 && k == n - 1);
    for (size_t i = 0; i < n; ++i) {
      const long long turn = 4 * wave * static_cast<long long>(i);  // of 2 pi / (4 n) each
      const double value =
          (plain || k % 2) ? portable_cos_pi(turn, 2 * count) : portable_cos_pi(turn - count, 2 * count);
      m[k * n + i] = value * std::sqrt((plain ? 1.0 : 2.0) / static_cast<double>(n));
    }
  }
  return m;
}

}  // namespace

BlockTransform::BlockTransform(const AlignedLayout& layout) : views_(layout.views()), channels_(layout.channels) {
  const size_t nt = layout.theta.size(), np = layout.phi_count;
  const std::vector<double> t = cosine_matrix(nt), p = fourier_matrix(np), c = cosine_matrix(channels_);
  channel_.assign(c.begin(), c.end());
  // View frequencies in the order of their height.
  std::vector<std::pair<int, size_t>> order;
  for (size_t k = 0; k < views_; ++k) order.push_back({static_cast<int>(k / np + (k % np + 1) / 2), k});
  std::stable_sort(order.begin(), order.end(), [](auto& a, auto& b) { return a.first < b.first; });
  for (const auto& [height, k] : order) {
    height_.push_back(height);
    for (size_t i = 0; i < nt; ++i)
      for (size_t j = 0; j < np; ++j) view_.push_back(static_cast<float>(t[(k / np) * nt + i] * p[(k % np) * np + j]));
  }
}

void BlockTransform::forward(std::span<const float> values, std::span<float> out) const {
  std::vector<float> mixed(views_ * channels_);  // [channel frequency][view]
  for (size_t c = 0; c < channels_; ++c)
    for (size_t v = 0; v < views_; ++v) {
      float sum = 0;
      for (size_t i = 0; i < channels_; ++i) sum += channel_[c * channels_ + i] * values[v * channels_ + i];
      mixed[c * views_ + v] = sum;
    }
  for (size_t c = 0; c < channels_; ++c)
    for (size_t k = 0; k < views_; ++k) {
      float sum = 0;
      for (size_t v = 0; v < views_; ++v) sum += view_[k * views_ + v] * mixed[c * views_ + v];
      out[c * views_ + k] = sum;
    }
}

void BlockTransform::inverse(std::span<const float> coefficients, std::span<float> values) const {
  std::vector<float> mixed(views_ * channels_, 0.0f);
  for (size_t c = 0; c < channels_; ++c)
    for (size_t k = 0; k < views_; ++k) {
      const float a = coefficients[c * views_ + k];
      if (a == 0) continue;
      for (size_t v = 0; v < views_; ++v) mixed[c * views_ + v] += a * view_[k * views_ + v];
    }
  std::fill(values.begin(), values.end(), 0.0f);
  for (size_t c = 0; c < channels_; ++c)
    for (size_t i = 0; i < channels_; ++i) {
      const float a = channel_[c * channels_ + i];
      for (size_t v = 0; v < views_; ++v) values[v * channels_ + i] += a * mixed[c * views_ + v];
    }
}

StepRule::StepRule(const AlignedLayout& layout, double reference)
    : layout_(layout), reference_(reference), log2_quality_(portable_log2(layout.quality)) {
  for (const double theta : layout.theta)
    for (size_t j = 0; j < layout.phi_count; ++j) {
      const double phi = 2 * kPi * static_cast<double>(j) / static_cast<double>(layout.phi_count);
      maps_.emplace_back(layout.frame, dir_from_angles(theta, phi), false);
      view_weight_.push_back(static_cast<float>(std::sin(theta) + 0.05));
    }
}

float StepRule::step(CellId cell, std::span<const float> value) const {
  constexpr double kWeightPower = 0.75, kAreaPower = 0.5;
  const Dir d = center_of(cell);
  float sum = 0, norm = 0;
  for (size_t v = 0; v < maps_.size(); ++v) {
    float mean = 0;
    for (size_t c = 0; c < layout_.channels; ++c) mean += value[v * layout_.channels + c];
    const double cosine = layout_.cosine_weighted ? std::max(0.02, std::fabs(maps_[v].cosine(d))) : 1.0;
    sum += view_weight_[v] * portable_exp2(mean / static_cast<float>(layout_.channels)) *
           static_cast<float>(cosine * maps_[v].stretch(d));
    norm += view_weight_[v];
  }
  const double weight = portable_log2(std::max(1e-30f, sum / norm)) - reference_;
  const double area = -2.0 * (cell.order() - 4);  // log2, relative to order 4
  double step = log2_quality_ - kWeightPower * weight - kAreaPower * area;
  step = std::clamp(step, -9.0, 1.0);
  // Quarter powers of two: the last bits of the weight do not matter.
  return portable_exp2(0.25f * static_cast<float>(std::floor(4 * step + 0.5)));
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

// ---- entropy model ----

namespace {
constexpr int kViewClasses = 6, kChannelClasses = 3, kNeighbour = 3;
int channel_class(size_t c) { return c == 0 ? 0 : c == 1 ? 1 : 2; }
int bucket(int n) { return std::min(n, 2); }
}  // namespace

BlockModel::BlockModel(const AlignedLayout& layout, const BlockTransform& transform)
    : views_(layout.views()),
      channels_(layout.channels),
      any_(3 * kChannelClasses * 4 * 4),
      significant_(kViewClasses * kChannelClasses * 9),
      last_(kViewClasses * kChannelClasses * 3),
      split_(16 * 5 * 2),
      magnitude_(kViewClasses * kChannelClasses * kNeighbour),
      nothing_(views_, 0) {
  for (size_t k = 0; k < views_; ++k) {
    const int h = transform.height(k);
    view_class_.push_back(h == 0 ? 0 : h == 1 ? 1 : h == 2 ? 2 : h <= 4 ? 3 : h <= 8 ? 4 : 5);
  }
}

template <class Coder>
bool BlockModel::code_split(Coder& coder, bool split, int order, int divided_around, bool parent_busy) {
  return coder.bit(split_[static_cast<size_t>((std::min(order, 15) * 5 + divided_around) * 2 + (parent_busy ? 1 : 0))],
                   split);
}

// Magnitudes >= 1: unary up to 14, then Exp-Golomb.
template <class Coder>
int BlockModel::code_magnitude(Coder& coder, int magnitude, Magnitude& contexts) {
  int m = 1;
  while (m < 15) {
    if (!coder.bit(contexts[static_cast<size_t>(m - 1)], magnitude > m)) return m;
    ++m;
  }
  const uint32_t rest = static_cast<uint32_t>(magnitude - 15) + 1;
  int bits = 0;
  while (bits < 20 && coder.bit(contexts[static_cast<size_t>(14 + std::min(bits, 5))], (rest >> (bits + 1)) != 0))
    ++bits;
  uint32_t value = 1;
  for (int b = bits - 1; b >= 0; --b) value = (value << 1) | (coder.even_bit((rest >> b) & 1) ? 1u : 0u);
  return static_cast<int>(value) - 1 + 15;
}

template <class Coder>
void BlockModel::code(Coder& coder, std::span<int32_t> block, size_t details, std::span<const int32_t> parent,
                      int order) {
  const size_t width = views_ * channels_;
  const int depth = std::min(3, order / 2);
  const bool has_parent = parent.size() == 3 * width;
  int busy_before = 0;
  for (size_t d = 0; d < details; ++d)
    for (size_t c = 0; c < channels_; ++c) {
      // Levels known already at the same frequencies: of the parent, of the detail and of the channel before.
      const size_t base = d * width + c * views_;
      int32_t* row = &block[base];
      const int32_t* above = has_parent ? &parent[base] : nothing_.data();
      const int32_t* detail = d > 0 ? row - width : nothing_.data();
      const int32_t* channel = c > 0 ? row - views_ : nothing_.data();
      // Is there anything in this row?
      int parent_any = 0;
      for (size_t k = 0; k < views_ && parent_any < 3; ++k) parent_any += std::min(2, std::abs(above[k]));
      size_t end = views_;
      if constexpr (Coder::kEncodes)
        while (end > 0 && row[end - 1] == 0) --end;
      const size_t any_context = static_cast<size_t>(
          ((depth * 3 + channel_class(c)) * 4 + std::min(3, parent_any)) * 3 + std::min(2, busy_before));
      if (!coder.bit(any_[any_context], end > 0)) {
        std::fill_n(row, views_, int32_t{0});
        busy_before = std::max(0, busy_before - (c + 1 == channels_ ? 1 : 0));
        continue;
      }
      busy_before = std::min(2, busy_before + 1);
      int before = 0;
      for (size_t k = 0; k < views_; ++k) {
        const int up = std::abs(above[k]), beside = std::abs(detail[k]) + std::abs(channel[k]) + before;
        const size_t where = static_cast<size_t>(view_class_[k] * kChannelClasses + channel_class(c));
        const int known = row[k];
        if (!coder.bit(significant_[where * 9 + static_cast<size_t>(bucket(up) * 3 + bucket(beside))], known != 0)) {
          row[k] = before = 0;
          continue;
        }
        const int m =
            code_magnitude(coder, std::abs(known),
                           magnitude_[where * kNeighbour + static_cast<size_t>(bucket((up + beside + 1) / 2))]);
        const bool negative = coder.even_bit(known < 0);
        row[k] = negative ? -m : m;
        before = m;
        if (k + 1 < views_ && coder.bit(last_[where * 3 + static_cast<size_t>(bucket(up))], k + 1 == end)) {
          std::fill(row + k + 1, row + views_, int32_t{0});
          break;
        }
      }
    }
}

// ---- the walk ----

template <class Coder>
Lattice walk_sheet(const AlignedLayout& layout, const BlockTransform& transform, const StepRule& steps, Coder& coder,
                   Targets* targets, size_t max_nodes) {
  const size_t width = layout.width();
  Lattice lattice({layout.upper_only, layout.half_stored}, width);
  if (!targets) lattice.reserve(std::min(max_nodes, (size_t{1} << 23) / width));
  BlockModel model(layout, transform);
  std::vector<float> predicted(width, 0.0f), difference(3 * width), coefficient(3 * width), change(3 * width);
  std::vector<int32_t> levels(3 * width);
  std::vector<int32_t> blocks;                           // of divided nodes, one after the other
  std::vector<int32_t> block_above(lattice.size(), -1);  // index of the parent's block

  // Quantises (encoder) or not (decoder), codes, and reconstructs `count` rows of differences.
  auto convey = [&](size_t count, float step, std::span<const int32_t> parent, int order) {
    if (targets)
      for (size_t d = 0; d < count; ++d) {
        transform.forward({&difference[d * width], width}, {&coefficient[d * width], width});
        for (size_t j = 0; j < width; ++j) levels[d * width + j] = quantise(coefficient[d * width + j] / step);
      }
    model.code(coder, {levels.data(), count * width}, count, parent, order);
    for (size_t d = 0; d < count; ++d) {
      bool any = false;
      for (size_t j = 0; j < width; ++j) {
        coefficient[d * width + j] = static_cast<float>(levels[d * width + j]) * step;
        any |= levels[d * width + j] != 0;
      }
      if (any)
        transform.inverse({&coefficient[d * width], width}, {&change[d * width], width});
      else
        std::fill_n(&change[d * width], width, 0.0f);
    }
  };

  const float root_step = std::min(0.25f, static_cast<float>(layout.quality));
  for (size_t i = 0; i < lattice.size(); ++i) {
    if (targets) targets->root(i, predicted, {difference.data(), width});
    convey(1, root_step, {}, 0);
    for (size_t j = 0; j < width; ++j)
      predicted[j] = lattice.value(i)[j] = std::clamp(predicted[j] + change[j], -100.0f, 100.0f);
  }
  size_t begin = 0;
  while (begin < lattice.size()) {
    const size_t end = lattice.size();
    lattice.compute_slopes(begin, end);
    for (size_t i = begin; i < end; ++i) {
      const CellId id = lattice.node(i).id;
      if (id.order() >= kMaxOrder) continue;
      const std::span<const int32_t> parent =
          block_above[i] >= 0
              ? std::span<const int32_t>(&blocks[static_cast<size_t>(block_above[i]) * 3 * width], 3 * width)
              : std::span<const int32_t>{};
      bool busy = false;
      for (const int32_t l : parent) busy |= std::abs(int{l}) > 1;
      const int around = lattice.divided_around(i);
      if (!model.code_split(coder, targets ? targets->split(i) : false, id.order(), around, busy)) continue;
      if (lattice.size() + 4 > max_nodes) throw Error("SQT payload is damaged: more nodes than allowed");
      const float step = steps.step(id, lattice.value(i));
      if (targets) targets->differences(lattice, i, difference);
      convey(3, step, parent, id.order());
      blocks.insert(blocks.end(), levels.begin(), levels.end());
      lattice.divide(i);
      block_above.resize(lattice.size(), static_cast<int32_t>(blocks.size() / (3 * width)) - 1);
      const Lattice::Node node = lattice.node(i);
      size_t child = static_cast<size_t>(node.first_child);
      for (uint32_t k = 0; k < 4; ++k) {
        if (!(node.child_mask & (1u << k))) continue;
        const std::span<float> value = lattice.value(child++);
        lattice.predict(i, k, value);
        const float sx = k & 1 ? 1.0f : -1.0f, sy = k & 2 ? 1.0f : -1.0f, sxy = sx * sy;
        for (size_t j = 0; j < width; ++j)
          value[j] = std::clamp(value[j] + (sx * change[j] + sy * change[width + j] + sxy * change[2 * width + j]),
                                -100.0f, 100.0f);
      }
      if (targets) targets->divided(lattice, i);
    }
    begin = end;
  }
  return lattice;
}

template Lattice walk_sheet<RangeEncoder>(const AlignedLayout&, const BlockTransform&, const StepRule&, RangeEncoder&,
                                          Targets*, size_t);
template Lattice walk_sheet<RangeDecoder>(const AlignedLayout&, const BlockTransform&, const StepRule&, RangeDecoder&,
                                          Targets*, size_t);

}  // namespace suite::sqt
