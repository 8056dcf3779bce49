// Measured Mueller matrices from a table to a picture: fitted, inspected, on a plate under the sun, seen in Stokes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "support/polished_metal.h"
#include "support/run_command.h"

namespace suite::mueller_test {
namespace {

using testing::HasSubstr;

const std::string kBin = SUITE_BIN_DIR "/";

std::string table() {
  const auto metal = test::polished_metal();
  const sqt::MuellerBrdf::Data& d = metal->data();
  std::string text = "# name: polished metal\ntheta_h_deg,theta_d_deg,phi_d_deg,wavelength_um";
  for (int i = 1; i <= 4; ++i)
    for (int j = 1; j <= 4; ++j) text += strf(",m%d%d", i, j);
  text += '\n';
  for (size_t n = 0; n < d.grid.nodes(); ++n)
    for (size_t w = 0; w < 2; ++w) {
      const sqt::HalfAngles a = d.grid.angles(n);
      text +=
          strf("%.9g,%.9g,%.9g,%g", a.theta_h / kDegree, a.theta_d / kDegree, a.phi_d / kDegree, d.wavelength_um[w]);
      for (size_t e = 0; e < 16; ++e) text += strf(",%.7g", static_cast<double>(d.values[(n * 2 + w) * 16 + e]));
      text += '\n';
    }
  return text;
}

class MeasuredMatrices : public testing::Test {
 protected:
  void SetUp() override { write_text(folder_ / "metal.csv", table()); }
  CommandResult run(const std::string& command) const {
    return run_command("cd " + folder_.path() + " && " + kBin + command);
  }
  void write_text(const std::string& path, const std::string& text) const { std::ofstream(path) << text; }
  TempFolder folder_;
};

constexpr const char* kScene = R"(
scene: 1
materials: {metal: {model: sqt, file: {file: metal.sqt, outside: hold}}}
objects: {plate: {plane: {width: 100, depth: 100}, material: metal}}
world: [{place: plate}]
)";
// The camera looks from the south into the mirror image of a sun in the north, both 55 degrees from the normal.
constexpr const char* kSim = R"(
scene: scene.h5
sun: {direction: {zenith_deg: 55, azimuth_deg: 0}, irradiance: 1000}
sensors:
  - {kind: frame_camera, name: cam, columns: 1, rows: 1, pitch_um: 1, focal_length_mm: 100, position_m: [0, -14.281480067, 10], look_at_m: [0, 0, 0],
     paths: 16, stokes: [i, q, u, v], bands: [{name: red, center_um: 0.65, fwhm_um: 0.01, shape: rectangular}]}
)";

TEST_F(MeasuredMatrices, AreSeenInThePicture) {
  const CommandResult fit = run("sqt-fit metal.csv -o metal.sqt --views 6 --order 6 --min-peak 0 --report fit.json");
  ASSERT_EQ(fit.code, 0) << fit.err;
  EXPECT_THAT(fit.err, HasSubstr("matrices at "));
  EXPECT_THAT(read_text(folder_ / "fit.json"), HasSubstr("\"mueller\""));
  const CommandResult seen = run("sqt-inspect metal.sqt");
  EXPECT_THAT(seen.out, HasSubstr("m12/m11 55"));
  EXPECT_THAT(run("sqt-inspect metal.sqt --export metal_m11.csv").err, HasSubstr("holds m11 alone"));
  write_text(folder_ / "scene.yaml", kScene);
  write_text(folder_ / "sim.yaml", kSim);
  ASSERT_EQ(run("scene-prep scene.yaml -o scene.h5 -q").code, 0);
  const CommandResult render = run("dirsig-render sim.yaml -o out -q");
  ASSERT_EQ(render.code, 0) << render.err;
  EXPECT_THAT(render.err, Not(HasSubstr("DR209"))) << "nothing depolarises unknown";
  const std::vector<double> stokes = EnviImage(folder_ / "out/cam.img").read_all();
  const double i = stokes[0], q = stokes[1], u = stokes[2];
  const PlaneBlocks f = test::polished_matrix({0, 55 * kDegree, 0}, {0.2, 3.3});
  EXPECT_NEAR(q / i, f.b, 0.01);
  EXPECT_LT(q / i, -0.02) << "across the plane of reflection: Q along the meridian is below 0";
  EXPECT_NEAR(u / i, 0, 0.002);
}

TEST_F(MeasuredMatrices, WrongOptionsAreAnswered) {
  EXPECT_EQ(run("sqt-fit metal.csv -o m.sqt --swap").code, 2);
  EXPECT_THAT(run("sqt-fit metal.csv -o m.sqt --mueller-error 2").err, HasSubstr("--mueller-error 2 is out of range"));
  write_text(folder_ / "bad.csv", table().substr(0, 400) + ",x\n");
  const CommandResult bad = run("sqt-fit bad.csv -o m.sqt");
  EXPECT_EQ(bad.code, 1);
  EXPECT_THAT(bad.err, HasSubstr("bad.csv"));
}

}  // namespace
}  // namespace suite::mueller_test
