// Finding the quality of the aligned method that keeps a promise: an error, a size, or both.
#pragma once
#include <functional>
#include <limits>

#include "sqt/aligned.h"
#include "sqt/errors.h"

namespace suite::sqt {

inline constexpr double kDefaultQuality = 0.08;  // log2 units

struct FitTarget {
  double max_l1 = 0;     // cosine-weighted relative L1 over all channels; 0 = none
  size_t max_bytes = 0;  // of trees and totals together with `overhead`; 0 = none
  size_t overhead = 0;   // bytes the container adds
};

struct FitResult {
  AlignedFit fit;
  double l1 = 0;
  bool error_met = true, bytes_met = true;
};

// No target: the default quality. max_l1: the smallest file found whose l1 keeps it. max_bytes: the best that fits.
// Both: the smallest file that keeps the error, if it also keeps the size; else the best that fits, error_met = false.
// A promise that cannot be kept gives the nearest result and the flag. progress(fraction) may be null.
FitResult fit_to(const AlignedSource& source, const Reference& reference, const FitTarget& target,
                 const std::function<void(double)>& progress = {});

}  // namespace suite::sqt
