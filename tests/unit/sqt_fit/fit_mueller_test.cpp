// Tables of Mueller matrices: thinned to an error, and possible everywhere.
#include <gtest/gtest.h>

#include "math/coherency.h"
#include "math/sampling.h"
#include "math/warps.h"
#include "sqt_fit/mueller_fit.h"
#include "sqt_fit/whole_circle.h"
#include "support/polished_metal.h"

namespace suite::fit_mueller_test {
namespace {

double least_between_nodes(const sqt::MuellerTable& table) {
  Pcg32 random(7);
  std::vector<Mueller> m(table.data().wavelength_um.size());
  double least = 1;
  for (int i = 0; i < 3000; ++i) {
    const Dir out = uniform_sphere({0.5 * random.uniform(), random.uniform()}),
              in = uniform_sphere({0.5 * random.uniform(), random.uniform()});
    table.at(out, in, m);
    for (const Mueller& x : m) least = std::min(least, least_coherency(x));
  }
  return least;
}

TEST(MuellerFit, KeepsTheErrorThatWasAskedFor) {
  const auto metal = test::polished_metal();
  size_t before = metal->data().grid.nodes() + 1;
  for (const double error : {0.001, 0.005, 0.02}) {
    const sqt::MuellerFit fit = sqt::fit_mueller(*metal, error);
    EXPECT_LE(fit.errors.rms, error);
    EXPECT_GT(fit.errors.largest, fit.errors.rms);
    EXPECT_LT(fit.table->data().grid.nodes(), before) << "fewer angles for a larger error";
    EXPECT_EQ(fit.table->data().grid.phi_d.size(), 2u) << "nothing here depends on it";
    EXPECT_EQ(fit.changed, 0);
    before = fit.table->data().grid.nodes();
  }
  const sqt::MuellerFit all = sqt::fit_mueller(*metal, 0);
  EXPECT_EQ(all.table->data().grid.nodes(), metal->data().grid.nodes());
  EXPECT_LT(all.errors.largest, 2e-4) << "whole numbers, and their room";
}

// The table beside the formula, at directions that are no nodes.
TEST(MuellerFit, IsTheFormulaBetweenNodes) {
  const sqt::MuellerFit fit = sqt::fit_mueller(*test::polished_metal(), 0.002);
  Pcg32 random(3);
  std::vector<Mueller> m(2);
  double sum = 0;
  int count = 0;
  for (int i = 0; i < 4000; ++i) {
    const Dir out = uniform_sphere({0.5 * random.uniform(), random.uniform()}),
              in = uniform_sphere({0.5 * random.uniform(), random.uniform()});
    if (out.z < 0.1 || in.z < 0.1) continue;
    fit.table->at(out, in, m);
    const Mueller expected = test::polished_matrix(sqt::HalfAngles::of(out, in), {0.2, 3.3}).matrix();
    for (size_t e = 1; e < 16; ++e) sum += std::pow(m[1].m[e] - expected.m[e], 2), ++count;
  }
  EXPECT_LT(std::sqrt(sum / count), 0.006);
}

// Where the azimuth does not matter, angles count that are above the horizon at any.
TEST(MuellerFit, CountsAllAzimuthsOfOne) {
  sqt::MuellerBrdf::Data d;
  d.grid.theta_h = {0, kPi / 4, kPi / 2}, d.grid.phi_d = {0}, d.wavelength_um = {0.5};
  for (int i = 0; i <= 30; ++i) d.grid.theta_d.push_back(kPi / 2 * i / 30);
  const auto matrix = [](double theta_d) {
    const PlaneBlocks b = fresnel_reflection(std::cos(theta_d), {1.4, 1.9});
    return (b * (0.9 / b.a)).matrix() + Mueller::depolariser() * 0.1;
  };
  for (size_t n = 0; n < d.grid.nodes(); ++n)
    for (const double x : matrix(d.grid.angles(n).theta_d).m) d.values.push_back(static_cast<float>(0.2 * x));
  const sqt::MuellerFit fit = sqt::fit_mueller({"facets", "formula", d}, 0.001);
  EXPECT_LT(fit.errors.largest, 0.1) << "at the horizon, of little weight";
  std::vector<Mueller> m(1);
  for (int i = 0; i <= 21; ++i) {
    Dir out, in;
    sqt::HalfAngles{0.5, kPi / 2 * i / 30, kPi / 2}.directions(out, in);
    fit.table->at(out, in, m);
    for (size_t e = 1; e < 16; ++e) EXPECT_NEAR(m[0].m[e], matrix(kPi / 2 * i / 30).m[e], 0.01) << i << " " << e;
  }
}

// Interpolated linearly, what is possible at nodes is possible between them; noise is made so, and told.
TEST(MuellerFit, IsPossibleEverywhere) {
  const sqt::MuellerFit clean = sqt::fit_mueller(*test::polished_metal(), 0.01);
  EXPECT_GE(clean.table->least(), 0);
  EXPECT_GE(least_between_nodes(*clean.table), -1e-12);
  const sqt::MuellerFit noisy = sqt::fit_mueller(*test::polished_metal(0.1), 0.05);
  EXPECT_GT(noisy.changed, 0.1);
  EXPECT_GT(noisy.most_changed, 0.01);
  EXPECT_GE(noisy.table->least(), 0);
  EXPECT_GE(least_between_nodes(*noisy.table), -1e-12);
}

TEST(MuellerFit, ImpossibleMatricesBecomePossible) {
  // A mirror that turns U and V by other amounts than light can be.
  const Mueller bad = PlaneBlocks{1, 0.3, 0.99, 0.3, 1, 0.99}.matrix(), good = physical(bad);
  EXPECT_LT(least_coherency(bad), -0.01);
  EXPECT_GT(least_coherency(good), -1e-12);
  EXPECT_NEAR(good(0, 0), 1, 1e-12);
  EXPECT_NEAR(good(0, 1), 0.3, 0.1);
  const Mueller kept = PlaneBlocks{1, 0.3, 0.5, 0.1, 1, 0.5}.matrix();
  EXPECT_EQ(physical(kept), kept);
}

// A surface that prefers 0.4 Q + 0.2 U in meridian frames about its normal, whatever the plane of scattering: straight
// back, as a laser and its receiver look, every plane is one.
TEST(MuellerTable, StraightBackIsTheLimitOfAllPlanes) {
  sqt::MuellerTable::Data d;
  d.grid.theta_h = {0.2, 0.8, 1.4}, d.grid.theta_d = {0, 1}, d.wavelength_um = {0.5};
  for (int i = 0; i < 180; ++i) d.grid.phi_d.push_back(-kPi + 2 * kPi * i / 180);
  for (size_t n = 0; n < d.grid.nodes(); ++n) {
    sqt::HalfAngles a = d.grid.angles(n);
    a.theta_d = 1e-4;
    Dir out, in;
    a.directions(out, in);
    Mueller q;
    q(0, 1) = 1;
    const Mueller turn = ScatteringPlane(out, in).turned(q);
    std::vector<double> elements(sqt::MuellerTable::kElements);
    elements[0] = 0.4 * turn(0, 1) + 0.2 * turn(0, 2), elements[1] = 0.2 * turn(0, 1) - 0.4 * turn(0, 2);
    for (const double e : elements)
      d.elements.push_back(static_cast<int16_t>(std::lround(e * sqt::MuellerTable::kUnit)));
  }
  const sqt::MuellerTable table(d);
  for (const double zenith : {0.3, 0.7, 1.1})
    for (int i = 0; i < 12; ++i) {
      const Dir out = dir_from_angles(zenith, 0.3 + 0.5 * i);
      for (const double off : {0.0, 1e-15, 1e-5}) {
        const Dir in = normalized(out + dir_from_angles(0.4 * i, 1.0 * i) * off);
        std::vector<Mueller> m(1);
        table.at(out, in, m);
        const Mueller seen = ScatteringPlane(out, in).turned(m[0]);
        EXPECT_NEAR(seen(0, 1), 0.4, 0.002) << zenith << " " << i << " " << off;
        EXPECT_NEAR(seen(0, 2), 0.2, 0.002) << zenith << " " << i << " " << off;
      }
    }
}

TEST(WholeCircle, TakesWholeAndHalfTurns) {
  EXPECT_EQ(sqt::whole_circle({0, kPi / 2, kPi, 3 * kPi / 2, 2 * kPi}).size(), 4u);
  EXPECT_EQ(sqt::whole_circle({-kPi, -kPi / 2, 0, kPi / 2}).size(), 4u);
  EXPECT_EQ(sqt::whole_circle({0.4}).size(), 1u);
  const auto half = sqt::whole_circle({0, kPi / 2, kPi});
  ASSERT_EQ(half.size(), 4u);
  EXPECT_TRUE(half[1].mirrored);
  EXPECT_EQ(half[1].from, 1u);
  EXPECT_THROW(sqt::whole_circle({0, 1, 1, 2 * kPi - 1}), Error);
  EXPECT_THROW(sqt::whole_circle({-1, 0, 1}), Error);
}

}  // namespace
}  // namespace suite::fit_mueller_test
