// `atmosphere: {tables: ...}`: which runs make which table, their units, and faults at their places.
#include "formats/sim_text/air_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/hdf5/h5.h"
#include "spectral/planck.h"
#include "tests/support/message_of.h"
#include "tests/support/tape7_kit.h"
#include "tests/support/temp_folder.h"

namespace suite::format_sim_text_air_tables_test {
namespace {

using test::MadeRow;
using test::MadeRun;
using testing::HasSubstr;

class AirTables : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) { write_file(folder_ / name, std::string_view(text)); }
  void write(const std::string& name, const std::vector<MadeRun>& runs) { write(name, test::tape7_text(runs)); }
  std::shared_ptr<const TabledAirSpec> read(const std::string& text) {
    const Params root = Params::parse_text(text, folder_ / "sim.yaml");
    auto air = read_tabled_air(root);
    root.reject_unread();
    return air;
  }
  std::string told(const std::string& text) {
    return message_of([&] { read(text); });
  }
  TempFolder folder_;
};

std::string all_notes(const TabledAirSpec& air) {
  std::string all;
  for (const std::string& n : air.notes) all += n + "\n";
  return all;
}

// Air of one temperature sends what a blackbody does, times what it does not let through: the column of W, cm and 1/cm
// against Planck's law over wavelength.
TEST_F(AirTables, AColumnOfABlackbodyIsPlancksLaw) {
  constexpr double kKelvin = 288, kPasses = 0.25;
  MadeRun run;
  run.mode = 1, run.first = 700, run.last = 1300, run.step = 1;
  run.row = [&](double nu) {
    MadeRow v;
    v.transmittance = kPasses;
    v.thermal = (1 - kPasses) * test::blackbody_per_wavenumber(nu, kKelvin);
    return v;
  };
  write("warm.tp7", std::vector{run});
  const auto spec = read("tables: [warm.tp7]");
  const std::vector<Band> bands{Band::rectangular("b", 10.5, 4)};
  const SpectralState state = make_state(bands, 0.05);
  const auto air = make_tabled_air(*spec, state, std::nullopt);
  std::vector<float> T(state.size()), S(state.size());
  air->path({0, 0, 3000}, {0, 0, -1}, 3000, T, S);
  for (size_t i = 0; i < state.size(); ++i) {
    const Bin& b = state.bins[i];
    EXPECT_NEAR(T[i], kPasses, 1e-6);
    EXPECT_NEAR(S[i] / ((1 - kPasses) * planck_band_radiance(b.low_um, b.high_um, kKelvin) / (b.high_um - b.low_um)), 1,
                2e-5)
        << b.center_um();
  }
}

TEST_F(AirTables, RunsBecomeTablesOverWhatTheyDifferIn) {
  std::vector<MadeRun> views(6);
  for (size_t i = 0; i < 6; ++i) {
    views[i].zenith_deg = 140 + 20 * static_cast<double>(i % 3);
    views[i].azimuth_deg = i < 3 ? 0 : -180;
    views[i].range_km = 3 / -std::cos(views[i].zenith_deg * kDegree);
  }
  write("a.tp7", {views[0], views[4], views[2]});
  write("b.tp7", {views[3], views[1], views[5]});
  const auto air = read("tables: [a.tp7, b.tp7]\nwithin_deg: 3\nwithin_m: 250\nscene_height_m: 120");
  ASSERT_TRUE(air->sights);
  EXPECT_FALSE(air->sky || air->sun);
  EXPECT_EQ(air->sights->axes, (std::vector{SightAxis::relative_azimuth, SightAxis::view_zenith}));
  EXPECT_NEAR(air->sights->covered(SightAxis::view_zenith)->first, 140 * kDegree, 1e-9);
  EXPECT_NEAR(air->sights->covered(SightAxis::relative_azimuth)->second, kPi, 1e-9);
  EXPECT_EQ(air->sights->alike[SightAxis::observer_height], 3000);
  EXPECT_NEAR(*air->sights->alike[SightAxis::solar_zenith], 40 * kDegree, 1e-9);
  EXPECT_TRUE(air->two_way());
  EXPECT_NEAR(air->within_angle, 3 * kDegree, 1e-12);
  EXPECT_EQ(air->within_height, 250);
  EXPECT_EQ(air->scene_height, 120);
  EXPECT_THAT(all_notes(*air), AllOf(HasSubstr("lines of sight: 6 runs over relative azimuth 0 to 180 degrees, view "
                                               "zenith angle 140 to 180 degrees, 0.485437 to 0.625 um"),
                                     HasSubstr("no run is of the sky"), HasSubstr("two-way column"),
                                     HasSubstr("adjacency"), HasSubstr("changes of the air from place to place")));
}

