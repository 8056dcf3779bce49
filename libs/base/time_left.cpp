#include "base/time_left.h"

#include <algorithm>

#include "base/error.h"
#include "base/progress.h"

namespace suite {

void TimeLeft::tell(double seconds, double done) {
  constexpr size_t kMost = 256;
  seconds_ = seconds;
  if (!(done > 0)) return;
  if (moments_.size() >= kMost) {  // every second, the first among them
    size_t kept = 0;
    for (size_t i = 0; i < moments_.size(); i += 2) moments_[kept++] = moments_[i];
    moments_.resize(kept);
  }
  moments_.push_back({seconds, done});
}

std::optional<std::array<double, 2>> TimeLeft::range() const {
  constexpr double kLeastSeconds = 1, kLeastShare = 0.01;
  if (moments_.size() < 2) return std::nullopt;
  const Moment first = moments_.front(), last = moments_.back();
  const double seconds = last.seconds - first.seconds, done = last.done - first.done;
  if (!(seconds >= kLeastSeconds) || !(done >= kLeastShare * total_)) return std::nullopt;
  const double left = std::max(0.0, total_ - last.done), by_all = left * seconds / done;
  const auto middle = std::lower_bound(moments_.begin(), moments_.end() - 1, first.seconds + seconds / 2,
                                       [](const Moment& m, double at) { return m.seconds < at; });
  if (!(middle->seconds < last.seconds && middle->done < last.done)) return std::array{by_all, by_all};
  const double by_half = left * (last.seconds - middle->seconds) / (last.done - middle->done);
  return std::array{std::min(by_all, by_half), std::max(by_all, by_half)};
}

std::string TimeLeft::text() const {
  constexpr double kAlike = 1.25;
  static const std::string unknown = "time left not known yet";
  const auto found = range();
  const double limit = std::max(0.0, bounds_.seconds - seconds_);
  if (std::isfinite(limit)) return "at most " + human_seconds(found ? std::min((*found)[1], limit) : limit) + " left";
  if (!found) return unknown;
  const auto [low, high] = *found;
  if (bounds_.total == Total::least) return low > 0 ? "at least " + human_seconds(low) + " left" : unknown;
  if (high <= kAlike * low || high <= 0) return human_seconds(low) + " left";
  return human_seconds(low) + " to " + human_seconds(high) + " left";
}

}  // namespace suite
