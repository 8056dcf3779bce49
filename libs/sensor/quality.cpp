#include "sensor/quality.h"

#include "base/error.h"

namespace suite {

std::span<const QualityBit> quality_bits() {
  static const std::vector<QualityBit> bits{
      {quality_heavy_tail, "heavy_tail",
       strf("rare events: the true error may exceed %g times the reported standard error by more than %g %% of the "
            "radiance (or the target)",
            kTailFactor, 100 * kTailShare)},
      {quality_failures, "failures", "NaN or negative samples were rejected and are missing from the mean"},
      {quality_truncated, "truncated",
       "more than 1 % of the light was cut at the maximum number of nodes, and more than a tenth of the error"},
      {quality_unresolved, "unresolved",
       "more than 0.1 % of the light, behind smooth refracting surfaces, was not found, and more than a tenth of the "
       "error"},
      {quality_clipped, "clipped",
       "the detector's charge is beyond its full well or its counts beyond an end of the converter: the radiance "
       "holds, counts and apparent temperature are no measure of it"},
      {quality_no_information, "no_information",
       "value or error is unknown: no sample was accepted, the sensor gives every ray the weight 0, or only one of the "
       "groups of samples whose scatter makes the error has any, or any light"}};
  return bits;
}

void QualityCounts::add(std::span<const uint8_t> quality) {
  problems += quality.size();
  for (const uint8_t q : quality) {
    flagged += q != 0;
    for (unsigned rest = q; rest; rest &= rest - 1) ++of[static_cast<size_t>(std::countr_zero(rest))];
  }
}

std::string text_of(const QualityCounts& counts) {
  std::string text;
  for (const QualityBit& b : quality_bits())
    if (const uint64_t n = counts.with(b.bit))
      text += (text.empty() ? "" : ", ") + b.name + strf(" %llu", static_cast<unsigned long long>(n));
  return text;
}

}  // namespace suite
