#include "sqt/aligned_codec.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/error.h"
#include "sqt/cell_centers.h"
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

BlockTransform::BlockTransform(const AlignedLayout& layout)
    : views_(layout.views()), channels_(layout.channels), stride_((views_ + 31) / 32 * 32) {
  const size_t nt = layout.theta.size(), np = layout.phi_count;
  const std::vector<double> t = cosine_matrix(nt), p = fourier_matrix(np);
  if (layout.spectra.empty()) {
    const std::vector<double> c = cosine_matrix(channels_);
    channel_.assign(c.begin(), c.end());
  } else {
    channel_.resize(channels_ * channels_, 0.0f);
    for (size_t j = 0; j < layout.spectra.size(); ++j)
      channel_[j] = static_cast<float>(layout.spectra[j]) / AlignedLayout::kSpectrumUnit;
  }
  // View frequencies in the order of their height.
  std::vector<std::pair<int, size_t>> order;
  for (size_t k = 0; k < views_; ++k) order.push_back({static_cast<int>(k / np + (k % np + 1) / 2), k});
  std::stable_sort(order.begin(), order.end(), [](auto& a, auto& b) { return a.first < b.first; });
  view_.resize(views_ * stride_, 0.0f);
  for (size_t n = 0; n < views_; ++n) {
    const auto [height, k] = order[n];
    height_.push_back(height);
    for (size_t i = 0; i < nt; ++i)
      for (size_t j = 0; j < np; ++j)
        view_[n * stride_ + i * np + j] = static_cast<float>(t[(k / np) * nt + i] * p[(k % np) * np + j]);
  }
  mixed_.resize(channels_ * stride_);
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
      for (size_t v = 0; v < views_; ++v) sum += view_[k * stride_ + v] * mixed[c * views_ + v];
      out[c * views_ + k] = sum;
    }
}

bool BlockTransform::inverse(const int32_t* levels, const uint16_t* counts, float step, int16_t* values) const {
  size_t channels = channels_;
  while (channels > 0 && counts[channels - 1] == 0) --channels;
  if (!channels) return false;
  for (size_t c = 0; c < channels; ++c) {
    float* to = &mixed_[c * stride_];
    for (size_t v = 0; v < stride_; v += 32) {
      EightFloats sum[4] = {};
      for (size_t k = 0; k < counts[c]; ++k) {
        const float a = static_cast<float>(levels[c * views_ + k]) * step;
        const float* basis = &view_[k * stride_ + v];
        for (size_t part = 0; part < 4; ++part) sum[part] += a * load<EightFloats>(basis + 8 * part);
      }
      for (size_t part = 0; part < 4; ++part) store(to + v + 8 * part, sum[part]);
    }
  }
  // Adding 1.5 * 2^23 leaves the nearest whole number in the low bits.
  constexpr float kRound = 12582912.0f;
  for (size_t i = 0; i < channels_; ++i)
    for (size_t v = 0; v < views_; v += 8) {
      EightFloats sum = channel_[i] * load<EightFloats>(&mixed_[v]);
      for (size_t c = 1; c < channels; ++c)
        sum += channel_[c * channels_ + i] * load<EightFloats>(&mixed_[c * stride_ + v]);
      const EightFloats most = EightFloats{} + static_cast<float>(LogScale::kMost), least = -most;
      sum = sum > most ? most : sum;
      sum = sum < least ? least : sum;
      const Short8 whole =
          __builtin_convertvector(reinterpret_cast<Int8>(sum + kRound) - std::bit_cast<int32_t>(kRound), Short8);
      // The next channel, or the room behind the row, takes what goes beyond.
      store(values + i * views_ + v, whole);
    }
  return true;
}

