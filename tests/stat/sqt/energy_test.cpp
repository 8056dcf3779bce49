// The energy sum of very many samples: the mean of w / pdf stays the total as samples are added, to 1e-3 as the runtime
// promises (a million by default, 1e8 under the label `long`: SUITE_ENERGY_SAMPLES).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "base/parallel.h"
#include "math/sampling.h"
#include "support/sqt_examples.h"

namespace suite::sqt::energy_test {
namespace {

// mean of w / pdf, with weights spoilt by a factor for the control.
struct Mean {
  double mean, error;
};
Mean mean_weight(const Bundle& bundle, Dir out, size_t n, double spoil) {
  constexpr size_t kChunk = 50000;
  struct Sums {
    double sum = 0, square = 0;
  };
  std::vector<Sums> parts((n + kChunk - 1) / kChunk);
  parallel_for(0, parts.size(), 1, [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) {
      Pcg32 random(23, k);
      for (size_t i = k * kChunk; i < std::min(n, (k + 1) * kChunk); ++i) {
        const auto in = bundle.sample(out, {random.uniform(), random.uniform()}, random.uniform(), 0);
        if (!in) continue;
        const double x = spoil * bundle.eval(out, *in, 0) / bundle.pdf(out, *in, 0);
        parts[k].sum += x, parts[k].square += x * x;
      }
    }
  });
  Sums all;
  for (const Sums& s : parts) all.sum += s.sum, all.square += s.square;
  const double count = static_cast<double>(n), mean = all.sum / count;
  return {mean, std::sqrt((all.square / count - mean * mean) / count)};
}

TEST(SqtEnergy, SumsToTheTotal) {
  const char* asked = std::getenv("SUITE_ENERGY_SAMPLES");
  const size_t n = asked ? static_cast<size_t>(std::atof(asked)) : 1000000;
  const auto bundle = make_bundle(test::small_fit(test::glossy(0.1, 1)).data);
  for (const double theta : {0.3, 1.1}) {
    const Dir out = dir_from_angles(theta, 0.7);
    const double W = bundle->total(out, 0);
    const Mean m = mean_weight(*bundle, out, n, 1);
    std::printf("%zu samples at %.1f rad: %.6f +- %.6f of the total\n", n, theta, m.mean / W, m.error / W);
    EXPECT_NEAR(m.mean / W, 1, 1e-3 + 4 * m.error / W);  // 4 sigma: 6e-5
    EXPECT_LT(m.error / W, 1e-3);
  }
}

TEST(SqtEnergyControl, HalfAPercentIsSeen) {
  const auto bundle = make_bundle(test::small_fit(test::glossy(0.1, 1)).data);
  const Dir out = dir_from_angles(0.3, 0.7);
  const Mean m = mean_weight(*bundle, out, 1000000, 1.005);
  EXPECT_GT(std::fabs(m.mean / bundle->total(out, 0) - 1), 1e-3 + 4 * m.error / bundle->total(out, 0));
}

}  // namespace
}  // namespace suite::sqt::energy_test
