// What sensors leave on disk: how images are cut into files, types, units, map coordinates, products, logs; and that
// truth is what is there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "formats/raster/raster.h"
#include "math/vec.h"
#include "motion/scene_frame.h"
#include "sensor/detectors/detectors.h"
#include "support/programs_kit.h"

namespace suite::sensor_output_test {
namespace {

using testing::HasSubstr;

const char* const kScene =
    "scene: 1\norigin: {latitude_deg: 49, longitude_deg: 8, height_m: 120}\n"
    "materials:\n  ground: {model: lambert, reflectance: 0.2}\n  white: {model: lambert, reflectance: 0.8, "
    "temperature_k: 300}\n"
    "objects:\n  plane: {plane: {width: 40, depth: 40}, material: ground}\n  board: {box: {x0: -2, y0: -2, z0: 0, x1: "
    "2, y1: 2, z1: 3}, material: white}\n"
    "world:\n  - {place: plane, tag: ground}\n  - {place: board, tag: board, translate: [4, 0, 0]}\n";
const std::string kLight =
    "scene: scene.h5\nepoch: 2026-06-21T10:30:00Z\nsun: {direction: {zenith_deg: 45, azimuth_deg: 90}, irradiance: "
    "1000, collimated: true}\n";
const std::string kBand = "bands: [{name: pan, center_um: 0.6, fwhm_um: 0.1, shape: rectangular}]";
const std::string kFlight =
    "  - kind: platform\n    name: uas\n    motion: {kind: straight, position_m: [0, 0, 100], heading_deg: 0, "
    "speed_m_s: 10}\n";

class SensorOutput : public ProgramsTest<SensorOutput> {
 protected:
  static void SetUpTestSuite() {
    make_folder();
    prepare(kScene);
  }
  static void render(const std::string& text, const std::string& out) {
    const CommandResult r = ProgramsTest::render(kLight + text, out);
    ASSERT_EQ(r.code, 0) << r.err;
  }
  static bool there(const std::string& name) { return file_exists(*folder_ / name); }
};

std::string two_tasks(const std::string& files) {
  return "output: {files: " + files + "}\nsensors:\n" + kFlight +
         "    tasks: [{name: out, start: 0, stop: 1}, {name: back, start: 2, stop: 2.5}]\n    instruments:\n" +
         "      - {name: eye, focal_length_mm: 50, clock: {rate_hz: 2}, arrays: [{columns: 6, rows: 4, pitch_um: 50, "
         "paths: 1, " +
         kBand + "}]}\n";
}

TEST_F(SensorOutput, FilesHoldACaptureATaskOrAll) {
  render(two_tasks("capture"), "capture");
  for (const char* n :
       {"capture/uas_0000.img", "capture/uas_0004.img", "capture/uas_0002_truth.img", "capture/uas_0001.png"})
    EXPECT_TRUE(there(n)) << n;
  EXPECT_FALSE(there("capture/uas_0005.img"));
  render(two_tasks("task"), "task");
  EXPECT_EQ(EnviImage(*folder_ / "task/uas_out.img").header().lines, 12u);
  EXPECT_EQ(EnviImage(*folder_ / "task/uas_back.img").header().lines, 8u);
  render(two_tasks("simulation"), "all");
  const EnviImage all(*folder_ / "all/uas.img");
  EXPECT_EQ(all.header().lines, 20u);
  EXPECT_THAT(all.header().description, HasSubstr("dirsig-render all.yaml -o all"));
  EXPECT_THAT(all.header().description, HasSubstr("Embree"));
  // The same numbers, whatever the files.
  const std::vector<double> rows = all.read_lines(8, 4);
  EXPECT_EQ(rows, EnviImage(*folder_ / "capture/uas_0002.img").read_all());
  EXPECT_EQ(rows, EnviImage(*folder_ / "task/uas_out.img").read_lines(8, 4));
}

// No file held the flags, so nobody could see which pixels they were about.
TEST_F(SensorOutput, FlagsAreAnImageAndAreCounted) {
  // One scattering event a path: what the lit box sends to the ground is cut, in a ring around it.
  for (const char* files : {"capture", "task", "simulation"}) {
    const std::string out = std::string("flags_") + files, name = out == "flags_task" ? "uas_out" : "uas";
    std::string text = two_tasks(files);
    render("max_nodes: 1\n" + text, out);
    const std::string stem = out + (out == "flags_capture" ? "/uas_0001" : "/" + name);
    const EnviImage radiance(*folder_ / (stem + ".img")), quality(*folder_ / (stem + "_quality.img"));
    EXPECT_EQ(quality.header().type, EnviType::uint8);
    EXPECT_EQ(quality.header().bands, 1u);
    EXPECT_EQ(quality.header().lines, radiance.header().lines) << out;
    EXPECT_THAT(quality.header().description, HasSubstr("1 = heavy_tail: rare events"));
    const std::pair<std::string, std::string> bits{
        "quality bits", "{1 heavy_tail, 2 failures, 4 truncated, 8 unresolved, 16 clipped, 32 no_information}"};
    EXPECT_THAT(quality.header().extra, testing::Contains(bits));
    const std::vector<double> pixels = quality.read_all();
    const auto truncated = [](double q) { return (static_cast<int>(q) & 4) != 0; };
    EXPECT_GT(std::count_if(pixels.begin(), pixels.end(), truncated), 0) << "cut at the first node";
    if (std::string(files) != "simulation") continue;
    // All pixels of the run are in this image, so the log counts the same.
    const std::string log = read_text(*folder_ / (out + "/render.json"));
    EXPECT_THAT(log, HasSubstr(strf("\"pixels\": %zu", pixels.size())));
    EXPECT_THAT(log, HasSubstr(strf("\"truncated\": %ld,\n",
                                    static_cast<long>(std::count_if(pixels.begin(), pixels.end(), [](double q) {
                                      return static_cast<int>(q) & 4;
                                    })))));
  }
}

TEST_F(SensorOutput, PushBroomLinesAndLogsAndCounts) {
  render("sensors:\n" + kFlight +
             "    tasks: [{name: pass, start: 0, stop: 1}]\n    instruments:\n      - focal_length_mm: 50\n        "
             "f_number: 4\n        name: broom\n        arrays: [{columns: 9, pitch_um: 50, integration_time_s: 0.01, "
             "paths: 2, readout: {kind: line, line_rate_hz: 50, lines_per_capture: 7}, " +
             kBand +
             ", detector: {quantum_efficiency: 0.5, gain_e_per_dn: 10, bits: 12}}]\n      - {name: imu, kind: log, "
             "rate_hz: 10}\n",
         "broom");
  EXPECT_EQ(EnviImage(*folder_ / "broom/uas.img").header().lines, 50u);
  const EnviImage counts(*folder_ / "broom/uas_dn.img");
  EXPECT_EQ(counts.header().type, EnviType::uint16);
  EXPECT_EQ(counts.header().data_units, "DN");
  for (const double v : counts.read_all()) EXPECT_LE(v, 4095);
  EXPECT_TRUE(there("broom/uas_electrons.img"));
  const std::string log = read_text(*folder_ / "broom/uas_imu.csv");
  EXPECT_THAT(log, HasSubstr("# second 0 is 2026-06-21T10:30:00.000000Z"));
  EXPECT_THAT(log, HasSubstr(",5,100,1.000000000000,0.0000"));
}

// Counts at the end of the converter, or of a well that is full, looked like any others.
TEST_F(SensorOutput, ClippedCountsAreFlaggedAndTold) {
  const auto run = [](const std::string& detector, const std::string& out) {
    const CommandResult r =
        ProgramsTest::render(kLight + "sensors:\n" + kFlight +
                                 "    tasks: [{start: 1}]\n    instruments:\n      - {focal_length_mm: 50, f_number: "
                                 "4, arrays: [{columns: 8, "
                                 "rows: 8, pitch_um: 50, integration_time_s: 0.01, paths: 4, " +
                                 kBand + ", detector: {quantum_efficiency: 0.5, " + detector + "}}]}\n",
                             out);
    EXPECT_EQ(r.code, 0) << r.err;
    const std::vector<double> flags = EnviImage(*folder_ / (out + "/uas_quality.img")).read_all();
    return std::pair{r.err, std::count_if(flags.begin(), flags.end(), [](double q) { return int(q) & 16; })};
  };
  for (const auto& [detector, name] : {std::pair{"gain_e_per_dn: 1, bits: 8", "full_scale"},
                                       {"gain_e_per_dn: 1e5, full_well_e: 50", "full_well"},
                                       {"gain_e_per_dn: 1e-9", "fine_steps"}}) {
    const auto [said, clipped] = run(detector, name);
    EXPECT_EQ(clipped, 64) << name;
    EXPECT_THAT(said, HasSubstr("sensor 'uas': 64 of 64 pixels are clipped (100 %)"));
    EXPECT_THAT(said, HasSubstr("[DR113]"));
    EXPECT_THAT(read_text(*folder_ / (std::string(name) + "/render.json")), HasSubstr("\"clipped\": 64"));
  }
  // Room for all of it, and detectors that always give an end of the scale: nothing is clipped.
  for (const auto& [detector, name] : {std::pair{"gain_e_per_dn: 1e5, full_well_e: 1e12", "room"},
                                       {"gain_e_per_dn: 1e5, dead_fraction: 0.5, hot_fraction: 0.5", "bad"}}) {
    const auto [said, clipped] = run(detector, name);
    EXPECT_EQ(clipped, 0) << name;
    EXPECT_THAT(said, testing::Not(HasSubstr("clipped")));
  }
}

// Detectors that count write what they count; a run that was planned by noise is continued as it was planned.
TEST_F(SensorOutput, CountsAndPlansOfDetectorsThatCount) {
  const std::string text =
      kLight + "sensors:\n" + kFlight +
      "    tasks: [{start: 1}]\n    instruments:\n      - {focal_length_mm: 50, f_number: 4, arrays: [{columns: 16, "
      "rows: 8, pitch_um: 50, integration_time_s: 1.0e-9, paths: {min: 16, max: 4096, detector_noise: 0.1}, " +
      kBand + ", detector: {kind: spad, frames: 255, quantum_efficiency: 0.5, dark_rate_hz: 100}}]}\n";
  write_file(*folder_ / "counting.yaml", std::string_view(text));
  const CommandResult first = run("dirsig-render counting.yaml --state -o counting");
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_THAT(first.err, HasSubstr("10 % of the detectors' noise"));
  const EnviImage counts(*folder_ / "counting/uas_counts.img");
  EXPECT_EQ(counts.header().type, EnviType::uint16);
  for (const double v : counts.read_all()) EXPECT_LE(v, 255);
  EXPECT_TRUE(there("counting/uas_electrons.img"));
  EXPECT_FALSE(there("counting/uas_dn.img"));
  const std::vector<double> before = EnviImage(*folder_ / "counting/uas.img").read_all();
  EXPECT_EQ(run("dirsig-render counting.yaml --more 0 -o counting").code, 0);
  EXPECT_EQ(EnviImage(*folder_ / "counting/uas.img").read_all(), before);
  const CommandResult other = run("dirsig-render counting.yaml --more 0 --target-error 0.01 -o counting");
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, HasSubstr("planned by its detector's noise"));
  const CommandResult kinds = run("dirsig-render --list-image-detectors");
  EXPECT_EQ(kinds.code, 0);
  for (const std::string& kind : array_detectors().names()) EXPECT_THAT(kinds.out, HasSubstr(kind));
}

TEST_F(SensorOutput, TruthIsWhatIsThere) {
  render("sensors:\n" + kFlight +
             "    tasks: [{start: 0}]\n    truth: [material, tag, location, ecef, geodetic, range, incidence, "
             "view_angle, normal, temperature, sun_visibility, abundance, reflectance, nodes, time, state, "
             "material_fraction]\n    instruments:\n" +
             "      - {focal_length_mm: 50, arrays: [{columns: 50, rows: 20, pitch_um: 500, paths: 16, " + kBand +
             "}]}\n",
         "truth");
  const EnviImage image(*folder_ / "truth/uas_truth.img");
  const std::vector<std::string>& names = image.header().band_names;
  const std::vector<double> t = image.read_all();
  auto value = [&](size_t row, size_t column, const std::string& name) {
    const auto at = std::find(names.begin(), names.end(), name);
    EXPECT_NE(at, names.end()) << name;
    return t[(row * 50 + column) * names.size() + static_cast<size_t>(at - names.begin())];
  };
  // Pixels are 1 m. Column 14 looks at x = -10.5, row 10 at y = -0.5: bare ground in the sun.
  EXPECT_EQ(value(10, 14, "material"), 0);
  EXPECT_NEAR(value(10, 14, "east [m]"), -10.5, 0.1);
  EXPECT_NEAR(value(10, 14, "north [m]"), -0.5, 0.1);
  EXPECT_NEAR(value(10, 14, "incidence angle [deg]"), 45, 1e-9);
  EXPECT_NEAR(value(10, 14, "range [m]"), std::sqrt(10000 + 10.5 * 10.5 + 0.25), 0.05);
  EXPECT_NEAR(value(10, 14, "view angle [deg]"), std::atan(std::hypot(10.5, 0.5) / 100) * 180 / kPi, 0.05);
  EXPECT_EQ(value(10, 14, "normal up"), 1);
  EXPECT_EQ(value(10, 14, "sun visibility"), 1);
  EXPECT_EQ(value(10, 14, "mean nodes"), 1);
  EXPECT_NEAR(value(10, 14, "reflectance pan"), 0.2, 1e-6);
  EXPECT_TRUE(std::isnan(value(10, 14, "temperature [K]")));
  // The sun stands in the east: the board from x = 2 to 6, 3 m high, throws its shadow to x = -1.
  EXPECT_EQ(value(10, 25, "sun visibility"), 0);
  EXPECT_EQ(value(10, 30, "temperature [K]"), 300);
  EXPECT_NEAR(value(10, 30, "reflectance pan"), 0.8, 1e-6);
  EXPECT_NEAR(value(10, 30, "up [m]"), 3, 1e-9);
  EXPECT_EQ(value(10, 30, "share of tag board"), 1);
  EXPECT_EQ(value(10, 30, "material fraction"), 1);
  // Place on the Earth: the same point in all three frames.
  const SceneFrame frame({49, 8, 120});
  const Vec3 enu{value(10, 14, "east [m]"), value(10, 14, "north [m]"), value(10, 14, "up [m]")};
  EXPECT_LT(length(frame.ecef_from_enu(enu) -
                   Vec3{value(10, 14, "ecef x [m]"), value(10, 14, "ecef y [m]"), value(10, 14, "ecef z [m]")}),
            1e-6);
  const Geodetic g = frame.geodetic_from_enu(enu);
  EXPECT_NEAR(value(10, 14, "latitude [deg]"), g.latitude_deg, 1e-12);
  EXPECT_NEAR(value(10, 14, "height [m]"), g.height_m, 1e-6);
  // Column 0 looks past the ground's edge: nothing there.
  for (const char* n : {"material", "east [m]", "range [m]", "incidence angle [deg]", "latitude [deg]", "tag"})
    EXPECT_TRUE(std::isnan(value(10, 0, n))) << n;
  EXPECT_EQ(value(10, 0, "share of tag ground"), 0);
}

TEST_F(SensorOutput, MapsCarryTheirCoordinates) {
  render(
      "output: {also: [geotiff, exr], type: float64}\nsensors: [{kind: orthographic, columns: 40, rows: 30, gsd_m: "
      "0.5, center_m: [3, -2], paths: 4, " +
          kBand + "}]\n",
      "map");
  const EnviImage envi(*folder_ / "map/map.img");
  ASSERT_EQ(envi.header().map_info.size(), 9u);
  EXPECT_EQ(envi.header().map_info[3], "-7");   // west edge
  EXPECT_EQ(envi.header().map_info[4], "5.5");  // north edge
  const Raster tiff = read_raster(*folder_ / "map/map.tif"), exr = read_raster(*folder_ / "map/map.exr");
  ASSERT_EQ(exr.channels, 2u);
  const std::vector<double> flags = EnviImage(*folder_ / "map/map_quality.img").read_all();
  for (const char* file : {"map/map_quality.tif", "map/map_quality.exr"}) {
    const Raster also = read_raster(*folder_ / file);
    ASSERT_EQ(also.values.size(), flags.size()) << file;
    for (size_t i = 0; i < flags.size(); ++i) ASSERT_EQ(also.values[i], static_cast<float>(flags[i])) << file;
  }
  const std::vector<double> values = envi.read_all();
  for (size_t i = 0; i < values.size(); ++i) {
    ASSERT_EQ(tiff.values[i], static_cast<float>(values[i]));
    // The band as the picture that viewers show, and under its name.
    ASSERT_EQ(exr.values[2 * i], static_cast<float>(values[i]));
    ASSERT_EQ(exr.values[2 * i + 1], static_cast<float>(values[i]));
  }
  if (run_command("command -v gdalinfo").code != 0)
    GTEST_SKIP() << "gdalinfo (Debian package gdal-bin) is not installed";
  const CommandResult r = run_command("gdalinfo '" + (*folder_ / "map/map.tif") + "'");
  EXPECT_THAT(r.out, HasSubstr("Orthographic"));
  EXPECT_THAT(r.out, HasSubstr("Origin = (-7.0"));
  EXPECT_THAT(r.out, HasSubstr("Pixel Size = (0.5"));
}

TEST_F(SensorOutput, UnitsAndWholeNumbers) {
  const std::string sensors =
      "sensors: [{kind: orthographic, columns: 4, rows: 4, gsd_m: 0.5, center_m: [-10, 0], paths: 4, " + kBand + "}]\n";
  render(sensors, "plain");
  render("output: {units: W/(cm2 sr um)}\n" + sensors, "per_cm2");
  render("output: {units: photons/(s m2 sr um)}\n" + sensors, "photons");
  render("output: {type: uint16, scale: 0.01}\n" + sensors, "whole");
  const double L = 0.2 * 1000 * std::cos(45 * kDegree) / kPi;
  EXPECT_NEAR(EnviImage(*folder_ / "plain/map.img").read_all()[5] / L, 1, 1e-6);
  const EnviImage cm(*folder_ / "per_cm2/map.img"), photons(*folder_ / "photons/map.img"),
      whole(*folder_ / "whole/map.img");
  cm.require_units("W/(cm2 sr um)");
  EXPECT_NEAR(cm.read_all()[5] / L, 1e-4, 1e-9);
  photons.require_units("photons/(s m2 sr um)");
  EXPECT_NEAR(photons.read_all()[5] / (L * 0.6e-6 / (6.62607015e-34 * 299792458.0)), 1, 1e-6);
  EXPECT_EQ(whole.header().type, EnviType::uint16);
  EXPECT_EQ(whole.read_all()[5], std::round(L / 0.01));
}

TEST_F(SensorOutput, AnUnknownTruthIsNamed) {
  write_file(
      *folder_ / "bad.yaml",
      std::string_view(
          kLight +
          "sensors: [{kind: orthographic, columns: 4, rows: 4, gsd_m: 0.5, center_m: [0, 0], truth: [materiel], " +
          kBand + "}]\n"));
  const CommandResult r = run("dirsig-render bad.yaml -o bad");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("unknown truth 'materiel'; did you mean 'material'?"));
  EXPECT_FALSE(there("bad/map.img"));
}

