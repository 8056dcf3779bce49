// The goniometer: what does not look the same from each side is measured as the mean of its sides, with the light
// turned with the view.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "base/files.h"
#include "math/vec.h"
#include "support/run_command.h"

namespace suite::goniometer_test {
namespace {

// White ground with black fins, a metre apart and half a metre high, that run to the north or to the east.
class Goniometer : public testing::Test {
 protected:
  void SetUp() override {
    for (const auto& [name, fin] : {std::pair{"north", "x0: -0.01, x1: 0.01, y0: -0.5, y1: 0.5"},
                                    {"east", "x0: -0.5, x1: 0.5, y0: -0.01, y1: 0.01"}}) {
      write_file(folder_ / (std::string(name) + ".yaml"),
                 "scene: 1\nname: fins\nmaterials:\n  white: {model: lambert, reflectance: 0.5}\n  black: {model: "
                 "lambert, reflectance: 0}\nobjects:\n  ground: {plane: {width: 1, depth: 1}, material: white}\n  fin: "
                 "{box: {z0: 0, z1: 0.5, " +
                     std::string(fin) +
                     "}, material: black}\nworld: [{place: ground, tag: g}, {place: fin, tag: f}]\n");
      ASSERT_EQ(run("scene-prep " + std::string(name) + ".yaml -q -o " + name + ".h5").code, 0);
    }
  }
  CommandResult run(const std::string& command) {
    return run_command("cd '" + folder_.path() + "' && export PATH='" SUITE_BIN_DIR "':$PATH && " + command);
  }
  CommandResult render(const std::string& scene, const std::string& keys) {
    write_file(folder_ / "m.yaml",
               "scene: " + scene +
                   ".h5\nsky: {radiance: 1, full_sphere: true}\nperiodic: {origin_m: [-0.5, -0.5], size_m: [1, "
                   "1]}\nsensors:\n  - {kind: goniometer, name: g, bands: [{name: a, center_um: 0.55, fwhm_um: 0.01, "
                   "shape: rectangular}], patch: {origin_m: [-0.5, -0.5], size_m: [1, 1]}, height_m: 0.5, "
                   "view_zenith_deg: [0, 50], rings: 2, azimuths: 8, " +
                   keys + "}\n");
    return run("dirsig-render m.yaml -q -o out");
  }
  // [view][ring][azimuth], 1/sr.
  std::vector<double> table(const std::string& scene, const std::string& keys) {
    const CommandResult r = render(scene, keys);
    EXPECT_EQ(r.code, 0) << r.err;
    std::istringstream text(read_text(folder_ / "out/g.rawbh"));
    std::string line;
    std::vector<double> values;
    for (int n = 0; std::getline(text, line); ++n)
      if (n > 2 && !line.empty()) values.push_back(std::stod(line.substr(line.rfind(' '))));
    EXPECT_EQ(values.size(), 32u);
    values.resize(32);
    return values;
  }
  TempFolder folder_;
};

// Relative to the mean of f, 0.5 / pi without fins; noise of a cell is about 0.02.
double largest(const std::vector<double>& a, const std::vector<double>& b, size_t from) {
  double most = 0;
  for (size_t i = from; i < a.size(); ++i) most = std::max(most, std::fabs(a[i] - b[i]) * kPi / 0.5);
  return most;
}

TEST_F(Goniometer, SeesTheMeanOfItsSides) {
  const std::vector<double> north = table("north", "paths: 100000"), east = table("east", "paths: 100000"),
                            four = table("north", "view_azimuths: 4, paths: 50000");
  std::vector<double> mean(32);
  for (size_t i = 0; i < 32; ++i) mean[i] = (north[i] + east[i]) / 2;
  EXPECT_LT(largest(four, mean, 16), 0.08);
  EXPECT_GT(largest(north, mean, 16), 0.3);  // one side is another thing
  // From the zenith all azimuths of light are one.
  for (size_t i = 1; i < 8; ++i) EXPECT_EQ(four[i], four[0]);
}

TEST_F(Goniometer, BilateralIsTheSameFromLeftAndRight) {
  const std::vector<double> one = table("north", "paths: 20000"),
                            both = table("north", "bilateral: true, paths: 20000");
  for (size_t ring = 2; ring < 4; ++ring)
    for (size_t a = 0; a < 8; ++a) {
      const size_t i = 8 * ring + a, mirrored = 8 * ring + (8 - a) % 8;
      EXPECT_EQ(both[i], both[mirrored]);
      EXPECT_NEAR(both[i], (one[i] + one[mirrored]) / 2, 1e-6);
    }
}

TEST_F(Goniometer, SidesMustFitTheAzimuths) {
  const CommandResult r = render("north", "view_azimuths: 3, paths: 100");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, testing::HasSubstr("the number of azimuths must be a multiple of it"));
}

}  // namespace
}  // namespace suite::goniometer_test
