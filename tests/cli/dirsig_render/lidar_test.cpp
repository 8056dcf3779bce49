// Laser radars from the text to point clouds: places and times, beside passive sensors, surveys, presets; what is
// refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "base/files.h"
#include "formats/hdf5/foreign.h"
#include "formats/las/las.h"
#include "formats/response/response_file.h"
#include "motion/map_system.h"
#include "scene/issues.h"
#include "support/run_command.h"

namespace suite::lidar_test {
namespace {

using testing::HasSubstr;

// Everything is 100 km east of the scene's origin.
constexpr const char* kScene = R"(scene: 1
name: boxes
origin: {latitude_deg: 50, longitude_deg: 8, height_m: 100}
windows_um: [[0.5, 1.1]]
materials: {ground: {model: lambert, reflectance: 0.3}, roof: {model: lambert, reflectance: 0.5}}
objects:
  ground: {plane: {width: 400, depth: 400}, material: ground}
  house: {box: {x0: -5, y0: -5, z0: 0, x1: 5, y1: 5, z1: 6}, material: roof}
world:
  - {place: ground, translate: [100000, 0, 0]}
  - {place: house, tag: roof, translate: [100000, 0, 0]}
)";
constexpr const char* kSimulation = R"(scene: scene.h5
epoch: 2026-11-27T23:59:59.98Z
sensors:
  - kind: lidar
    name: als
    motion: {kind: straight, position_m: [100000, -15, 400], heading_deg: 0, speed_m_s: 60}
    tasks: [{start: 0, stop: 0.5}]
    laser: {wavelength_um: 1.064, pulse_energy_j: 2.0e-5, rate_hz: 800, pulse: {kind: gaussian, fwhm_ns: 4},
            beam: {kind: gaussian, full_angle_1_e2_mrad: 0.1}}
    receiver: {aperture_mm: 100, field_of_view_mrad: 1.5, filter_nm: 1}
    scanner: {kind: sweep, half_angle_deg: 3, rate_hz: 20}
    gate: {start_m: 385, stop_m: 410, bin_ns: 0.1}
    orders: 1
    paths: 8
    tags: [roof]
    detectors: [{kind: linear, name: points, quantum_efficiency: 0.8, receiver_fwhm_ns: 1, amplifier_noise_e_per_ns: 10,
                 returns: {by: gaussian, threshold_e_per_ns: 100}}]
)";

class Lidar : public testing::Test {
 protected:
  void SetUp() override {
    write_file(folder_ / "scene.yaml", kScene), write_file(folder_ / "sim.yaml", kSimulation);
    ASSERT_EQ(run_command("cd '" + folder_.path() + "' && " SUITE_BIN_DIR "/scene-prep scene.yaml -o scene.h5 -q").code,
              0);
  }
  CommandResult run(const std::string& arguments) {
    return run_command("cd '" + folder_.path() + "' && " SUITE_BIN_DIR "/dirsig-render " + arguments);
  }
  // GPS times of a cloud of point format 6.
  std::vector<double> times(const std::string& file) {
    const std::vector<std::byte> bytes = read_bytes(folder_ / file);
    const auto at = [&]<class T>(size_t offset, T) {
      T v;
      std::memcpy(&v, bytes.data() + offset, sizeof v);
      return v;
    };
    std::vector<double> all;
    for (uint64_t k = 0; k < at(247, uint64_t{}); ++k)
      all.push_back(at(at(96, uint32_t{}) + k * at(105, uint16_t{}) + 22, double{}));
    return all;
  }
  TempFolder folder_;
};

// 1e8 photons a pulse: their noise of range is below 0.1 mm, places are stored to 0.5 mm.
TEST_F(Lidar, PlacesAndTimes) {
  const CommandResult r = run("sim.yaml -o out");
  ASSERT_EQ(r.code, 0) << r.err;
  Report report(scene_issues());
  const PointCloud cloud = read_las(folder_ / "out/als/points.las", report);
  ASSERT_GT(cloud.places.size(), size_t{395});
  const SceneFrame frame({50, 8, 100});
  size_t roof = 0, ground = 0;
  for (const Vec3& place : cloud.places) {
    const Vec3 enu = frame.enu_from_utm({*utm_zone_of_epsg(32632), place.x, place.y, place.z});
    const bool inside = std::fabs(enu.x - 1e5) < 4.8 && std::fabs(enu.y) < 4.8;
    const bool outside = std::fabs(enu.x - 1e5) > 5.2 || std::fabs(enu.y) > 5.2;
    if (inside || outside) {
      EXPECT_NEAR(enu.z, inside ? 6 : 0, 2e-3);
    }
    roof += inside, ground += outside;
  }
  EXPECT_GT(roof, size_t{20});
  EXPECT_GT(ground, size_t{200});
  // Midnight is 479859218 s.
  const std::vector<double> gps = times("out/als/points.las");
  EXPECT_NEAR(gps.front(), 479859218.0 - 0.02, 1e-7);
  EXPECT_GT(gps.back(), 479859218.4);
  const ResponseReader stored(folder_ / "out/als_response.h5");
  EXPECT_EQ(stored.pulses(), 400u);
  EXPECT_EQ(stored.head().channels.size(), 3u);
  EXPECT_THAT(read_text(folder_ / "out/render.json"), HasSubstr("\"laser_radars\""));
}

