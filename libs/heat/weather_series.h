// One quantity over time, from instants or from means over intervals; a polynomial a piece, whose integral is exact.
//
// Instants: monotone cubics through them, so that nothing overshoots: between two values lie only values between them.
// Means: the derivative of the monotone cubic through the running integral, so that the mean over each interval is the
// given one, and what is nowhere negative stays so; a peak may exceed the mean of its interval, as it must.
// Means with a pace: the same in a time that runs as fast as the pace, so that what is interpolated is the quantity
// over its pace. Light paced by the sun's height rises and sets with it, and the means are kept all the same. Based on:
// F. N. Fritsch & R. E. Carlson, "Monotone piecewise cubic interpolation", SIAM J. Numer. Anal. 17, 1980.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace suite {

class WeatherSeries {
 public:
  // How a quantity is expected to vary with time; above 0, 1 where it is at its largest. Rows that it calls dark (below
  // 0.03 at their ends and middle) bend no other row.
  using Pace = std::function<double(double t)>;

  WeatherSeries() = default;
  // Through (time, value); not across values that are NaN nor across more than `longest` seconds. Times ascend.
  static WeatherSeries of_instants(std::span<const double> times, std::span<const double> values, double longest);
  // Means over intervals that ascend and do not overlap, 0 or more; not across means that are NaN nor across gaps.
  static WeatherSeries of_means(std::span<const double> begins, std::span<const double> ends,
                                std::span<const double> means, Pace pace = {});

  bool empty() const { return pieces_.empty(); }
  double at(double t) const;  // NaN where nothing is known
  // Mean over begin..end, end >= begin; NaN unless all of it is known. In the time of two searches.
  double mean(double begin, double end) const;

 private:
  struct Piece {
    double begin = 0, end = 0;
    double weight = 0;  // s: the integral of the pace; without one the length
    double c[4] = {};   // powers of the share of the weight
    double before = 0;  // integral over all pieces before
    uint32_t gaps = 0;  // before this piece
  };
  double share(const Piece& piece, double t) const;
  double integral(const Piece& piece, double t) const;  // from its begin to t
  void add(Piece piece);
  void add_run(std::span<const double> begins, std::span<const double> ends, std::span<const double> means);
  bool dark(double begin, double end) const;
  const Piece* find(double t) const;

  std::vector<Piece> pieces_;
  Pace pace_;
};

}  // namespace suite
