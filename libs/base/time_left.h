// How long work will take on, from what is done of it at which moments.
//
// What comes before the first work is done (tables, trees) happens once and does not count. Two rates are looked at,
// that of all work and that of the later half of the time: where they differ, the work is not even, and both are told.
#pragma once
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace suite {

class TimeLeft {
 public:
  // least: more than the total may be done.
  enum class Total { known, least };
  struct Bounds {
    Total total = Total::known;
    double seconds = INFINITY;  // when it ends at the latest
  };
  TimeLeft(double total, Bounds bounds) : total_(total), bounds_(bounds) {}
  // done units in all after `seconds`; both never less than before.
  void tell(double seconds, double done);
  // "12 s left", "40 s to 2 min 05 s left", "at least 12 s left", "at most 60 s left", "time left not known yet".
  std::string text() const;

 private:
  // Seconds, the least and the most; nothing as long as too little is done.
  std::optional<std::array<double, 2>> range() const;
  struct Moment {
    double seconds, done;
  };
  double total_, seconds_ = 0;
  Bounds bounds_;
  std::vector<Moment> moments_;  // thinned; the first is that of the first work done
};

}  // namespace suite
