// The decoder of the aligned method; see aligned.h.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "sqt/prefix_code.h"
#include "sqt/sheet_walk.h"
#include "sqt/totals_code.h"

namespace suite::sqt {

std::vector<double> total_angles(const std::vector<double>& views) {
  std::vector<double> theta{views[0]};
  for (size_t v = 1; v < views.size(); ++v) {
    const double step = (views[v] - views[v - 1]) / 6;
    while (theta.back() < views[v]) {
      const double here = std::min(step, 0.15 * (kPi / 2 - theta.back())), next = theta.back() + here;
      theta.push_back(next > views[v] - 0.3 * here ? views[v] : next);
    }
  }
  return theta;
}

std::vector<AlignedSheet> decode_sheets(const AlignedLayout& asked, std::span<const std::byte> payload,
                                        size_t max_leaves) {
  AlignedLayout layout = asked;
  const size_t head = AlignedLayout::kHeadBytes + 2 * layout.spectra.size();
  if (payload.size() < head) throw Error("SQT payload is damaged: it ends too early");
  for (size_t i = 0; i < layout.spectra.size(); ++i)
    layout.spectra[i] = static_cast<int16_t>(std::to_integer<int>(payload[AlignedLayout::kHeadBytes + 2 * i]) |
                                             std::to_integer<int>(payload[AlignedLayout::kHeadBytes + 2 * i + 1]) << 8);
  const int reference = std::to_integer<int>(payload[0]) - 128;
  const LogScale scale{std::to_integer<int>(payload[1]) - 128, std::to_integer<int>(payload[2])};
  if (std::abs(scale.offset) > LogScale::kMostOffset || scale.fraction_bits < LogScale::kLeastBits ||
      scale.fraction_bits > LogScale::kMostBits)
    throw Error("SQT payload is damaged: a scale that does not exist");
  PrefixDecoder coder(payload.subspan(head), BlockCode::contexts_of(layout));
  const BlockTransform transform(layout);
  const StepRule steps(layout, 0.25 * reference);
  std::vector<AlignedSheet> sheets(static_cast<size_t>(layout.sheets));
  for (AlignedSheet& sheet : sheets) {
    LeafTable leaves(layout, scale, sheet, max_leaves);
    walk_sheet(layout, scale, transform, steps, coder, nullptr, &leaves, max_leaves + max_leaves / 2 + 64);
  }
  if (coder.overrun()) throw Error("SQT payload is damaged: it ends too early");
  return sheets;
}

void decode_totals(std::span<const std::byte> bytes, size_t channels, bool has_delta, AlignedTotals& totals) {
  const size_t rows = totals.theta.size() * totals.phi_count;
  totals.magnitudes.assign(rows * totals.magnitude_um.size(), 0.0f);
  totals.log2_scale.assign(rows * channels, 0.0f);
  totals.delta.assign(has_delta ? rows * channels : 0, 0.0f);
  RangeDecoder coder(bytes);
  code_totals(coder, totals, channels);
  if (coder.overrun() > 8) throw Error("SQT payload is damaged: its totals end too early");
}

}  // namespace suite::sqt