TEST_F(AirTables, PathsAtOneAngleAreATableOverTheirRange) {
  MadeRun near, far;
  near.zenith_deg = far.zenith_deg = 120;
  near.range_km = 2, near.h2_km = 2, far.range_km = 6, far.h2_km = 0;
  write("a.tp7", {near, far});
  const auto air = read("tables: [a.tp7]");
  EXPECT_EQ(air->sights->axes, std::vector{SightAxis::range});
  EXPECT_EQ(air->sights->least_range, 2000);
  // A level path is one over its range, too.
  MadeRun level;
  level.type = 1, level.h1_km = 0, level.zenith_deg = 90, level.range_km = 5;
  write("level.tp7", std::vector{level});
  EXPECT_EQ(read("tables: [level.tp7]")->sights->axes, std::vector{SightAxis::range});
}

TEST_F(AirTables, RisingPathsAreTheSkyAndIrradianceTheSun) {
  std::vector<MadeRun> sky(2);
  sky[0].zenith_deg = 0, sky[1].zenith_deg = 90;
  for (MadeRun& r : sky)
    r.type = 3, r.h1_km = 0, r.h2_km = 100, r.row = [](double) {
      MadeRow v;
      v.sun = 2e-6;
      return v;
    };
  MadeRun sun;
  sun.type = 3, sun.mode = 3, sun.h1_km = 0, sun.zenith_deg = 40;
  sun.row = [](double) {
    MadeRow v;
    v.transmittance = 0.7, v.sun = 2e-6;
    return v;
  };
  write("sky.tp7", sky);
  write("sun.tp7", std::vector{sun});
  const auto alone = read("tables: [sky.tp7]");
  ASSERT_TRUE(alone->sky && alone->sun);  // SOL@OBS
  EXPECT_FALSE(alone->sights);
  EXPECT_EQ(alone->sky->axes, std::vector{SightAxis::view_zenith});
  EXPECT_THAT(all_notes(*alone), HasSubstr("no run is a line of sight"));
  const auto both = read("tables: [sky.tp7, {file: sun.tp7, as: sun}]");
  PathSpectra path;
  both->sun->table.at(std::span<const double>{}, path);
  EXPECT_NEAR(path.irradiance.back() / (0.7 * 2e-6 * 16000.0 * 16000.0), 1, 1e-6);
  EXPECT_NEAR(both->sun->covered(SightAxis::solar_zenith)->first, 40 * kDegree, 1e-9);
}

TEST_F(AirTables, GeometryThatTheFileDoesNotSay) {
  MadeRun run;
  std::string text = test::run_text(run);
  write("bare.tp7", text.substr(text.find("    FREQ")));
  EXPECT_THAT(told("tables: [bare.tp7]"),
              AllOf(HasSubstr("bare.tp7:1:5: error: the cards before this run do not state its geometry"),
                    HasSubstr("give observer_height_m, zenith_deg, and end_height_m or range_m")));
  const auto air = read(
      "tables: [{file: bare.tp7, observer_height_m: 4000, zenith_deg: 170, end_height_m: 20, solar_zenith_deg: 30, "
      "relative_azimuth_deg: 270}]");
  EXPECT_NEAR(*air->sights->alike[SightAxis::view_zenith], 170 * kDegree, 1e-12);
  EXPECT_EQ(air->sights->alike[SightAxis::end_height], 20);
  EXPECT_NEAR(*air->sights->alike[SightAxis::relative_azimuth], 90 * kDegree, 1e-12);
}

