#include "heat/weather_series.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace suite {

namespace {

constexpr double kPanel = 200;  // s; the sun's elevation changes by less than a degree
constexpr double kDark = 0.03;

// Slopes at the ends of pieces from their lengths and mean slopes (Fritsch & Carlson 1980): central differences, 0
// beside a change of direction, limited to the circle of radius 3; at both ends that of the last piece.
std::vector<double> limited_slopes(std::span<const double> lengths, std::span<const double> secants) {
  const size_t n = secants.size();
  std::vector<double> d(n + 1);
  d.front() = secants.front();
  d.back() = secants.back();
  for (size_t i = 1; i < n; ++i) {
    const double left = secants[i - 1], right = secants[i];
    // The slope of the parabola through three knots; on an even grid the central difference.
    const bool turns = (left > 0) != (right > 0) || left == 0 || right == 0;
    d[i] = turns ? 0 : (lengths[i] * left + lengths[i - 1] * right) / (lengths[i - 1] + lengths[i]);
  }
  for (size_t i = 0; i < n; ++i) {
    if (secants[i] == 0) {
      d[i] = d[i + 1] = 0;
      continue;
    }
    const double a = d[i] / secants[i], b = d[i + 1] / secants[i], radius = std::hypot(a, b);
    if (radius <= 3) continue;
    d[i] = 3 / radius * a * secants[i];
    d[i + 1] = 3 / radius * b * secants[i];
  }
  return d;
}

// Gauss-Legendre with three points a panel.
double integrate(const WeatherSeries::Pace& pace, double begin, double end) {
  const int panels = std::max(1, static_cast<int>(std::ceil((end - begin) / kPanel)));
  const double h = (end - begin) / panels, x = std::sqrt(0.6) * h / 2;
  double sum = 0;
  for (int i = 0; i < panels; ++i) {
    const double middle = begin + h * (i + 0.5);
    sum += 5 * pace(middle - x) + 8 * pace(middle) + 5 * pace(middle + x);
  }
  return sum * h / 18;
}

}  // namespace

double WeatherSeries::share(const Piece& piece, double t) const {
  return (pace_ ? integrate(pace_, piece.begin, t) : t - piece.begin) / piece.weight;
}

double WeatherSeries::integral(const Piece& piece, double t) const {
  const double s = share(piece, t), *c = piece.c;
  return piece.weight * s * (c[0] + s * (c[1] / 2 + s * (c[2] / 3 + s * c[3] / 4)));
}

void WeatherSeries::add(Piece piece) {
  if (!pieces_.empty()) {
    const Piece& last = pieces_.back();
    piece.before = last.before + last.weight * (last.c[0] + last.c[1] / 2 + last.c[2] / 3 + last.c[3] / 4);
    piece.gaps = last.gaps + (last.end == piece.begin ? 0 : 1);
  }
  pieces_.push_back(piece);
}

WeatherSeries WeatherSeries::of_instants(std::span<const double> times, std::span<const double> values,
                                         double longest) {
  WeatherSeries series;
  const auto joined = [&](size_t i) {
    return i + 1 < times.size() && std::isfinite(values[i]) && std::isfinite(values[i + 1]) &&
           times[i + 1] - times[i] <= longest;
  };
  for (size_t first = 0; first < times.size();) {
    size_t last = first;
    std::vector<double> lengths, secants;
    for (; joined(last); ++last) {
      lengths.push_back(times[last + 1] - times[last]);
      secants.push_back((values[last + 1] - values[last]) / lengths.back());
    }
    if (last > first) {
      const std::vector<double> d = limited_slopes(lengths, secants);
      for (size_t i = first; i < last; ++i) {
        const double h = lengths[i - first], rise = values[i + 1] - values[i];
        const double d0 = h * d[i - first], d1 = h * d[i - first + 1];
        series.add({times[i], times[i + 1], h, {values[i], d0, 3 * rise - 2 * d0 - d1, d0 + d1 - 2 * rise}});
      }
    }
    first = last + 1;
  }
  return series;
}

// Means without a gap, bent by each other.
void WeatherSeries::add_run(std::span<const double> begins, std::span<const double> ends,
                            std::span<const double> means) {
  std::vector<double> weights, ratios;
  for (size_t i = 0; i < means.size(); ++i) {
    const double length = ends[i] - begins[i];
    // Of nothing any pace is as good.
    weights.push_back(pace_ && means[i] > 0 ? integrate(pace_, begins[i], ends[i]) : length);
    ratios.push_back(means[i] * length / weights.back());
  }
  // Slopes of the running integral are values: its secants are the means.
  const std::vector<double> d = limited_slopes(weights, ratios);
  for (size_t i = 0; i < means.size(); ++i) {
    const double d0 = d[i], d1 = d[i + 1], mean = ratios[i];
    add({begins[i], ends[i], weights[i], {d0, 6 * mean - 4 * d0 - 2 * d1, 3 * (d0 + d1) - 6 * mean, 0}});
  }
}

bool WeatherSeries::dark(double begin, double end) const {
  return pace_ && std::max({pace_(begin), pace_((begin + end) / 2), pace_(end)}) < kDark;
}

WeatherSeries WeatherSeries::of_means(std::span<const double> begins, std::span<const double> ends,
                                      std::span<const double> means, Pace pace) {
  WeatherSeries series;
  series.pace_ = std::move(pace);
  for (size_t first = 0; first < means.size();) {
    if (!std::isfinite(means[first])) {
      ++first;
      continue;
    }
    size_t end = first + 1;
    if (!series.dark(begins[first], ends[first]))
      while (end < means.size() && std::isfinite(means[end]) && begins[end] == ends[end - 1] &&
             !series.dark(begins[end], ends[end]))
        ++end;
    const size_t n = end - first;
    series.add_run(begins.subspan(first, n), ends.subspan(first, n), means.subspan(first, n));
    first = end;
  }
  return series;
}

const WeatherSeries::Piece* WeatherSeries::find(double t) const {
  const auto after =
      std::upper_bound(pieces_.begin(), pieces_.end(), t, [](double time, const Piece& p) { return time < p.begin; });
  if (after == pieces_.begin()) return nullptr;
  const Piece& piece = *(after - 1);
  return t <= piece.end ? &piece : nullptr;
}

double WeatherSeries::at(double t) const {
  const Piece* piece = find(t);
  if (!piece) return std::numeric_limits<double>::quiet_NaN();
  const double s = share(*piece, t), *c = piece->c;
  return (c[0] + s * (c[1] + s * (c[2] + s * c[3]))) * (pace_ ? pace_(t) : 1);
}

double WeatherSeries::mean(double begin, double end) const {
  if (!(end >= begin)) throw Error(strf("a mean from %.9g to %.9g s", begin, end), "an interval ends after it begins");
  if (begin == end) return at(begin);
  const Piece *a = find(begin), *b = find(end);
  if (!a || !b || a->gaps != b->gaps) return std::numeric_limits<double>::quiet_NaN();
  return (b->before - a->before + integral(*b, end) - integral(*a, begin)) / (end - begin);
}

}  // namespace suite
