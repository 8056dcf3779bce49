// The conformance of every row of the table of models, for every example, knot and direction.
//
// Family-wise significance: 1e-3 over all tests of this file, divided evenly (Bonferroni). Fixed seeds. The negative
// controls show that with these sample sizes a sampler or a total that is wrong by 2 % is rejected (the sampler
// in 99 of 100 runs).
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "math/warps.h"
#include "optics/models.h"
#include "support/conformance.h"
#include "support/model_examples.h"

namespace suite::conformance_test {
namespace {

using test::ConformanceOptions;
using test::ConformanceResult;

constexpr double kFamilySignificance = 1e-3;
constexpr double kTests = 3000;  // more than there are: three questions for each (example, knot, direction)

ConformanceOptions options() {
  ConformanceOptions o;
  o.significance = kFamilySignificance / kTests;
  return o;
}

struct Case {
  std::string name;
  ModelSpec spec;
  bool reciprocal;
};
std::vector<Case> cases() {
  std::vector<Case> list;
  for (const ModelRow& row : models()) {
    size_t n = 0;
    for (ModelSpec spec : test::examples_of(row)) {
      check_model(spec);
      list.push_back({row.name + "_" + std::to_string(n++), std::move(spec), row.reciprocal});
    }
  }
  return list;
}

// The model of a case for three knots, baked once for all questions: some models integrate tables of their own.
const SpectralState& state_of_three() {
  static const SpectralState state = test::test_state(3);
  return state;
}
const ScatterModel& baked(const Case& c) {
  static std::map<std::string, std::unique_ptr<const ScatterModel>> models;
  auto& model = models[c.name];
  if (!model) model = bake(c.spec, state_of_three());
  return *model;
}

// The most that a surface may return: 1, or the squared index across an interface seen from the dense side.
double most_total(const ModelSpec& spec, Dir out) {
  const auto index = spec.curves.find("index");
  return index == spec.curves.end() || out.z > 0 ? 1 : index->second.max() * index->second.max();
}

class Conformance : public testing::TestWithParam<Case> {};

TEST_P(Conformance, SamplingFollowsPdfAndAveragesToTotal) {
  const SpectralState& state = state_of_three();
  const ScatterModel& model = baked(GetParam());
  // All knots together (-1) always, which is the question of each where the shape is the same at all of them; else each
  // direction at one knot in turn, at all of them with SUITE_LONG.
  const bool at_length = std::getenv("SUITE_LONG") != nullptr;
  int turn = 0;
  for (const Dir out : test::test_directions(model)) {
    const int own = turn++ % static_cast<int>(state.knots.size());
    for (int knot = -1; knot < static_cast<int>(state.knots.size()); ++knot) {
      if (knot >= 0 && (model.spectrally_uniform_shape() || (!at_length && knot != own))) continue;
      const ConformanceResult r = test::conform(model, state, out, knot, options());
      EXPECT_TRUE(r.passes(options())) << GetParam().name << " out (" << out.x << ' ' << out.y << ' ' << out.z
                                       << ") knot " << knot << ": " << r.text();
    }
  }
}

TEST_P(Conformance, TotalStaysWithinEnergy) {
  const SpectralState& state = state_of_three();
  const ScatterModel& model = baked(GetParam());
  std::vector<float> W(state.size());
  for (int deg = 0; deg < 180; ++deg)
    for (const double phi : {0.0, 1.0, 4.0}) {
      const Dir out = dir_from_angles((deg + 0.45) * kDegree, phi);
      model.total(out, W);
      for (const float w : W)
        EXPECT_TRUE(w >= 0 && w <= most_total(GetParam().spec, out) * (1 + 1e-4)) << deg << " deg: " << w;
    }
}

TEST_P(Conformance, GrazingGivesNothing) {
  const SpectralState& state = state_of_three();
  const ScatterModel& model = baked(GetParam());
  std::vector<float> w(state.size()), p(state.knots.size());
  const Dir grazing{0.6, 0.8, 0}, other = dir_from_angles(0.5, 1);
  const std::pair<Dir, Dir> pairs[] = {{grazing, other}, {other, grazing}, {grazing, grazing}};
  for (const auto& [out, in] : pairs) {
    model.eval(out, in, w);
    model.pdf(out, in, p);
    for (const float x : w) EXPECT_EQ(x, 0);
    for (const float x : p) EXPECT_EQ(x, 0);
  }
  model.total(grazing, w);
  for (const float x : w) EXPECT_EQ(x, 0);
  EXPECT_FALSE(model.sample(grazing, {0.3, 0.7}, 0.5, 0).has_value());
}

TEST_P(Conformance, ReciprocityWhereClaimed) {
  if (!GetParam().reciprocal) GTEST_SKIP() << "the row does not claim it";
  EXPECT_LT(test::worst_reciprocity_error(baked(GetParam()), state_of_three(), 4000, 5), 1e-5);
}

TEST_P(Conformance, OpaqueMeansNothingPasses) {
  const SpectralState& state = state_of_three();
  const ScatterModel& model = baked(GetParam());
  std::vector<float> w(state.size());
  bool passes = model.has_delta();  // Dirac lobes are invisible to eval
  for (int n = 0; n < 200; ++n) {
    const Dir out = dir_from_angles(0.1 + 0.005 * n, 0.3), in = dir_from_angles(kPi - 1.3 + 0.006 * n, 2);
    model.eval(out, in, w);
    for (const float x : w) passes = passes || x > 0;
    if (model.opaque()) {
      for (const float x : w) EXPECT_EQ(x, 0);
    }
  }
  EXPECT_TRUE(passes || model.opaque()) << "a model that lets nothing pass should say that it is opaque";
}

INSTANTIATE_TEST_SUITE_P(Models, Conformance, testing::ValuesIn(cases()), [](const auto& c) { return c.param.name; });

// --- negative controls: the same tests reject models that are wrong by 2 % -------------------------------------------

class Wrapped : public ScatterModel {
 public:
  explicit Wrapped(std::unique_ptr<const ScatterModel> model) : model_(std::move(model)) {}
  void eval(Dir out, Dir in, std::span<float> w) const override { model_->eval(out, in, w); }
  void total(Dir out, std::span<float> W) const override { model_->total(out, W); }
  std::optional<Sample> sample(Dir out, Vec2 u, double lobe_u, int knot) const override {
    return model_->sample(out, u, lobe_u, knot);
  }
  void pdf(Dir out, Dir in, std::span<float> p) const override { model_->pdf(out, in, p); }

