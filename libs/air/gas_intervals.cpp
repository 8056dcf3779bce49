#include "air/gas_intervals.h"

#include <algorithm>
#include <mutex>

namespace suite {

namespace {

bool same(const AirLevel& a, const AirLevel& b) {
  return a.height == b.height && a.pressure == b.pressure && a.temperature == b.temperature && a.fraction == b.fraction;
}

bool same(const GasReduction& a, const GasReduction& b) {
  return a.most == b.most && a.thin == b.thin && a.error == b.error;
}

}  // namespace

GasIntervals::GasIntervals(std::shared_ptr<const GasProvider> provider, std::vector<AirLevel> levels,
                           const GasReduction& reduction, size_t most)
    : provider_(std::move(provider)), levels_(std::move(levels)), reduction_(reduction), most_(most) {}

std::shared_ptr<const GasPoints> GasIntervals::points(double low_um, double high_um) {
  const std::pair interval{low_um, high_um};
  {
    const std::shared_lock lock(mutex_);
    if (const auto found = known_.find(interval); found != known_.end()) return found->second;
  }
  auto points = std::make_shared<const GasPoints>(gas_points(*provider_, levels_, low_um, high_um, reduction_));
  const std::unique_lock lock(mutex_);
  if (known_.size() < most_) known_.emplace(interval, points);
  return points;
}

size_t GasIntervals::kept() const {
  const std::shared_lock lock(mutex_);
  return known_.size();
}

bool GasIntervals::are_of(const GasProvider* provider, std::span<const AirLevel> levels,
                          const GasReduction& reduction) const {
  return provider == provider_.get() && same(reduction, reduction_) &&
         std::ranges::equal(levels, levels_, [](const AirLevel& a, const AirLevel& b) { return same(a, b); });
}

std::shared_ptr<GasIntervals> shared_gas_intervals(const std::shared_ptr<const GasProvider>& provider,
                                                   std::span<const AirLevel> levels, const GasReduction& reduction) {
  constexpr size_t kAirs = 2;
  static std::mutex mutex;
  static std::vector<std::shared_ptr<GasIntervals>> kept;
  const std::lock_guard lock(mutex);
  for (const auto& intervals : kept)
    if (intervals->are_of(provider.get(), levels, reduction)) return intervals;
  if (kept.size() == kAirs) kept.erase(kept.begin());
  return kept.emplace_back(
      std::make_shared<GasIntervals>(provider, std::vector<AirLevel>(levels.begin(), levels.end()), reduction));
}

}  // namespace suite
