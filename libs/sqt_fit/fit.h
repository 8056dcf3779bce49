// Finding the quality of the aligned method that keeps a promise: an error, a size, or both.
#pragma once
#include <array>
#include <functional>
#include <limits>

#include "sqt_fit/aligned_fit.h"
#include "sqt_fit/errors.h"

namespace suite::sqt {

inline constexpr double kDefaultQuality = 0.08;  // log2 units

struct FitTarget {
  double max_l1 = 0;     // cosine-weighted relative L1 over all channels; 0 = none
  size_t max_bytes = 0;  // of the whole file; 0 = none
  double min_peak = 0;   // least height of the lobes, fit over data, at 20, 45 and 70 deg; 0 = none
};

struct FitResult {
  std::unique_ptr<AlignedSource> source;
  AlignedFit fit;
  double l1 = 0;
  std::array<double, 3> peaks{1, 1, 1};  // least over the channels; Reference::least_peaks
  bool peak_met = true;
  bool error_met = true, bytes_met = true;
};

// Options under which a source can keep an error: views dense enough that interpolating between them costs a part of it
// only, cells asked as finely as it needs, and both mirror images of bilateral data kept when their noise differs by
// more.
AlignedSource::Options suited(AlignedSource::Options options, double l1);

// No target: the default quality. max_l1: the smallest file found whose l1 keeps it, from a source suited to it.
// max_bytes: the best that fits, from the better of a source of `options` and one suited to the error reached with it.
// Where a surface codes best in another frame than that of half vectors, that one is tried as well: tables over half
// vectors (MERL) have steps there that cost most in others once the error asked is about as small as they are.
// Both: the smallest file that keeps the error, if it also keeps the size; else the best that fits, error_met = false.
// A promise that cannot be kept gives the nearest result and the flag.
// min_peak: where the lobes of that fit stay lower, finer cells, then finer steps, then more views are tried, in this
// order and together, until they do not; under max_l1 or max_bytes finer cells only, as far as these allow. What the
// options fix (order_fixed, views) stays as it is. When none keeps it: the first that no later one exceeds by more than
// 0.02, peak_met = false. container: bytes a file takes beside trees and totals. progress(fraction) may be null.
FitResult fit_to(const Function& function, const Reference& reference, const AlignedSource::Options& options,
                 const FitTarget& target, const std::function<size_t(const AlignedSource&)>& container,
                 const std::function<void(double)>& progress = {});

}  // namespace suite::sqt
