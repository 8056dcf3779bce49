// Every phase function of the table: normalised, sampled as its density says, with the mean cosine it claims.
// Family-wise significance 1e-3 over at most 100 chi-square tests; a sampler wrong by 2 % is rejected.
#include <gtest/gtest.h>

#include <cmath>

#include "math/sampling.h"
#include "math/stats.h"
#include "optics/phase_function.h"
#include "optics/phases/henyey_greenstein.h"
#include "support/conformance.h"
#include "support/model_examples.h"

namespace suite::phases_test {
namespace {

constexpr double kSignificance = 1e-3 / 100;

// Equal-probability classes found from the sampled cosines of one stream, expected counts by quadrature, observed ones
// from another stream.
template <class Sample, class Density>
double chi_square_of_cosines(Sample sample, Density density) {
  constexpr int n = 100000, classes = 40;
  Pcg32 pilot(1), random(2);
  std::vector<double> border;
  for (int i = 0; i < 20000; ++i) border.push_back(sample(pilot.uniform()));
  std::sort(border.begin(), border.end());
  std::vector<double> edges{-1};
  for (int k = 1; k < classes; ++k)
    if (const double e = border[static_cast<size_t>(k) * border.size() / classes]; e > edges.back()) edges.push_back(e);
  edges.push_back(1);
  std::vector<double> observed(edges.size() - 1), expected(edges.size() - 1);
  for (int i = 0; i < n; ++i) {
    const size_t c =
        static_cast<size_t>(std::upper_bound(edges.begin(), edges.end(), sample(random.uniform())) - edges.begin());
    observed[std::min(c, observed.size()) - 1] += 1;
  }
  for (size_t c = 0; c < expected.size(); ++c) {
    // Nodes crowd towards both ends of a class: the outer classes may hold a peak at +-1.
    constexpr int nodes = 4000;
    for (int i = 0; i < nodes; ++i) {
      const double t = (i + 0.5) / nodes, warp = t * t * t * (10 - 15 * t + 6 * t * t),
                   slope = 30 * t * t * (1 - t) * (1 - t);
      expected[c] += n * 2 * kPi * density(edges[c] + (edges[c + 1] - edges[c]) * warp) * slope *
                     (edges[c + 1] - edges[c]) / nodes;
    }
  }
  double whole = 0;
  for (const double e : expected) whole += e;
  EXPECT_NEAR(whole / n, 1, 1e-3) << "not normalised";
  return chi_square_test(observed, expected, 20);
}

TEST(Phases, SamplesFollowTheDensityAndItsMean) {
  const SpectralState state = test::test_state(3);
  std::vector<float> p(state.size()), q(state.knots.size()), g(state.size());
  for (const PhaseRow& row : phases())
    for (ModelSpec spec : test::examples_of(row)) {
      check_phase(spec);
      const auto phase = bake_phase(spec, state);
      phase->asymmetry(g);
      for (int k = 0; k < static_cast<int>(state.knots.size()); ++k) {
        const auto density = [&](double c) {
          phase->pdf(c, q);
          return static_cast<double>(q[static_cast<size_t>(k)]);
        };
        EXPECT_GE(chi_square_of_cosines([&](double u) { return phase->sample(u, k); }, density), kSignificance)
            << row.name << " knot " << k;
        double mean = 0;
        for (int i = 0; i < 20000; ++i) mean += phase->sample((i + 0.5) / 20000, k) / 20000;
        EXPECT_NEAR(mean, g[state.knots[static_cast<size_t>(k)]], 2e-4) << row.name;
        phase->eval(0.3, p);
        EXPECT_EQ(p[state.knots[static_cast<size_t>(k)]], static_cast<float>(density(0.3)));
      }
    }
}

TEST(Phases, NegativeControlIsRejected) {
  const double p = chi_square_of_cosines([](double u) { return hg_sample(0.7 * 1.02, u); },
                                         [](double c) { return hg_value(0.7, c); });
  EXPECT_LT(p, kSignificance);
}

TEST(Phases, HenyeyGreensteinSamplingInvertsItsDistribution) {
  for (const double g : {-0.9999, -0.5, -1e-9, 0.0, 1e-9, 0.3, 0.9, 0.9999})
    for (const double u : {0.0, 1e-6, 0.2, 0.5, 0.9, 0.999999}) {
      const double c = hg_sample(g, u);
      // Integral of 2 pi hg from -1 to c in closed form.
      const double d = std::sqrt((1 - g) * (1 - g) + 2 * g * (1 - c));
      const double cumulative = std::fabs(g) < 1e-6 ? (1 + c) / 2 : (1 - g * g) / (2 * g) * (1 / d - 1 / (1 + g));
      EXPECT_NEAR(cumulative, u, 1e-6) << g << ' ' << u;
    }
}

TEST(Phases, DirectionsHaveTheSampledAngle) {
  Pcg32 random(3);
  for (int i = 0; i < 1000; ++i) {
    const Dir out = dir_from_angles(kPi * random.uniform(), 7 * random.uniform());
    const double c = 2 * random.uniform() - 1;
    const Dir in = scattered_direction(out, c, random.uniform());
    EXPECT_NEAR(scattering_cosine(out, in), c, 1e-14);
    EXPECT_NEAR(length(in), 1, 1e-14);
  }
  EXPECT_NEAR(length(scattered_direction({0, 0, 1}, 1, 0.5) - Dir{0, 0, -1}), 0, 1e-15);  // straight on
}

TEST(Phases, FaultsAreNamed) {
  auto message = [](ModelSpec spec) -> std::string {
    try {
      check_phase(spec, {"media.yaml", 3, 5, {}, -1});
      bake_phase(spec, test::test_state(1));
    } catch (const Error& e) {
      return e.what();
    }
    return "accepted";
  };
  auto contains = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  contains(message({"hq", {}, {}, {}, nullptr}),
           "media.yaml:3:5: error: unknown phase function 'hq' [OP111]; did you mean 'hg'?");
  contains(message({"hg", {{"g", 1.0}}, {}, {}, nullptr}), "phase function 'hg': g = 1 is outside its range");
  contains(message({"hg", {}, {}, {}, nullptr}), "phase function 'hg' needs 'g'");
  contains(message({"tabulated", {}, {}, {{"table", "0 1, 90 2"}}, nullptr}), "ends before 180 deg");
  contains(message({"tabulated", {}, {}, {{"table", "0 1, 90 -2, 180 0"}}, nullptr}), "is negative");
  contains(message({"tabulated", {}, {}, {{"table", "0 1, ninety 2, 180 0"}}, nullptr}),
           "an angle expected at character 6");
  contains(message({"tabulated", {}, {}, {{"table", "0 0, 180 0"}}, nullptr}), "all zero");
}

}  // namespace
}  // namespace suite::phases_test
