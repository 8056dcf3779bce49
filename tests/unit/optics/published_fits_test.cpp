// Models with published parameters, beside their published formulas written out anew. Energy, sampling and reciprocity
// are the conformance tests' of every row.
#include <gtest/gtest.h>

#include <cmath>

#include "optics/fresnel.h"
#include "optics/models.h"
#include "support/conformance.h"

namespace suite::published_fits_test {
namespace {

Dir at(double theta_deg, double phi_deg) { return dir_from_angles(theta_deg * kDegree, phi_deg * kDegree); }

struct Baked {
  SpectralState state = test::test_state(1);
  std::unique_ptr<const ScatterModel> model;
  Baked(const char* name, std::map<std::string, double> numbers) {
    ModelSpec spec{name, std::move(numbers), {}, {}, nullptr};
    check_model(spec);
    model = bake(spec, state);
  }
  double f(Dir out, Dir in) const {
    std::vector<float> w(state.size());
    model->eval(out, in, w);
    return static_cast<double>(w[0]) / in.z;
  }
};

// Kernels by hand, sun and view at 45 deg: hot spot f1 = 1/2 - 2/pi, f2 = sqrt(2)/3 - 1/3; forward f1 = -4/pi, f2 = 4 /
// (3 pi sqrt(2)) - 1/3.
TEST(Roujean, KernelsByHand) {
  const Baked m("roujean", {{"isotropic", 0.4}, {"geometry", 0.1}, {"volume", 0.2}});
  EXPECT_NEAR(m.f(at(0, 0), at(0, 0)) * kPi, 0.4, 1e-6);
  EXPECT_NEAR(m.f(at(45, 10), at(45, 10)) * kPi, 0.4 + 0.1 * (0.5 - 2 / kPi) + 0.2 * (std::sqrt(2) - 1) / 3, 1e-6);
  EXPECT_NEAR(m.f(at(45, 10), at(45, 190)) * kPi, 0.4 - 0.1 * 4 / kPi + 0.2 * (4 / (3 * kPi * std::sqrt(2)) - 1.0 / 3),
              1e-6);
}

// Angles between two directions and their half vector, by spherical trigonometry (Priest & Germer's equations 3 and 4).
struct Angles {
  double cos_beta, cos_theta;
  Angles(double to, double ti, double phi) {
    const double cos_2beta = std::cos(to) * std::cos(ti) + std::sin(to) * std::sin(ti) * std::cos(phi);
    cos_beta = std::sqrt((1 + cos_2beta) / 2);
    cos_theta = (std::cos(to) + std::cos(ti)) / (2 * cos_beta);
  }
  double tan2() const { return 1 / (cos_theta * cos_theta) - 1; }
};

TEST(PriestGermer, IsTheirEquation) {
  const double sigma = 0.3, n = 1.4, k = 0.5, diffuse = 0.2;
  const Baked m("priest_germer", {{"index", n}, {"absorption", k}, {"sigma", sigma}, {"diffuse", diffuse}});
  for (const double to : {0.0, 20.0, 50.0, 75.0})
    for (const double ti : {10.0, 40.0, 80.0})
      for (const double phi : {0.0, 65.0, 150.0, 180.0}) {
        const double o = to * kDegree, i = ti * kDegree;
        const Angles a(o, i, phi * kDegree);
        const double c4 = std::pow(a.cos_theta, 4);
        const double first = fresnel_conductor(a.cos_beta, n, k) * std::exp(-a.tan2() / (2 * sigma * sigma)) /
                             (2 * kPi * 4 * sigma * sigma * c4 * std::cos(o) * std::cos(i));
        const double cavity =
            std::min({1.0, 2 * a.cos_theta * std::cos(o) / a.cos_beta, 2 * a.cos_theta * std::cos(i) / a.cos_beta});
        const double expected = first * cavity + diffuse / kPi;
        EXPECT_NEAR(m.f(at(to, 5), at(ti, 5 + phi)), expected, 1e-5 * expected) << to << ' ' << ti << ' ' << phi;
      }
}

// Westlund & Meyer's form: R(beta) / R(0) of the scan in which light comes back to where it came from.
void expect_beard_maxwell(const char* name, bool cauchy) {
  const double sigma = 0.25, bias = 0.04, n = 1.5, k = 0.1, tau = 15, omega = 40, diffuse = 0.1, volume = 0.02;
  const Baked m(name, {{"index", n},
                       {"absorption", k},
                       {"sigma", sigma},
                       {"bias", bias},
                       {"tau_deg", tau},
                       {"omega_deg", omega},
                       {"diffuse", diffuse},
                       {"volume", volume}});
  for (const double to : {0.0, 30.0, 70.0})
    for (const double ti : {5.0, 55.0, 80.0})
      for (const double phi : {0.0, 90.0, 180.0}) {
        const double o = to * kDegree, i = ti * kDegree;
        const Angles a(o, i, phi * kDegree);
        const double c = a.cos_theta, lean = std::acos(std::min(1.0, c)) / (omega * kDegree);
        const double slopes =
            cauchy ? bias / (c * (sigma * sigma + a.tan2()))
                   : bias * std::exp(-a.tan2() / (2 * sigma * sigma)) / (2 * kPi * sigma * sigma * c * c * c);
        const double scan = fresnel_conductor(1, n, k) * slopes / (4 * c * c * c);
        const double shadow = (1 + lean * std::exp(-2 * std::acos(a.cos_beta) / (tau * kDegree))) / (1 + lean);
        const double expected = fresnel_conductor(a.cos_beta, n, k) / fresnel_conductor(1, n, k) * scan * c * c /
                                    (std::cos(o) * std::cos(i)) * shadow +
                                diffuse / kPi + 2 * volume / (std::cos(o) + std::cos(i));
        EXPECT_NEAR(m.f(at(to, 5), at(ti, 5 + phi)), expected, 1e-5 * expected) << to << ' ' << ti << ' ' << phi;
      }
}
TEST(BeardMaxwell, IsItsFormula) { expect_beard_maxwell("beard_maxwell", true); }
TEST(Shell, IsItsFormula) { expect_beard_maxwell("shell", false); }

// A perfect mirror of facets returns at most what it receives, and at the zenith nearly all; more than everything is
// refused.
TEST(PublishedFits, EnergyIsKept) {
  const Baked white("priest_germer", {{"index", 0.05}, {"absorption", 100}, {"sigma", 0.1}});
  std::vector<float> W(white.state.size());
  for (const double deg : {0.0, 30.0, 60.0, 80.0, 89.0}) {
    white.model->total(at(deg, 0), W);
    EXPECT_LE(W[0], 1.0f) << deg;
    EXPECT_GT(W[0], deg < 31 ? 0.97f : 0.3f) << deg;
  }
  EXPECT_THROW(Baked("shell", {{"index", 0.05},
                               {"absorption", 100},
                               {"sigma", 0.1},
                               {"tau_deg", 100},
                               {"omega_deg", 100},
                               {"diffuse", 0.5}}),
               Error);
}

}  // namespace
}  // namespace suite::published_fits_test
