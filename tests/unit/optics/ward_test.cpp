#include "optics/models/ward.h"

#include <gtest/gtest.h>

#include "math/sampling.h"
#include "optics/models.h"
#include "support/conformance.h"

namespace suite::ward_test {
namespace {

TEST(WardAlbedo, TableAgreesWithTheQuadrature) {
  for (const auto& [ax, ay] : {std::pair{1e-4, 1e-4}, {0.02, 0.02}, {0.3, 0.3}, {1.0, 1.0}, {0.05, 0.5}, {1.0, 0.1}}) {
    const WardAlbedo albedo(ax, ay);
    Pcg32 random(3);
    for (int n = 0; n < 400; ++n) {
      const Dir out = dir_from_angles((n % 2 ? 89.9 : 80.0) * kDegree * random.uniform(), 7 * random.uniform());
      const double exact = albedo.exact(out);
      EXPECT_NEAR(albedo.at(out), exact, 1e-3 * exact) << ax << ' ' << ay << ' ' << polar_angle(out) / kDegree;
    }
  }
}
TEST(WardAlbedo, ClosedValueAtTheNormal) {
  // At normal view the weight is 1 - r^2 for slopes of length r < 1: A = 1 - a^2 (1 - exp(-1 / a^2)).
  for (const double a : {0.01, 0.2, 1.0})
    EXPECT_NEAR(WardAlbedo(a, a).exact({0, 0, 1}), 1 - a * a * (1 - std::exp(-1 / (a * a))), 1e-9);
}
TEST(Ward, WeightsOfGlossSamplesAreBoundedByTwo) {
  const SpectralState state = test::test_state(1);
  ModelSpec spec{
      "ward", {{"roughness", 0.4}}, {{"specular", Curve::constant(1)}, {"diffuse", Curve::constant(0)}}, {}, nullptr};
  check_model(spec);
  const auto model = bake(spec, state);
  std::vector<float> w(state.size()), p(1);
  Pcg32 random(4);
  for (int n = 0; n < 20000; ++n) {
    const Dir out = dir_from_angles(89.99 * kDegree * random.uniform(), 1);
    const auto s = model->sample(out, {random.uniform(), random.uniform()}, random.uniform(), 0);
    if (!s) continue;
    model->eval(out, s->in, w);
    model->pdf(out, s->in, p);
    EXPECT_LE(w[0] / p[0], 2.0001);
    EXPECT_NEAR(w[0] / p[0], 2 * s->in.z / (s->in.z + out.z), 1e-4);
  }
}
TEST(Ward, SaysWhatItCannotBe) {
  const SpectralState state = test::test_state(1);
  auto message = [&](ModelSpec spec) -> std::string {
    try {
      check_model(spec);
      bake(spec, state);
    } catch (const Error& e) {
      return e.what();
    }
    return "accepted";
  };
  EXPECT_NE(message({"ward",
                     {{"roughness", 0.1}},
                     {{"specular", Curve::constant(0.7)}, {"diffuse", Curve::constant(0.7)}},
                     {},
                     nullptr})
                .find("diffuse + specular = 1.4"),
            std::string::npos);
  EXPECT_NE(
      message({"ward", {{"roughness", 0.1}, {"roughness_y", 1e-6}}, {{"specular", Curve::constant(0.7)}}, {}, nullptr})
          .find("roughness_y = 1e-06"),
      std::string::npos);
  EXPECT_NE(message({"ggx", {{"roughness", 0.1}}, {}, {}, nullptr}).find("needs f0, or n and k"), std::string::npos);
  EXPECT_NE(
      message({"oren_nayar", {{"sigma", 0.3}}, {{"reflectance", Curve::constant(1)}}, {}, nullptr}).find("not bounded"),
      std::string::npos);
  EXPECT_NE(message({"rpv",
                     {},
                     {{"rho0", Curve::constant(0.9)}, {"k", Curve::constant(0.4)}, {"asymmetry", Curve::constant(0)}},
                     {},
                     nullptr})
                .find("the ground returns"),
            std::string::npos);
}

}  // namespace
}  // namespace suite::ward_test
