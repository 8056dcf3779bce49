// total() against the integral of what eval returns, for every example of every row, in many directions: the mean of
// w / pdf over low-discrepancy points: eight independent scrambles, whose spread tells the error of the reference (4
// standard errors are allowed for it). Points are doubled until the answer is certain: the total is within what is
// asked even with these errors added, or this is a fifth of it, or there are 2^13 a scramble. The control: totals that
// are off by three times as much are seen.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>

#include "math/sampling.h"
#include "math/stats.h"
#include "optics/models.h"
#include "support/conformance.h"
#include "support/model_examples.h"

namespace suite::totals_test {
namespace {

// Point i of scramble s: the same of all integrals, made once.
const std::array<double, 4>& point(uint32_t s, uint32_t i) {
  static std::array<std::vector<std::array<double, 4>>, 8> points;
  auto& of = points[s];
  while (of.size() <= i) of.push_back(SampleStream(s + 1, 0, 0).draw(static_cast<uint32_t>(of.size()), 0));
  return of[i];
}

// Sums of w / pdf at one knot over points of eight scrambles, all of as many.
class Integral {
 public:
  Integral(const ScatterModel& model, const SpectralState& state, Dir out, int knot)
      : model_(model),
        out_(out),
        knot_(knot),
        bin_(state.knots[static_cast<size_t>(knot)]),
        w_(state.size()),
        p_(state.knots.size()) {}

  // Doubles the points until `total` is within `asked` of the mean (or of 1e-3) with four standard errors added, or
  // these are a fifth of it, to 2^13 a scramble.
  RunningStats to(double total, double asked) {
    RunningStats means;
    for (uint32_t n = 1u << 9; n <= 1u << 13; n *= 2) {
      means = {};
      for (uint32_t s = 0; s < sums_.size(); ++s) {
        for (uint32_t i = done_; i < n; ++i) sums_[s] += at(point(s, i));
        means.add(sums_[s] / n);
      }
      done_ = n;
      const double allowed = asked * std::max(means.mean(), 1e-3), unsure = 4 * means.stderr_of_mean();
      if (std::fabs(total - means.mean()) + unsure < allowed || unsure < allowed / 5) break;
    }
    return means;
  }

 private:
  double at(const std::array<double, 4>& u) {
    const auto s = model_.sample(out_, {u[0], u[1]}, u[2], knot_);
    if (!s) return 0;
    if (s->delta) {
      model_.delta_weight(out_, s->lobe, knot_, w_);
      model_.delta_probability(out_, s->lobe, knot_, p_);
    } else {
      model_.eval(out_, s->in, w_);
      model_.pdf(out_, s->in, p_);
    }
    return static_cast<double>(w_[bin_]) / p_[static_cast<size_t>(knot_)];
  }
  const ScatterModel& model_;
  Dir out_;
  int knot_;
  size_t bin_;
  std::vector<float> w_, p_;
  std::array<double, 8> sums_{};
  uint32_t done_ = 0;
};

// How far a total is from the integral beyond four standard errors, as a part of it (or of 1e-3).
double beyond(double total, double asked, Integral integral) {
  const RunningStats reference = integral.to(total, asked);
  const double apart = std::fabs(total - reference.mean()) - 4 * reference.stderr_of_mean();
  return std::max(0.0, apart) / std::max(reference.mean(), 1e-3);
}

std::vector<double> angles_deg() {
  if (std::getenv("SUITE_LONG")) return {0, 3, 17, 33, 41, 47, 58, 71, 79, 84, 87, 89, 89.9};
  return {0, 3, 17, 41, 47, 71, 84, 89, 89.9};
}

TEST(Totals, AgreeWithTheIntegralOfEval) {
  const SpectralState state = test::test_state(3);
  std::vector<float> W(state.size());
  size_t seen = 0, controls = 0;
  for (const ModelRow& row : models()) {
    // Shell's table of totals is coarse beside its gloss at the horizon: 4.2e-3 at 89.9 degrees, where 1e-3 is asked.
    const double asked = row.name == "shell" ? 5e-3 : 1e-3;
    for (ModelSpec spec : test::examples_of(row)) {
      check_model(spec);
      const auto model = bake(spec, state);
      double worst = 0, worst_deg = 0;
      for (const double side : {1.0, -1.0})
        for (const double deg : angles_deg()) {
          Dir out = dir_from_angles(deg * kDegree, 0.05 * deg);
          out.z *= side;
          model->total(out, W);
          const double total = static_cast<double>(W[state.knots[1]]),
                       error = beyond(total, asked, {*model, state, out, 1});
          if (error > worst) worst = error, worst_deg = side * deg;
        }
      std::printf("%-16s roughness %-6g worst relative error of total %.1e at %g deg\n", row.name.c_str(),
                  spec.numbers.count("roughness") ? spec.numbers["roughness"] : 0.0, worst, worst_deg);
      EXPECT_LT(worst, asked) << row.name << " at " << worst_deg << " deg";
      // The control, in the direction that is hardest to integrate.
      const Dir low = dir_from_angles(84 * kDegree, 0.05 * 84);
      model->total(low, W);
      const double off = std::max(static_cast<double>(W[state.knots[1]]), 1e-3) * (1 + 3 * asked);
      ++controls, seen += beyond(off, asked, {*model, state, low, 1}) >= asked;
    }
  }
  std::printf("totals that are off: %zu of %zu seen\n", seen, controls);
  EXPECT_GE(seen, controls * 9 / 10);
}

}  // namespace
}  // namespace suite::totals_test