// 2016 ended with a leap second: midnight UTC is 167264018 s, and the second before it lasts two.
TEST_F(Lidar, LeapSecond) {
  const CommandResult r =
      run("sim.yaml -o out -q --set epoch=2016-12-31T23:59:59.5Z --set 'sensors.als.tasks=[{start: 0, stop: 2}]' --set "
          "sensors.als.laser.rate_hz=2 --set sensors.als.scanner=null --set sensors.als.motion.speed_m_s=0");
  ASSERT_EQ(r.code, 0) << r.err;
  const std::vector<double> gps = times("out/als/points.las");
  ASSERT_EQ(gps.size(), size_t{4});
  for (size_t k = 0; k < 4; ++k) EXPECT_NEAR(gps[k], 167264016.5 + 0.5 * static_cast<double>(k), 1e-7);
}

// The same responses, detected later, give the same points; a camera beside it is rendered in the same run.
TEST_F(Lidar, DetectedAgainAndBesideACamera) {
  write_file(folder_ / "both.yaml",
             std::string(kSimulation) +
                 R"(  - {kind: orthographic, name: map, columns: 4, rows: 4, gsd_m: 5, center_m: [100000, 0], paths: 2,
     bands: [{name: red, center_um: 0.6, fwhm_um: 0.1}]}
sun: {direction: {zenith_deg: 30, azimuth_deg: 180}}
)");
  const CommandResult r = run("both.yaml -o out --set 'sensors.als.tasks=[{start: 0, pulses: 20}]'");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_TRUE(file_exists(folder_ / "out/map.img"));
  EXPECT_THAT(read_text(folder_ / "out/render.json"), HasSubstr("\"passive_light\": true"));
  write_file(folder_ / "d.yaml", R"(pulse: {kind: gaussian, fwhm_ns: 4}
detectors: [{kind: linear, name: points, quantum_efficiency: 0.8, receiver_fwhm_ns: 1, amplifier_noise_e_per_ns: 10,
             returns: {by: gaussian, threshold_e_per_ns: 100}}]
)");
  ASSERT_EQ(run("--detect out/als_response.h5 d.yaml -o again -q").code, 0);
  std::vector<std::byte> a = read_bytes(folder_ / "out/als/points.las"), b = read_bytes(folder_ / "again/points.las");
  for (auto* bytes : {&a, &b}) std::fill(bytes->begin() + 58, bytes->begin() + 90, std::byte{0});  // the command line
  EXPECT_EQ(a, b);
}

// Text of a fast survey without detectors, most of whose shots leave no scanner.
constexpr const char* kGaps = R"(scene: scene.h5
sensors:
  - kind: lidar
    name: als
    motion: {kind: straight, position_m: [100000, -15, 400], heading_deg: 0, speed_m_s: 60}
    tasks: [{start: 0, stop: 0.5}]
    laser: {wavelength_um: 1.064, pulse_energy_j: 2.0e-5, rate_hz: 80000, beam: {kind: gaussian, full_angle_1_e2_mrad: 0.1}}
    receiver: {aperture_mm: 100, field_of_view_mrad: 1.5, filter_nm: 1}
    scanner: {kind: sweep, half_angle_deg: 3, rate_hz: 20, from_deg: -1, to_deg: 2}
    gate: {start_m: 385, stop_m: 410, bin_ns: 1}
    orders: 1
    paths: 2
)";

