#include "motion/timetable.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace suite {

namespace {

// The cycle that a time lies in, so that times[0] + cycle * period <= t in floating point as well.
double cycle_of(const Timetable& table, double t) {
  double cycle = std::floor((t - table.times.front()) / table.period);
  if (table.times.front() + (cycle + 1) * table.period <= t) ++cycle;
  if (table.times.front() + cycle * table.period > t) --cycle;
  return cycle;
}

}  // namespace

std::optional<size_t> Timetable::at(double t) const {
  if (times.empty()) return std::nullopt;
  const double back = period > 0 ? cycle_of(*this, t) * period : 0;
  const auto after =
      std::upper_bound(times.begin(), times.end(), t, [back](double x, double begin) { return x < begin + back; });
  return after == times.begin() ? std::nullopt : std::optional(static_cast<size_t>(after - times.begin()) - 1);
}

double Timetable::end_of(std::optional<size_t> row, double t) const {
  const size_t next = row ? *row + 1 : 0;
  const bool repeats = period > 0 && !times.empty();
  const double cycle = repeats ? cycle_of(*this, t) : 0;
  if (next < times.size()) return times[next] + cycle * period;
  return repeats ? times.front() + (cycle + 1) * period : std::numeric_limits<double>::infinity();
}

std::string Timetable::fault() const {
  for (size_t k = 0; k < times.size(); ++k) {
    if (!std::isfinite(times[k])) return "a time is not finite";
    if (k && !(times[k] > times[k - 1])) return strf("the row at %.9g s does not come after the one before", times[k]);
  }
  if (!std::isfinite(period) || period < 0) return strf("a period of %g s", period);
  if (period > 0 && (times.empty() || !(times.back() - times.front() < period)))
    return strf("the rows reach over more than the period of %.9g s", period);
  return {};
}

}  // namespace suite