TEST_F(AirTables, LibradtranSky) {
  write("sky.inp", "rte_solver disort\nsza 30\numu -1 -0.5 -0.01\nphi 0 180\n");
  std::string out;
  for (const double nm : {500, 510}) {
    out += strf("%g 1200 0 0 0 0 0\n 0 180\n", nm);
    for (const char* row : {"-1 60 60 60", "-0.5 80 90 70", "-0.01 100 110 90"}) out += std::string(row) + "\n";
  }
  write("sky.out", out);
  const auto air = read("tables: [{file: sky.out, input: sky.inp, observer_height_m: 0}]");
  ASSERT_TRUE(air->sky && air->sun);
  EXPECT_EQ(air->sky->axes, (std::vector{SightAxis::view_zenith, SightAxis::relative_azimuth}));
  PathSpectra path;
  air->sun->table.at(std::array{0.0, 0.0}, path);
  EXPECT_NEAR(path.irradiance[0], 1200 / std::cos(30 * kDegree), 1e-9);
  EXPECT_THAT(told("tables: [{file: sky.out, input: gone.inp}]"), HasSubstr("there is no file"));
}

TEST_F(AirTables, FourCurveAirIsTheSameEverywhere) {
  const std::string path = folder_ / "curves.hdf";
  h5::Writer writer(path, path);
  writer.put("/SpectralSamples", std::vector<float>{0.4f, 0.5f, 0.6f}, "1", 3);
  writer.put("/SolarDeclinationSamples", std::vector<float>{10, 70}, "1");
  std::vector<float> values;
  for (int angle = 0; angle < 2; ++angle)
    for (const float v : {0.1f, 1e-9f, 1e-4f, 0.02f}) values.insert(values.end(), 3, v);
  writer.put("/Conditions/clear", values, "1", 3);
  writer.close();
  const auto air = read("tables: [{file: curves.hdf, max_range_m: 5000}]");
  ASSERT_TRUE(air->sights && air->sky && air->sun);
  EXPECT_TRUE(air->sights->everywhere);
  PathSpectra sky;
  air->sky->table.at(std::array{20 * kDegree}, sky);
  EXPECT_NEAR(sky.radiance[1], 200 / kPi, 1e-4);
  EXPECT_THAT(told("tables: [curves.hdf]"), HasSubstr("{file: ..., max_range_m: N}"));
  EXPECT_THAT(told("tables: [{file: curves.hdf, max_range_m: 5000, condition: cleer}]"), HasSubstr("clear"));
}

TEST_F(AirTables, FaultsAreToldWhereTheyStand) {
  MadeRun run, dark;
  dark.mode = 0;
  write("good.tp7", std::vector{run});
  write("dark.tp7", std::vector{dark});
  const std::string text = test::run_text(run);
  write("cut.tp7", text.substr(0, text.size() / 2));
  EXPECT_EQ(told("tables: [good.tp7]"), "no error");
  EXPECT_THAT(told("tables: [dark.tp7]"),
              AllOf(HasSubstr("dark.tp7:"), HasSubstr("a run of transmittances alone (IEMSCT 0) has no path radiance"),
                    HasSubstr("IEMSCT 1 (thermal) or 2")));
  EXPECT_THAT(told("tables: [cut.tp7]"), HasSubstr("cut.tp7:"));
  EXPECT_THAT(told("tables: [gone.tp7]"),
              AllOf(HasSubstr("sim.yaml:1:10: error: there is no file"), HasSubstr("gone")));
  EXPECT_THAT(told("tables: []"), HasSubstr("no table is given"));
  EXPECT_THAT(told("tables: [{file: good.tp7, as: sun}]"), HasSubstr("only runs of the Sun's irradiance"));
  EXPECT_THAT(told("tables: [{file: good.tp7, zenit_deg: 3}]"), HasSubstr("zenith_deg"));
  EXPECT_THAT(told("tables: [good.tp7, good.tp7]"), HasSubstr("good.tp7:"));  // no grid
  MadeRun red = run;
  red.type = 3, red.h1_km = 0, red.h2_km = 100, red.zenith_deg = 0, red.first = 12000, red.last = 14000;
  write("red.tp7", std::vector{red});
  EXPECT_THAT(told("tables: [good.tp7, red.tp7]"), HasSubstr("the tables have no wavelengths in common"));
}

}  // namespace
}  // namespace suite::format_sim_text_air_tables_test
