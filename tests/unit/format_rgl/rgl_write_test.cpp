// A function written as a .bsdf and read again: lobes keep their height and energy, the viewer's direction is theta_i.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "formats/rgl/rgl.h"
#include "math/warps.h"
#include "sqt_fit/swapped.h"
#include "support/sqt_examples.h"

namespace suite::format_rgl_rgl_write_test {
namespace {

// Cosine-weighted mean difference over even directions up to 80 deg, relative.
double difference(const sqt::Function& a, const sqt::Function& b) {
  double error = 0, sum = 0;
  std::vector<double> f(a.info().wavelength_um.size()), g(f.size());
  for (int o = 0; o < 80; o += 9)
    for (int i = 1; i < 80; i += 3)
      for (int p = 0; p < 360; p += 7) {
        const Dir out = dir_from_angles(o * kDegree, 0.3), in = dir_from_angles(i * kDegree, p * kDegree + 0.3);
        a.value(out, in, f), b.value(out, in, g);
        for (size_t c = 0; c < f.size(); ++c)
          error += std::fabs(f[c] - g[c]) * in.z * std::sin(i * kDegree), sum += f[c] * in.z * std::sin(i * kDegree);
      }
  return error / sum;
}

TEST(RglWrite, IsReadAsItWas) {
  test::Analytic gloss = test::glossy(0.15, 2);
  EXPECT_THROW(rgl_of(gloss, ""), Error);  // 0.65, 0.55 um
  gloss.info().wavelength_um = {0.55, 0.65};
  const auto read = parse_rgl(rgl_of(gloss, "gloss"), "x.bsdf");
  EXPECT_EQ(read->description(), "gloss");
  EXPECT_TRUE(read->info().isotropic);
  ASSERT_EQ(read->info().wavelength_um.size(), 2u);
  EXPECT_NEAR(read->info().wavelength_um[1], 0.65, 1e-6);
  EXPECT_LT(difference(gloss, *sqt::swapped(read)), 0.01);
}

// A function that is not reciprocal tells which direction is which; the wrong one must fail.
TEST(RglWrite, ThetaIIsTheViewers) {
  const test::Analytic leaning([](Dir out, Dir in) { return 0.1 + 0.2 * out.z + 0.02 * in.x * out.x; });
  const auto read = parse_rgl(rgl_of(leaning, "leaning"), "x.bsdf");
  EXPECT_LT(difference(leaning, *sqt::swapped(read)), 0.01);
  EXPECT_GT(difference(leaning, *read), 0.05);
}

TEST(RglWrite, KeepsTheAzimuthOfAnisotropicData) {
  const test::Analytic brushed(
      [](Dir out, Dir in) {
        const Dir h = normalized(out + in);
        return 0.1 + std::exp(-(h.x * h.x / 0.04 + h.y * h.y / 0.3));
      },
      1, sqt::Domain::hemisphere, sqt::Quantity::bsdf, false);
  const auto read = parse_rgl(rgl_of(brushed, "brushed"), "x.bsdf");
  EXPECT_FALSE(read->info().isotropic);
  EXPECT_LT(difference(brushed, *sqt::swapped(read)), 0.02);
}

TEST(RglWrite, RefusesWhatIsNoBrdf) {
  const test::Analytic haze([](Dir, Dir) { return 0.1; }, 1, sqt::Domain::sphere, sqt::Quantity::phase);
  EXPECT_THROW(rgl_of(haze, ""), Error);
}

}  // namespace
}  // namespace suite::format_rgl_rgl_write_test
