#include "optics/fresnel.h"

#include <gtest/gtest.h>

#include <complex>

#include "math/sampling.h"
#include "optics/microfacet.h"
#include "optics/models.h"
#include "optics/models/gauss_facets.h"
#include "support/conformance.h"

namespace suite::fresnel_test {
namespace {

// The textbook formulas with complex indices in long double.
long double textbook(long double c, std::complex<long double> n) {
  const std::complex<long double> ct = std::sqrt(std::complex<long double>(1) - (1 - c * c) / (n * n));
  const auto rs = (c - n * ct) / (c + n * ct), rp = (n * c - ct) / (n * c + ct);
  return 0.5L * (std::norm(rs) + std::norm(rp));
}

TEST(Fresnel, DielectricAgreesWithTheTextbookToTwelveDigits) {
  for (const double eta : {1.0001, 1.33, 1.5, 2.4, 5.0, 1 / 1.5, 1 / 1.0001})
    for (const double c : {1.0, 0.9, 0.5, 0.1, 1e-3, 1e-6}) {
      const Fresnel f = fresnel_dielectric(c, eta);
      const double wanted = static_cast<double>(textbook(c, eta));
      EXPECT_NEAR(f.reflectance, wanted, 1e-12 * wanted + 1e-18) << eta << ' ' << c;
      EXPECT_NEAR(f.reflectance + f.transmittance, 1, 1e-14);
    }
}
TEST(Fresnel, LimitsOfDielectrics) {
  EXPECT_NEAR(fresnel_dielectric(1, 1.5).reflectance, 0.04, 1e-15);
  EXPECT_EQ(fresnel_dielectric(0.5, 1).reflectance, 0);
  EXPECT_EQ(fresnel_dielectric(0.3, 1 / 1.5).transmittance, 0);  // beyond the critical angle
  EXPECT_EQ(fresnel_dielectric(0, 1.5).reflectance, 1);
  const double brewster = std::cos(std::atan(1.5));
  const Fresnel f = fresnel_dielectric(brewster, 1.5);
  EXPECT_NEAR(f.reflectance, 0.5 * std::pow((1 - 2.25) / (1 + 2.25), 2),
              1e-14);  // p vanishes, s = ((1 - n^2)/(1 + n^2))^2
  // Transmittance at grazing keeps its relative precision: 2 c (1 + n^2) / sqrt(n^2 - 1) to first order in c.
  EXPECT_NEAR(fresnel_dielectric(1e-9, 1.5).transmittance / (2e-9 * (1 + 2.25) / std::sqrt(1.25)), 1, 1e-8);
}
// Radiance over the squared index is what an interface keeps (R. Preisendorfer, 1976): straight through n = 1.5 a
// surface reflects 0.04, lets 0.96 / n^2 in and 0.96 n^2 out, and what is bent obeys Snell's law on both sides.
TEST(Fresnel, DielectricScalesRadianceByTheSquaredIndex) {
  const SpectralState state = test::test_state(1);
  ModelSpec spec{"dielectric", {}, {{"index", Curve::constant(1.5)}}, {}, nullptr};
  check_model(spec);
  const auto model = bake(spec, state);
  std::vector<float> W(state.size()), through(state.size());
  const struct { double side, passed; } sides[] = {{1, 0.96 / 2.25}, {-1, 0.96 * 2.25}};
  for (const auto& s : sides) {
    model->total({0, 0, s.side}, W);
    EXPECT_NEAR(W[0], 0.04 + s.passed, 1e-6) << s.side;
    const auto bent = model->sample({0.3, 0, s.side * std::sqrt(1 - 0.09)}, {0.5, 0.5}, 0.99, 0);
    ASSERT_TRUE(bent && bent->delta);
    EXPECT_NEAR(bent->in.x, s.side > 0 ? -0.2 : -0.45, 1e-12) << "sine 0.3 over or times 1.5";
    EXPECT_LT(bent->in.z * s.side, 0);
    model->delta_weight({0, 0, s.side}, bent->lobe, 0, through);
    EXPECT_NEAR(through[0], s.passed, 1e-6) << s.side;
  }
}
TEST(Fresnel, ConductorAgreesWithTheTextbook) {
  for (const auto& [n, k] : {std::pair{0.2, 3.4}, {1.35, 9.6}, {2.0, 0.0}, {0.05, 0.01}, {3.0, 50.0}})
    for (const double c : {1.0, 0.7, 0.2, 1e-3, 1e-6}) {
      const double wanted = static_cast<double>(textbook(c, {n, k}));
      EXPECT_NEAR(fresnel_conductor(c, n, k), wanted, 1e-11) << n << ' ' << k << ' ' << c;
    }
  EXPECT_EQ(fresnel_conductor(0, 1.3, 9), 1);
}

// f / n^2 of the side it leaves to is reciprocal, across an interface and on either side of it, with one index and with
// one that stands between tables.
TEST(Fresnel, RoughInterfaceIsReciprocalInBasicRadiance) {
  const SpectralState state = test::test_state(1);
  const Curve steady = Curve::constant(1.6), dispersive({0.4, 1.7}, {1.6, 1.5}, Outside::hold);
  Pcg32 random(5);
  for (const double roughness : {0.4, 1.0})
    for (const Curve& index : {steady, dispersive}) {
      ModelSpec spec{"ggx_dielectric", {{"roughness", roughness}}, {{"index", index}}, {}, nullptr};
      check_model(spec);
      const auto model = bake(spec, state);
      const std::vector<float> n = state.sample(index);
      std::vector<float> there(state.size()), back(state.size());
      int compared[2][2] = {};
      for (int i = 0; i < 4000; ++i) {
        const Dir a = dir_from_angles(kPi * random.uniform(), 7 * random.uniform()),
                  b = dir_from_angles(kPi * random.uniform(), 7 * random.uniform());
        model->eval(a, b, there);
        model->eval(b, a, back);
        for (size_t k = 0; k < n.size(); ++k) {
          const double f = there[k] / std::fabs(b.z) / (a.z > 0 ? 1 : n[k] * n[k]),
                       g = back[k] / std::fabs(a.z) / (b.z > 0 ? 1 : n[k] * n[k]);
          if (f + g < 1e-12) continue;
          ++compared[a.z > 0][b.z > 0];
          EXPECT_NEAR(f, g, 1e-5 * (f + g));
        }
      }
      for (const auto& row : compared)
        for (const int count : row) EXPECT_GT(count, 2000);
    }
}

// Tables and rays see the same normals: many at once are those of one at a time to the last bit, of views from the
// pole to below the horizon and counts that fill no block.
TEST(GaussFacets, NormalsOfManySamplesAreThoseOfOne) {
  const auto samples = baking_samples<GaussFacets>(256);
  for (const GaussFacets facets : {GaussFacets{0.22, 0.19}, GaussFacets{0.05, 0.6}, GaussFacets{0.9, 0.3}})
    for (const double polar : {0.0, 0.02, 0.7, 1.3, 1.56, 1.8, 2.8}) {
      const GaussFacets::View view(facets, dir_from_angles(polar, 0.4));
      std::vector<Dir> many(101);
      view.normals(std::span(samples).first(many.size()), many);
      for (size_t i = 0; i < many.size(); ++i) {
        const Dir one = view.normal(samples[i]);
        EXPECT_TRUE(one.x == many[i].x && one.y == many[i].y && one.z == many[i].z) << polar << ", sample " << i;
      }
    }
}

}  // namespace
}  // namespace suite::fresnel_test