ViewLanes::ViewLanes(const AlignedLayout& layout)
    : reflects(layout.frame == LobeFrame::half || layout.frame == LobeFrame::retro), views(layout.views()) {
  const size_t n = padded_row(views);
  x.resize(n, 0), y.resize(n, 0), z.resize(n, 0), weight.resize(n, 0);
  for (size_t i = 0; i < layout.theta.size(); ++i)
    for (size_t j = 0; j < layout.phi_count; ++j) {
      // Portable, unlike the sine and cosine of the library.
      const double turn = static_cast<double>(j) / static_cast<double>(layout.phi_count);
      const auto cosine = [](double angle) { return portable_cos_pi(std::llround(angle * 0x1p40 / kPi), 1LL << 40); };
      const double sine = cosine(layout.theta[i] - kPi / 2), side = layout.frame == LobeFrame::retro ? -1 : 1;
      const size_t v = i * layout.phi_count + j;
      x[v] = static_cast<float>(side * sine * cosine(2 * kPi * turn));
      y[v] = static_cast<float>(side * sine * cosine(2 * kPi * turn - kPi / 2));
      z[v] = static_cast<float>(cosine(layout.theta[i]));
      weight[v] = static_cast<float>(sine + 0.05);
    }
}

namespace {
constexpr double kLeastStep = -9, kMostStep = 1;  // log2 of the steps there are
}

StepRule::StepRule(const AlignedLayout& layout, double reference)
    : layout_(layout), reference_(reference), log2_quality_(portable_log2(layout.quality)), lanes_(layout) {
  for (const float w : lanes_.weight) norm_ += w;
}

double StepRule::wanted(const Center& d, int order, const float* mean) const {
  constexpr double kWeightPower = 0.75, kAreaPower = 0.5;
  EightFloats sums{};
  for (size_t v = 0; v < lanes_.views; v += 8) {
    EightFloats stretch, cosine;
    lanes_.at(v, d, stretch, cosine);
    cosine = cosine < 0 ? -cosine : cosine;
    cosine = cosine < 0.02f ? EightFloats{} + 0.02f : cosine;
    if (!layout_.cosine_weighted) cosine = EightFloats{} + 1;
    sums += load<EightFloats>(&lanes_.weight[v]) * portable_exp2(load<EightFloats>(mean + v)) * cosine * stretch;
  }
  const float sum = ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
  const double weight = portable_log2(std::max(1e-30f, sum / norm_)) - reference_;
  const double area = -2.0 * (order - 4);  // log2, relative to order 4
  return log2_quality_ - kWeightPower * weight - kAreaPower * area;
}

float StepRule::step(const Center& d, int order, const float* mean, int finer) const {
  const double step = std::clamp(wanted(d, order, mean) - finer, kLeastStep, kMostStep);
  // Quarter powers of two: the last bits of the weight do not matter.
  return portable_exp2(0.25f * static_cast<float>(std::floor(4 * step + 0.5)));
}

