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
};

// Moves t to `end` (>= t), the first step being dt (s); returns the step to go on with. attempt(dt): the estimated
// error of a step, K, or infinite where none can be taken; accept(dt): takes the step just attempted and moves t;
// reject(): counts. Error: no step above min_step keeps the tolerance.
template <class Attempt, class Accept, class Reject>
double advance_by_error(double& t, double end, double dt, const StepControl& control, const Attempt& attempt,
                        const Accept& accept, const Reject& reject) {
  while (t < end) {
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
