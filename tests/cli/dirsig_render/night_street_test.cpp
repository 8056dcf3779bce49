// The night street, generated, prepared and rendered: light under its lamps against closed forms, the same bytes for
// any number of threads; lists of sources.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "base/files.h"
#include "base/params.h"
#include "formats/envi/envi.h"
#include "math/vec.h"
#include "spectral/state.h"
#include "support/run_command.h"

namespace suite::night_street_test {
using testing::HasSubstr;

namespace {

const std::string kBin = SUITE_BIN_DIR "/";

class NightStreet : public testing::Test {
 protected:
  CommandResult run(const std::string& command) { return run_command("cd " + folder_.path() + " && " + command); }
  void make() {
    const CommandResult made = run("python3 " SUITE_SOURCE_DIR "/sample_scenes/night_street/make_scene.py . 96 54");
    ASSERT_EQ(made.code, 0) << made.err;
  }
  // Leaves out the lines of a text that hold one of the words.
  void drop(const std::string& file, const std::vector<std::string>& words) {
    std::istringstream in(read_text(folder_ / file));
    std::string kept, line;
    while (std::getline(in, line))
      if (std::none_of(words.begin(), words.end(), [&](const auto& w) { return line.find(w) != std::string::npos; }))
        kept += line + "\n";
    write_file(folder_ / file, kept);
  }
  TempFolder folder_;
};

// Irradiance of a level plane, W/(m2 um), by the lamps of a simulation that hang over open ground: the intensity down
// to there over the square of the distance times the cosine. scale: of all heights.
double under_lamps(const Params& sim, Vec3 place, const Band& band, double scale = 1) {
  double sum = 0;
  for (const Params& lamp : sim.at("lamps").items()) {
    const std::vector<double> um = lamp.at("intensity").at("wavelength_um").as_numbers(),
                              value = lamp.at("intensity").at("value").as_numbers();
    const double intensity = band_mean(band, Curve(um, value, Outside::error));
    std::vector<double> relative;
    for (const Params& row : lamp.at("distribution").at("table").items()) relative.push_back(row.as_numbers().at(0));
    for (const Params& p : lamp.at("positions_m").items()) {
      const auto [x, y, z] = p.as_vec3();
      const Vec3 to = Vec3{x, y, z * scale} - place;
      const double d = length(to), cosine = to.z / d;
      const double row = std::acos(cosine) / kPi * static_cast<double>(relative.size() - 1);
      const auto k = static_cast<size_t>(row);
      sum += intensity * std::lerp(relative[k], relative[k + 1], row - static_cast<double>(k)) * cosine / (d * d);
    }
  }
  return sum;
}

// The town without its houses, by its 1000 lamps alone: level ground lights no other level ground, so that the
// irradiance is a sum of inverse squares.
TEST_F(NightStreet, LightOnOpenGroundIsTheSumOverLamps) {
  make();
  drop("scene.yaml", {"place: house", "place: pane", "place: pole"});
  drop("sim.yaml", {"moon:", "sky:", "kind: surface"});
  const Params lamps = Params::parse_file(folder_ / "sim.yaml");
  const Vec3 places[] = {{-291, -276, 0.06}, {-3, 24, 0.06},   {4, -36, 0.06},  {120.5, 90, 0.06}, {250, 158, 0.06},
                         {60, 0, 0.01},      {-120, 62, 0.01}, {0, -262, 0.06}, {200, 210, 0.06},  {-290, 30, 0.06}};
  std::string sim = read_text(folder_ / "sim.yaml");
  sim = sim.substr(0, sim.find("sensors:")) +
        "sensors:\n  - kind: point\n    name: ground\n    paths: 4096\n    bands:\n"
        "      - {name: green, center_um: 0.55, fwhm_um: 0.06, shape: rectangular}\n"
        "      - {name: red, center_um: 0.63, fwhm_um: 0.06, shape: rectangular}\n    collectors:\n";
  for (const Vec3& p : places)
    sim += strf("      - {quantity: irradiance, position_m: [%g, %g, %g], normal: [0, 0, 1]}\n", p.x, p.y, p.z);
  write_file(folder_ / "sim.yaml", sim);
  const CommandResult prep = run(kBin + "scene-prep scene.yaml -o scene.h5 -q"),
                      render = run(kBin + "dirsig-render sim.yaml -o out -q");
  ASSERT_EQ(prep.code, 0) << prep.err;
  ASSERT_EQ(render.code, 0) << render.err;
  const std::vector<double> seen = EnviImage(folder_ / "out/ground.img").read_all(),
                            error = EnviImage(folder_ / "out/ground_error.img").read_all();
  ASSERT_EQ(seen.size(), 2 * std::size(places));
  const Band bands[] = {Band::rectangular("green", 0.55, 0.06), Band::rectangular("red", 0.63, 0.06)};
  size_t told_apart = 0;
  for (size_t i = 0; i < seen.size(); ++i) {
    const double exact = under_lamps(lamps, places[i / 2], bands[i % 2]), bound = 4.5 * error[i] + 2e-4 * exact;
    std::printf("%2zu: %.5f +- %.5f, closed form %.5f W/(m2 um)\n", i, seen[i], error[i], exact);
    EXPECT_NEAR(seen[i], exact, bound) << "place " << i / 2 << ", band " << bands[i % 2].name;
    EXPECT_LT(error[i], 0.01 * exact) << "too coarse to say anything";
    // Negative control: lamps that hang 5 % higher.
    told_apart += std::fabs(seen[i] - under_lamps(lamps, places[i / 2], bands[i % 2], 1.05)) > bound;
  }
  EXPECT_GE(told_apart, 12u) << "of 20";
}

// The town as it is: the same bytes for any number of threads.
TEST_F(NightStreet, TheSameBytesForAnyNumberOfThreads) {
  make();
  ASSERT_EQ(run(kBin + "scene-prep scene.yaml -o scene.h5 -q").code, 0);
  const CommandResult one = run(kBin + "dirsig-render sim.yaml -o one --paths 16 -q -j 1");
  ASSERT_EQ(one.code, 0) << one.err;
  ASSERT_EQ(run(kBin + "dirsig-render sim.yaml -o two --paths 16 -q -j 2").code, 0);
  EXPECT_EQ(sha256(read_text(folder_ / "one/night.img")), sha256(read_text(folder_ / "two/night.img")));
}

TEST_F(NightStreet, ListsTheKindsOfSources) {
  const CommandResult r = run_command(kBin + "dirsig-render --list-sources");
  EXPECT_EQ(r.code, 0);
  for (const char* kind : {"clear", "thermal", "image", "spot", "moon"}) EXPECT_THAT(r.out, HasSubstr(kind));
}

}  // namespace

}  // namespace suite::night_street_test
