// Anisotropic data from end to end: a brushed metal as a model and as an anisotropic RGL file, fitted, inspected, put
// on panels and rendered; its highlight is the analytic model's, lies across the brush marks and turns with the panel.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/files.h"
#include "base/params.h"
#include "formats/envi/envi.h"
#include "optics/model_function.h"
#include "support/run_command.h"
#include "support/tensor_file.h"

namespace suite::anisotropic_test {
namespace {

const std::string kModel = "ward:diffuse=0.1,specular=0.3,roughness=0.15,roughness_y=0.45";

// The model tabulated in the RGL layout, with 13 azimuths of the light: no analytic shape, uniform warps, so that the
// values stand over the warped half vector itself.
std::vector<std::byte> tabulated(const sqt::Function& model) {
  test::TensorFileBuilder b;
  const size_t azimuths = 13, thetas = 9, rows = 65, columns = 41;  // half vectors: azimuth, polar angle
  std::vector<float> phi, theta, values;
  for (size_t p = 0; p < azimuths; ++p) phi.push_back(static_cast<float>(kPi * (static_cast<double>(p) / 6 - 1)));
  for (size_t t = 0; t < thetas; ++t) theta.push_back(static_cast<float>(0.195 * static_cast<double>(t)));
  for (size_t p = 0; p < azimuths; ++p)
    for (size_t t = 0; t < thetas; ++t) {
      const Dir in = dir_from_angles(std::max(1e-4, double{theta[t]}), double{phi[p]});
      std::vector<float> slice;
      for (size_t r = 0; r < rows; ++r)
        for (size_t c = 0; c < columns; ++c) {
          const double u = static_cast<double>(c) / (columns - 1), v = static_cast<double>(r) / (rows - 1);
          const Dir m = dir_from_angles(kPi / 2 * u * u, (2 * v - 1) * kPi), out = m * (2 * dot(m, in)) - in;
          double f = 0;
          if (out.z > 0) model.value(out, in, {&f, 1});
          slice.push_back(static_cast<float>(f * std::max(0.0, out.z)));
        }
      values.insert(values.end(), slice.begin(), slice.end());
    }
  b.bytes("description", "brushed metal, tabulated");
  b.bytes("jacobian", std::string(1, '\0'));
  b.floats("phi_i", {azimuths}, phi);
  b.floats("theta_i", {thetas}, theta);
  b.floats("ndf", {4, 5}, std::vector<float>(20, 1.0f));
  b.floats("sigma", {4, 6}, std::vector<float>(24, 1.0f));
  b.floats("vndf", {azimuths, thetas, 2, 2}, std::vector<float>(azimuths * thetas * 4, 1.0f));
  b.floats("wavelengths", {1}, {550});  // each channel would be fitted by itself, at the same cost
  b.floats("spectra", {azimuths, thetas, 1, rows, columns}, values);
  return b.build();
}

class SqtAnisotropic : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    fit_ = run("sqt-fit -q --model " + kModel + " --views 9 --order 5 -o brushed.sqt --report brushed.json");
    write_file(path("brushed.bsdf"), tabulated(*model_function(kModel)));
    fit_file_ = run("sqt-fit -q brushed.bsdf --views 7 --order 5 -o file.sqt --report file.json");
  }
  static void TearDownTestSuite() { delete folder_; }
  static CommandResult run(const std::string& command) {
    return run_command("cd " + folder_->path() + " && " SUITE_BIN_DIR "/" + command);
  }
  static std::string path(const std::string& name) { return *folder_ / name; }
  static TempFolder* folder_;
  static CommandResult fit_, fit_file_;
};
TempFolder* SqtAnisotropic::folder_ = nullptr;
CommandResult SqtAnisotropic::fit_, SqtAnisotropic::fit_file_;

// The error between azimuths is part of the figures, and both programs find the same.
TEST_F(SqtAnisotropic, ErrorsAreKnown) {
  ASSERT_EQ(fit_.code, 0) << fit_.err;
  ASSERT_EQ(fit_file_.code, 0) << fit_file_.err;
  const double told = Params::parse_file(path("brushed.json")).at("overall").number("l1");
  const CommandResult model = run("sqt-inspect brushed.sqt --json --compare-model " + kModel);
  ASSERT_EQ(model.code, 0) << model.err;
  const double found = Params::parse_text(model.out, "json").at("overall").number("l1");
  std::printf("l1: the fitter says %.2f %%, the inspector %.2f %%\n", 100 * told, 100 * found);
  EXPECT_LT(told, 0.05);
  EXPECT_NEAR(found, told, 0.15 * told);
  // Half a turn is the surface's own symmetry, a quarter is not.
  const CommandResult turned = run(
      "sqt-inspect brushed.sqt --json --compare-model ward:diffuse=0.1,specular=0.3,roughness=0.45,roughness_y=0.15");
  EXPECT_GT(Params::parse_text(turned.out, "json").at("overall").number("l1"), 0.3);
  const CommandResult file = run("sqt-inspect file.sqt --json --compare brushed.bsdf --error-map e.png");
  ASSERT_EQ(file.code, 0) << file.err;
  EXPECT_LT(Params::parse_text(file.out, "json").at("overall").number("l1"), 0.06);
}

