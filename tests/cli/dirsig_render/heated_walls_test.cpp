// A wall that an engine beside it heats far beyond what weather does: bins that follow, bands that do not see it, what
// the stages of the search count, and spans of time that cross a midnight.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/files.h"
#include "support/programs_kit.h"

namespace suite::heated_walls_test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kScene = R"(scene: 1
origin: {latitude_deg: 39.83, longitude_deg: -104.65, height_m: 1650}
materials:
  engine: {model: lambert, reflectance: 0.1, temperature_k: 1300}
  wall:
    model: lambert
    reflectance: 0.05
    thermal: {thickness_m: 0.12, density_kg_m3: 40, specific_heat_j_kg_k: 1400, conductivity_w_m_k: 0.035}
    temperature: {model: heat, convection: mcadams, back: air, back_k: 294, back_film_w_m2_k: 600}
objects:
  engine: {box: {x0: 0.5, y0: -2, z0: 0, x1: 0.7, y1: 2, z1: 4}, material: engine}
  wall: {box: {x0: -0.2, y0: -2, z0: 0, x1: 0, y1: 2, z1: 4}, material: wall}
world:
  - {place: engine}
  - {place: wall}
)";
constexpr const char* kSimulation = R"(scene: scene.h5
epoch: 2001-07-14T07:00:00Z
weather: {file: denver_july.epw, year: 2001}
heat: {elements: 40, step_s: 1800, paths: 64}
sun: {direction: {time_utc: 2001-07-14T07:00:00Z}}
sensors:
  - {kind: frame_camera, name: eye, columns: 1, rows: 1, pitch_um: 120, focal_length_mm: 30, position_m: [0.3, -3, 5], look_at_m: [0, 0, 2],
     up: [0, 0, 1], time_s: 43200, paths: 8, bands: [{name: b, center_um: 2.2, fwhm_um: 0.6, shape: rectangular}]}
)";
const std::string kFew = "dirsig-render sim.yaml -o out ";

class HeatedWalls : public ProgramsTest<HeatedWalls> {
 protected:
  static void SetUpTestSuite() {
    make_folder();
    run_command("cp " SUITE_SOURCE_DIR "/sample_scenes/summer_street/denver_july.epw " + folder_->path());
    write_file(*folder_ / "scene.yaml", std::string_view(kScene));
    std::string cool(kScene);
    cool.replace(cool.find("temperature_k: 1300"), 19, "temperature_k: 300");
    write_file(*folder_ / "cool.yaml", std::string_view(cool));
    write_file(*folder_ / "sim.yaml", std::string_view(kSimulation));
    cool.insert(cool.find("convection: mcadams"), "source_w_m2: 100000, ");
    write_file(*folder_ / "source.yaml", std::string_view(cool));
    for (const char* name : {"scene", "cool", "source"}) {
      const CommandResult prep = run(strf("scene-prep %s.yaml -o %s.h5 -q", name, name));
      ASSERT_EQ(prep.code, 0) << prep.err;
    }
  }
  static std::string told(const std::string& arguments, int code = 0) {
    const CommandResult r = run(kFew + arguments);
    EXPECT_EQ(r.code, code) << r.err;
    return r.err;
  }
};

TEST_F(HeatedWalls, BinsFollowTheTemperaturesThatAreFound) {
  const std::string hot = told("");
  EXPECT_THAT(hot, ContainsRegex(
                       "surfaces are as hot as 1[0-9][0-9][0-9] K: bins, chosen for at most 400 K, are chosen again"));
  EXPECT_EQ(hot.find("[DR603]"), hot.npos);
  EXPECT_THAT(told("--heat out/heat.h5"), HasSubstr("chosen again"));
  EXPECT_THAT(told("--set scene=cool.h5"), Not(HasSubstr("chosen again")));
}

TEST_F(HeatedWalls, StagesCountFacesOnlyWhereTheyTraceThem) {
  const std::string said = told("--heat-only");
  EXPECT_THAT(said, ContainsRegex("heat: exchange of infrared: [0-9]+ faces in"));
  EXPECT_THAT(said, ContainsRegex("heat: sunlight: [0-9]+ faces in"));
  EXPECT_THAT(said, ContainsRegex("heat: balance: [0-9.]+ m?s\n"));
  EXPECT_THAT(said, ContainsRegex("heat: errors: [0-9.]+ m?s\n"));
  // Each face has straight and scattered sunlight, and is one all the same.
  const auto faces = [&](const std::string& stage) { return std::atoi(&said[said.find(stage) + stage.size()]); };
  EXPECT_EQ(faces("heat: sunlight: "), faces("heat: exchange of infrared: "));
}

TEST_F(HeatedWalls, BandsThatDoNotSeeWeatherMaySeeThem) {
  const std::string near = " --set 'sensors.0.bands=[{name: v, center_um: 0.75, fwhm_um: 0.1, shape: rectangular}]'";
  const std::string said = told(near);
  EXPECT_THAT(said, HasSubstr("surfaces that wait for the balance of heat stay dark"));
  EXPECT_THAT(said, HasSubstr("the scene holds 1300 K"));
  EXPECT_THAT(said, HasSubstr("[DR603]"));
  EXPECT_THAT(told(near + " --set scene=cool.h5"), Not(HasSubstr("stay dark")));
  // A source of 100 kW/m2 of its own, of which neither the program nor the scene's file may think less.
  const std::string own = told(near + " --set scene=source.h5");
  EXPECT_THAT(own, HasSubstr("the scene holds 1167 K"));
  EXPECT_THAT(own, HasSubstr("[DR603]"));
}

TEST_F(HeatedWalls, SpansOverMidnightAreToldWithTheirCure) {
  // Captures on both sides of the sun's midnight, at about 7:00 of UTC.
  const std::string split = told("--set sensors.0.time_s=-1800 --set sensors.0.integration_time_s=7200", 1);
  EXPECT_THAT(split, HasSubstr("sim.yaml:4:"));
  EXPECT_THAT(split, HasSubstr("captures (2001-07-14T06:30:00Z to 2001-07-14T08:30:00Z) lie on both sides of one, at "
                               "2001-07-14T06:59:00Z"));
  EXPECT_THAT(split, HasSubstr("'from: 2001-07-13T19:30:00Z, to: 2001-07-14T19:30:00Z'"));
  const std::string turned = told("--set 'heat.from=2001-07-14T22:00:00Z' --set 'heat.to=2001-07-14T08:00:00Z'", 1);
  EXPECT_THAT(turned, HasSubstr("'to' is 14 hours before 'from'"));
  EXPECT_THAT(turned, HasSubstr("ends on the next date"));
}

}  // namespace
}  // namespace suite::heated_walls_test
