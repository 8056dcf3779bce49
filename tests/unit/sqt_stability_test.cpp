// Inputs that are hard on a fitter: constants, zeros, holes, noise, lobes narrower than any cell, grazing views.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "math/sampling.h"
#include "sqt/fit.h"
#include "sqt/narrow_lobe.h"
#include "sqt/scattered.h"
#include "support/sqt_examples.h"

namespace suite::sqt {
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
  expect_sane(*fit(Analytic([](Dir, Dir in) { return in.x > 0 ? std::nan("") : 0.1; })));
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

TEST(SqtStability, LobesAreFollowedWhereverTheyPoint) {
  auto frame_of = [](const Analytic& f) { return AlignedSource(f, test::small_options()).layout().frame; };
  EXPECT_EQ(frame_of(test::glossy()), LobeFrame::half);
  EXPECT_EQ(frame_of(Analytic([](Dir o, Dir i) {
              return 0.3 * test::glossy_value({-o.x, -o.y, o.z}, i, 0.15);
            })),
            LobeFrame::retro);
}

TEST(SqtStability, PaperMethodStandsTheSame) {
  for (const auto& f : {Analytic([](Dir, Dir) { return 0.5 / kPi; }), Analytic([](Dir, Dir) { return 0.0; }),
                        Analytic([](Dir, Dir) { return std::nan(""); })})
    expect_sane(*make_bundle(test::small_paper(f)));
}

}  // namespace
}  // namespace suite::sqt
