// The paper's construction, on the paper's own example and on inputs that are hard on it.
#include <gtest/gtest.h>

#include <cmath>

#include "sqt_fit/paper_fit.h"
#include "support/sqt_examples.h"

namespace suite::sqt::builder_test {
namespace {

// Figure 5: the Henyey-Greenstein function of g = 0.9 from 64,800 one-degree samples becomes a tree of 612 nodes with a
// maximum depth of six. The paper does not state its similarity threshold; at 5 times the mean over the sphere (2.7 %
// of the peak) ours comes to the same size, with the stated error.
TEST(PaperBuilder, HenyeyGreensteinBecomesAFewHundredLeaves) {
  Builder builder(6, Domain::sphere);
  for (int i = 0; i < 180; ++i)
    for (int j = 0; j < 360; ++j) {
      const double theta = (i + 0.5) * kDegree, phi = (j + 0.5) * kDegree;
      builder.insert(dir_from_angles(theta, phi), test::henyey_greenstein(std::cos(theta), 0.9));
    }
  const auto leaves = builder.reduce(5);
  std::printf("HG g = 0.9: %zu leaves (the paper: 612)\n", leaves.size());
  EXPECT_GT(leaves.size(), 400u);
  EXPECT_LT(leaves.size(), 800u);
  // Energy and mean error against the function, by the leaves' own solid angles.
  double energy = 0, error = 0;
  int deepest = 0;
  for (const PaperLeaf& leaf : leaves) {
    deepest = std::max(deepest, leaf.id.order());
    for (int k = 0; k < 64; ++k) {
      const Dir d = direction_in(leaf.id, {(k % 8 + 0.5) / 8, (k / 8 + 0.5) / 8});
      const double area = cell_solid_angle(leaf.id.order()) / 64;
      energy += area * leaf.value;
      error += area * std::fabs(leaf.value - test::henyey_greenstein(d.z, 0.9));
    }
  }
  std::printf("energy %.4f, mean error %.2f %%\n", energy, 100 * error);
  EXPECT_EQ(deepest, 6);
  EXPECT_NEAR(energy, 1, 0.03);
  EXPECT_LT(error, 0.25);
}

TEST(PaperBuilder, ConstantCollapsesToFaces) {
  Builder builder(5, Domain::sphere);
  for (uint32_t i = 0; i < cell_count(5); ++i) builder.insert(center_of(CellId::of(5, i)), 0.25);
  const auto leaves = builder.reduce(0.01);
  EXPECT_EQ(leaves.size(), 12u);
  for (const auto& leaf : leaves) EXPECT_FLOAT_EQ(leaf.value, 0.25f);
}

TEST(PaperBuilder, OneSampleFillsItsFace) {
  Builder builder(8, Domain::sphere);
  builder.insert(dir_from_angles(0.3, 0.4), 2);
  const auto leaves = builder.reduce(0.1);
  EXPECT_EQ(leaves.size(), 12u);
  double largest = 0;
  for (const auto& leaf : leaves) largest = std::max(largest, static_cast<double>(leaf.value));
  EXPECT_EQ(largest, 2);
}

TEST(PaperBuilder, NoSampleIsZeroEverywhere) {
  for (const auto& leaf : Builder(3, Domain::hemisphere).reduce(0.1)) EXPECT_EQ(leaf.value, 0);
}

TEST(PaperBuilder, BadValuesAreCountedAndLeftOut) {
  Builder builder(2, Domain::hemisphere);
  builder.insert({0, 0, 1}, NAN);
  builder.insert({0, 0, 1}, INFINITY);
  builder.insert({0, 0, -1}, 1);
  EXPECT_EQ(builder.rejected(), 3u);
  builder.insert(dir_from_angles(0.5, 0.5), -1);
  for (const auto& leaf : builder.reduce(0.1)) EXPECT_EQ(leaf.value, 0);
  EXPECT_EQ(builder.negative_leaves(), 1u);
}

TEST(PaperBuilder, LeavesCoverTheHemisphereWithoutOverlap) {
  const auto f = test::glossy(0.1, 1);
  PaperOptions options;
  options.views = 2;
  options.threshold = 0.2;
  const PaperData data = fit_paper(f, options);
  for (const auto& slice : data.slices) {
    double cosine = 0;
    for (const auto& leaf : slice) cosine += cosine_integral(leaf.id);
    EXPECT_NEAR(cosine, kPi, 1e-9);  // make_bundle refuses overlaps; full cover shows here
  }
  EXPECT_NO_THROW(make_bundle(data));
}

}  // namespace
}  // namespace suite::sqt::builder_test
