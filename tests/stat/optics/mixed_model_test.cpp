// Mixtures conform as the models of the table do: sampling follows the density, and the mean of w / p is the total, for
// shares that are even over the wavelengths and for shares that are not. Family-wise significance 1e-3.
#include <gtest/gtest.h>

#include "optics/mixed_model.h"
#include "support/conformance.h"

namespace suite::mixed_model_test {
namespace {

using test::ConformanceOptions;

std::unique_ptr<const ScatterModel> example(const char* row, size_t n, const SpectralState& state) {
  ModelSpec spec = models().find(row).examples()[n];
  check_model(spec);
  return bake(spec, state);
}

TEST(MixedModel, SamplingFollowsTheDensityAndAveragesToTheTotal) {
  const SpectralState state = test::test_state(3);
  const auto leaf = example("leaf", 0, state), ward = example("ward", 1, state), mirror = example("mirror", 0, state),
             lambert = example("lambert", 0, state);
  std::vector<float> rising, falling;
  for (size_t i = 0; i < state.size(); ++i) {
    rising.push_back(0.1f + 0.8f * static_cast<float>(i) / static_cast<float>(state.size()));
    falling.push_back(1 - rising.back());
  }
  std::vector<MixedModel> mixtures(3);
  for (MixedModel& m : mixtures) m.reset(state.knots);
  mixtures[0].add(*leaf, 0.3f), mixtures[0].add(*ward, 0.7f);
  mixtures[1].add(*ward, 1, rising), mixtures[1].add(*leaf, 1, falling);
  mixtures[2].add(*mirror, 0.25f), mixtures[2].add(*lambert, 0.25f), mixtures[2].add(*ward, 0.5f, rising),
      mixtures[2].add(*lambert, 0.5f, falling);
  ConformanceOptions options;
  options.significance = 1e-3 / 300;
  for (size_t m = 0; m < mixtures.size(); ++m)
    for (const Dir out : test::test_directions(mixtures[m]))
      for (int knot = -1; knot < 3; ++knot) {
        const auto r = test::conform(mixtures[m], state, out, knot, options);
        EXPECT_TRUE(r.passes(options)) << "mixture " << m << " out " << out.z << " knot " << knot << ": " << r.text();
      }
}

TEST(MixedModel, ValuesAreTheSharesOfTheParts) {
  const SpectralState state = test::test_state(2);
  const auto ward = example("ward", 0, state), lambert = example("lambert", 0, state);
  MixedModel mixed;
  mixed.reset(state.knots);
  mixed.add(*ward, 0.3f);
  mixed.add(*lambert, 0.7f);
  std::vector<float> a(state.size()), b(state.size()), w(state.size());
  const Dir out = dir_from_angles(0.4, 0), in = dir_from_angles(0.5, 3);
  ward->eval(out, in, a), lambert->eval(out, in, b), mixed.eval(out, in, w);
  for (size_t i = 0; i < w.size(); ++i) EXPECT_NEAR(w[i], 0.3f * a[i] + 0.7f * b[i], 1e-6 * w[i]);
  ward->total(out, a), lambert->total(out, b), mixed.total(out, w);
  for (size_t i = 0; i < w.size(); ++i) EXPECT_NEAR(w[i], 0.3f * a[i] + 0.7f * b[i], 1e-6);
}

// The control: a mixture that draws its parts half and half but claims other densities is refused.
class Lying final : public ScatterModel {
 public:
  Lying(const MixedModel& drawn, const MixedModel& claimed) : drawn_(drawn), claimed_(claimed) {}
  void eval(Dir o, Dir i, std::span<float> w) const override { claimed_.eval(o, i, w); }
  void total(Dir o, std::span<float> W) const override { claimed_.total(o, W); }
  std::optional<Sample> sample(Dir o, Vec2 u, double l, int k) const override { return drawn_.sample(o, u, l, k); }
  void pdf(Dir o, Dir i, std::span<float> p) const override { claimed_.pdf(o, i, p); }

 private:
  const MixedModel &drawn_, &claimed_;
};

TEST(MixedModel, AWrongShareIsRefused) {
  const SpectralState state = test::test_state(1);
  const auto ward = example("ward", 0, state), lambert = example("lambert", 0, state);
  MixedModel drawn, claimed;
  drawn.reset(state.knots), claimed.reset(state.knots);
  drawn.add(*ward, 0.5f), drawn.add(*lambert, 0.5f);
  claimed.add(*ward, 0.45f), claimed.add(*lambert, 0.55f);
  ConformanceOptions options;
  options.significance = 1e-3 / 300;
  EXPECT_FALSE(test::conform(Lying(drawn, claimed), state, dir_from_angles(0.3, 0), 0, options).passes(options));
}

}  // namespace
}  // namespace suite::mixed_model_test
