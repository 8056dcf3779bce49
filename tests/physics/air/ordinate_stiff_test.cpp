// Discrete ordinates where the equations are stiff or nearly singular: against closed forms and limits.
#include <gtest/gtest.h>

#include "air/discrete_ordinates.h"
#include "air/ordinate_angles.h"
#include "support/phase_moments.h"

namespace suite::test::ordinate_stiff_test {
namespace {

DiscreteOrdinates solve(std::span<const DiffuseLayer> layers, double sun, int streams, double above = 0,
                        std::span<const double> secants = {}) {
  DiffuseProblem problem;
  problem.layers = layers;
  problem.beam.irradiance = sun > 0 ? 1 : 0;
  problem.beam.cosine = sun > 0 ? sun : 1;
  problem.beam.secants = secants;
  problem.top_radiance = above;
  DiscreteOrdinates solver(streams);
  solver.solve(problem);
  return solver;
}

// Chandrasekhar's H function of isotropic scattering, by the iteration 1 / H = sqrt(1 - w) + w / 2 * integral of
// x H(x) / (x + mu) ("Radiative transfer", 1950, chapter V, equation 20) on 64 points.
struct HFunction {
  GaussRule rule = gauss_rule(64);
  std::vector<double> h;
  double albedo;
  explicit HFunction(double w) : h(64, 1), albedo(w) {
    for (int step = 0; step < 200; ++step) {  // geometric means: by itself it swings when the albedo is 1
      std::vector<double> next;
      for (size_t i = 0; i < h.size(); ++i) next.push_back(std::sqrt(h[i] * at(rule.nodes[i])));
      h = next;
    }
  }
  double at(double mu) const {
    double sum = 0;
    for (size_t i = 0; i < h.size(); ++i) sum += rule.weights[i] * rule.nodes[i] * h[i] / (rule.nodes[i] + mu);
    return 1 / (std::sqrt(1 - albedo) + albedo / 2 * sum);
  }
};

TEST(OrdinateStiff, HalfSpaceReflectsByHFunctions) {
  for (const double albedo : {0.5, 0.9, 0.999}) {
    const HFunction h(albedo);
    for (const double depth : {1e4, 1e6}) {
      const DiffuseLayer layer{.depth = depth, .albedo = albedo, .moments = {}};
      const DiscreteOrdinates solver = solve(std::span(&layer, 1), 0.4, 32);
      const std::vector<double> phase{1 / (4 * kPi)};
      for (const double mu : {0.1, 0.4, 1.0}) {
        const double exact = albedo / (4 * kPi) * 0.4 / (mu + 0.4) * h.at(mu) * h.at(0.4);
        EXPECT_NEAR(solver.radiance({0, 0}, mu, 0, phase), exact, 1e-4 * exact) << albedo;
      }
    }
  }
}

// A thick conservative slab transmits 4 K(sun) sun / (3 (depth + 2 q)) of isotropic scattering, K = sqrt(3) / 4 H,
// q = 0.710446 (van de Hulst, "Multiple light scattering", 1980, chapter 5).
TEST(OrdinateStiff, ThickConservativeSlabTransmitsByTheEscapeFunction) {
  const HFunction h(1);
  const double sun = 0.4, escape = std::sqrt(3.0) / 4 * h.at(sun);
  for (const double depth : {100.0, 1e4, 1e6}) {
    for (const double albedo : {1.0, 1 - 1e-16}) {
      const DiffuseLayer layer{.depth = depth, .albedo = albedo, .moments = {}};
      const double through = solve(std::span(&layer, 1), sun, 32).black_irradiance(),
                   exact = 4.0 / 3 * escape * sun / (depth + 2 * 0.7104460895);
      EXPECT_NEAR(through, exact, 1e-4 * exact) << depth;
      if (depth < 1e3) {  // an extrapolation length of 0.7 instead of 0.7104 would show
        EXPECT_GT(std::fabs(through - exact * (depth + 1.4209) / (depth + 1.4)), 1e-4 * exact);
      }
    }
  }
}

// Depth 1000, albedo 1 - 1e-6: 16 streams against 64, and the transmission, next to that of lossless air, against the
// diffusion limit k L / sinh(k L), L = depth + 2 q / (1 - g), k^2 = 3 (1 - albedo) (1 - g) (van de Hulst 1980, chapter
// 5).
TEST(OrdinateStiff, CloudOfDepth1000) {
  const double g = 0.85, loss = 1e-6, depth = 1000;
  const std::vector<double> chi = henyey_greenstein(g, 129);
  const DiffuseLayer layer{.depth = depth, .albedo = 1 - loss, .moments = chi};
  const DiffuseLayer lossless{.depth = depth, .albedo = 1, .moments = chi};
  for (const double sun : {0.3, 1.0}) {
    const DiscreteOrdinates few = solve(std::span(&layer, 1), sun, 16), many = solve(std::span(&layer, 1), sun, 64);
    EXPECT_NEAR(few.fluxes({0, 0}).up / many.fluxes({0, 0}).up, 1, 0.001);
    EXPECT_NEAR(few.black_irradiance() / many.black_irradiance(), 1, 0.001);
    EXPECT_NEAR(few.fluxes({0, 0.5}).up / many.fluxes({0, 0.5}).up, 1, 0.001);
    EXPECT_NEAR(few.source({0, 0.5}, 0.3, 0) / many.source({0, 0.5}, 0.3, 0), 1, 0.005);
  }
  const double k = std::sqrt(3 * loss * (1 - g)), whole = depth + 2 * 0.7104 / (1 - g);
  const double ratio =
      solve(std::span(&layer, 1), 1, 16).black_irradiance() / solve(std::span(&lossless, 1), 1, 16).black_irradiance();
  EXPECT_NEAR(ratio, k * whole / std::sinh(k * whole), 0.002 * ratio);
  EXPECT_GT(std::fabs(ratio - 1), 0.05) << "the loss must show";
}

// The smallest eigenvalue of all decides what a thick cloud absorbs: nothing, or a part in 1e12 a scattering.
TEST(OrdinateStiff, ThickCloudsAbsorbWhatTheyShould) {
  const std::vector<double> chi = henyey_greenstein(0.85, 70);
  const auto absorbed = [&](double depth, double albedo, int streams) {
    const DiffuseLayer layer{.depth = depth, .albedo = albedo, .moments = chi};
    const DiscreteOrdinates solver = solve(std::span(&layer, 1), 0.5, streams);
    return 0.5 - solver.fluxes({0, 0}).up - solver.black_irradiance();
  };
  for (const int streams : {8, 16, 64}) EXPECT_NEAR(absorbed(1e7, 1, streams), 0, 1e-12);
  EXPECT_NEAR(absorbed(1e5, 1 - 1e-12, 16) / absorbed(1e5, 1 - 1e-12, 64), 1, 0.002);
  EXPECT_NEAR(absorbed(1e5, 1 - 1e-12, 16), 8.7e-8, 1e-9);  // some depth times loss
}

// Radiances of few streams against 64 over views, leaving out what is near the sun and opposite to it.
double worst_view(const std::vector<double>& chi, double depth, double sun, int streams, double* flux) {
  const DiffuseLayer layer{.depth = depth, .albedo = 0.95, .moments = chi};
  const DiscreteOrdinates few = solve(std::span(&layer, 1), sun, streams), many = solve(std::span(&layer, 1), sun, 64);
  double worst = 0;
  for (const double mu : {-1.0, -0.8, -0.5, -0.3, -0.1, 0.1, 0.3, 0.5, 0.8, 1.0})
    for (const double phi : {0.0, 0.5, 1.0, 2.0, kPi}) {
      const double cosine = scattering_cosine(sun, mu, phi);
      if (std::fabs(cosine) > std::cos(15 * kPi / 180)) continue;
      const std::vector<double> phase{phase_of(chi, cosine)};
      const DiffusePlace place{0, mu > 0 ? 0.0 : 1.0};
      worst =
          std::max(worst, std::fabs(few.radiance(place, mu, phi, phase) / many.radiance(place, mu, phi, phase) - 1));
    }
  *flux = std::max(std::fabs(few.fluxes({0, 0}).up / many.fluxes({0, 0}).up - 1),
                   std::fabs(few.black_irradiance() / many.black_irradiance() - 1));
  return worst;
}

TEST(OrdinateStiff, SixteenStreamsAreEnoughAwayFromTheSun) {
  double flux = 0;
  for (const double sun : {0.8, 0.3}) {
    for (const double depth : {0.3, 2.0}) {
      EXPECT_LT(worst_view(from_published(kHazeL), depth, sun, 16, &flux), 2e-3);
      EXPECT_LT(flux, 2e-4);
      EXPECT_GT(worst_view(from_published(kHazeL), depth, sun, 8, &flux), 8e-3) << "8 must be worse";
    }
    for (const double depth : {1.0, 30.0}) {
      EXPECT_LT(worst_view(from_published(kCloudC1), depth, sun, 16, &flux), 8e-3);
      EXPECT_LT(flux, 4e-4);
    }
  }
}

// Rayleigh air of depth 1e-9: half of what is scattered leaves to each side, to the first order.
TEST(OrdinateStiff, VeryThinAirKeepsItsDigits) {
  const std::vector<double> chi = rayleigh_moments();
  for (const double depth : {1e-4, 1e-9, 1e-15, 1e-30}) {
    const DiffuseLayer layers[3] = {{.depth = depth / 4, .albedo = 0.8, .moments = chi, .planck_top = 1e-3},
                                    {.depth = 0, .albedo = 0.8, .moments = chi},
                                    {.depth = depth * 3 / 4, .albedo = 0.8, .moments = chi}};
    const DiscreteOrdinates solver = solve(layers, 0.5, 16);
    const double scattered = 0.8 * depth / 2, emitted = 2 * kPi * 0.2 * depth / 4 * 0.5e-3;
    const double tolerance = 1e-9 + 40 * depth;
    EXPECT_NEAR(solver.fluxes({0, 0}).up / (scattered + emitted), 1, tolerance);
    EXPECT_NEAR(solver.black_irradiance() - 0.5 * std::exp(-depth / 0.5), scattered + emitted,
                1e-15 + 40 * depth * depth);
    EXPECT_NEAR(solver.fluxes({2, 1}).down / (scattered + emitted), 1, tolerance);
    const double mu = 0.3, phi = 0.5;
    const std::vector<double> phase(3, phase_of(chi, scattering_cosine(0.5, mu, phi)));
    EXPECT_NEAR(solver.radiance({0, 0}, mu, phi, phase) / ((0.8 * phase[0] + 0.2 * 0.5e-3 / 4) * depth / mu), 1,
                1e-9 + 10 * depth);
    EXPECT_NEAR(solver.spherical_albedo() / (0.8 * depth), 1, 1e-9 + 40 * depth);
  }
}

// A thin film under light from above: what it scatters of it, and what of a nearly conservative one is emission.
TEST(OrdinateStiff, ThinFilmsKeepTheirDigits) {
  const std::vector<double> chi = henyey_greenstein(0.8, 40);
  for (const double depth : {1e-6, 1e-12, 1e-20}) {
    const DiffuseLayer film{.depth = depth, .albedo = 0.6, .moments = {}};
    const DiscreteOrdinates solver = solve(std::span(&film, 1), 0, 8, 1);
    for (const double mu : {0.1, 1.0}) {
      EXPECT_NEAR(solver.radiance({0, 0}, mu, 0, {}) / (0.6 / 2 * depth / mu), 1, 1e-10 + 30 * depth);
      EXPECT_NEAR(solver.radiance({0, 0.25}, mu, 0, {}) / (0.6 / 2 * 0.75 * depth / mu), 1, 1e-10 + 30 * depth);
    }
  }
  const double albedo = 1 - 1e-13, forward = std::pow(0.8, 8);
  const DiffuseLayer white{.depth = 1, .albedo = albedo, .moments = chi, .planck_top = 3, .planck_bottom = 3};
  const DiscreteOrdinates solver = solve(std::span(&white, 1), 0, 8);
  EXPECT_NEAR(solver.emission({0, 0.5}) / (3 * (1 - albedo) / (1 - albedo * forward)), 1, 1e-14);
  EXPECT_NEAR(solver.depth_scale(0), 1 - albedo * forward, 1e-15);
}

// The core of an absorption line, Planck radiance linear in depth: the radiance is that of the place, plus mu times the
// slope (Eddington), and leaves the top as that of the topmost air.
TEST(OrdinateStiff, LineCoresShowTheLocalAir) {
  for (const double albedo : {0.0, 1e-8, 1e-3}) {
    const DiffuseLayer layers[2] = {
        {.depth = 1e5, .albedo = albedo, .moments = {}, .planck_top = 2, .planck_bottom = 5},
        {.depth = 2e5, .albedo = albedo, .moments = {}, .planck_top = 5, .planck_bottom = 9}};
    const DiscreteOrdinates solver = solve(layers, 0, 16, 7);
    for (const double mu : {-1.0, -0.1, 0.1, 1.0}) {
      EXPECT_NEAR(solver.radiance({0, 0.5}, mu, 0, {}), 3.5 + mu * 3e-5, 1e-9);
      EXPECT_NEAR(solver.radiance({1, 0.25}, mu, 0, {}), 6 + mu * 2e-5, 1e-9);
    }
    EXPECT_NEAR(solver.fluxes({0, 0.5}).up, kPi * (3.5 + 2e-5), 1e-7);
    EXPECT_NEAR(solver.radiance({0, 0}, 0.6, 0, {}), 2 + 0.6 * 3e-5, 1e-7 + 2 * albedo);
  }
}

// A beam whose secant is a mode's k, and a ray whose secant is: no jump. For isotropic scattering in the discrete
// ordinates k follows from sum of w_i albedo / (1 - k^2 mu_i^2) = 1 (Chandrasekhar 1950, chapter III).
TEST(OrdinateStiff, SecantsMeetModes) {
  const double albedo = 0.9;
  const GaussRule rule = gauss_rule(8);
  double low = 1e-3, high = 1 / rule.nodes[0] - 1e-9;
  while (high - low > 1e-15) {
    const double k = (low + high) / 2;
    double sum = 0;
    for (int i = 0; i < 8; ++i) sum += rule.weights[i] * albedo / (1 - k * k * rule.nodes[i] * rule.nodes[i]);
    (sum < 1 ? low : high) = k;
  }
  EXPECT_LT(low, 1);  // the diffusion mode: no real ray meets it, a mean secant of the beam may
  for (const double depth : {1e-3, 1.0, 30.0}) {
    const auto up = [&](double secant) {
      const DiffuseLayer layer{.depth = depth, .albedo = albedo, .moments = {}};
      return solve(std::span(&layer, 1), 0.5, 16, 0, std::span(&secant, 1)).fluxes({0, 0.3}).up;
    };
    const double step = 1e-4, mean = (up(low * (1 + step)) + up(low * (1 - step))) / 2;
    EXPECT_NEAR(up(low) / mean, 1, 1e-6);
    EXPECT_NEAR(up(low * (1 + 1e-13)) / up(low), 1, 1e-10);
  }
  // The next mode lies between 1 / mu_1 and 1 / mu_2; a ray of just that secant.
  low = 1 / rule.nodes[0] + 1e-9, high = 1 / rule.nodes[1] - 1e-9;
  while (high - low > 1e-15) {
    const double k = (low + high) / 2;
    double sum = 0;
    for (int i = 0; i < 8; ++i) sum += rule.weights[i] * albedo / (1 - k * k * rule.nodes[i] * rule.nodes[i]);
    (sum < 1 ? low : high) = k;
  }
  const DiffuseLayer layer{.depth = 1, .albedo = albedo, .moments = {}};
  const DiscreteOrdinates solver = solve(std::span(&layer, 1), 0.5, 16);
  for (const double side : {1.0, -1.0}) {
    const auto seen = [&](double kappa) { return solver.radiance({0, 0.5}, side / kappa, 0, {}); };
    const double step = 3e-3, mean = (seen(low * (1 + step)) + seen(low * (1 - step))) / 2;
    EXPECT_NEAR(seen(low) / mean, 1, 1e-5);
    EXPECT_NEAR(seen(low * (1 + 9.9e-5)) / seen(low * (1 + 1.01e-4)), 1, 1e-5) << "where the mean of two slants ends";
  }
}

TEST(OrdinateStiff, EmptyAirPassesEverything) {
  const DiffuseLayer layers[2] = {{}, {.depth = 0, .albedo = 1, .moments = {}, .planck_top = 4, .planck_bottom = 4}};
  DiscreteOrdinates solver = solve(layers, 0.5, 4, 2);
  solver.set_ground(0.25, 1);
  const double ground = 1 + 0.25 * (0.5 + 2 * kPi) / kPi;
  EXPECT_NEAR(solver.ground_radiance(), ground, 1e-14);
  EXPECT_NEAR(solver.transmittance(), 1, 1e-14);
  EXPECT_EQ(solver.spherical_albedo(), 0);
  for (const DiffusePlace p : {DiffusePlace{0, 0}, {0, 0.5}, {1, 1}}) {
    EXPECT_NEAR(solver.fluxes(p).up, kPi * ground, 1e-13);
    EXPECT_NEAR(solver.fluxes(p).down, 2 * kPi, 1e-13);
    EXPECT_NEAR(solver.fluxes(p).direct, 0.5, 1e-14);
    EXPECT_NEAR(solver.radiance(p, 0.3, 1, {}), ground, 1e-13);
    EXPECT_NEAR(solver.radiance(p, -0.3, 1, {}), 2, 1e-13);
    EXPECT_NEAR(solver.source(p, 0.3, 1), p.layer == 0 ? 0 : (ground + 2) / 2, 1e-13);
  }
}

// Only forward scattering, all of it within the peak: as if there were none.
TEST(OrdinateStiff, PureForwardScatteringIsNone) {
  const std::vector<double> ones(20, 1.0);
  const DiffuseLayer forward{.depth = 2, .albedo = 0.75, .moments = ones},
      none{.depth = 0.5, .albedo = 0, .moments = {}};
  const DiscreteOrdinates a = solve(std::span(&forward, 1), 0.5, 8, 1), b = solve(std::span(&none, 1), 0.5, 8, 1);
  EXPECT_NEAR(a.black_irradiance(), b.black_irradiance(), 1e-14);
  EXPECT_NEAR(a.fluxes({0, 1}).direct, 0.5 * std::exp(-4), 1e-14);
}

// 200 layers from 1e-12 to 1e4 in depth and from no scattering to nothing else: finite, bounded, energy in order.
TEST(OrdinateStiff, TwoHundredUnlikeLayers) {
  const std::vector<double> chi = henyey_greenstein(0.8, 70);
  std::vector<DiffuseLayer> layers;
  for (int l = 0; l < 200; ++l) {
    const double albedo[4] = {1, 0, 1 - 1e-10, 0.5};
    layers.push_back({.depth = std::pow(10.0, -12 + (l * 37 % 17)), .albedo = albedo[l % 4], .moments = chi});
    layers.back().planck_top = 1 + l % 3;
    layers.back().planck_bottom = 1 + (l + 1) % 3;
  }
  const DiscreteOrdinates solver = solve(layers, 0.7, 16, 2);
  for (int l = 0; l < 200; ++l) {
    const DiffuseFluxes f = solver.fluxes({l, 0.5});
    EXPECT_GE(f.up, -1e-12) << l;
    EXPECT_GE(f.down, -1e-12) << l;
    EXPECT_LE(std::max(f.up, f.down), 4 * kPi);
    const double seen = solver.radiance({l, 0.5}, 0.2, 1, {});
    EXPECT_TRUE(seen > -1e-9 && seen < 5) << l << ": " << seen;
  }
}

}  // namespace
}  // namespace suite::test::ordinate_stiff_test
