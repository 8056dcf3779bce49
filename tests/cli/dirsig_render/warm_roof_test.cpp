// Temperatures solved at render time, through both programs: pixels against the slab solver asked directly, and what is
// wrong with loads told at its place. And a phase function from sqt-fit to the picture, against its formula.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "spectral/planck.h"
#include "support/run_command.h"
#include "thermal/models.h"

namespace suite::warm_roof_test {
using testing::HasSubstr;

namespace {

const std::string kBin = SUITE_BIN_DIR "/";

class Folder : public testing::Test {
 protected:
  CommandResult run(const std::string& command) {
    return run_command("cd " + folder_.path() + " && " + kBin + command);
  }
  void change(const std::string& file, const std::string& from, const std::string& to) {
    std::string text = read_text(folder_ / file);
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write_file(folder_ / file, text.replace(at, from.size(), to));
  }
  TempFolder folder_;
};

class WarmRoof : public Folder {
 protected:
  WarmRoof() { run_command("cp -r " SUITE_SOURCE_DIR "/sample_scenes/warm_roof/. " + folder_.path()); }
};

TEST_F(WarmRoof, PixelsAreAsWarmAsTheSlabs) {
  const CommandResult prep = run("scene-prep scene.yaml -o scene.h5");
  ASSERT_EQ(prep.code, 0) << prep.err;
  const CommandResult render = run("dirsig-render sim.yaml -o out -q");
  ASSERT_EQ(render.code, 0) << render.err;
  const Scene scene = read_scene(folder_ / "scene.h5");
  std::map<std::string, std::array<double, 2>> seen;  // yard, roof
  for (const auto& [name, time] :
       std::map<std::string, double>{{"night", 10800}, {"noon", 43200}, {"evening", 72000}}) {
    const EnviImage image(folder_ / ("out/" + name + ".img"));
    const std::vector<double> row = image.read_lines(24, 1);
    seen[name] = {row[4], row[32]};
    for (const TemperatureBinding& t : scene.temperatures) {
      const bool roof = scene.materials[t.material].id == "metal";
      double kelvin = 0;
      make_temperature_model(t.spec)->kelvin({&time, 1}, loads_of(t.spec), {&kelvin, 1});
      // Nothing shines but the slabs: what they reflect is nothing but a little of each other.
      const double expected = 0.95 * planck_band_radiance(9.5, 10.5, kelvin);
      EXPECT_NEAR(row[roof ? 32 : 4], expected, 0.005 * expected) << name << (roof ? " roof" : " yard");
    }
  }
  EXPECT_GT(seen["noon"][1], 1.1 * seen["noon"][0]) << "the roof is hotter at noon";
  EXPECT_LT(seen["night"][1], 0.98 * seen["night"][0]) << "and colder at night";
}

TEST_F(WarmRoof, FaultsOfLoads) {
  change("scene.yaml", "[18000, 0, 295, 280, 1]", "[18000, -3, 295, 280, 1]");
  CommandResult prep = run("scene-prep scene.yaml -o scene.h5");
  EXPECT_EQ(prep.code, 1);
  EXPECT_THAT(prep.err, HasSubstr("a load of -3 in row 2"));
  change("scene.yaml", "[18000, -3, 295, 280, 1]", "[18000, 0]");
  prep = run("scene-prep scene.yaml -o scene.h5");
  EXPECT_EQ(prep.code, 1);
  EXPECT_THAT(prep.err, HasSubstr("a row of loads is"));
  // A day that does not repeat has to cover the simulated times.
  change("scene.yaml", "[18000, 0]", "[18000, 0, 295, 280, 1]");
  change("scene.yaml", "repeat: true", "repeat: false");
  change("scene.yaml", "period_s: 86400", "start_s: 0");
  change("sim.yaml", "time_s: 72000", "time_s: 90000");
  ASSERT_EQ(run("scene-prep scene.yaml -o scene.h5").code, 0);
  const CommandResult render = run("dirsig-render sim.yaml -o out -q");
  EXPECT_EQ(render.code, 1);
  EXPECT_THAT(render.err, HasSubstr("): material 'concrete': a table over time is asked for"));
}

TEST_F(WarmRoof, SlabsWithoutLoadsAreRefused) {
  const std::string text = read_text(folder_ / "scene.yaml");
  const size_t from = text.find("      loads:"), to = text.find("  metal:");
  write_file(folder_ / "scene.yaml", text.substr(0, from) + text.substr(to));
  ASSERT_EQ(run("scene-prep scene.yaml -o scene.h5").code, 0);
  const CommandResult render = run("dirsig-render sim.yaml -o out -q");
  EXPECT_EQ(render.code, 1);
  EXPECT_THAT(render.err, HasSubstr("needs the loads of its surface"));
}

// A slab of haze over a dark ground; its phase function as given.
class Haze : public Folder {
 protected:
  double seen(const std::string& phase) {
    write_file(
        folder_ / "scene.yaml",
        "scene: 1\nmedia: {haze: {absorption: 0.1, scattering: 1, phase: " + phase +
            "}}\nmaterials: {soil: {model: lambert, reflectance: 0.1}, side: {inside: haze}}\nobjects: {ground: "
            "{plane: {width: 0, depth: 0}, material: soil}, layer: {box: {x0: -50, y0: -50, z0: 0.1, x1: 50, y1: "
            "50, z1: 1.1}, material: side}}\nworld: [{place: ground}, {place: layer}]\n");
    write_file(folder_ / "sim.yaml",
               "scene: scene.h5\nsun: {direction: {zenith_deg: 60, azimuth_deg: 0}, irradiance: 3, collimated: true}\n"
               "sensors: [{kind: frame_camera, name: a, columns: 8, rows: 8, pitch_um: 1, focal_length_mm: 100, "
               "position_m: [0, -5, 9], look_at_m: [0, 0, 0], bands: [{name: b, center_um: 0.55, fwhm_um: 0.01, shape: "
               "rectangular}], paths: 256}]\n");
    const CommandResult prep = run("scene-prep scene.yaml -o scene.h5 --force"),
                        render = run("dirsig-render sim.yaml -o out -q");
    EXPECT_EQ(prep.code, 0) << prep.err;
    EXPECT_EQ(render.code, 0) << render.err;
    const EnviImage image(folder_ / "out/a.img");
    double sum = 0;
    for (size_t r = 0; r < 8; ++r)
      for (const double v : image.read_lines(r, 1)) sum += v / 64;
    return sum;
  }
};

TEST_F(Haze, FittedPhaseFunctionToThePicture) {
  const CommandResult fit = run("sqt-fit --model hg:g=0.6 --order 7 -o haze.sqt -q");
  ASSERT_EQ(fit.code, 0) << fit.err;
  const double fitted = seen("{model: sqt, file: haze.sqt}"), exact = seen("{model: hg, g: 0.6}"),
               other = seen("{model: hg, g: 0.3}");
  EXPECT_NEAR(fitted, exact, 0.03 * exact);
  EXPECT_GT(std::fabs(other - exact), 0.1 * exact) << "any phase function would do";
  // A surface function is no phase function.
  ASSERT_EQ(run("sqt-fit --model lambert:reflectance=0.5 --order 5 -o matte.sqt -q").code, 0);
  change("scene.yaml", "{model: hg, g: 0.3}", "{model: sqt, file: matte.sqt}");
  run("scene-prep scene.yaml -o scene.h5 --force");
  const CommandResult render = run("dirsig-render sim.yaml -o out -q");
  EXPECT_EQ(render.code, 1);
  EXPECT_THAT(render.err, HasSubstr("does not hold a phase function"));
}

}  // namespace

}  // namespace suite::warm_roof_test
