// The sky that the Moon lights through real air, against the formula of K. Krisciunas & B. E. Schaefer, "A model of the
// brightness of moonlight", Publ. Astron. Soc. Pacific 103, 1991 (V at 2800 m, known to 8 to 23 %), with air of the
// same extinction.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/files.h"
#include "math/vec.h"
#include "support/run_command.h"

namespace suite::moonlit_sky_test {
namespace {

constexpr double kExtinction = 0.172;  // mag of V per air mass

// Degrees: phase angle, zenith distances of Moon and view, angle between them.
struct View {
  double phase, moon, zenith, apart;
};
double nanolamberts(const View& v) {
  const auto mass = [](double z) { return 1 / std::sqrt(1 - 0.96 * std::pow(std::sin(z * kDegree), 2)); };
  const double scatter = std::pow(10, 5.36) * (1.06 + std::pow(std::cos(v.apart * kDegree), 2)) +
                         std::pow(10, 6.15 - v.apart / 40),
               moon = std::pow(10, -0.4 * (3.84 + 0.026 * v.phase + 4e-9 * std::pow(v.phase, 4)));
  return scatter * moon * std::pow(10, -0.4 * kExtinction * mass(v.moon)) *
         (1 - std::pow(10, -0.4 * kExtinction * mass(v.zenith)));
}
// Of V a square arc second.
double magnitude(double nanolamberts) { return (20.7233 - std::log(nanolamberts / 34.08)) / 0.92104; }

class MoonlitSky : public testing::Test {
 protected:
  MoonlitSky() {
    write_file(
        folder_ / "scene.yaml",
        "scene: 1\norigin: {latitude_deg: 19.8, longitude_deg: -155.5, height_m: 2800}\nmaterials: {g: {model: "
        "lambert, reflectance: 0.1}}\nobjects: {p: {plane: {width: 20, depth: 20}, material: g}}\nworld: [{place: "
        "p}]\n");
    run("scene-prep scene.yaml -o scene.h5 -q");
  }
  CommandResult run(const std::string& command) {
    return run_command("cd '" + folder_.path() + "' && " SUITE_BIN_DIR "/" + command);
  }
  void write(const View& v, double aerosol) {
    const double zenith = v.zenith * kDegree, moon = v.moon * kDegree,
                 turn = std::acos((std::cos(v.apart * kDegree) - std::cos(moon) * std::cos(zenith)) /
                                  (std::sin(moon) * std::sin(zenith)));
    const Dir d{std::sin(zenith) * std::sin(turn), std::sin(zenith) * std::cos(turn), std::cos(zenith)};
    write_file(
        folder_ / "sim.yaml",
        strf("scene: scene.h5\nmoon: {direction: {zenith_deg: %g, azimuth_deg: 0}, phase_deg: %g}\n"
             "atmosphere: {profile: us_standard, scattering: diffuse, aerosol: {model: rural, optical_depth_550: "
             "%g}}\nsensors:\n  - {kind: point, name: m, paths: 64, bands: [{name: v, center_um: 0.55, fwhm_um: "
             "0.088}], collectors: [{name: L, quantity: radiance, position_m: [0, 0, 2], look: [%.9f, %.9f, "
             "%.9f]}]}\n",
             v.moon, v.phase, aerosol, d.x, d.y, d.z));
  }
  // V = 0 is 3.631e-8 W/(m2 um) at 0.55 um (Bessell 1998).
  double rendered(const View& v, double aerosol) {
    write(v, aerosol);
    const CommandResult r = run("dirsig-render sim.yaml -o out -q");
    EXPECT_EQ(r.code, 0) << r.err;
    const std::string csv = read_text(folder_ / "out/m.csv");
    const double radiance = std::stod(csv.substr(csv.find("0.55,", csv.find("L,")) + 5)), second = kDegree / 3600;
    return -2.5 * std::log10(radiance / 3.631e-8 * second * second);
  }
  TempFolder folder_;
};

// The formula's own examples, by hand: 448.846 nL or 19.7009, 104.763 nL or 21.2806, and two beside the views.
TEST_F(MoonlitSky, IsThatOfKrisciunasAndSchaefer) {
  const View views[] = {{7, 30, 1, 30}, {45, 45, 30, 60}, {90, 60, 20, 60}, {30, 30, 60, 60}};
  EXPECT_NEAR(nanolamberts(views[1]), 448.846, 1e-3);
  EXPECT_NEAR(magnitude(nanolamberts(views[2])), 21.2806, 1e-4);
  EXPECT_NEAR(nanolamberts({0, 30, 0, 30}), 2367.59, 0.01);
  EXPECT_NEAR(magnitude(2367.59), 17.8954, 1e-4);
  EXPECT_NEAR(nanolamberts({120, 60, 0, 60}), 28.681, 1e-3);
  EXPECT_NEAR(magnitude(28.681), 22.6872, 1e-4);
  constexpr double kAerosol = 0.056;  // with molecules and ozone above 2800 m: V's extinction
  write(views[0], kAerosol);
  const std::string air = run("dirsig-render sim.yaml --air").out;
  const size_t row = air.find("0.55 um", air.find("zenith transmittance"));
  ASSERT_NE(row, air.npos);
  EXPECT_NEAR(-2.5 * std::log10(std::stod(air.substr(row + 7))), kExtinction, 0.003);
  for (const View& v : views) {
    const double ours = rendered(v, kAerosol), formula = magnitude(nanolamberts(v));
    std::printf("phase %g, zenith distance %g: V = %.2f, formula %.2f\n", v.phase, v.zenith, ours, formula);
    EXPECT_NEAR(ours, formula, 0.3) << v.phase << " " << v.zenith;
  }
  // Negative control: hazier air is not the formula's.
  EXPECT_GT(std::fabs(rendered(views[0], 0.3) - magnitude(nanolamberts(views[0]))), 0.3);
}

}  // namespace
}  // namespace suite::moonlit_sky_test
