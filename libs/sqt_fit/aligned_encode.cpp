// Coding the trees of the aligned method: rate-distortion pruning, then the walk with targets. See aligned_fit.h.
#include <algorithm>
#include <cmath>
#include <optional>

#include "sqt/sheet_walk.h"
#include "sqt/totals_code.h"
#include "sqt_fit/aligned_source.h"
#include "sqt_fit/prefix_encoder.h"
#include "sqt_fit/range_encoder.h"
#include "sqt_fit/source_means.h"
#include "sqt_fit/source_totals.h"

namespace suite::sqt {

namespace {

// Which nodes of the data are worth dividing at a quality: bottom-up, a family stays when what it saves in squared
// error (in units of squared steps) outweighs its bits.
struct Reduction {
  std::vector<uint8_t> keep, finer;  // [node]: whether it stays divided; octaves by which its step is finer
};
Reduction prune(const AlignedLayout& layout, const AlignedSource::Impl::Sheet& sheet, const StepRule& steps) {
  constexpr double kBitPrice =
      0.14;  // squared steps per bit: 2 ln 2 / 12 at high rate, a little more with the dead zone
  const size_t width = layout.width();
  NodeLevels levels(layout);
  Reduction reduction{std::vector<uint8_t>(sheet.data.size(), 0), std::vector<uint8_t>(sheet.data.size(), 0)};
  std::vector<double> benefit(sheet.data.size(), 0.0);
  for (size_t i = sheet.data.size(); i-- > 0;) {
    const Lattice::Node& node = sheet.data.node(i);
    if (node.first_child < 0) continue;
    const Dir middle = center_of(node.id);
    const Center center{static_cast<float>(middle.x), static_cast<float>(middle.y), static_cast<float>(middle.z)};
    levels.look(layout, sheet, i);
    int finer = 0;
    if (layout.refined) {
      finer = steps.finer(center, node.id.order(), levels.value.data(), levels.mean.data());
      // Below a node that states none no other may.
      for (int k = 0; k < node.child_count; ++k)
        if (reduction.finer[static_cast<size_t>(node.first_child + k)]) finer = std::max(1, finer);
    }
    const float step = steps.step(center, node.id.order(), levels.value.data(), finer);
    const float* detail = &sheet.details[static_cast<size_t>(sheet.detail_index[i]) * 3 * width];
    double gain = 0, bits = 6;
    for (size_t j = 0; j < 3 * width; ++j) {
      const float x = std::fabs(detail[j] / step);
      const int n = std::abs(int{quantise(x)});
      if (!n) continue;
      gain += x * x - (x - static_cast<float>(n)) * (x - static_cast<float>(n));
      bits += 4 + 2 * std::log2(static_cast<double>(n));
    }
    benefit[i] = gain - kBitPrice * bits;
    for (int k = 0; k < node.child_count; ++k)
      benefit[i] += std::max(0.0, benefit[static_cast<size_t>(node.first_child + k)]);
    reduction.keep[i] = benefit[i] > 0;
    if (reduction.keep[i]) reduction.finer[i] = static_cast<uint8_t>(finer);
  }
  return reduction;
}

class SourceTargets final : public Targets {
 public:
  SourceTargets(const AlignedLayout& layout, LogScale scale, const AlignedSource::Impl::Sheet& sheet,
                Reduction reduction)
      : layout_(layout),
        scale_(scale),
        sheet_(sheet),
        reduction_(std::move(reduction)),
        values_(reduced_values(layout, sheet, reduction_.keep)),
        predicted_(4 * layout.width()) {}
  bool split(size_t node) override { return reduction_.keep[source(node)] != 0; }
  int finer(size_t node) override { return reduction_.finer[source(node)]; }
  void differences(const CodedLattice& lattice, size_t node, std::span<float> details) override {
    for (uint32_t k = 0; k < 4; ++k)
      for (size_t v = 0; v < layout_.views(); ++v)
        for (size_t c = 0; c < layout_.channels; ++c)
          predicted_[k * layout_.width() + v * layout_.channels + c] =
              scale_.value(static_cast<float>(lattice.predicted(node, k, c * layout_.views() + v)));
    family_details(layout_, sheet_, source(node), values_, predicted_, details);
  }
  void root(size_t node, std::span<const float> predicted, std::span<float> difference) override {
    if (source_.size() <= node) source_.push_back(node);
    const float* value = &values_[node * difference.size()];
    for (size_t j = 0; j < difference.size(); ++j) difference[j] = value[j] - predicted[j];
  }
  void divided(const CodedLattice& lattice, size_t node) override {
    const CodedLattice::Node& here = lattice.node(node);
    for (int k = 0; k < here.child_count; ++k)
      source_.push_back(static_cast<size_t>(sheet_.data.node(source(node)).first_child + k));
  }

 private:
  size_t source(size_t node) const { return source_[node]; }
  const AlignedLayout& layout_;
  LogScale scale_;
  const AlignedSource::Impl::Sheet& sheet_;
  Reduction reduction_;
  std::vector<float> values_, predicted_;
  std::vector<size_t> source_;
};

}  // namespace

std::vector<std::byte> encode_sheets(const AlignedSource& source, double quality, std::vector<AlignedSheet>* decoded) {
  AlignedLayout layout = source.layout();
  layout.quality = quality;
  const AlignedSource::Impl& m = source.impl();
  const BlockTransform transform(layout);
  PrefixEncoder coder(BlockCode::contexts_of(layout));
  const int reference = step_reference(m.totals, layout);
  const StepRule steps(layout, 0.25 * reference);
  for (const auto& sheet : m.sheets) {
    SourceTargets targets(layout, m.scale, sheet, prune(layout, sheet, steps));
    std::optional<LeafTable> leaves;
    if (decoded) leaves.emplace(layout, m.scale, decoded->emplace_back(), 0);
    walk_sheet(layout, m.scale, transform, steps, coder, &targets, leaves ? &*leaves : nullptr, size_t{1} << 26);
  }
  std::vector<std::byte> bytes{static_cast<std::byte>(reference + 128), static_cast<std::byte>(m.scale.offset + 128),
                               static_cast<std::byte>(m.scale.fraction_bits)};
  for (const int16_t s : layout.spectra) {
    const auto bits = static_cast<uint16_t>(s);
    bytes.push_back(static_cast<std::byte>(bits & 0xFF)), bytes.push_back(static_cast<std::byte>(bits >> 8));
  }
  const std::vector<std::byte> coded = coder.finish();
  bytes.insert(bytes.end(), coded.begin(), coded.end());
  return bytes;
}

std::vector<std::byte> encode_totals(AlignedTotals& totals, size_t channels) {
  RangeEncoder coder;
  code_totals(coder, totals, channels);
  return coder.finish();
}

AlignedFit encode_aligned(const AlignedSource& source, double quality) {
  AlignedFit fit;
  AlignedData& d = fit.data;
  d.function = source.function();
  d.layout = source.layout();
  d.layout.quality = quality;
  d.totals = source.totals();
  fit.sheets_bytes = encode_sheets(source, quality, &d.sheets);
  d.totals.log2_scale = fit_scale(d.layout, d.function, d.sheets, d.totals);
  fit.totals_bytes = encode_totals(d.totals, d.layout.channels);
  return fit;
}

}  // namespace suite::sqt