// A run that is stopped is gone on with, to the same values; shots without a beam are in no block and in no number.
TEST_F(Lidar, InterruptedSurvey) {
  write_file(folder_ / "gaps.yaml", kGaps);
  ASSERT_EQ(run("gaps.yaml -o whole -q").code, 0);
  const ResponseReader whole(folder_ / "whole/als_response.h5");
  EXPECT_EQ(whole.pulses(), 20000u) << "half of the sweep is open";
  EXPECT_FALSE(whole.unfinished());
  EXPECT_EQ(run("gaps.yaml -o part --resume").code, 2) << "nothing to go on from";
  const auto left = [&] {
    const std::string path = folder_ / "part/als_response.unfinished.h5";
    return file_exists(path) ? ResponseReader(path).pulses() : 0;
  };
  for (int k = 0; k < 40 && left() == 0 && !file_exists(folder_ / "part/als_response.h5"); ++k)
    run_command("cd '" + folder_.path() + "' && { timeout -s INT " + std::to_string(0.03 + 0.02 * k) +
                " " SUITE_BIN_DIR "/dirsig-render gaps.yaml -o part -q; }");
  if (left() == 0) GTEST_SKIP() << "no signal came while pulses were traced";
  EXPECT_LT(left(), whole.pulses());
  const CommandResult other = run("gaps.yaml -o part --resume --seed 5");
  EXPECT_EQ(other.code, 1);
  EXPECT_THAT(other.err, HasSubstr("is of another run"));
  ASSERT_EQ(run("gaps.yaml -o part --resume -q").code, 0);
  EXPECT_FALSE(file_exists(folder_ / "part/als_response.unfinished.h5"));
  const ResponseReader joined(folder_ / "part/als_response.h5");
  ASSERT_EQ(joined.blocks(), whole.blocks());
  for (size_t b = 0; b < whole.blocks(); ++b) {
    const ResponseBlock one = whole.block(b), two = joined.block(b);
    EXPECT_EQ(one.bin, two.bin);
    EXPECT_EQ(one.value, two.value);
    EXPECT_EQ(one.variance, two.variance);
    EXPECT_EQ(one.skewness, two.skewness);
    EXPECT_EQ(one.begin, two.begin);
  }
  EXPECT_THAT(run("gaps.yaml -o part --resume").err, HasSubstr("was finished before"));
}

TEST_F(Lidar, Refused) {
  const auto refused = [&](const std::string& arguments, int code, const std::string& text) {
    const CommandResult r = run(arguments);
    EXPECT_EQ(r.code, code) << arguments << "\n" << r.err;
    EXPECT_THAT(r.err, HasSubstr(text)) << arguments;
  };
  for (const std::string option : {"--time 1s", "--state", "--part 1/2 --state", "--study s"})
    refused("sim.yaml -o out " + option, 2, "does not go with laser radars");
  for (const std::string option : {"--target-error 1%", "--view v.html", "--stop plan"})
    refused("sim.yaml -o out " + option, 2, "is of images");
  refused("sim.yaml -o out --paths 4,8", 2, "--paths of laser radars is one number");
  refused("sim.yaml -o out --set 'sensors.als.tags=[rooof]'", 1, "the scene has no tag and no material 'rooof'");
  refused("sim.yaml -o out --set sensors.als.beam=3", 1, "unknown key 'beam'");
  refused("sim.yaml -o out --set 'sensors.als.las={scales: 3}'", 1, "unknown key 'scales'");
  refused("sim.yaml -o out --set sensors.als.detectors=null --set 'sensors.als.output=[las]'", 1,
          "belongs to detectors");
  refused("sim.yaml -o out --set 'sensors.als.output=[waveforms_h5]'", 1, "no detector has any");
  refused("sim.yaml -o out --set sensors.als.laser.rate_hz=400000", 1, "unambiguous range 374.741 m");
  refused("sim.yaml -o out --set 'periodic={origin_m: [0, 0], size_m: [9, 9]}'", 1, "is not traced for laser radars");
  refused(
      "sim.yaml -o out --set 'sensors.als.receiver={aperture_mm: 100, array: {columns: 200, rows: 200, pitch_um: 50, "
      "focal_length_mm: 400}}'",
      1, "samples of all pixels");
  EXPECT_FALSE(file_exists(folder_ / "out")) << "before a pulse is traced";
  const CommandResult dry = run("sim.yaml -o out --dry-run");
  EXPECT_EQ(dry.code, 0) << dry.err;
  EXPECT_THAT(dry.out, HasSubstr("laser radar 'als': 400 pulses"));
  EXPECT_FALSE(file_exists(folder_ / "out"));
  const CommandResult kinds = run("--list-deflectors");
  EXPECT_THAT(kinds.out, HasSubstr("rotating_head"));
}

// Every preset is a sensor that can be rendered.
TEST_F(Lidar, Presets) {
  const std::string list = run("--lidar-presets").out;
  size_t presets = 0;
  for (size_t at = 0; at < list.size(); at = list.find('\n', at) + 1, ++presets) {
    const std::string name = list.substr(at, list.find(' ', at) - at);
    const CommandResult text = run("--lidar-preset " + name);
    ASSERT_EQ(text.code, 0) << name;
    EXPECT_THAT(text.out, HasSubstr("# Source: "));
    write_file(folder_ / "p.yaml", "scene: scene.h5\nsensors:\n" + text.out);
    const CommandResult dry = run("p.yaml --dry-run -o p");
    EXPECT_EQ(dry.code, 0) << name << "\n" << dry.err;
    EXPECT_THAT(dry.out, HasSubstr("laser radar '" + name + "'"));
  }
  EXPECT_EQ(presets, size_t{9});
  EXPECT_THAT(run("--lidar-preset vlp_61").err, HasSubstr("did you mean 'vlp_16'"));
}

