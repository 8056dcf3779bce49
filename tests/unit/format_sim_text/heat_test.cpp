// `weather` and `heat` of a simulation text: what comes of them, and faults at their places.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/sim_text/sim_text.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::format_sim_text_heat_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class HeatInSimulations : public testing::Test {
 protected:
  HeatInSimulations() {
    write_file(folder_ / "w.csv", std::string_view("time_utc, air_temperature [C], wind_speed [m/s], global [W/m2]\n"
                                                   "2026-06-21T00:00Z, 10, 2, 0\n2026-06-21T01:00Z, 10, 2, 0\n"));
  }
  // The first line of more is the third.
  Simulation read(const std::string& more, const std::string& head = "scene: s.h5\nepoch: 2026-06-21T00:00:00Z\n") {
    write_file(folder_ / "sim.yaml",
               head + more +
                   "\nsensors:\n  - {kind: frame_camera, columns: 4, rows: 3, pitch_um: 5, focal_length_mm: 9, "
                   "position_m: [0, 0, 60], look_at_m: [0, 0, 0], bands: [{name: p, center_um: 10, fwhm_um: 1}]}\n");
    return read_simulation(folder_ / "sim.yaml", {});
  }
  std::string told(const std::string& more) {
    return message_of([&] { read(more); });
  }
  TempFolder folder_;
};

const std::string kWeather = "weather: {file: w.csv, site: [45, 0, 100]}\n";

TEST_F(HeatInSimulations, KeysArrive) {
  const Simulation plain = read(kWeather + "heat: {}");
  ASSERT_TRUE(plain.heat);
  EXPECT_EQ(plain.heat->spec.elements, 20000u);
  EXPECT_EQ(plain.heat->spec.paths, 64u);
  EXPECT_TRUE(plain.heat->spec.periodic);
  EXPECT_FALSE(plain.heat->span);
  EXPECT_EQ(plain.heat->weather->site().latitude_deg, 45);
  const Simulation full =
      read(kWeather +
           "heat: {elements: 500, paths: 100, step_s: 300, tolerance_k: 0.001, ground_albedo: 0.3, from: "
           "2026-06-21T00:00:00Z, to: 2026-06-23T00:00:00Z}");
  EXPECT_EQ(full.heat->spec.elements, 500u);
  EXPECT_EQ(full.heat->spec.paths, 112u) << "whole blocks";
  EXPECT_EQ(full.heat->spec.step, 300);
  EXPECT_EQ(full.heat->spec.ground_albedo, 0.3);
  EXPECT_FALSE(full.heat->spec.periodic) << "longer than a day";
  EXPECT_EQ(full.heat->span->end, 2 * 86400);
  EXPECT_TRUE(full.heat->spec.cut_by_sun);
  EXPECT_EQ(full.heat->spec.target, 0);
  const Simulation asked = read(kWeather + "heat: {elements_by: area, target_error_k: 0.1}");
  EXPECT_FALSE(asked.heat->spec.cut_by_sun);
  EXPECT_EQ(asked.heat->spec.target, 0.1);
  EXPECT_FALSE(read("").heat);
  EXPECT_FALSE(plain.heat->keep_operator);
  const Simulation kept = read(kWeather + "heat: {keep: operator, save_every_s: 5}");
  EXPECT_TRUE(kept.heat->keep_operator);
  EXPECT_EQ(kept.heat->save_every, 5);
  EXPECT_FALSE(plain.heat->spec.lateral);
  EXPECT_TRUE(read(kWeather + "heat: {lateral_conduction: true}").heat->spec.lateral);
}

TEST_F(HeatInSimulations, Messages) {
  const std::vector<std::array<std::string, 3>> table{
      {"heat: {}", ":3:", "needs weather"},
      {kWeather, ":3:", "add 'heat: {}'"},
      {kWeather + "heat: {elements: 0}", ":4:", "elements"},
      {kWeather + "heat: {elements: 0.5}", ":4:", "whole number"},
      {kWeather + "heat: {elements_by: size}", ":4:", "sun"},
      {kWeather + "heat: {target_error_k: 0}", ":4:", "target_error_k"},
      {kWeather + "heat: {target_error_k: 0.1, paths: 64}", ":4:", "drop one of them"},
      {kWeather + "heat: {step_s: 0}", ":4:", "step_s"},
      {kWeather + "heat: {keep: paths}", ":4:", "keep: operator"},
      {kWeather + "heat: {save_every_s: 5}", ":4:", "save_every_s"},
      {kWeather + "heat: {random_walks: 1}", ":4:", "one probe"},
      {kWeather + "heat: {lateral_conduction: 2}", ":4:", "lateral_conduction"},
      {kWeather + "heat: {lateral_conduction: true, random_walks: 9}", ":4:", "not known to 'random_walks'"},
      {kWeather + "heat: {lateral_conduction: true, final_gather: true}", ":4:", "not known to 'final_gather'"},
      {kWeather + "heat: {lateral_conduction: true, influence_cutoff_k: 0.1}",
       ":4:", "not known to 'influence_cutoff_k'"},
      {kWeather + "heat: {ground_albedo: 1.2}", ":4:", "ground_albedo"},
      {kWeather + "heat: {from: 0}", ":4:", "give both, or none"},
      {kWeather + "heat: {from: 0, to: 100}", ":4:", "shorter than 24 steps"},
      {kWeather + "heat: {from: 72000, to: 7200}", ":4:", "'to' is 18 hours before 'from'"},
      {kWeather + "heat: {from: 0, to: 43200, repeats: false}", ":4:", "begins with a whole day"},
      {kWeather + "heat: {element: 3}", ":4:", "did you mean 'elements'?"},
      {"weather: {file: none.csv}\nheat: {}", "", "none.csv"},
      {"weather: {file: w.csv, site: [95, 0, 0]}\nheat: {}", ":3:", "latitude"},
      {"weather: {file: w.csv, site: [95, 0]}\nheat: {}", ":3:", "[latitude, longitude, height m]"},
      {"weather: {file: w.csv, longwave: clark}\nheat: {}", ":3:", "clark_allen"},
      {kWeather + "heat: {}\nperiodic: {origin_m: [0, 0], size_m: [1, 1]}", ":4:", "drop one of them"}};
  for (const auto& [text, place, says] : table)
    EXPECT_THAT(told(text), AllOf(HasSubstr(place), HasSubstr(says))) << text;
  EXPECT_THAT(message_of([&] { read(kWeather + "heat: {}", "scene: s.h5\n"); }),
              AllOf(HasSubstr("sim.yaml:3:"), HasSubstr("give 'epoch: DATE'")));
}

}  // namespace
}  // namespace suite::format_sim_text_heat_test