TEST_F(SqtAnisotropic, ChecksAndSlices) {
  const CommandResult r = run("sqt-inspect brushed.sqt --check");
  EXPECT_EQ(r.code, 0) << r.out;
  for (const char* name : {"brushed.sqt", "file.sqt"}) {
    EXPECT_EQ(run(std::string("sqt-inspect ") + name + " --slice s.csv --plot s.png --map m.png --sphere b.png").code,
              0);
  }
  // Both fits, at directions with and across the marks, against the model.
  const auto model = model_function(kModel);
  for (const auto& [theta_o, phi_o, theta_i, phi_i] :
       {std::array{30.0, 0.0, 45.0, 180.0}, std::array{30.0, 90.0, 45.0, 270.0}, std::array{40.0, 30.0, 20.0, 250.0}}) {
    double f = 0;
    model->value(dir_from_angles(theta_o * kDegree, phi_o * kDegree),
                 dir_from_angles(theta_i * kDegree, phi_i * kDegree), {&f, 1});
    for (const char* name : {"brushed.sqt", "file.sqt"}) {
      const CommandResult e = run(strf("sqt-inspect %s --eval %g,%g,%g,%g,0.55", name, theta_o, phi_o, theta_i, phi_i));
      ASSERT_EQ(e.code, 0) << e.err;
      EXPECT_NEAR(std::stod(e.out.substr(9)) / f, 1, 0.12) << name << " at " << phi_o;
    }
  }
}

struct Picture {
  std::vector<double> radiance, error;
};

// Variance along y over that along x of what is brighter than half of the peak.
double elongation(const Picture& p) {
  double peak = 0, n = 0, x = 0, y = 0, xx = 0, yy = 0;
  for (const double L : p.radiance) peak = std::max(peak, L);
  for (size_t i = 0; i < p.radiance.size(); ++i) {
    if (p.radiance[i] < 0.5 * peak) continue;
    const double c = static_cast<double>(i % 24), r = static_cast<double>(i / 24);
    n += 1, x += c, y += r, xx += c * c, yy += r * r;
  }
  return (yy / n - y * y / (n * n)) / std::max(0.1, xx / n - x * x / (n * n));
}

TEST_F(SqtAnisotropic, TheHighlightLiesAcrossTheMarks) {
  ASSERT_EQ(fit_.code, 0) << fit_.err;
  write_file(path("scene.yaml"),
             "scene: 1\nname: brushed\nwindows_um: [[0.5, 0.6]]\nmaterials:\n"
             "  analytic: {model: ward, diffuse: 0.1, specular: 0.3, roughness: 0.15, roughness_y: 0.45}\n"
             "  fitted: {model: sqt, file: brushed.sqt, outside: hold}\n"
             "objects:\n  a: {plane: {width: 8, depth: 8}, material: analytic}\n"
             "  b: {plane: {width: 8, depth: 8}, material: fitted}\n"
             "world:\n  - {place: a, translate: [-20, 0, 0]}\n  - {place: b}\n"
             "  - {place: b, rotate: {axis: [0, 0, 1], angle_deg: 90}, translate: [20, 0, 0]}\n");
  std::string sim =
      "scene: scene.h5\nseed: 1\nmax_nodes: 2\nsun: {direction: {zenith_deg: 15, azimuth_deg: 40}, irradiance: 1500}\n"
      "sky: {radiance: 20}\nsensors:\n";
  const char* names[] = {"analytic", "fitted", "turned"};
  for (int k = 0; k < 3; ++k)
    sim += strf(
        "  - kind: frame_camera\n    name: %s\n    columns: 24\n    rows: 24\n    pitch_um: 100\n"
        "    focal_length_mm: 1\n    position_m: [%d, 0, 3]\n    look_at_m: [%d, 0.001, 0]\n"
        "    bands:\n      - {name: green, center_um: 0.55, fwhm_um: 0.02}\n    paths: 64\n",
        names[k], 20 * (k - 1), 20 * (k - 1));
  write_file(path("sim.yaml"), sim);
  const CommandResult prep = run("scene-prep scene.yaml -o scene.h5 -q");
  ASSERT_EQ(prep.code, 0) << prep.err << prep.out;
  const CommandResult render = run("dirsig-render sim.yaml -o out -q");
  ASSERT_EQ(render.code, 0) << render.err;
  Picture pictures[3];
  for (int k = 0; k < 3; ++k)
    pictures[k] = {EnviImage(path(strf("out/%s.img", names[k]))).read_all(),
                   EnviImage(path(strf("out/%s_error.img", names[k]))).read_all()};
  const Picture &analytic = pictures[0], &fitted = pictures[1], &turned = pictures[2];
  double sum = 0, apart = 0, apart_turned = 0;
  size_t beyond = 0;
  for (size_t i = 0; i < analytic.radiance.size(); ++i) {
    const double a = analytic.radiance[i], b = fitted.radiance[i];
    sum += a, apart += std::fabs(a - b), apart_turned += std::fabs(a - turned.radiance[i]);
    // Noise of both, and the error that the fit says it has (times two: it is a mean, where the lobe is steep it is
    // more).
    const double noise = std::hypot(analytic.error[i], fitted.error[i]);
    beyond += std::fabs(a - b) > 4 * noise + 0.08 * a;
  }
  std::printf("fitted against analytic: %.2f %% apart, %zu of %zu pixels beyond; turned: %.0f %%\n", 100 * apart / sum,
              beyond, analytic.radiance.size(), 100 * apart_turned / sum);
  EXPECT_LT(apart / sum, 0.03);
  EXPECT_LE(beyond, analytic.radiance.size() / 100);
  EXPECT_GT(apart_turned / sum, 0.2);  // the control
  std::printf("variance of the highlight along y over x: analytic %.1f, fitted %.1f, turned %.2f\n",
              elongation(analytic), elongation(fitted), elongation(turned));
  EXPECT_GT(elongation(fitted), 2);
  EXPECT_LT(elongation(turned), 0.5);
}

}  // namespace
}  // namespace suite::anisotropic_test
