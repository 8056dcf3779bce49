// The gas points of one air by interval, each computed once: choosing bins, baking columns for them and judging them
// ask for the same cells again.
#pragma once
#include <map>
#include <memory>
#include <shared_mutex>
#include <span>
#include <utility>
#include <vector>

#include "air/gases.h"

namespace suite {

class GasIntervals {
 public:
  // Keeps the provider. levels, reduction: as of gas_points(). most: intervals that are kept, about 2 kB each; beyond
  // it they are computed every time.
  GasIntervals(std::shared_ptr<const GasProvider> provider, std::vector<AirLevel> levels, const GasReduction& reduction,
               size_t most = 1 << 14);
  // As gas_points(), from any thread.
  std::shared_ptr<const GasPoints> points(double low_um, double high_um);
  size_t kept() const;
  // Whether these are the points of another air, too.
  bool are_of(const GasProvider* provider, std::span<const AirLevel> levels, const GasReduction& reduction) const;

 private:
  const std::shared_ptr<const GasProvider> provider_;
  const std::vector<AirLevel> levels_;
  const GasReduction reduction_;
  const size_t most_;
  mutable std::shared_mutex mutex_;
  std::map<std::pair<double, double>, std::shared_ptr<const GasPoints>> known_;
};

// Those of an air, of which the process keeps the last few.
std::shared_ptr<GasIntervals> shared_gas_intervals(const std::shared_ptr<const GasProvider>& provider,
                                                   std::span<const AirLevel> levels, const GasReduction& reduction);

}  // namespace suite
