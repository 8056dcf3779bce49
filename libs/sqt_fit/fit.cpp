#include "sqt_fit/fit.h"

#include <algorithm>
#include <cmath>

namespace suite::sqt {

namespace {

constexpr double kFinest = 0.001, kCoarsest = 16;  // qualities searched
constexpr int kFinestOrder = 12;                   // of cells that lobes may ask for
constexpr size_t kMostViews = 64;                  // that they may ask for
constexpr double kWorthIt = 0.02;                  // by how much lobes must rise if they stay too low all the same

struct Trial {
  AlignedFit fit;
  std::shared_ptr<const Bundle> bundle;
  double l1;
};

Trial attempt(const AlignedSource& source, const Reference& reference, double quality) {
  Trial t{encode_aligned(source, quality), nullptr, 0};
  t.bundle = make_bundle(t.fit.data);
  t.l1 = reference.l1(*t.bundle);
  return t;
}

size_t bytes_of(const AlignedFit& fit) { return fit.sheets_bytes.size() + fit.totals_bytes.size(); }

// The largest x of [first, last] whose excess is not positive, where the excess grows with x; to 1 %, and closer to 0
// from below than half a percent is close enough. Brackets by steps of 1.1 from a guess, then the Illinois variant of
// regula falsi (Dowell & Jarratt, BIT 11, 1971). `first` when even its excess is positive.
double last_within(double first, double last, double guess, const std::function<double(double)>& excess) {
  struct End {
    double x, excess;
  };
  auto at = [&](double x) { return End{x, excess(x)}; };
  End low = at(std::clamp(guess, first, last)), high = low;
  while (low.excess > 0 && low.x > first) high = low, low = at(std::max(first, low.x - 1.1));
  while (high.excess <= 0 && high.x < last) low = high, high = at(std::min(last, high.x + 1.1));
  if (low.excess > 0) return first;
  if (high.excess <= 0) return last;
  double low_weight = low.excess, high_weight = high.excess;
  for (int i = 0; i < 12 && high.x - low.x > 0.01 && low.excess < -0.005; ++i) {
    const double t = std::clamp(low_weight / (low_weight - high_weight), 0.05, 0.95);
    const End mid = at(low.x + t * (high.x - low.x));
    if (mid.excess <= 0)
      low = mid, low_weight = mid.excess, high_weight *= 0.5;
    else
      high = mid, high_weight = mid.excess, low_weight *= 0.5;
  }
  return low.x;
}

}  // namespace

AlignedSource::Options suited(AlignedSource::Options options, double l1) {
  options.view_error = std::clamp(0.5 * l1, 0.001, 0.03);
  options.most_views = l1 < 0.01 ? 64 : 25;
  options.detail = 2e-6 * std::min(1.0, l1 / 0.01);
  options.fold_error = 0.25 * l1;
  return options;
}

namespace {

double least(const std::array<double, 3>& peaks) { return *std::min_element(peaks.begin(), peaks.end()); }

// The best a source can do for a target; quality: where there is neither an error nor a size to keep.
FitResult fit_from(std::unique_ptr<AlignedSource> owned, const Reference& reference, const FitTarget& target,
                   double quality_otherwise, const std::function<size_t(const AlignedSource&)>& container,
                   const std::function<void(double)>& progress) {
  FitResult result;
  result.source = std::move(owned);
  const AlignedSource& source = *result.source;
  // The number of steps is not known beforehand: every step takes a sixth of what is left.
  double left = 1;
  auto step = [&] {
    progress(left / 6);
    left *= 5.0 / 6;
  };
  auto take = [&](double quality) {
    Trial t = attempt(source, reference, quality);
    result.fit = std::move(t.fit);
    result.l1 = t.l1;
    result.peaks = reference.least_peaks(*t.bundle);
  };
  const size_t around = target.max_bytes ? container(source) : 0;
  if (target.max_l1 <= 0 && target.max_bytes == 0) {
    take(quality_otherwise);
  } else {
    const double finest = std::log(kFinest), coarsest = std::log(kCoarsest);
    double fits = finest,
           keeps = coarsest;  // log of the finest quality that fits, of the coarsest that keeps the error
    if (target.max_bytes)
      fits = -last_within(-coarsest, -finest, -std::log(kDefaultQuality), [&](double x) {
        step();
        return std::log(static_cast<double>(bytes_of(encode_aligned(source, std::exp(-x))) + around) /
                        static_cast<double>(target.max_bytes));
      });
    if (target.max_l1 > 0)
      keeps = last_within(finest, coarsest, std::log(5 * target.max_l1), [&](double x) {
        step();
        return std::log(attempt(source, reference, std::exp(x)).l1 / target.max_l1);
      });
    take(std::exp(target.max_l1 > 0 ? std::max(keeps, fits) : fits));  // the error decides as long as it fits
  }
  result.error_met = target.max_l1 <= 0 || result.l1 <= target.max_l1;
  result.bytes_met = !target.max_bytes || bytes_of(result.fit) + around <= target.max_bytes;
  result.peak_met = least(result.peaks) >= target.min_peak;
  progress(left);
  return result;
}

bool better(const FitResult& a, const FitResult& b, const FitTarget& target) {
  if (a.bytes_met != b.bytes_met) return a.bytes_met;
  if (a.error_met != b.error_met) return a.error_met;
  if (a.peak_met != b.peak_met) return a.peak_met;
  if (!a.peak_met && target.max_l1 <= 0 && !target.max_bytes) return least(a.peaks) > least(b.peaks) + kWorthIt;
  return target.max_l1 > 0 && a.error_met ? bytes_of(a.fit) < bytes_of(b.fit) : a.l1 < b.l1;
}

// Ways to raise the lobes of a fit, the cheapest first.
struct Rise {
  AlignedSource::Options options;
  double quality;
};
std::vector<Rise> rises(const AlignedSource::Options& options, const FitTarget& target) {
  std::vector<Rise> all;
  Rise next{options, kDefaultQuality};
  if (!options.order_fixed && options.max_order < kFinestOrder) {
    next.options.max_order = kFinestOrder, next.options.detail *= 0.25;
    all.push_back(next);
  }
  if (target.max_l1 > 0 || target.max_bytes) return all;
  next.quality *= 0.5;
  all.push_back(next);
  if (!options.views) {
    next.options.view_error *= 0.1, next.options.most_views = kMostViews;
    all.push_back(next);
  }
  return all;
}

}  // namespace

FitResult fit_to(const Function& function, const Reference& reference, const AlignedSource::Options& options,
                 const FitTarget& target, const std::function<size_t(const AlignedSource&)>& container,
                 const std::function<void(double)>& progress) {
  double left = 1;  // of the progress
  auto fit = [&](const AlignedSource::Options& o, double quality, double share) {
    const std::function<void(double)> part = [&progress, share](double fraction) {
      if (progress) progress(0.5 * share * fraction);
    };
    left -= share;
    return fit_from(std::make_unique<AlignedSource>(function, o, part), reference, target, quality, container, part);
  };
  const bool free = target.max_l1 <= 0 && !target.max_bytes;
  AlignedSource::Options used = target.max_l1 > 0 ? suited(options, target.max_l1) : options;
  FitResult best = fit(used, kDefaultQuality, free ? 0.5 : 1.0 / 3);
  auto consider = [&](const AlignedSource::Options& o, double quality = kDefaultQuality) {
    FitResult other = fit(o, quality, left / 2);
    if (!better(other, best, target)) return;
    best = std::move(other);
    used = o;
  };
  if (!free) {
    const double l1 = target.max_l1 > 0 ? target.max_l1 : best.l1;
    if (target.max_l1 <= 0) consider(suited(options, l1));
    if (!options.frame && best.source->function().quantity == Quantity::bsdf &&
        best.source->layout().frame != LobeFrame::half) {
      AlignedSource::Options half = suited(options, l1);
      half.frame = LobeFrame::half;
      consider(half);
    }
  }
  for (const Rise& rise : rises(used, target)) {
    if (best.peak_met) break;
    consider(rise.options, rise.quality);
  }
  if (progress) progress(left);
  return best;
}

}  // namespace suite::sqt
