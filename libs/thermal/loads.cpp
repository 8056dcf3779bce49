#include "thermal/loads.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace suite {

namespace {

void check_times(const std::vector<double>& times, size_t values, LoadTable::Outside outside) {
  if (times.empty()) throw Error("a table over time without a row");
  if (times.size() != values) throw Error(strf("a table over time has %zu times and %zu values", times.size(), values));
  if (outside == LoadTable::Outside::repeat && times.size() < 2)
    throw Error("a table over time that repeats needs at least two rows");
  for (size_t i = 0; i < times.size(); ++i)
    if (!std::isfinite(times[i]) || (i > 0 && !(times[i] > times[i - 1])))
      throw Error(strf("time %g in row %zu of a table is out of order", times[i], i + 1), "times ascend");
}

// The row before t and the share of the next one.
struct Place {
  size_t row;
  double share;
};
Place find(const std::vector<double>& times, double t, LoadTable::Outside outside) {
  if (outside == LoadTable::Outside::repeat) {
    const double period = times.back() - times.front();
    t -= period * std::floor((t - times.front()) / period);
    t = std::clamp(t, times.front(), times.back());
  }
  if (!(t >= times.front() && t <= times.back()))
    throw Error(strf("a table over time is asked for %.9g s", t),
                strf("it covers %.9g to %.9g s", times.front(), times.back()));
  if (times.size() == 1) return {0, 0};
  const auto after = std::upper_bound(times.begin(), times.end(), t);
  const size_t row = std::min<size_t>(static_cast<size_t>(after - times.begin()), times.size() - 1) - 1;
  return {row, (t - times[row]) / (times[row + 1] - times[row])};
}

double blend(double a, double b, double s) { return a + (b - a) * s; }

}  // namespace

LoadTable::LoadTable(std::vector<double> times, std::vector<SurfaceLoad> loads, Outside outside)
    : times_(std::move(times)), loads_(std::move(loads)), outside_(outside) {
  check_times(times_, loads_.size(), outside);
  for (size_t i = 0; i < loads_.size(); ++i) {
    const SurfaceLoad& l = loads_[i];
    for (const double v : {l.sun_absorbed, l.sky_irradiance, l.air_temperature, l.wind})
      if (!(v >= 0 && std::isfinite(v)))
        throw Error(strf("a load of %g in row %zu of a table is outside its range", v, i + 1), "0 or more");
  }
}

SurfaceLoad LoadTable::at(double t) const {
  const Place p = find(times_, t, outside_);
  if (times_.size() == 1) return loads_[0];
  const SurfaceLoad &a = loads_[p.row], &b = loads_[p.row + 1];
  return {blend(a.sun_absorbed, b.sun_absorbed, p.share), blend(a.sky_irradiance, b.sky_irradiance, p.share),
          blend(a.air_temperature, b.air_temperature, p.share), blend(a.wind, b.wind, p.share)};
}

Loads LoadTable::function(std::shared_ptr<const LoadTable> table) {
  return [table = std::move(table)](double t) { return table->at(t); };
}

TimeTable::TimeTable(std::vector<double> times, std::vector<double> values, LoadTable::Outside outside)
    : times_(std::move(times)), values_(std::move(values)), outside_(outside) {
  check_times(times_, values_.size(), outside);
  for (const double v : values_)
    if (!std::isfinite(v)) throw Error("a table over time holds a value that is not finite");
}

double TimeTable::at(double t) const {
  const Place p = find(times_, t, outside_);
  return times_.size() == 1 ? values_[0] : blend(values_[p.row], values_[p.row + 1], p.share);
}

}  // namespace suite
