// Steps in time whose length follows the estimated error of a second-order scheme.
#pragma once
#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace suite {

struct StepControl {
  double tolerance = 0.01;  // K, bound of the estimated error of one step
  double max_step = 3600;   // s
  double min_step = 1e-9;   // s; below it there is an Error
  double most_steps = 1e7;  // tried on the way to one time; more, or many times more in sight, and there is an Error
};

// Counts steps and gives up in time: every 20,000 it looks at how far those led.
class StepBudget {
 public:
  StepBudget(double t, double most) : last_(t), most_(most) {}
  void take(double begin, double t, double end) {
    if (++taken_ % kLook != 0) return;
    const double ahead = (end - t) / (t - last_) * kLook;  // steps, if they stay as they are
    if (static_cast<double>(taken_) >= most_ || !(ahead <= 10 * most_))
      throw Error(strf("a slab would take about %.2g steps from %.9g to %.9g s", static_cast<double>(taken_) + ahead,
                       begin, end),
                  strf("at most %.2g: a shorter time, a larger tolerance, or loads that change less often", most_));
    last_ = t;
  }

 private:
  static constexpr long long kLook = 20000;
  double last_, most_;
  long long taken_ = 0;
};

// Moves t to `end` (>= t), the first step being dt (s); returns the step to go on with. attempt(dt): the estimated
// error of a step, K, or infinite where none can be taken; accept(dt): takes the step just attempted and moves t;
// reject(): counts. Error: no step above min_step keeps the tolerance; more steps than most_steps.
template <class Attempt, class Accept, class Reject>
double advance_by_error(double& t, double end, double dt, const StepControl& control, const Attempt& attempt,
                        const Accept& accept, const Reject& reject) {
  const double begin = t;
  StepBudget budget(t, control.most_steps);
  while (t < end) {
    budget.take(begin, t, end);
    const double left = end - t;
    const bool last = dt >= left * (1 - 1e-12);
    // Near the end two even steps are better than a long one and a crumb.
    const double now = last ? left : dt > 0.5 * left ? 0.5 * left : dt;
    const double error = attempt(now);
    if (error <= control.tolerance) {
      accept(now);
      if (last) t = end;
      const double factor = std::clamp(0.9 * std::cbrt(control.tolerance / std::fmax(error, 1e-300)), 0.3, 4.0);
      // Small gains are not worth a new elimination; a step cut short for the end of the time says nothing.
      const double wish = factor > 1 && factor < 1.15 ? now : now * factor;
      if (now == dt || wish > dt || factor < 1) dt = std::fmin(wish, control.max_step);
      continue;
    }
    reject();
    dt = now * (std::isfinite(error) ? std::clamp(0.9 * std::cbrt(control.tolerance / error), 0.1, 0.9) : 0.25);
    if (dt < control.min_step)
      throw Error(strf("a slab finds no step at %.9g s", t), "its loads or its materials change too violently");
  }
  return dt;
}

}  // namespace suite
