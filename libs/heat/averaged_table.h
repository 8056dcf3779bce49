// A quantity over time, told to long steps without aliasing: what a step sees is the straight line through it that has
// the mean and the first moment of the quantity, so gusts of a second under steps of ten minutes are averaged, not
// sampled, and what is linear in a step is kept exactly.
#pragma once
#include <cstddef>
#include <vector>

namespace suite {

// A quantity through one step: its values at the step's begin and end, straight in between.
struct StepLine {
  double begin = 0, end = 0;
  double mean() const { return (begin + end) / 2; }
  // At a fraction 0..1 of the step.
  double at(double fraction) const { return begin + fraction * (end - begin); }
};

class AveragedTable {
 public:
  enum class Between {
    linear,  // values[i] at times[i], straight in between
    held,    // values[i] from times[i] to times[i + 1]; the last value is not used
  };
  // times: s, strictly ascending, at least two; values: one a time, finite. repeat: the table is one period.
  // Error: anything else; a linear table that repeats and whose ends differ.
  AveragedTable(std::vector<double> times, std::vector<double> values, Between between, bool repeat);

  // Least-squares line over begin < end (s). A line of values that are all >= 0 is kept >= 0, with the same mean.
  // Cost: the pieces within, or the logarithm of their number when there are many.
  // Error: a step outside of a table that does not repeat.
  StepLine over(double begin, double end) const;
  // Root of the mean square of what the line leaves out: gusts. Error: as over().
  double deviation(double begin, double end) const;
  // The means over cells of about `width` (s), straight between the middles of the cells: what to choose steps by, so
  // that they follow the sun and not the gusts.
  AveragedTable averaged(double width) const;
  double begin() const { return times_.front(); }
  double end() const { return times_.back(); }

 private:
  struct Moments {  // integrals of the quantity, of it times (t - origin), and of its square
    double area = 0, moment = 0, square = 0;
  };
  struct Fit {
    double mean, rise, variance;  // of the line, and about it
  };
  Fit fit(double begin, double end) const;
  size_t piece_at(double t) const;
  Moments piece(size_t i, double a, double b, double origin) const;
  Moments within(double a, double b, double origin) const;  // inside of the table

  std::vector<double> times_, values_;
  Between between_;
  bool repeat_, nonnegative_;
  std::vector<double> areas_, moments_, squares_;  // from the table's begin, about it, to each time
};

}  // namespace suite
