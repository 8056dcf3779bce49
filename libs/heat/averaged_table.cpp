#include "heat/averaged_table.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace suite {

namespace {

// Up to so many pieces a step are summed one by one: differences of sums over the whole table would cancel there.
constexpr size_t kFew = 64;

}  // namespace

AveragedTable::AveragedTable(std::vector<double> times, std::vector<double> values, Between between, bool repeat)
    : times_(std::move(times)), values_(std::move(values)), between_(between), repeat_(repeat) {
  if (times_.size() < 2 || times_.size() != values_.size())
    throw Error(strf("a table of %zu times and %zu values", times_.size(), values_.size()), "as many, two or more");
  for (size_t i = 0; i < times_.size(); ++i) {
    if (!std::isfinite(values_[i]) || !std::isfinite(times_[i]))
      throw Error(strf("row %zu of a table over time is not finite", i + 1));
    if (i > 0 && !(times_[i] > times_[i - 1]))
      throw Error(strf("row %zu of a table over time lies at %.9g s, the one before at %.9g s", i + 1, times_[i],
                       times_[i - 1]),
                  "times ascend");
  }
  if (repeat_ && between_ == Between::linear && values_.front() != values_.back())
    throw Error("a table that repeats ends with another value than it begins with", "they are one moment");
  if (between_ == Between::held) values_.back() = values_[values_.size() - 2];
  nonnegative_ = std::all_of(values_.begin(), values_.end(), [](double v) { return v >= 0; });
  areas_.assign(times_.size(), 0);
  moments_.assign(times_.size(), 0);
  squares_.assign(times_.size(), 0);
  for (size_t i = 0; i + 1 < times_.size(); ++i) {
    const Moments m = piece(i, times_[i], times_[i + 1], times_.front());
    areas_[i + 1] = areas_[i] + m.area;
    moments_[i + 1] = moments_[i] + m.moment;
    squares_[i + 1] = squares_[i] + m.square;
  }
}

size_t AveragedTable::piece_at(double t) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), t);
  const auto i = static_cast<size_t>(after - times_.begin());
  return std::clamp<size_t>(i, 1, times_.size() - 1) - 1;
}

AveragedTable::Moments AveragedTable::piece(size_t i, double a, double b, double origin) const {
  double at_a = values_[i], at_b = values_[i];
  if (between_ == Between::linear) {
    const double slope = (values_[i + 1] - values_[i]) / (times_[i + 1] - times_[i]);
    at_a += slope * (a - times_[i]);
    at_b += slope * (b - times_[i]);
  }
  const double mean = (at_a + at_b) / 2, width = b - a;
  return {mean * width, width * (mean * ((a + b) / 2 - origin) + (at_b - at_a) * width / 12),
          width * (mean * mean + (at_b - at_a) * (at_b - at_a) / 12)};
}

AveragedTable::Moments AveragedTable::within(double a, double b, double origin) const {
  const size_t first = piece_at(a), last = piece_at(b);
  if (first == last) return piece(first, a, b, origin);
  Moments sum = piece(first, a, times_[first + 1], origin);
  const Moments end = piece(last, times_[last], b, origin);
  sum.area += end.area;
  sum.moment += end.moment;
  sum.square += end.square;
  if (last - first <= kFew) {
    for (size_t i = first + 1; i < last; ++i) {
      const Moments m = piece(i, times_[i], times_[i + 1], origin);
      sum.area += m.area;
      sum.moment += m.moment;
      sum.square += m.square;
    }
  } else {
    const double area = areas_[last] - areas_[first + 1];
    sum.area += area;
    sum.moment += moments_[last] - moments_[first + 1] - (origin - times_.front()) * area;
    sum.square += squares_[last] - squares_[first + 1];
  }
  return sum;
}

AveragedTable::Fit AveragedTable::fit(double begin, double end) const {
  SUITE_CHECK(end > begin);
  double a = begin, b = end;
  const double period = times_.back() - times_.front(), slack = 1e-9 * period;
  if (repeat_) {
    const double shift = std::floor((a - times_.front()) / period) * period;
    a -= shift, b -= shift;
  } else if (!(a >= times_.front() - slack && b <= times_.back() + slack)) {
    throw Error(
        strf("a table over %.9g to %.9g s is asked for %.9g to %.9g s", times_.front(), times_.back(), begin, end),
        "it must cover the run");
  }
  const double middle = (a + b) / 2, width = b - a;
  Moments sum;
  for (double from = a; from < b;) {
    // Of a table that repeats a step may see the end and the beginning, or several periods.
    const double turn = repeat_ ? std::floor((from - times_.front()) / period + 1e-12) * period : 0;
    const double to = repeat_ ? std::fmin(b, turn + times_.back()) : b;
    const Moments m = within(from - turn, to - turn, middle - turn);
    sum.area += m.area;
    sum.moment += m.moment;
    sum.square += m.square;
    from = to;
  }
  // The slope of the least-squares line is 12 / width^3 times the moment about the middle.
  const double mean = sum.area / width, rise = 12 * sum.moment / (width * width);
  return {mean, rise, std::fmax(0.0, sum.square / width - mean * mean - rise * rise / 12)};
}

StepLine AveragedTable::over(double begin, double end) const {
  const Fit f = fit(begin, end);
  const double mean = f.mean, rise = f.rise;
  StepLine line{mean - rise / 2, mean + rise / 2};
  if (nonnegative_ && std::fmin(line.begin, line.end) < 0)
    line = rise > 0 ? StepLine{0, 2 * mean} : StepLine{2 * mean, 0};
  return line;
}

double AveragedTable::deviation(double begin, double end) const { return std::sqrt(fit(begin, end).variance); }

AveragedTable AveragedTable::averaged(double width) const {
  SUITE_CHECK(width > 0);
  const double span = end() - begin();
  const auto cells = static_cast<size_t>(std::fmax(2.0, std::round(span / width)));
  const double cell = span / static_cast<double>(cells);
  std::vector<double> times{begin()}, values{0};
  for (size_t i = 0; i < cells; ++i) {
    const double from = begin() + cell * static_cast<double>(i), to = i + 1 < cells ? from + cell : end();
    times.push_back((from + to) / 2);
    values.push_back(over(from, to).mean());
  }
  times.push_back(end());
  values.push_back(repeat_ ? (values[1] + values[cells]) / 2 : values[cells]);
  values.front() = repeat_ ? values.back() : values[1];
  return AveragedTable(std::move(times), std::move(values), Between::linear, repeat_);
}

}  // namespace suite