int StepRule::finer(const Center& d, int order, const float* mean, const float* should) const {
  const double stated = wanted(d, order, mean), right = wanted(d, order, should);
  if (std::clamp(right, kLeastStep, kMostStep) > std::clamp(stated, kLeastStep, kMostStep) - 1) return 0;
  return static_cast<int>(std::clamp(std::floor(stated - right + 0.5), 0.0, double{BlockCode::kMostFiner}));
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

namespace {

// One sheet being rebuilt, level by level.
template <class Coder>
class SheetWalk {
 public:
  SheetWalk(const AlignedLayout& layout, LogScale scale, const BlockTransform& transform, const StepRule& steps,
            Coder& coder, Targets* targets, LeafTable* leaves, size_t max_nodes)
      : layout_(layout),
        scale_(scale),
        transform_(transform),
        steps_(steps),
        coder_(coder),
        targets_(targets),
        leaves_(leaves),
        max_nodes_(max_nodes),
        width_(layout.width()),
        lattice_({layout.upper_only, layout.half_stored}, width_),
        blocks_(layout, transform),
        levels_(3 * width_),
        changes_(3 * (lattice_.row() + 16), int16_t{0}),
        mean_(padded_row(layout.views())),
        difference_(targets ? 3 * width_ : 0),
        coefficient_(difference_.size()) {
    if (!targets) lattice_.reserve(std::min(max_nodes, (size_t{1} << 24) / width_));
  }

  void run() {
    roots();
    size_t begin = 0, above = 0;
    while (begin < lattice_.size()) {
      const size_t end = lattice_.size();
      if (begin > 0) {
        read_splits(above, begin);
        lattice_.link(begin, end);
      }
      find_centers(begin, end);
      for (size_t i = begin; i < end; ++i) visit(i, centers_[i - begin]);
      above = begin, begin = end;
    }
  }

 private:
  // Roots, each predicted by the one before, and which of them are divided.
  void roots() {
    const float step = std::min(0.25f, static_cast<float>(layout_.quality));
    std::vector<int16_t> predicted(lattice_.row(), 0);
    std::vector<float> known(width_);
    for (size_t i = 0; i < lattice_.size(); ++i) {
      if (targets_) {
        to_source(predicted.data(), known);
        targets_->root(i, known, {difference_.data(), width_});
      }
      const int32_t block = convey(1, step, -1);
      const bool any = change(0, block, step);
      int16_t* value = lattice_.value(i);
      for (size_t j = 0; j < lattice_.row(); ++j) {
        const int sum = predicted[j] + (any && j < width_ ? change_row(0)[j] : 0);
        predicted[j] = value[j] = static_cast<int16_t>(std::clamp(sum, -LogScale::kMost, LogScale::kMost));
      }
    }
    for (size_t i = 0; i < lattice_.size(); ++i)
      lattice_.node(i).split = coder_.raw(targets_ && targets_->split(i) ? 1 : 0, 1) != 0;
  }
  // For the children of the nodes [begin, end).
  void read_splits(size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const CodedLattice::Node& node = lattice_.node(i);
      if (node.first_child < 0 || node.order + 1 >= kMaxOrder) continue;
      uint32_t mask = 0;
      if (targets_) {
        size_t child = static_cast<size_t>(node.first_child);
        for (uint32_t k = 0; k < 4; ++k)
          if (node.child_mask & (1u << k)) mask |= targets_->split(child++) ? 1u << k : 0;
      }
      mask = blocks_.code_split(coder_, mask, block_[i], lattice_.divided_around(i));
      size_t child = static_cast<size_t>(node.first_child);
      for (uint32_t k = 0; k < 4; ++k)
        if (node.child_mask & (1u << k)) lattice_.node(child++).split = (mask & (1u << k)) != 0;
    }
  }
  void find_centers(size_t begin, size_t end) {
    centers_.resize((end - begin + 7) / 8 * 8);
    for (size_t i = begin; i < end; i += 8) {
      CellLanes cells;
      for (size_t lane = 0; lane < std::min<size_t>(8, end - i); ++lane) cells.set(lane, lattice_.node(i + lane).at);
      EightFloats x, y, z;
      centers_of(cells, lattice_.node(i).order, x, y, z);
      for (size_t lane = 0; lane < 8; ++lane) centers_[i - begin + lane] = {x[lane], y[lane], z[lane]};
    }
  }
  void visit(size_t i, const Center& center) {
    lattice_.find_slopes(i);
    block_.resize(lattice_.size(), -1);
    const CodedLattice::Node& node = lattice_.node(i);
    if (!node.split) {
      if (leaves_)
        leaves_->add(node.at, node.order, center, lattice_.value(i), lattice_.slope(i, 0), lattice_.slope(i, 1));
      return;
    }
    if (lattice_.size() + 4 > max_nodes_) throw Error("SQT payload is damaged: more nodes than allowed");
    const float step = steps_.step(center, node.order, mean_of(i), find_finer(i));
    if (targets_) targets_->differences(lattice_, i, difference_);
    const int32_t block = convey(3, step, node.parent >= 0 ? block_[static_cast<size_t>(node.parent)] : -1);
    block_[i] = block;
    const int16_t* details[3];
    for (size_t d = 0; d < 3; ++d) details[d] = change(d, block, step) ? change_row(d) : nullptr;
    lattice_.divide(i, details);
    if (targets_) targets_->divided(lattice_, i);
  }
  // Octaves by which a divided node's step is finer: stated below nodes that have some.
  int find_finer(size_t i) {
    if (!layout_.refined) return 0;
    finer_.resize(lattice_.size(), 0);
    const int32_t parent = lattice_.node(i).parent;
    const int above = parent >= 0 ? finer_[static_cast<size_t>(parent)] : -1;
    if (above != 0)
      finer_[i] = static_cast<uint8_t>(
          blocks_.code_finer(coder_, targets_ ? static_cast<uint32_t>(targets_->finer(i)) : 0, above));
    return finer_[i];
  }
  // Quantises (encoder) or not (decoder) and codes the rows of differences.
  int32_t convey(size_t count, float step, int32_t above) {
    if (targets_)
      for (size_t d = 0; d < count; ++d) {
        transform_.forward({&difference_[d * width_], width_}, {&coefficient_[d * width_], width_});
        for (size_t j = 0; j < width_; ++j) levels_[d * width_ + j] = quantise(coefficient_[d * width_ + j] / step);
      }
    return blocks_.code(coder_, {levels_.data(), count * width_}, count, above);
  }
  int16_t* change_row(size_t d) { return &changes_[d * (lattice_.row() + 16)]; }
  bool change(size_t d, int32_t block, float step) {
    return transform_.inverse(&levels_[d * width_], blocks_.counts(block) + d * layout_.channels, step / scale_.unit(),
                              change_row(d));
  }
  // Log2 values of a node's views, averaged over channels.
  const float* mean_of(size_t i) {
    const size_t views = layout_.views();
    const int16_t* value = lattice_.value(i);
    const float unit = scale_.unit() / static_cast<float>(layout_.channels), offset = static_cast<float>(scale_.offset);
    for (size_t v = 0; v < views; v += 8) {  // what is read behind the views counts for nothing
      Int8 sum{};
      for (size_t c = 0; c < layout_.channels; ++c)
        sum += __builtin_convertvector(load<Short8>(value + c * views + v), Int8);
      store(&mean_[v], offset + unit * __builtin_convertvector(sum, EightFloats));
    }
    return mean_.data();
  }
  void to_source(const int16_t* row, std::span<float> values) const {
    for (size_t v = 0; v < layout_.views(); ++v)
      for (size_t c = 0; c < layout_.channels; ++c)
        values[v * layout_.channels + c] = scale_.value(static_cast<float>(row[c * layout_.views() + v]));
  }

  const AlignedLayout& layout_;
  LogScale scale_;
  const BlockTransform& transform_;
  const StepRule& steps_;
  Coder& coder_;
  Targets* targets_;
  LeafTable* leaves_;
  size_t max_nodes_, width_;
  CodedLattice lattice_;
  BlockCode blocks_;
  std::vector<int32_t> block_;  // [node] of divided nodes
  std::vector<uint8_t> finer_;  // [node] of divided nodes
  std::vector<int32_t> levels_;
  std::vector<int16_t> changes_;
  std::vector<Center> centers_;  // of the level's nodes
  std::vector<float> mean_, difference_, coefficient_;
};

}  // namespace

template <class Coder>
void walk_sheet(const AlignedLayout& layout, LogScale scale, const BlockTransform& transform, const StepRule& steps,
                Coder& coder, Targets* targets, LeafTable* leaves, size_t max_nodes) {
  SheetWalk<Coder>(layout, scale, transform, steps, coder, targets, leaves, max_nodes).run();
}
template void walk_sheet(const AlignedLayout&, LogScale, const BlockTransform&, const StepRule&, PrefixEncoder&,
                         Targets*, LeafTable*, size_t);
template void walk_sheet(const AlignedLayout&, LogScale, const BlockTransform&, const StepRule&, PrefixDecoder&,
                         Targets*, LeafTable*, size_t);

}  // namespace suite::sqt
