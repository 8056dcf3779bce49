// The four verbs of a bundle agree with one another: what sample draws is what pdf says, pdf weighs what eval says, and
// total is their mean. With negative controls.
#include <gtest/gtest.h>

#include "math/sampling.h"
#include "math/stats.h"
#include "math/warps.h"
#include "sqt/paper.h"

namespace suite::sqt {
namespace {

// A glossy lobe around the mirror direction over a diffuse floor, two channels.
class Glossy final : public Function {
 public:
  Glossy() {
    info_.name = "glossy";
    info_.wavelength_um = {0.65, 0.45};
  }
  const Info& info() const override { return info_; }
  void value(Dir out, Dir in, std::span<double> f) const override {
    const Dir h = normalized(out + in);
    const double lobe = std::exp(-(1 - h.z * h.z) / (h.z * h.z * 0.04));
    f[0] = 0.1 + 0.5 * lobe;
    f[1] = 0.02 + 1.0 * lobe;
  }

 private:
  Info info_;
};

std::shared_ptr<const Bundle> paper_bundle() {
  PaperOptions options;
  options.views = 8;
  options.order = 5;
  options.threshold = 0.3;
  options.samples_per_cell_side = 2;
  static const auto bundle = make_bundle(fit_paper(Glossy(), options));
  return bundle;
}

// Chi-square of n draws against the density integrated over HEALPix cells of order 3 (failed draws are one more class).
double chi_square_of(const Bundle& bundle, Dir out, size_t channel, double spoil) {
  const int order = 3, side = 24;
  Pcg32 rng(7);
  std::vector<double> expected(cell_count(order) + 1, 0.0), seen(expected.size(), 0.0);
  const int n = 200000;
  double sum = 0;
  for (uint32_t i = 0; i < cell_count(order); ++i) {
    for (int k = 0; k < side * side; ++k) {
      const Dir in = direction_in(CellId::of(order, i), {(k % side + 0.5) / side, (k / side + 0.5) / side});
      expected[i] += n * bundle.pdf(out, in, channel) * cell_solid_angle(order) / (side * side) *
                     (in.x > 0 ? 1 + spoil : 1 - spoil);
    }
    sum += expected[i];
  }
  expected.back() = std::max(0.0, n - sum);
  for (int i = 0; i < n; ++i) {
    const auto in = bundle.sample(out, {rng.uniform(), rng.uniform()}, rng.uniform(), channel);
    ++seen[in ? cell_of(*in, order).index() : cell_count(order)];
  }
  return chi_square_test(seen, expected, 20);
}

TEST(SqtVerbs, SampleFollowsPdf) {
  for (const double theta : {0.0, 0.3, 0.8, 1.3, 89.9 * kDegree})
    for (size_t c = 0; c < 2; ++c) {
      const Dir out = dir_from_angles(theta, 0.4);
      EXPECT_GT(chi_square_of(*paper_bundle(), out, c, 0), 1e-4) << theta << " " << c;
    }
}

TEST(SqtVerbs, NegativeControlTwoPercentIsRejected) {
  EXPECT_LT(chi_square_of(*paper_bundle(), dir_from_angles(0.8, 0.4), 0, 0.02), 1e-6);
}

TEST(SqtVerbs, MeanWeightIsTotal) {
  for (const double theta : {0.0, 0.5, 1.2, 89.9 * kDegree}) {
    const Dir out = dir_from_angles(theta, -2.0);
    SampleStream stream(3, 0, 0);
    double sum = 0;
    const uint32_t n = 1 << 17;
    for (uint32_t i = 0; i < n; ++i) {
      const auto u = stream.draw(i, 0);
      const auto in = paper_bundle()->sample(out, {u[0], u[1]}, u[2], 1);
      if (in) sum += paper_bundle()->eval(out, *in, 1) / paper_bundle()->pdf(out, *in, 1);
    }
    const double W = paper_bundle()->total(out, 1);
    EXPECT_NEAR(sum / n / W, 1, 1e-3) << theta;
  }
}

TEST(SqtVerbs, EvalIntegratesToTotal) {
  for (const double theta : {0.0, 0.5, 1.2}) {
    const Dir out = dir_from_angles(theta, 1.0);
    const int order = 8;
    double sum = 0;
    for (uint32_t i = 0; i < cell_count(order); ++i)
      sum += paper_bundle()->eval(out, center_of(CellId::of(order, i)), 0);
    EXPECT_NEAR(sum * cell_solid_angle(order) / paper_bundle()->total(out, 0), 1, 1e-3);
  }
}

}  // namespace
}  // namespace suite::sqt