// Stokes vectors: bands of their own, a frame that the header says, and what follows from them beside the image.
TEST_F(SensorOutput, StokesVectorsHaveBandsOfTheirOwn) {
  const std::string camera =
      "sensors:\n  - {kind: frame_camera, name: eye, columns: 4, rows: 3, pitch_um: 10, focal_length_mm: 10, "
      "position_m: "
      "[0, -30, 20], look_at_m: [0, 0, 0], paths: 16, " +
      kBand + ", ";
  render(camera + "stokes: linear, stokes_frame: image}\n", "stokes");
  const EnviHeader image = EnviImage(*folder_ / "stokes/eye.img").header();
  EXPECT_THAT(image.band_names, testing::ElementsAre("pan I", "pan Q", "pan U", "pan depolarised"));
  EXPECT_THAT(image.description, HasSubstr("+Q up in the picture"));
  const EnviHeader of = EnviImage(*folder_ / "stokes/eye_polarisation.img").header();
  EXPECT_THAT(of.band_names, testing::ElementsAre("pan dolp", "pan dolp_error", "pan dolp_debiased", "pan aolp",
                                                  "pan aolp_error", "pan aolp_undefined", "pan depolarised_share"));
  EXPECT_TRUE(there("stokes/eye_error.img"));
  const auto refused = [&](const std::string& text, const std::string& out) {
    const CommandResult r = ProgramsTest::render(kLight + text, out);
    EXPECT_NE(r.code, 0);
    return r.err;
  };
  EXPECT_THAT(refused("output: {type: uint16, scale: 0.1}\n" + camera + "stokes: linear}\n", "counts"),
              HasSubstr("Q, U and V have signs"));
  EXPECT_THAT(refused(camera + "stokes: linear, units: brightness_temperature}\n", "warm"),
              HasSubstr("Q, U and V are no light that has a temperature"));
  EXPECT_THAT(refused("atmosphere: {scene_height_m: 0}\n" + camera + "stokes: linear}\n", "air"),
              HasSubstr("sees polarisation, and the light of this air is known without it"));
  render("atmosphere: {profile: us_standard, scattering: single}\n" + camera + "stokes: linear}\n", "real_air");
  EXPECT_TRUE(there("real_air/eye_polarisation.img"));
}
// Grooves have no Mueller matrix: all of what is seen counts as depolarised, which is said.
TEST_F(SensorOutput, LightOfUnknownPolarisationIsToldOf) {
  prepare(
      "scene: 1\nmaterials:\n  ground: {model: oren_nayar, reflectance: 0.2, sigma: 0.3}\nobjects:\n  plane: {plane: "
      "{width: 40, depth: 40}, material: ground}\nworld:\n  - {place: plane}\n",
      "grooves");
  const std::string text =
      "scene: grooves.h5\nsun: {direction: {zenith_deg: 45, azimuth_deg: 90}, irradiance: 1000}\nsensors:\n  - "
      "{kind: orthographic, columns: 2, rows: 2, gsd_m: 1, center_m: [0, 0], paths: 16, stokes: linear, " +
      kBand + "}\n";
  write_file(*folder_ / "unknown.yaml", std::string_view(text));
  const CommandResult r = run("dirsig-render unknown.yaml -o unknown");
  EXPECT_EQ(r.code, 0);
  EXPECT_THAT(r.err, testing::AllOf(HasSubstr("[DR209]"), HasSubstr("100.0 % of the light")));
}

