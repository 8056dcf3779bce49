// Phase functions of large particles, as tables of aerosols hold them, through the quad-tree.
#include <gtest/gtest.h>

#include <cmath>

#include "optics/model_function.h"
#include "optics/phase_function.h"
#include "sqt_fit/fit.h"

namespace suite::phase_test {
namespace {

// Diffraction by a coarse mode (Fraunhofer's pattern, size parameters spread evenly in their logarithm around `size`)
// over a Henyey-Greenstein floor, at the angles of the tables of OPAC (Hess, Koepke & Schult 1998): close near 0, then
// every degree.
std::string coarse_mode(double size) {
  std::string table;
  for (double angle = 0; angle < 180.5; angle += angle < 1.95 ? 0.1 : angle < 9.75 ? 0.5 : 1) {
    const double c = std::cos(angle * kDegree), g = 0.7;
    double sum = 0, norm = 0;
    for (int k = -10; k <= 10; ++k) {
      const double x = size * std::exp(0.08 * k), z = x * std::sin(angle * kDegree);
      const double pattern = z < 1e-6 ? 1 : std::pow(2 * std::cyl_bessel_j(1, z) / z, 2);
      sum += angle < 90 ? x * x * x * x * pattern / (4 * kPi) : 0, norm += x * x;
    }
    const double floor = (1 - g * g) / (4 * kPi * std::pow(1 + g * g - 2 * g * c, 1.5));
    table += strf("%s%.1f %.6g", table.empty() ? "" : ", ", angle, 0.5 * sum / norm + 0.5 * floor);
  }
  return table;
}

TEST(SqtPhase, ForwardPeaksOfLargeParticlesKeepTheirHeight) {
  // Regression: the peak straight on of fits to tables of large particles was clipped, here by 3.5 % at size 200.
  for (const double size : {15.0, 60.0, 200.0}) {
    const std::string table = coarse_mode(size);
    const auto function = model_function("tabulated:table=" + table);
    const sqt::Reference reference(*function, 20000);
    const sqt::FitResult fit =
        sqt::fit_to(*function, reference, {}, {0, 0, 0.98}, [](const sqt::AlignedSource&) { return size_t{0}; });
    EXPECT_TRUE(fit.peak_met) << size;
    const ModelSpec fitted{"sqt", {}, {}, {{"file", "dust.sqt"}}, sqt::make_bundle(fit.fit.data)};
    const SpectralState state = make_state(std::vector<Band>{Band::rectangular("b", 0.55, 0.01)}, 0.01);
    const auto phase = bake_phase(fitted, state),
               exact = bake_phase({"tabulated", {}, {}, {{"table", table}}, nullptr}, state);
    std::vector<float> p(1), q(1);
    // Straight on, and over the peak as far as its half; then everywhere as the table is.
    for (double angle = 0; angle < 60 / size; angle += 5 / size) {
      phase->eval(std::cos(angle * kDegree), p), exact->eval(std::cos(angle * kDegree), q);
      EXPECT_NEAR(p[0] / q[0], 1, 0.025) << size << " at " << angle;
    }
    double difference = 0;
    for (int i = 0; i < 20000; ++i) {
      const double c = -1 + (i + 0.5) / 10000;
      phase->eval(c, p), exact->eval(c, q);
      difference += 2 * kPi / 10000 * std::fabs(p[0] - q[0]);
    }
    EXPECT_LT(difference, 0.02) << size;
    phase->asymmetry(p), exact->asymmetry(q);
    EXPECT_NEAR(p[0], q[0], 5e-3) << size;  // a quarter of the difference allowed above
  }
}

// The figures of functions over the sphere, where half of the pairs are drawn near either pole, are those of a
// quadrature over the angle. Weights that forget one of the poles are 4 % off in cos_rmse.
TEST(SqtPhase, ErrorFiguresAreThoseOfAQuadrature) {
  const auto narrow = model_function("hg:g=0.7"), wide = model_function("hg:g=0.4");
  const sqt::Reference of_wide(*wide, 5000), of_narrow(*narrow, 200000);
  const sqt::FitResult fit =
      sqt::fit_to(*wide, of_wide, {}, {0, 0, 0.9}, [](const sqt::AlignedSource&) { return size_t{0}; });
  const auto bundle = sqt::make_bundle(fit.fit.data);
  const SpectralState state = make_state(std::vector<Band>{Band::rectangular("b", 0.55, 0.01)}, 0.01);
  const auto fitted = bake_phase({"sqt", {}, {}, {{"file", "wide.sqt"}}, bundle}, state);
  double off = 0, all = 0, squares = 0, of = 0;
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {
    const double c = -1 + (i + 0.5) * 2 / kSteps, g = 0.7,
                 f = (1 - g * g) / (4 * kPi * std::pow(1 + g * g - 2 * g * c, 1.5));
    std::vector<float> p(1);
    fitted->eval(c, p);
    const double d = double{p[0]} - f;
    off += std::fabs(d), all += f, squares += d * d, of += f * f;
  }
  const sqt::ErrorFigures seen = of_narrow.measure(*bundle).back();
  std::printf("l1 %.5f (%.5f), cos_rmse %.5f (%.5f)\n", seen.l1, off / all, seen.cos_rmse, std::sqrt(squares / of));
  EXPECT_NEAR(seen.l1, off / all, 0.01 * off / all);
  EXPECT_NEAR(seen.cos_rmse, std::sqrt(squares / of), 0.01 * std::sqrt(squares / of));
}

}  // namespace
}  // namespace suite::phase_test
