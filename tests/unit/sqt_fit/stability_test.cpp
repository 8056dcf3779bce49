// Inputs that are hard on a fitter: constants, zeros, holes, noise, lobes narrower than any cell, grazing views.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "formats/merl/merl.h"
#include "math/sampling.h"
#include "sqt_fit/fit.h"
#include "sqt_fit/narrow_lobe.h"
#include "sqt_fit/scattered.h"
#include "support/sqt_examples.h"

namespace suite::sqt::stability_test {
namespace {

using test::Analytic;

// Finite and non-negative for any unit vectors, the axes and the horizon included.
void expect_sane(const Bundle& b) {
  std::vector<Dir> dirs;
  for (const double theta : {0.0, 1e-9, 0.3, 0.9, 1.3, 89.9 * kDegree, kPi / 2, kPi - 0.4, kPi})
    for (const double phi : {0.0, 0.7, kPi / 2, kPi, 4.0}) dirs.push_back(dir_from_angles(theta, phi));
  dirs.push_back({1, 0, 0});
  dirs.push_back({0, -1, 0});
  dirs.push_back({0, 0, 1});
  for (const Dir out : dirs)
    for (const Dir in : dirs)
      for (size_t c = 0; c < b.channels(); ++c) {
        const double f = b.value(out, in, c), p = b.pdf(out, in, c), W = b.total(out, c);
        EXPECT_TRUE(f >= 0 && std::isfinite(f)) << f;
        EXPECT_TRUE(p >= 0 && std::isfinite(p)) << p;
        EXPECT_TRUE(W >= 0 && W <= 1.001) << W;
        if (f > 1e-6) {
          EXPECT_GT(p, 0) << "drawn never, though it scatters";
        }
      }
}

std::shared_ptr<const Bundle> fit(const Function& f, double quality = 0.1) {
  return make_bundle(test::small_fit(f, quality).data);
}

TEST(SqtStability, ConstantIsALambertReflector) {
  const auto b = fit(Analytic([](Dir, Dir) { return 0.5 / kPi; }));
  expect_sane(*b);
  EXPECT_LT(b->info().leaves, 40u);
  for (const double theta : {0.0, 0.5, 1.2, 1.5}) {
    EXPECT_NEAR(b->total(dir_from_angles(theta, 1), 0), 0.5, 2e-3);
    EXPECT_NEAR(b->value(dir_from_angles(theta, 1), dir_from_angles(0.8, 3), 0), 0.5 / kPi, 3e-3 / kPi);
  }
}

TEST(SqtStability, ZeroScattersNothing) {
  const auto b = fit(Analytic([](Dir, Dir) { return 0.0; }));
  expect_sane(*b);
  EXPECT_EQ(b->total(dir_from_angles(0.4, 0), 0), 0);
  EXPECT_LT(b->value(dir_from_angles(0.4, 0), dir_from_angles(0.4, 3), 0), 1e-9);
}

TEST(SqtStability, NowhereValidScattersNothing) {
  const auto b = fit(Analytic([](Dir, Dir) { return std::nan(""); }));
  expect_sane(*b);
  EXPECT_EQ(b->total(dir_from_angles(0.4, 0), 0), 0);
}

TEST(SqtStability, HolesInfinitiesAndNegativesStayOut) {
  Pcg32 random(3);
  const auto b = fit(Analytic([](Dir out, Dir in) {
    const double noise =
        unit_double(hash_of(static_cast<uint64_t>(1e6 * (in.x + 2)), static_cast<uint64_t>(1e6 * (out.x + 2))));
    return noise < 0.02 ? std::nan("") : noise < 0.03 ? INFINITY : noise < 0.04 ? -5.0 : 0.2 / kPi;
  }));
  expect_sane(*b);
  EXPECT_NEAR(b->total(dir_from_angles(0.4, 0), 0), 0.2, 0.03);
}

TEST(SqtStability, HalfOfTheDirectionsInvalid) {
  // What is known goes on into what is not.
  const auto b = fit(Analytic([](Dir, Dir in) { return in.x > 0 ? std::nan("") : 0.1; }));
  expect_sane(*b);
  for (const double theta : {0.1, 0.8}) EXPECT_NEAR(b->total(dir_from_angles(theta, 0), 0), 0.1 * kPi, 0.01);
  EXPECT_NEAR(b->value(dir_from_angles(0.3, 0), dir_from_angles(0.6, 2.5), 0), 0.1, 0.01);
}

TEST(SqtStability, OneScatteredSample) {
  Samples s;
  s.info.wavelength_um = {0.55};
  s.out = {{0, 0, 1}};
  s.in = {dir_from_angles(0.4, 0)};
  s.value = {0.1};
  const auto f = interpolate(s);
  const auto b = fit(*f);
  expect_sane(*b);
  EXPECT_NEAR(b->value({0, 0, 1}, dir_from_angles(0.4, 0), 0), 0.1, 1e-3);
  s.value = {std::nan("")};
  EXPECT_THROW(interpolate(s), Error);
}

TEST(SqtStability, NarrowLobesAtEveryWidth) {
  for (const double width : {0.5, 0.05, 0.01, 0.002}) {
    AlignedSource::Options options = test::small_options();
    options.base_order = 6;
    options.max_order = 10;
    const Analytic f = Analytic([width](Dir out, Dir in) { return 0.3 * test::glossy_value(out, in, width); });
    const AlignedSource source(f, options);
    const auto b = make_bundle(encode_aligned(source, 0.1).data);
    expect_sane(*b);
    const double peak = 0.3 * test::glossy_value(dir_from_angles(0.5, 0), dir_from_angles(0.5, kPi), width);
    if (width > 0.004) {
      EXPECT_NEAR(b->value(dir_from_angles(0.5, 0), dir_from_angles(0.5, kPi), 0) / peak, 1, 0.15) << width;
    }
  }
}

// A lobe of one third of a cell's width is a Dirac lobe with its energy; one of several cells stays in the cells.
TEST(SqtStability, LobesNarrowerThanACellBecomeDirac) {
  const int order = 7;  // cells of 0.5 deg
  const double cell = std::sqrt(cell_solid_angle(order));
  auto lobe_and_floor = [](double width) {
    return std::make_shared<Analytic>(
        [width](Dir out, Dir in) { return 0.2 / kPi + 0.3 * (test::glossy_value(out, in, width) - 0.1); });
  };
  EXPECT_EQ(split_narrow_lobe(lobe_and_floor(3 * cell), order).rest, nullptr);
  const auto function = lobe_and_floor(cell / 3);
  const NarrowLobe split = split_narrow_lobe(function, order);
  ASSERT_NE(split.rest, nullptr);
  const auto b = fit(*split.rest);
  expect_sane(*b);
  ASSERT_TRUE(b->info().has_delta());
  const Dir out = dir_from_angles(0.5, 0.3);
  const auto dirac = b->delta(out, 0);
  ASSERT_TRUE(dirac.has_value());
  EXPECT_LT(length(dirac->in - Dir{-out.x, -out.y, out.z}), 1e-9);
  // The lobe's energy by a fine quadrature of the function itself.
  double lobe = 0;
  const int rings = 4000, spokes = 32;
  for (int r = 0; r < rings; ++r)
    for (int k = 0; k < spokes; ++k) {
      const double theta = 8 * cell / 3 * (r + 0.5) / rings, phi = 2 * kPi * (k + 0.5) / spokes;
      const Dir h = dir_from_angles(theta, phi), in = h * (2 * dot(h, out)) - out;
      lobe += 0.3 * (test::glossy_value(out, in, cell / 3) - 0.1) * 4 * dot(h, out) * in.z * std::sin(theta) *
              (8 * cell / 3 / rings) * (2 * kPi / spokes);
    }
  EXPECT_NEAR(dirac->total / lobe, 1, 0.01);
  EXPECT_NEAR(b->total(out, 0) - dirac->total, 0.2, 4e-3);
}

// Seen along the normal the azimuth of the view means nothing; along the horizon nothing is returned by a hemisphere,
// and just above it the verbs are finite and agree.
TEST(SqtStability, NormalAndGrazingViewsExactly) {
  const auto b = fit(test::glossy(0.4, 1), 0.02);
  const Dir in = dir_from_angles(0.4, 1.1);
  const double straight = b->value({0, 0, 1}, in, 0);
  EXPECT_GT(straight, 0);
  for (const double phi : {0.0, 1.0, 2.5, 4.7, 6.2}) {
    EXPECT_NEAR(b->value(dir_from_angles(1e-12, phi), in, 0) / straight, 1, 1e-6) << phi;
    EXPECT_NEAR(b->value({0, 0, 1}, dir_from_angles(0.4, phi), 0) / straight, 1, 0.02) << phi;  // isotropic
  }
  for (const double phi : {0.0, kPi / 2, kPi, 1.5 * kPi}) {
    const Dir level{std::cos(phi), std::sin(phi), 0};
    EXPECT_EQ(b->value(level, in, 0), 0);
    EXPECT_EQ(b->value(in, level, 0), 0);
    EXPECT_EQ(b->pdf(in, level, 0), 0);
    EXPECT_EQ(b->total(level, 0), 0);
    EXPECT_FALSE(b->sample(level, {0.5, 0.5}, 0.5, 0).has_value());
  }
  for (const double below : {1e-3, 1e-6, 1e-12}) {
    const Dir low = dir_from_angles(kPi / 2 - below, 0.3);
    EXPECT_TRUE(std::isfinite(b->total(low, 0)));
    Pcg32 random(5);
    for (int i = 0; i < 2000; ++i) {
      const auto drawn = b->sample(low, {random.uniform(), random.uniform()}, random.uniform(), 0);
      if (!drawn) continue;
      ASSERT_GT(drawn->z, 0);
      const double p = b->pdf(low, *drawn, 0);
      ASSERT_TRUE(p > 0 && std::isfinite(p)) << p;
      ASSERT_TRUE(std::isfinite(b->eval(low, *drawn, 0) / p));
    }
  }
}

// Isolated outliers in otherwise constant data, as measurements have them: negative and noisy values move the fit by no
// more than their share of it.
TEST(SqtStability, NoiseAndIsolatedNegatives) {
  const auto b = fit(Analytic([](Dir out, Dir in) {
    const uint64_t key = hash_of(static_cast<uint64_t>(1e6 * (in.x + 2)), static_cast<uint64_t>(1e6 * (in.y + 2)),
                                 static_cast<uint64_t>(1e6 * (out.x + 2)));
    const double u = unit_double(key);
    return u < 0.01 ? -3.0 : 0.4 / kPi * (0.8 + 0.4 * unit_double(mix64(key)));
  }));
  expect_sane(*b);
  for (const double theta : {0.0, 0.5, 1.0, 1.4}) EXPECT_NEAR(b->total(dir_from_angles(theta, 0), 0), 0.396, 0.02);
  double mean = 0;
  for (int k = 0; k < 100; ++k)
    mean += 0.01 * b->value(dir_from_angles(0.5, 0), dir_from_angles(0.012 * k, 0.4 * k), 0);
  EXPECT_NEAR(mean, 0.396 / kPi, 0.02 / kPi);
}

// Every other triple of a MERL table is invalid in one of its channels: what is left decides.
TEST(SqtStability, HalfOfTheMerlTriplesInvalid) {
  const size_t plane = 90 * 90 * 180;
  std::vector<double> raw(3 * plane);
  const double scale[3] = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
  for (size_t c = 0; c < 3; ++c)
    for (size_t i = 0; i < plane; ++i) raw[c * plane + i] = (i % 2 && i / 2 % 3 == c) ? -1.0 : 0.3 / kPi / scale[c];
  const MerlTable table("half", 180, raw);
  EXPECT_NEAR(
      static_cast<double>(table.invalid_bins()) / static_cast<double>(table.invalid_bins() + table.valid_bins()), 0.5,
      0.01);
  const auto b = fit(table);
  expect_sane(*b);
  for (size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(b->value(dir_from_angles(0.6, 0), dir_from_angles(0.7, 2), c), 0.3 / kPi, 0.02 / kPi) << c;
}

TEST(SqtStability, PaperMethodStandsTheSame) {
  for (const auto& f : {Analytic([](Dir, Dir) { return 0.5 / kPi; }), Analytic([](Dir, Dir) { return 0.0; }),
                        Analytic([](Dir, Dir) { return std::nan(""); })})
    expect_sane(*make_bundle(test::small_paper(f)));
}

}  // namespace
}  // namespace suite::sqt::stability_test