 protected:
  std::unique_ptr<const ScatterModel> model_;
};
// Draws a lobe that is 2 % too wide.
class WideSampler final : public Wrapped {
 public:
  WideSampler(const ModelSpec& spec, const SpectralState& state) : Wrapped(bake(spec, state)) {
    ModelSpec wide = spec;
    wide.numbers["roughness"] *= 1.02;
    wide_ = bake(wide, state);
  }
  std::optional<Sample> sample(Dir out, Vec2 u, double lobe_u, int knot) const override {
    return wide_->sample(out, u, lobe_u, knot);
  }

 private:
  std::unique_ptr<const ScatterModel> wide_;
};
// Claims 2 % more than it returns.
class BoastfulTotal final : public Wrapped {
 public:
  using Wrapped::Wrapped;
  void total(Dir out, std::span<float> W) const override {
    model_->total(out, W);
    for (float& w : W) w *= 1.02f;
  }
};
// Turns every 50th sample by a right angle.
class TurnedSampler final : public Wrapped {
 public:
  using Wrapped::Wrapped;
  std::optional<Sample> sample(Dir out, Vec2 u, double lobe_u, int knot) const override {
    auto s = model_->sample(out, {u.x < 0.02 ? u.x / 0.02 : (u.x - 0.02) / 0.98, u.y}, lobe_u, knot);
    if (s && u.x < 0.02) s->in = {-s->in.y, s->in.x, s->in.z};
    return s;
  }
};

ModelSpec glossy() {
  ModelSpec spec{"ward",
                 {{"roughness", 0.15}},
                 {{"specular", Curve::constant(0.6)}, {"diffuse", Curve::constant(0)}},
                 {},
                 nullptr};
  check_model(spec);
  return spec;
}

TEST(NegativeControl, SamplersWrongByTwoPercentAreRejected) {
  const SpectralState state = test::test_state(1);
  const Dir out = dir_from_angles(0.6, 0.4);
  const ConformanceResult honest = test::conform(*bake(glossy(), state), state, out, 0, options());
  EXPECT_TRUE(honest.passes(options())) << honest.text();
  const ConformanceResult wide = test::conform(WideSampler(glossy(), state), state, out, 0, options());
  EXPECT_LT(wide.chi_square_p, options().significance) << wide.text();
  const ConformanceResult turned = test::conform(TurnedSampler(bake(glossy(), state)), state, out, 0, options());
  EXPECT_LT(turned.chi_square_p, options().significance) << turned.text();
}
TEST(NegativeControl, TotalsWrongByTwoPercentAreRejected) {
  const SpectralState state = test::test_state(1);
  const ConformanceResult r =
      test::conform(BoastfulTotal(bake(glossy(), state)), state, dir_from_angles(0.6, 0.4), 0, options());
  EXPECT_GE(r.chi_square_p, options().significance);
  EXPECT_FALSE(r.passes(options())) << r.text();
}

}  // namespace
}  // namespace suite::conformance_test
