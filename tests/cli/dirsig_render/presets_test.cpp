// Presets of sensors: each can be rendered; the day/night band's zones fill its scan with even pixels, and its counts
// are those of a closed form.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/files.h"
#include "base/params.h"
#include "formats/envi/envi.h"
#include "math/vec.h"
#include "support/run_command.h"

namespace suite::presets_test {
namespace {

using testing::HasSubstr;

class Presets : public testing::Test {
 protected:
  Presets() {
    write_file(
        folder_ / "scene.yaml",
        "scene: 1\nmaterials: {m: {model: lambert, reflectance: 0.1}}\nobjects: {p: {plane: {width: 1, depth: 1}, "
        "material: m}}\nworld: [{place: p, translate: [9000000, 0, 0]}]\n");
    run_command("cd '" + folder_.path() + "' && " SUITE_BIN_DIR "/scene-prep scene.yaml -o scene.h5 -q");
  }
  CommandResult run(const std::string& arguments) {
    return run_command("cd '" + folder_.path() + "' && " SUITE_BIN_DIR "/dirsig-render " + arguments);
  }
  Params preset(const std::string& name) {
    write_file(folder_ / "preset.yaml", "sensors:\n" + run("--preset " + name).out);
    return Params::parse_file(folder_ / "preset.yaml").at("sensors").items().at(0);
  }
  TempFolder folder_;
};

TEST_F(Presets, AreRendered) {
  EXPECT_THAT(run("--list-presets").out, testing::AllOf(HasSubstr("viirs_dnb_like"), HasSubstr("vlp_16")));
  for (const char* name : {"viirs_dnb_like", "viirs_dnb_like_2", "viirs_dnb_like_32"}) {
    const CommandResult text = run(std::string("--preset ") + name);
    ASSERT_EQ(text.code, 0) << text.err;
    EXPECT_THAT(text.out, HasSubstr("# Source: "));
    write_file(folder_ / "sim.yaml", "scene: scene.h5\nsensors:\n" + text.out);
    EXPECT_EQ(run("sim.yaml --dry-run -o p").code, 0) << name;
  }
  EXPECT_THAT(run("--preset vlp_16").out, HasSubstr("kind: lidar"));
  EXPECT_THAT(run("--preset viirs_dnb_like_33").err, HasSubstr("no preset"));
  EXPECT_THAT(run("--preset vlp_61").err, HasSubstr("did you mean 'vlp_16'"));
}

// On a sphere of 6371 km from 833 km; the published pixel is 742 m at all angles. Negative control: zone 1 carried to
// the edge would have samples six times as long.
TEST_F(Presets, ZonesOfTheDayNightBandFillTheScan) {
  double edge = 0;
  for (int zone = 1; zone <= 32; ++zone) {
    const Params instrument =
        preset("viirs_dnb_like_" + std::to_string(zone)).at("instruments").items().back();  // to the left
    const Params array = instrument.at("arrays").items().at(0), mount = instrument.at("mount");
    const std::vector<double> pitch = array.at("pitch_um").as_numbers();
    const double focal = instrument.number("focal_length_mm"), samples = array.at("readout").number("samples"),
                 across = pitch[0] / focal * 1e-3 / kDegree, start = mount.number("start_deg") - 0.5 * across,
                 sampled = mount.number("rate_deg_s") / array.at("readout").number("sample_rate_hz");
    EXPECT_NEAR(sampled, across, 1e-5 * across) << zone;  // pixels touch
    EXPECT_NEAR(zone == 1 ? -start : start, zone == 1 ? 0.5 * samples * across : edge, 1e-4) << zone;
    edge = start + samples * across;
    const double nadir = (zone == 1 ? 0 : edge - 0.5 * samples * across) * kDegree;
    const double incidence = std::asin((6371 + 833) / 6371.0 * std::sin(nadir)),
                 range = nadir > 0 ? 6371 * std::sin(incidence - nadir) / std::sin(nadir) : 833,
                 along_scan = range * across * kDegree / std::cos(incidence) * 1e3;
    EXPECT_NEAR(along_scan, 742, 0.1 * 742) << zone;
    EXPECT_NEAR(range * pitch[1] / focal, 742, 1) << zone;
    if (zone == 32) {
      EXPECT_GT(range * 66 * 1.35e-5 / std::cos(incidence) * 1e3, 6 * 742);
    }
  }
  EXPECT_NEAR(edge, 56.06, 1e-3);
}

// 3e-9 W/(cm2 sr), the least radiance of the requirements, spread evenly over 0.5 to 0.9 um: at least six times the
// noise in the high gain; the gains keep their ratios.
TEST_F(Presets, DayNightBandCountsElectrons) {
  write_file(folder_ / "sim.yaml", "scene: scene.h5\nsky: {radiance: 7.5e-5, full_sphere: true}\nsensors:\n" +
                                       run("--preset viirs_dnb_like").out);
  const CommandResult done = run("sim.yaml -o out -q --paths 1 --set sensors.0.tasks.0.stop=0.1");
  ASSERT_EQ(done.code, 0) << done.err;
  const auto mean = [&](const std::string& name) {
    const std::vector<double> all = EnviImage(folder_ / ("out/viirs_dnb_like_" + name + ".img")).read_all();
    return std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
  };
  // pi/4 D^2 of 191 mm, a pixel of 742 m from 833 km, half of it passes, 250 times 3.835 us, an efficiency of 0.6,
  // photons of 0.7 um in the mean; 1 + 4 N^2 in place of 4 N^2 for the cone's finite angle.
  const double area = kPi / 4 * 0.191 * 0.191, solid = std::pow(742 / 833e3, 2), seconds = 250 * 3.8351e-6,
               four_n2 = 4 * std::pow(1141.0 / 191, 2),
               n = 3e-5 * area * solid * 0.5 * 0.6 * seconds * 0.7e-6 / 1.98644586e-25 * four_n2 / (1 + four_n2);
  EXPECT_NEAR(mean("high_electrons"), n, 0.001 * n);
  EXPECT_NEAR(mean("high_electrons") / mean("mid_electrons"), 250.0 / 3, 1e-3);
  EXPECT_NEAR(mean("mid_electrons") / mean("low_electrons"), 3 * 35, 1e-3);
  const double read = 1.6 * std::sqrt(66.0 * 42);
  EXPECT_GT(n / std::sqrt(n + read * read), 6);
}

}  // namespace
}  // namespace suite::presets_test
