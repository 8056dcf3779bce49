#include "sqt/fit.h"

#include <cmath>
#include <optional>

namespace suite::sqt {

namespace {

constexpr double kFinest = 0.004, kCoarsest = 8;  // qualities searched
constexpr int kSteps = 11;                        // bisections of log quality: to 0.4 %

struct Trial {
  AlignedFit fit;
  double l1;
};

Trial attempt(const AlignedSource& source, const Reference& reference, double quality) {
  Trial t{encode_aligned(source, quality), 0};
  t.l1 = reference.l1(*make_bundle(t.fit.data));
  return t;
}

size_t bytes_of(const AlignedFit& fit) { return fit.sheets_bytes.size() + fit.totals_bytes.size(); }

}  // namespace

FitResult fit_to(const AlignedSource& source, const Reference& reference, const FitTarget& target,
                 const std::function<void(double)>& progress) {
  auto report = [&] {
    if (progress) progress(1.0 / (2 * kSteps + 2));
  };
  FitResult result;
  auto take = [&](Trial t) {
    result.fit = std::move(t.fit);
    result.l1 = t.l1;
  };
  if (target.max_l1 <= 0 && target.max_bytes == 0) {
    take(attempt(source, reference, kDefaultQuality));
    return result;
  }
  // The finest quality that fits the size.
  double finest = kFinest;
  const size_t room = target.max_bytes > target.overhead ? target.max_bytes - target.overhead : 0;
  if (target.max_bytes) {
    auto fits = [&](double quality) {
      return encode_sheets(source, quality).size() + 1500 + source.totals().magnitudes.size() / 2 <= room;
    };
    double low = std::log(kFinest), high = std::log(kCoarsest);
    if (fits(kFinest)) {
      high = low;
    } else {
      for (int i = 0; i < kSteps; ++i, report()) (fits(std::exp(0.5 * (low + high))) ? high : low) = 0.5 * (low + high);
    }
    finest = std::exp(high);
    take(attempt(source, reference, finest));
    result.bytes_met = bytes_of(result.fit) <= room;
    if (target.max_l1 <= 0) return result;
  }
  // The coarsest quality that keeps the error.
  Trial best = attempt(source, reference, finest);
  result.error_met = best.l1 <= target.max_l1;
  if (result.error_met) {
    double low = std::log(finest), high = std::log(kCoarsest);
    for (int i = 0; i < kSteps; ++i, report()) {
      Trial t = attempt(source, reference, std::exp(0.5 * (low + high)));
      const bool kept = t.l1 <= target.max_l1;
      (kept ? low : high) = 0.5 * (low + high);
      if (kept && bytes_of(t.fit) <= bytes_of(best.fit)) best = std::move(t);
    }
  }
  take(std::move(best));
  return result;
}

}  // namespace suite::sqt
