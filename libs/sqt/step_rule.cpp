#include "sqt/step_rule.h"

#include <algorithm>
#include <cmath>

#include "sqt/block_code.h"
#include "sqt/portable_math.h"

namespace suite::sqt {

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

}  // namespace suite::sqt