// Level ground under an endless wall whose top stands at an elevation e: (1 + cos e) / 2 of an even sky (J. R. Howell,
// R. Siegel, "Thermal Radiation Heat Transfer", differential element to a strip). A roof of slope s alone: (1 + cos s)
// / 2.
TEST_F(SensorOutput, TerrainIsAsOpenAsItsWallsLeaveIt) {
  prepare(
      "scene: 1\nmaterials: {g: {model: lambert, reflectance: 0.2}}\nobjects:\n  ground: {plane: {width: 60, depth: "
      "60}, "
      "material: g}\n  wall: {plane: {width: 20, depth: 100000}, material: g}\n  roof: {plane: {width: 12, depth: 12}, "
      "material: g}\nworld:\n  - {place: ground}\n  - {place: wall, rotate: {euler_deg: [0, 90, 0]}, translate: [20, "
      "0, "
      "10]}\n  - {place: roof, rotate: {euler_deg: [0, 30, 0]}, translate: [-4000, 0, 5]}\n",
      "wall");
  const auto truth = [&](const std::string& at, const std::string& out) {
    write_file(
        *folder_ / (out + ".yaml"),
        std::string_view("scene: wall.h5\nsky: {radiance: 1}\nsensors:\n  - {kind: orthographic, name: map, columns: "
                         "3, rows: 1, gsd_m: 2, center_m: " +
                         at + ", paths: 512, truth: [slope, aspect, sky_view], " + kBand + "}\n"));
    EXPECT_EQ(run("dirsig-render " + out + ".yaml -q -o " + out).code, 0);
    return EnviImage(*folder_ / (out + "/map_truth.img")).read_all();  // [pixel][band]
  };
  const std::vector<double> level = truth("[10, 0]", "level"), roof = truth("[-4000, 0]", "roof");
  for (size_t i = 0; i < 3; ++i) {
    const double away = 20 - (8 + 2 * static_cast<double>(i));
    EXPECT_NEAR(level[3 * i + 2], (1 + away / std::hypot(away, 20)) / 2, 0.02) << i;
    EXPECT_LT(level[3 * i], 1e-4);
    EXPECT_TRUE(std::isnan(level[3 * i + 1]));
    EXPECT_NEAR(roof[3 * i], 30, 1e-3);
    EXPECT_NEAR(roof[3 * i + 1], 90, 1e-3);
    EXPECT_NEAR(roof[3 * i + 2], (1 + std::cos(30 * kDegree)) / 2, 0.02);
  }
  EXPECT_GT(level[2] - level[8], 0.05);  // nearer to the wall there is less sky
}

}  // namespace
}  // namespace suite::sensor_output_test
