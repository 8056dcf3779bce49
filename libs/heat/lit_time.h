// How much of every step of a day points are lit, and where in it: integrals of 1, s, s2 over the lit pieces, s from 0
// to 1 through the step, from which the integral of any straight line through the step follows exactly.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "heat/passing_edges.h"

namespace suite {

class LitTime {
 public:
  // begin: s; steps of `step` s each.
  LitTime(double begin, double step, size_t steps);
  void clear();
  // A point's day, times a weight of any sign.
  void add(const PointDay& day, double weight);
  // Steps, times weights, and times the shares of steps if there are any.
  double total(std::span<const float> shares = {}) const;
  // By step, how much of it is lit, times weights.
  void by_step(std::span<float> out) const;
  // takes: by moment (steps + 1), straight lines between them. Calls put(moment, value) with the integral of what is
  // taken while lit, in steps, times the hat of the moment. shares: of what is taken, by step; empty = all.
  template <class Put>
  void spread(std::span<const float> takes, std::span<const float> shares, const Put& put) const {
    double whole = 0;
    for (size_t m = 0; m < pieces_.size(); ++m) {
      whole += whole_[m];
      const double one = pieces_[m][0] + whole, s = pieces_[m][1] + whole / 2, s2 = pieces_[m][2] + whole / 3;
      if (one == 0 && s == 0) continue;
      const double share = shares.empty() ? 1 : double{shares[m]}, a = share * takes[m], b = share * takes[m + 1];
      put(m, a * (one - 2 * s + s2) + b * (s - s2));
      put(m + 1, a * (s - s2) + b * s2);
    }
  }

 private:
  void add_piece(size_t step, double from, double to, double weight);
  double begin_, step_;
  std::vector<std::array<double, 3>> pieces_;
  std::vector<double> whole_;  // changes of the weight of steps that are lit from end to end
};

}  // namespace suite
