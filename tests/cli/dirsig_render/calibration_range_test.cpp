// The whole chain on the calibration range, with few paths: the four programs in a row, cubes that other programs read,
// panels whose radiance is the closed form, the same bytes for any number of threads, and faults told at their place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "math/vec.h"
#include "spectral/state.h"
#include "support/run_command.h"

namespace suite::calibration_range_test {
using testing::HasSubstr;

namespace {

const std::string kBin = SUITE_BIN_DIR "/";

// One copy of the scene, prepared once for all tests of this file.
class CalibrationRange : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    run_command("cp -r " SUITE_SOURCE_DIR "/sample_scenes/calibration_range/. " + folder_->path());
    fit_ = run("sqt-fit satin_purple_rgb.bsdf -o satin.sqt -q");
    map_ = run("sqt-inspect satin.sqt --map satin.png -q");
    prep_ = run("scene-prep scene.yaml -o scene.h5 -q");
    render_ = run("dirsig-render sim.yaml -o out --paths 16 -q");
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static CommandResult run(const std::string& command) {
    return run_command("cd " + folder_->path() + " && " + kBin + command);
  }
  static std::string path(const std::string& name) { return *folder_ / name; }

  static TempFolder* folder_;
  static CommandResult fit_, map_, prep_, render_;
};
TempFolder* CalibrationRange::folder_ = nullptr;
CommandResult CalibrationRange::fit_, CalibrationRange::map_, CalibrationRange::prep_, CalibrationRange::render_;

Curve table(const std::string& file) {
  std::ifstream in(SUITE_SOURCE_DIR "/sample_scenes/calibration_range/curves/" + file);
  std::vector<double> x, y;
  for (std::string line; std::getline(in, line);) {
    double w = 0, v = 0;
    if (!line.empty() && line[0] != '#' && std::sscanf(line.c_str(), "%lf %lf", &w, &v) == 2)
      x.push_back(w), y.push_back(v);
  }
  return Curve(std::move(x), std::move(y), Outside::error);
}

// integral(L R) / integral(R), by a sum much finer than the response.
double in_band(const Curve& curve, const Band& band) {
  double sum = 0, weight = 0;
  for (double w = band.low_um(); w < band.high_um(); w += 1e-5) {
    const double r = band.response.at(w);
    sum += r * curve.at(w), weight += r;
  }
  return sum / weight;
}

size_t band_named(const EnviHeader& h, const std::string& name) {
  return static_cast<size_t>(std::find(h.band_names.begin(), h.band_names.end(), name) - h.band_names.begin());
}

}  // namespace

TEST_F(CalibrationRange, EveryStepSucceedsAndLeavesWhatItPromised) {
  for (const CommandResult* r : {&fit_, &map_, &prep_, &render_}) EXPECT_EQ(r->code, 0) << r->out << r->err;
  for (const char* name : {"satin.sqt", "satin.png", "scene.h5", "out/uas.img", "out/uas.img.hdr", "out/uas_error.img",
                           "out/uas_error.img.hdr", "out/uas_truth.img", "out/uas_truth.img.hdr", "out/uas.png"})
    EXPECT_TRUE(file_exists(path(name))) << name;
}

TEST_F(CalibrationRange, CubesCarryBandsUnitsAndTheCommandThatMadeThem) {
  const EnviImage radiance(path("out/uas.img")), error(path("out/uas_error.img")), truth(path("out/uas_truth.img"));
  const EnviHeader& h = radiance.header();
  EXPECT_EQ(h.samples, 640u);
  EXPECT_EQ(h.lines, 360u);
  EXPECT_EQ(h.wavelength_um, (std::vector<double>{0.475, 0.56, 0.668, 0.717, 0.842}));
  EXPECT_EQ(h.fwhm_um, (std::vector<double>{0.032, 0.027, 0.016, 0.012, 0.057}));
  EXPECT_THAT(h.description, HasSubstr("dirsig-render sim.yaml -o out --paths 16"));
  radiance.require_units("W/(m2 sr um)");
  error.require_units("W/(m2 sr um)");
  EXPECT_EQ(error.header().band_names, h.band_names);
  EXPECT_EQ(truth.header().samples, h.samples);
  for (const double v : radiance.read_all()) ASSERT_TRUE(std::isfinite(v) && v >= 0);
  for (const double v : error.read_all()) ASSERT_TRUE(std::isfinite(v) && v >= 0);
}

