// What must hold for any light in plane layers.
#include <gtest/gtest.h>

#include "air/discrete_ordinates.h"
#include "air/ordinate_angles.h"
#include "air/stokes_field.h"
#include "base/error.h"
#include "support/phase_moments.h"

namespace suite::test::ordinate_identities_test {
namespace {

// Three layers of different kinds, the middle one strongly forward.
struct Air {
  std::vector<std::vector<double>> moments{rayleigh_moments(), henyey_greenstein(0.85, 65), {1, 0.3}};
  std::vector<DiffuseLayer> layers{{.depth = 0.2, .albedo = 0.9, .moments = {}},
                                   {.depth = 3, .albedo = 0.7, .moments = {}},
                                   {.depth = 0.6, .albedo = 0.2, .moments = {}}};
  DiffuseProblem problem;
  Air() {
    problem.beam.irradiance = 2;
    problem.beam.cosine = 0.55;
    problem.azimuth_tolerance = 0;
  }
  std::vector<double> phase(double mu, double phi) const {
    std::vector<double> values;
    for (const auto& chi : moments) values.push_back(phase_of(chi, scattering_cosine(problem.beam.cosine, mu, phi)));
    return values;
  }
  DiscreteOrdinates solved(int streams = 16) {
    for (size_t l = 0; l < layers.size(); ++l) layers[l].moments = moments[l];
    problem.layers = layers;
    DiscreteOrdinates solver(streams);
    solver.solve(problem);
    return solver;
  }
  double radiance(const DiscreteOrdinates& solver, DiffusePlace place, double mu, double phi) const {
    return solver.radiance(place, mu, phi, phase(mu, phi));
  }
};

const DiffusePlace kPlaces[] = {{0, 0}, {0, 0.3}, {0, 1}, {1, 0}, {1, 0.01}, {1, 0.5}, {1, 1}, {2, 0.7}, {2, 1}};
const double kCosines[] = {-1, -0.6, -0.02, 1e-6, 0.02, 0.3, 1};

// Largest deviation from Planck's radiance of 5 anywhere, for a middle layer that is `warmer` by this part.
double isothermal_error(double warmer) {
  Air air;
  air.problem.beam.irradiance = 0;
  for (DiffuseLayer& l : air.layers) l.planck_top = l.planck_bottom = 5;
  air.layers[1].planck_bottom *= 1 + warmer;
  air.problem.top_radiance = 5;
  air.problem.ground_albedo = 0.3;
  air.problem.ground_emission = 0.7 * 5;
  const DiscreteOrdinates solver = air.solved();
  double worst = 0;
  for (const DiffusePlace p : kPlaces) {
    const DiffuseFluxes f = solver.fluxes(p);
    worst = std::max({worst, std::fabs(f.up / kPi - 5), std::fabs(f.down / kPi - 5), std::fabs(f.mean_intensity - 5)});
    for (const double mu : kCosines)
      worst = std::max({worst, std::fabs(air.radiance(solver, p, mu, 0) - 5),
                        std::fabs(solver.source(p, mu, 0) + solver.emission(p) - 5)});
  }
  return worst;
}

TEST(OrdinateIdentities, IsothermalAirIsABlackBody) {
  EXPECT_LT(isothermal_error(0), 5e-11);
  EXPECT_GT(isothermal_error(0.001), 5e-5) << "a warmer layer must show";
}

TEST(OrdinateIdentities, LightIsNotLost) {
  for (const double depth : {1e-6, 1.0, 100.0, 1e4}) {
    Air air;
    for (DiffuseLayer& l : air.layers) l.albedo = 1, l.depth *= depth;
    air.problem.top_radiance = 0.1;
    air.problem.ground_albedo = 0.4;
    DiscreteOrdinates solver = air.solved();
    const auto net = [&](DiffusePlace p) {
      const DiffuseFluxes f = solver.fluxes(p);
      return f.direct + f.down - f.up;
    };
    const double incoming = 2 * 0.55 + 0.1 * kPi;
    for (const DiffusePlace p : kPlaces) EXPECT_NEAR(net(p), net({0, 0}), 1e-8 * incoming) << depth;
    solver.set_ground(1, 0);
    for (const DiffusePlace p : kPlaces) EXPECT_NEAR(net(p), 0, 1e-8 * incoming) << depth;
    air.layers[1].albedo = 1 - 1e-6;
    const DiscreteOrdinates lossy = air.solved();
    const DiffuseFluxes top = lossy.fluxes({0, 0}), bottom = lossy.fluxes({2, 1});
    EXPECT_GT(top.direct + top.down - top.up - (bottom.direct + bottom.down - bottom.up), 1e-7 * depth / (1 + depth))
        << "a loss of a millionth must show";
  }
}

TEST(OrdinateIdentities, ALayerMayBeCut) {
  Air whole;
  for (DiffuseLayer& l : whole.layers) l.planck_top = 1, l.planck_bottom = 3;
  whole.problem.ground_albedo = 0.5;
  Air cut = whole;
  const double at = 0.37;
  DiffuseLayer lower = cut.layers[1];
  cut.layers[1].depth *= at;
  cut.layers[1].planck_bottom = 1 + 2 * at;
  lower.depth *= 1 - at;
  lower.planck_top = 1 + 2 * at;
  cut.layers.insert(cut.layers.begin() + 2, lower);
  cut.moments.insert(cut.moments.begin() + 2, cut.moments[1]);
  const DiscreteOrdinates a = whole.solved(), b = cut.solved();
  const DiffusePlace pairs[][2] = {{{0, 0.5}, {0, 0.5}},
                                   {{1, at}, {1, 1}},
                                   {{1, at}, {2, 0}},
                                   {{1, 0.2}, {1, 0.2 / at}},
                                   {{1, 0.9}, {2, (0.9 - at) / (1 - at)}},
                                   {{2, 1}, {3, 1}}};
  for (const auto& [p, q] : pairs) {
    EXPECT_NEAR(a.fluxes(p).up, b.fluxes(q).up, 1e-10);
    EXPECT_NEAR(a.fluxes(p).down, b.fluxes(q).down, 1e-10);
    EXPECT_NEAR(a.fluxes(p).mean_intensity, b.fluxes(q).mean_intensity, 1e-10);
    for (const double mu : kCosines)
      for (const double phi : {0.0, 2.0}) {
        EXPECT_NEAR(a.source(p, mu, phi), b.source(q, mu, phi), 1e-10);
        EXPECT_NEAR(whole.radiance(a, p, mu, phi), cut.radiance(b, q, mu, phi), 1e-9);
      }
  }
}

TEST(OrdinateIdentities, Reciprocity) {
  const auto reflected = [](double sun, double mu, double phi, bool upside_down) {
    Air air;
    air.problem.ground_albedo = upside_down ? 0 : 0.3;
    air.problem.beam.cosine = sun;
    if (upside_down) {
      std::swap(air.layers[0], air.layers[2]);
      std::swap(air.moments[0], air.moments[2]);
    }
    const DiscreteOrdinates solver = air.solved();
    return air.radiance(solver, {0, 0}, mu, phi) / sun;
  };
  for (const double phi : {0.0, 1.0, 3.0}) {
    EXPECT_NEAR(reflected(0.9, 0.2, phi, false) / reflected(0.2, 0.9, phi, false), 1, 1e-8);
    EXPECT_NEAR(reflected(0.5, 0.03, phi, false) / reflected(0.03, 0.5, phi, false), 1, 1e-8);
    EXPECT_GT(std::fabs(reflected(0.9, 0.2, phi, false) / reflected(0.2, 0.9, phi, true) - 1), 1e-3);
  }
}

// The radiance is the integral of the sources along the ray: 40 points of Gauss's rule in each layer.
TEST(OrdinateIdentities, RadianceIsTheSumOfItsSources) {
  Air air;
  for (DiffuseLayer& l : air.layers) l.planck_top = 0.1, l.planck_bottom = 0.3;
  air.problem.ground_albedo = 0.5;
  air.problem.top_radiance = 0.2;
  const DiscreteOrdinates solver = air.solved();
  const GaussRule rule = gauss_rule(40);
  for (const double mu : {-1.0, -0.3, 0.2, 0.8})
    for (const double phi : {0.0, 2.5}) {
      const std::vector<double> phase = air.phase(mu, phi);
      double sum = 0, left = 1;
      for (int i = 0; i < 3; ++i) {
        const int l = mu > 0 ? i : 2 - i;
        const double depth = air.layers[l].depth * solver.depth_scale(l) / std::fabs(mu);
        for (size_t k = 0; k < rule.nodes.size(); ++k) {
          const double x = rule.nodes[k];
          const DiffusePlace p{l, mu > 0 ? x : 1 - x};
          sum += rule.weights[k] * depth * left * std::exp(-x * depth) *
                 (solver.source(p, mu, phi) + solver.emission(p) + solver.beam(p) * solver.single_albedo(l) * phase[l]);
        }
        left *= std::exp(-depth);
      }
      sum += left * (mu > 0 ? solver.ground_radiance() : 0.2);
      EXPECT_NEAR(air.radiance(solver, {mu > 0 ? 0 : 2, mu > 0 ? 0.0 : 1.0}, mu, phi), sum, 1e-9 * sum);
    }
}

TEST(OrdinateIdentities, GroundIsCoupledBySphericalAlbedo) {
  Air air;
  air.problem.ground_albedo = 0.6;
  air.problem.ground_emission = 0.05;
  DiscreteOrdinates solver = air.solved();
  const DiffuseFluxes f = solver.fluxes({2, 1});
  EXPECT_NEAR(f.up, 0.6 * (f.direct + f.down) + 0.05 * kPi, 1e-12);
  EXPECT_NEAR(solver.ground_radiance(), f.up / kPi, 1e-12);
  EXPECT_NEAR((f.direct + f.down), solver.black_irradiance() + solver.spherical_albedo() * f.up, 1e-12);
  // Sources in parts, for any ground, in many directions.
  const double mu[3] = {-1, 0, 0.3}, phi = 1;
  const SourceAngles angles(16, mu);
  std::vector<double> air_part(3 * solver.orders()), ground_part(3);
  for (const DiffusePlace p : kPlaces) {
    solver.sources(p, angles, air_part, ground_part);
    for (int i = 0; i < 3; ++i) {
      double sum = solver.ground_radiance() * ground_part[i];
      for (int m = 0; m < solver.orders(); ++m) sum += air_part[i * solver.orders() + m] * std::cos(m * phi);
      EXPECT_NEAR(sum, solver.source(p, mu[i], phi), 1e-13);
      EXPECT_GT(ground_part[i], 1e-6);
    }
  }
  solver.set_ground(0, 0);
  EXPECT_NEAR(solver.fluxes({2, 1}).up, 0, 1e-14);
  // Light from above is transmitted as light from below is, though the layers differ.
  air.problem.beam.irradiance = 0;
  air.problem.top_radiance = 1;
  EXPECT_NEAR(air.solved().black_irradiance() / kPi, solver.transmittance(), 1e-12);
}

TEST(OrdinateIdentities, MomentsGiveTheSource) {
  Air air;
  const DiscreteOrdinates solver = air.solved();
  const DiffusePlace p{2, 0.4};
  double moments[2];
  solver.moments(p, 0, moments);
  EXPECT_NEAR(solver.fluxes(p).up - solver.fluxes(p).down + solver.beam(p) * 0.55 - solver.fluxes(p).direct,
              2 * kPi * moments[1], 1e-12);
  const double mu[1] = {-0.7};
  std::vector<double> cosines(solver.orders());
  solver.sources(p, SourceAngles(16, mu), cosines, {});
  EXPECT_NEAR(cosines[0], 0.2 / 2 * (moments[0] + 3 * 0.3 * -0.7 * moments[1]), 1e-12);
}

TEST(OrdinateIdentities, AnotherSunOverTheSameAir) {
  Air first, second;
  for (Air* air : {&first, &second}) {
    for (DiffuseLayer& l : air->layers) l.planck_top = 0.1, l.planck_bottom = 0.3;
    air->problem.ground_albedo = 0.5;
    air->problem.azimuth_tolerance = 3e-4;
  }
  first.problem.beam.cosine = 1;  // one azimuth order
  second.problem.beam.cosine = 0.2;
  second.problem.beam.irradiance = 3;
  DiscreteOrdinates moved = first.solved();
  EXPECT_EQ(moved.orders(), 1);
  moved.set_beam(second.problem.beam);
  const DiscreteOrdinates fresh = second.solved();
  EXPECT_EQ(moved.orders(), fresh.orders());
  EXPECT_GT(fresh.orders(), 5);
  for (const DiffusePlace p : kPlaces) {
    EXPECT_EQ(moved.fluxes(p).up, fresh.fluxes(p).up);
    EXPECT_EQ(moved.source(p, 0.3, 2), fresh.source(p, 0.3, 2));
    EXPECT_EQ(second.radiance(moved, p, -0.3, 2), second.radiance(fresh, p, -0.3, 2));
  }
  moved.set_beam({});
  first.problem.beam = {};
  EXPECT_EQ(moved.fluxes({1, 0.5}).down, first.solved().fluxes({1, 0.5}).down);
}

// Grey layers under other mean secants: those of a flat Earth change nothing, a sun below the horizon lights them by
// what its path leaves, and what the shadow covers stays dark.
TEST(OrdinateIdentities, SecantsOfTheBeam) {
  Air flat, given;
  double left = 1;
  const std::vector<double> secants(3, 1 / 0.55), low(3, 40.0), shadow{-1, -1, 0};
  std::vector<double> tops;
  for (const DiffuseLayer& l : given.layers) {
    tops.push_back(left);
    left *= std::exp(-l.depth / 0.55);
  }
  given.problem.beam.secants = secants;
  given.problem.beam.tops = tops;
  // The scaled beam is not continued across a given transmittance; without a forward peak there is no difference.
  flat.moments[1] = given.moments[1] = {1, 0.5, 0.2};
  const DiscreteOrdinates a = flat.solved(), b = given.solved();
  for (const DiffusePlace p : kPlaces) EXPECT_NEAR(a.fluxes(p).up, b.fluxes(p).up, 1e-12);

  Air dusk;
  dusk.problem.beam.cosine = -0.03;
  dusk.moments = {isotropic(), isotropic(), isotropic()};
  for (DiffuseLayer& l : dusk.layers) l.depth = 1e-5, l.albedo = 1;
  dusk.problem.beam.secants = low;
  dusk.problem.beam.tops = shadow;
  const DiscreteOrdinates lit = dusk.solved();
  const double scattered = 2 * 2e-5;  // irradiance times the depth of two lit layers
  EXPECT_NEAR(lit.fluxes({2, 1}).down / (scattered / 2), 1, 1e-3);
  EXPECT_NEAR(lit.fluxes({0, 0}).up / (scattered / 2), 1, 1e-3);
  EXPECT_EQ(lit.beam({2, 0.5}), 0);
  EXPECT_LT(lit.fluxes({0, 0}).direct, 0);
}

// A sun 7 degrees under the horizon of an exponential atmosphere on a round Earth: it comes up into the layers above
// its shadow, thin ones, through air far below them, with secants of thousands. Unpolarised, the polarised field is
// the scalar one.
TEST(OrdinateIdentities, ThePolarisedFieldInDeepTwilight) {
  constexpr double kEarth = 6371, kScale = 8, kVertical = 0.1, kSun = 97 * kPi / 180;
  const std::vector<double> heights{120, 100, 80, 70, 60, 55, 50, 40, 20, 0};
  const auto slant = [&](double height) {  // of the way that the sun's light has come
    double depth = 0;
    for (double s = 0.5; s < 3000; ++s) {
      const double r = kEarth + height;
      const double h = std::sqrt(r * r + s * s + 2 * r * s * std::cos(kSun)) - kEarth;
      if (h < 0) return HUGE_VAL;
      depth += kVertical / kScale * std::exp(-h / kScale);
    }
    return depth;
  };
  const std::vector<double> moments{1, 0.3, 0.1};
  const GreekMatrix matrix = GreekMatrix::depolarising(moments);
  std::vector<StokesAirLayer> layers;
  std::vector<DiffuseLayer> scalar_layers;
  std::vector<double> secants, tops;
  for (size_t l = 0; l + 1 < heights.size(); ++l) {
    const double depth = kVertical * (std::exp(-heights[l + 1] / kScale) - std::exp(-heights[l] / kScale));
    const double above = slant(heights[l]), below = slant(heights[l + 1]);
    layers.push_back({depth, 1, &matrix}), scalar_layers.push_back({depth, 1, moments});
    secants.push_back(std::isfinite(below) ? (below - above) / depth : 20);
    tops.push_back(l == 0 ? std::exp(-above) : std::isfinite(above) ? -1 : 0);
  }
  EXPECT_GT(*std::max_element(secants.begin(), secants.end()), 3e3);
  StokesProblem problem;
  problem.layers = layers;
  problem.beam = {1, std::cos(kSun), secants, tops};
  problem.ground_albedo = 0.3;
  DiffuseProblem scalar;
  scalar.layers = scalar_layers;
  scalar.beam = problem.beam, scalar.ground_albedo = 0.3, scalar.azimuth_tolerance = 1e-12;
  DiscreteOrdinates ordinates(16);
  ordinates.solve(scalar);
  StokesField field(StokesField::Light::polarised, 16, {0.05, 0.9});
  field.solve(problem);
  const std::vector<double> phase(layers.size(), 1 / (4 * kPi));
  const std::vector<Stokes> single(layers.size(), Stokes{1 / (4 * kPi), 0, 0, 0});
  for (int level = 0; level + 1 < static_cast<int>(heights.size()); ++level) {
    const double up = ordinates.fluxes({level, 0}).up, down = ordinates.fluxes({level, 0}).down;
    EXPECT_GT(up, 1e-9);
    EXPECT_NEAR(field.fluxes(level).up, up, 1e-6 * up) << level;
    EXPECT_NEAR(field.fluxes(level).down, down, 1e-6 * down + 1e-6 * up) << level;
    for (size_t view = 0; view < 2; ++view)
      for (const auto way : {StokesField::Way::up, StokesField::Way::down}) {
        const double mu = view == 0 ? 0.05 : 0.9;
        const double want = ordinates.radiance({level, 0}, way == StokesField::Way::up ? mu : -mu, 1.0, phase);
        EXPECT_NEAR(field.radiance(level, view, way, 1.0, single)[0], want, 1e-5 * want + 1e-6 * up) << level << mu;
      }
  }
  // What both refuse: a beam that grows by more than e^100 in a layer.
  secants[2] = -101 / layers[2].depth;
  EXPECT_THROW(field.solve(problem), Error);
  EXPECT_THROW(ordinates.solve(scalar), Error);
}

}  // namespace
}  // namespace suite::test::ordinate_identities_test