// Satellites move on by some 20 m while a pulse is under way: receivers of presets are aligned with where it comes
// back.
TEST_F(Lidar, PresetsInOrbitSeeTheirOwnFootprint) {
  write_file(folder_ / "wide.yaml", R"(scene: 1
name: wide
windows_um: [[0.5, 1.1]]
materials: {ground: {model: lambert, reflectance: 0.3}}
objects: {ground: {plane: {width: 2000, depth: 2000}, material: ground}}
world: [{place: ground}]
)");
  ASSERT_EQ(run_command("cd '" + folder_.path() + "' && " SUITE_BIN_DIR "/scene-prep wide.yaml -o wide.h5 -q").code, 0);
  const auto photons = [&](const std::string& name, const std::string& with) {
    const CommandResult r = run(
        "p.yaml -q -o " + name +
        " --set 'sensors.0.tasks=[{start: 0, pulses: 4}]' --set sensors.0.orders=1 --set sensors.0.paths=64 " + with);
    EXPECT_EQ(r.code, 0) << r.err;
    double sum = 0;
    ResponseReader(folder_ / (name + "/" + name + "_response.h5")).for_each_block([&](const ResponseBlock& b) {
      const size_t channels = b.entries() ? b.value.size() / b.entries() : 0;
      for (size_t k = 0; k < b.entries(); ++k)
        if (b.bin[k] > 0) sum += b.value[k * channels];  // of single scattering; bin 0 holds passive light
    });
    return sum;
  };
  for (const std::string name : {"gedi_like", "icesat2_like", "calipso_like"}) {
    write_file(folder_ / "p.yaml", "scene: wide.h5\nsensors:\n" + run("--lidar-preset " + name).out);
    const double all = photons(name, "--set sensors.0.receiver.field_of_view_mrad=0.5");
    EXPECT_GT(photons(name, ""), 0.9 * all) << name;
    EXPECT_LT(photons(name, "--set 'sensors.0.receiver.place={rotate_deg: [0, 0, 0]}'"), 0.85 * all)
        << name << ", straight down";
  }
}

// A survey of HELIOS++ over a plane: every shot comes back from it.
TEST_F(Lidar, Survey) {
  write_file(folder_ / "s.xml", R"(<document>
<platform id="plane" type="linearpath"><scannerMount z="0.7"><rot axis="x" angle_deg="-90"/><rot axis="z" angle_deg="90"/></scannerMount></platform>
<scanner id="galvo" optics="oscillating" beamDivergence_rad="0.0003" pulseFreqs_Hz="83000" pulseLength_ns="4" rangeMin_m="80" rangeMax_m="150" scanAngleMax_deg="37.5" accuracy_m="0.05"/>
<scene id="s" name="s"><part id="ground"><filter type="objloader"><param type="string" key="filepath" value="plane.obj"/></filter></part></scene>
<survey name="a" scene="s.xml#s" platform="#plane" scanner="#galvo">
<leg><platformSettings x="0" y="0" z="100" movePerSec_m="50"/><scannerSettings pulseFreq_hz="100" scanFreq_hz="10" scanAngle_deg="20"/></leg>
<leg><platformSettings x="0" y="25" z="100"/><scannerSettings active="false"/></leg></survey></document>
)");
  write_file(folder_ / "plane.obj", "v -500 -500 0\nv 500 -500 0\nv 500 500 0\nv -500 500 0\nf 1 2 3 4\n");
  const CommandResult r = run("s.xml -o out --paths 2");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.err, HasSubstr("accuracy_m = \"0.05\" is not used"));
  Report report(scene_issues());
  const PointCloud cloud = read_las(folder_ / "out/leg_00/returns.las", report);
  ASSERT_EQ(cloud.places.size(), size_t{50});
  for (const Vec3& p : cloud.places) {
    EXPECT_NEAR(p.z, 0, 0.01);
    EXPECT_LE(std::fabs(p.x), 100.7 * std::tan(20.01 * kDegree));
  }
  EXPECT_EQ(run("s.xml -o strict --strict").code, 1);
  EXPECT_EQ(run("s.xml --convert text -q").code, 0);
  EXPECT_THAT(read_text(folder_ / "text/s.yaml"), HasSubstr("kind: lidar"));
}

}  // namespace
}  // namespace suite::lidar_test