TEST_F(CalibrationRange, PanelsHaveTheRadianceOfTheClosedForm) {
  // A horizontal Lambert panel under the open sky: rho (E cos z / pi + L_sky). Seen on the tops only.
  const EnviImage radiance(path("out/uas.img")), truth(path("out/uas_truth.img"));
  const std::vector<double> l = radiance.read_all(), t = truth.read_all();
  const size_t bands = radiance.header().bands, columns = truth.header().bands;
  const size_t material = band_named(truth.header(), "material"), up = band_named(truth.header(), "up [m]");
  ASSERT_LT(material, columns);
  ASSERT_LT(up, columns);
  const Curve sun = table("sun_direct.txt"), sky = table("sky_diffuse.txt");
  for (const auto& [name, rho] :
       {std::pair{"panel_05", 0.05}, std::pair{"panel_50", 0.5}, std::pair{"panel_99", 0.99}}) {
    const size_t at = truth.header().description.find(std::string("=") + name);
    ASSERT_NE(at, std::string::npos);
    const double id = std::atof(truth.header().description.substr(truth.header().description.rfind(' ', at)).c_str());
    double top = -INFINITY;
    for (size_t p = 0; p < t.size() / columns; ++p)
      if (t[p * columns + material] == id) top = std::fmax(top, t[p * columns + up]);
    for (size_t b = 0; b < bands; ++b) {
      std::vector<double> seen;
      for (size_t p = 0; p < t.size() / columns; ++p)
        if (t[p * columns + material] == id && t[p * columns + up] > top - 0.005) seen.push_back(l[p * bands + b]);
      ASSERT_GT(seen.size(), 300u) << name;
      // The median leaves out the pixels at the rim, which also see the ground.
      std::nth_element(seen.begin(), seen.begin() + static_cast<long>(seen.size() / 2), seen.end());
      const Band band = Band::gaussian("", radiance.header().wavelength_um[b], radiance.header().fwhm_um[b]);
      const double expected = rho * (in_band(sun, band) * std::cos(48.19 * kDegree) / kPi + in_band(sky, band));
      EXPECT_NEAR(seen[seen.size() / 2] / expected, 1, 0.01) << name << " band " << b;
    }
  }
}

TEST_F(CalibrationRange, TheSameBytesForAnyNumberOfThreads) {
  // A quarter of the columns and rows: still more blocks than threads.
  const std::string small =
      "dirsig-render sim.yaml -o threads --paths 1 -q --set sensors.0.columns=160 --set sensors.0.rows=90 ";
  std::string first, image;
  for (const char* threads : {"1", "2", "5"}) {
    const CommandResult r = run(small + "-j " + threads);
    ASSERT_EQ(r.code, 0) << r.err;
    const std::string bytes = read_text(path("threads/uas.img")) + read_text(path("threads/uas_error.img")) +
                              read_text(path("threads/uas_truth.img"));
    if (first.empty()) first = sha256(bytes), image = sha256(read_text(path("threads/uas.img")));
    EXPECT_EQ(sha256(bytes), first) << threads << " threads";
  }
  ASSERT_EQ(run(small + "--seed 2").code, 0);
  EXPECT_NE(sha256(read_text(path("threads/uas.img"))), image);
}

TEST_F(CalibrationRange, GdalReadsTheCubes) {
  if (run_command("command -v gdalinfo").code != 0)
    GTEST_SKIP() << "gdalinfo (Debian package gdal-bin) is not installed";
  const CommandResult r = run_command("gdalinfo " + path("out/uas.img"));
  EXPECT_EQ(r.code, 0);
  EXPECT_THAT(r.out, HasSubstr("Size is 640, 360"));
  for (const char* text :
       {"Band 5 Block=640x1 Type=Float32", "wavelength=0.475", "wavelength=0.842", "wavelength_units=Micrometers"})
    EXPECT_THAT(r.out, HasSubstr(text));
}

TEST_F(CalibrationRange, FaultsAreOneLocatedMessageAndLeaveNothingBehind) {
  std::string text = read_text(path("sim.yaml"));
  const size_t at = text.find("focal_length_mm");
  ASSERT_NE(at, std::string::npos);
  write_file(path("bad.yaml"), std::string_view(text.replace(at, 15, "focal_lenght_mm")));
  CommandResult r = run("dirsig-render bad.yaml -o bad -q");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("bad.yaml:"));
  EXPECT_THAT(r.err, HasSubstr("focal_lenght_mm"));
  r = run("dirsig-render none.yaml -o bad -q");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("none.yaml: error: no such file"));
  r = run("dirsig-render . -o bad -q");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("is a directory"));
  r = run("dirsig-render sim.yaml -o scene.h5/out --paths 1 -q");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("error:"));
  r = run("dirsig-render sim.yaml -o bad --pahts 4");
  EXPECT_EQ(r.code, 2);
  EXPECT_THAT(r.err, HasSubstr("did you mean '--paths'?"));
  // These used to be the simulation's own seed, and the largest that there is.
  for (const char* seed : {"-1", "9007199254740993", "99999999999999999999999"}) {
    r = run(std::string("dirsig-render sim.yaml -o bad --seed ") + seed);
    EXPECT_EQ(r.code, 2) << seed;
    EXPECT_THAT(r.err, HasSubstr("--seed wants a whole number from 0 to 2^53")) << seed;
  }
  EXPECT_FALSE(std::filesystem::exists(path("bad")));
}

}  // namespace suite::calibration_range_test
