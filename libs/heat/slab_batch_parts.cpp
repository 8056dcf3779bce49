// Steps in which an element could lose more heat than it holds: the scheme's first stage takes the losses of the begin
// for half of what they do, and a thin skin that has just lost its sun then has none left. Shorter steps have some.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "heat/slab_batch.h"

namespace suite {

namespace {

constexpr double kFinest = 0x1p-16;     // of the step: below it there is no solution
constexpr double kFineEnough = 0x1p-7;  // of the step: parts for the sake of errors are no shorter
constexpr double kError = 0.1;          // K, estimated of a part

// Lines over a share of a step.
FaceLines between(const FaceLines& whole, double begin, double end) {
  FaceLines part = whole;
  const auto cut = [&](StepLine& line) {
    const StepLine all = line;
    line = {all.begin + (all.end - all.begin) * begin, all.begin + (all.end - all.begin) * end};
  };
  for (StepLine& line : part.constant) cut(line);
  for (StepLine& line : part.linear) cut(line);
  return part;
}

}  // namespace

void SlabBatch::step_in_parts(double dt) {
  const double begin = t_;
  const FaceLines top = top_lines_, bottom = bottom_lines_;
  const std::vector<Lanes> before = now_;
  std::vector<double> tops(elements_), bottoms(elements_), errors(elements_);
  double done = 0, part = 0.5;  // shares of the step, which doubles hold exactly
  while (done < 1) {
    part = std::fmin(part, 1 - done);
    const double estimate =
        attempt(part * dt, [&](double, double, const SlabBatch&, FaceLines& now_top, FaceLines& now_bottom) {
          now_top = between(top, done, done + part), now_bottom = between(bottom, done, done + part);
        });
    if (!std::isfinite(estimate) && part <= kFinest) {
      now_ = before, t_ = begin;
      attempt(dt, [&](double, double, const SlabBatch&, FaceLines& now_top, FaceLines& now_bottom) {
        now_top = top, now_bottom = bottom;
      });
      if (!std::isfinite(largest_estimate()))
        throw Error(strf("slabs find no temperatures after a step of %g s from %.9g s", dt, begin),
                    "a shorter step_s, or layers that hold more heat");
      return accept(dt);
    }
    if (!std::isfinite(estimate) || (estimate > kError && part > kFineEnough)) {
      part /= 2;
      continue;
    }
    accept(part * dt);
    for (size_t e = 0; e < elements_; ++e)
      tops[e] += part * top_mean_[e], bottoms[e] += part * bottom_mean_[e], errors[e] += estimate_[e];
    done += part, part *= 2;
  }
  t_ = begin + dt;
  top_lines_ = top, bottom_lines_ = bottom;
  top_mean_ = std::move(tops), bottom_mean_ = std::move(bottoms), estimate_ = std::move(errors);
}

}  // namespace suite
