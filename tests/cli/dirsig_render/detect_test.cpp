// --detect from a stored response to point clouds, waveforms and photons; what is refused, with exit codes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "detection/detection.h"
#include "formats/dirsig_bin/dirsig_bin.h"
#include "formats/hdf5/foreign.h"
#include "formats/las/las.h"
#include "formats/response/response_file.h"
#include "motion/map_system.h"
#include "scene/issues.h"
#include "support/response_kit.h"
#include "support/run_command.h"

namespace suite::detect_test {
namespace {

using testing::HasSubstr;

constexpr const char* kDetector = R"(
pulse: {kind: gaussian, fwhm_ns: 2}
detectors:
  - {kind: waveform, name: full, quantum_efficiency: 0.8, gain: 50, ionisation_ratio: 0.02, amplifier_noise_e: 80, receiver_fwhm_ns: 1,
     sample_ns: 0.5, bits: 12, gain_e_per_dn: 10, offset_dn: 100, returns: {by: gaussian, threshold_dn: 40}}
  - {kind: geiger, name: frames, mode: framed, detection_efficiency: 0.003, dark_rate_hz: 2.0e4}
output: [las, waveforms_h5, photons_h5, dirsig_bin, csv]
las: {packets: external}
csv: {pulse: 3}
)";
constexpr size_t kPulses = 40;
constexpr double kEast = 1e5;  // m: the flight is far from the scene's origin

class Detect : public testing::Test {
 protected:
  // A scene at 50 N 8 E; pulses run over midnight and a second that does not leap.
  void SetUp() override {
    ResponseHead head = test::response_head();
    head.epoch = Utc{2026, 11, 27, 23, 59, 59.98};
    ResponseWriter writer(folder_ / "r.h5", head, "a test");
    for (size_t p = 0; p < kPulses; p += 16)
      writer.take(test::response_block(head, p, std::min<size_t>(16, kPulses - p), 2000, kEast));
    writer.finish();
    write_file(folder_ / "d.yaml", kDetector);
  }
  CommandResult run(const std::string& arguments) {
    return run_command("cd '" + folder_.path() + "' && " SUITE_BIN_DIR "/dirsig-render " + arguments);
  }
  TempFolder folder_;
};

// Points within 1 mm and the noise of ranges of the surfaces that the response was made of: the ground at 0, a roof at
// 6 m (bins of 0.1 ns; middles lie half a bin behind 10 and 50 ns).
TEST_F(Detect, PointsWaveformsAndPhotons) {
  const CommandResult r = run("--detect r.h5 d.yaml -o out");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.err, HasSubstr("detector 'full': 80 returns of 40 pulses, 0 without any"));
  Report report(scene_issues());
  const PointCloud cloud = read_las(folder_ / "out/full.las", report);
  ASSERT_EQ(cloud.places.size(), 2 * kPulses);
  EXPECT_EQ(cloud.system, "EPSG:25832");
  const SceneFrame frame({50, 8, 100});
  double ground = 0, roof = 0;
  for (size_t k = 0; k < cloud.places.size(); ++k) {
    const Vec3 enu = frame.enu_from_utm({{32, true}, cloud.places[k].x, cloud.places[k].y, cloud.places[k].z});
    EXPECT_NEAR(enu.x, kEast + 2.0 * static_cast<double>(k / 2), 1e-3);
    EXPECT_NEAR(enu.y, 0, 1e-3);
    (k % 2 ? ground : roof) += enu.z / kPulses;
    EXPECT_NEAR(enu.z, k % 2 ? 0 : 6, 0.1);
  }
  const double half_bin = 0.05e-9 * kSpeedOfLight / 2;
  // 0.9 ns of system width and some 1600 and 400 electrons of excess noise 3: below 6 and 12 mm a point, 4 sigma of 40.
  EXPECT_NEAR(ground, -half_bin, 4 * 6e-3 / std::sqrt(kPulses) + 1e-3);
  EXPECT_NEAR(roof, 40e-9 * kSpeedOfLight / 2 - half_bin, 4 * 12e-3 / std::sqrt(kPulses) + 1e-3);
  const h5::Foreign waves(folder_ / "out/waveforms.h5"), photons(folder_ / "out/photons.h5");
  EXPECT_EQ(waves.table("/BEAM0000/shot_number").values.size(), kPulses);
  const std::vector<double> times = waves.table("/BEAM0000/delta_time").values;
  EXPECT_NEAR(times[0], 479859218.0 - 0.02, 1e-7);
  EXPECT_NEAR(times[39], 479859218.0 + 0.019, 1e-7);
  EXPECT_GT(photons.table("/gt1l/heights/h_ph").values.size(), size_t{30});
  const LidarBin bin = read_lidar_bin(folder_ / "out/photons.bin");
  ASSERT_EQ(bin.tasks[0].pulses.size(), kPulses);
  EXPECT_NEAR(bin.tasks[0].pulses[7].photons[501], 1500, 1e-9);
  EXPECT_TRUE(file_exists(folder_ / "out/full_pulse_3.csv"));
  EXPECT_THAT(read_text(folder_ / "out/full_pulse_3_returns.csv"), HasSubstr("tag:roof"));
  EXPECT_THAT(read_text(folder_ / "out/detect.json"), HasSubstr("\"points\": 80"));
}

// The same seed gives the same bytes, another seed other ones; a .bin of its own photons is detected again.
TEST_F(Detect, SeedsAndPhotonsOfDirsig) {
  ASSERT_EQ(run("--detect r.h5 d.yaml -o out -q").code, 0);
  ASSERT_EQ(run("--detect r.h5 d.yaml -o again -q --set output=las --set csv=null").code, 0);
  ASSERT_EQ(run("--detect r.h5 d.yaml -o other -q --seed 9 --set output=las --set csv=null").code, 0);
  const auto frames = [&](const std::string& from) {
    std::vector<std::byte> bytes = read_bytes(folder_ / (from + "/frames.las"));
    std::fill(bytes.begin() + 58, bytes.begin() + 90, std::byte{0});  // the command line
    return bytes;
  };
  EXPECT_EQ(frames("out"), frames("again"));
  EXPECT_NE(frames("out"), frames("other"));
  const CommandResult r = run("--detect out/photons.bin d.yaml -o bin --set output=las --set csv=null");
  ASSERT_EQ(r.code, 0) << r.err;
  Report report(scene_issues());
  const PointCloud a = read_las(folder_ / "out/full.las", report), b = read_las(folder_ / "bin/full.las", report);
  ASSERT_EQ(a.places.size(), b.places.size());
  for (size_t k = 0; k < a.places.size(); ++k) EXPECT_LT(length(a.places[k] - b.places[k]), 2e-3) << k;
}

// Nothing comes back: clouds of 0 points, waveforms of noise.
TEST_F(Detect, NothingComesBack) {
  const CommandResult r = run(
      "--detect r.h5 d.yaml -o out --set 'gate={start_m: 1500, stop_m: 1510}' --set detectors.frames.dark_rate_hz=0");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.err, HasSubstr("detector 'full': 0 returns of 40 pulses, 40 without any"));
  Report report(scene_issues());
  EXPECT_TRUE(read_las(folder_ / "out/full.las", report).places.empty());
  EXPECT_EQ(h5::Foreign(folder_ / "out/waveforms.h5").table("/BEAM0000/shot_number").values.size(), kPulses);
}

TEST_F(Detect, WhatIsRefused) {
  const auto refused = [&](const std::string& arguments, int code, const std::string& text) {
    const CommandResult r = run(arguments);
    EXPECT_EQ(r.code, code) << arguments << "\n" << r.err;
    EXPECT_THAT(r.err, HasSubstr(text)) << arguments;
  };
  refused("--detect r.h5 -o out", 2, "--detect wants the text of the detectors");
  refused("--detect r.h5 d.yaml -o out --paths 8", 2, "--paths is of renders");
  refused("--detect none.h5 d.yaml -o out", 1, "none.h5");
  refused("--detect d.yaml d.yaml -o out", 1, "is not an HDF5 file");
  refused("--detect r.h5 d.yaml -o out --set detectors.0.bits=17", 1, "--set detectors.0.bits");
  refused("--detect r.h5 d.yaml -o out --set gain=3", 1, "gain");
  refused("--detect r.h5 d.yaml -o out --set csv.pulse=40", 1, "pulses are 0 to 39");
  refused("--detect r.h5 d.yaml -o out --set las.epsg=2056", 1, "EPSG:2056 is no UTM zone");
  refused("--detect r.h5 d.yaml -o out --set 'pulse={kind: file, file: none.csv}'", 1, "none.csv");
  refused("--detect r.h5 d.yaml -o out --set 'gate={start_m: 0, stop_m: 1.0e+10}'", 1,
          "r.h5: error: pulse 0, detector 'full': a gate of");
  EXPECT_FALSE(file_exists(folder_ / "out/full.las"));
  const CommandResult kinds = run("--list-detectors");
  EXPECT_EQ(kinds.code, 0);
  for (const std::string& name : lidar_detectors().names()) EXPECT_THAT(kinds.out, HasSubstr(name));
}

// The cloud beside laspy, which shares nothing with the writer; SUITE_LASPY names a Python that has it.
TEST_F(Detect, ReadByLaspy) {
  const char* named = std::getenv("SUITE_LASPY");
  const std::string python = named ? named : "python3";
  if (run_command(python + " -c 'import laspy'").code != 0)
    GTEST_SKIP() << "no laspy; SUITE_LASPY names a Python with it";
  for (const std::string packets : {"external", "internal"}) {
    ASSERT_EQ(run("--detect r.h5 d.yaml -o " + packets + " -q --set las.packets=" + packets).code, 0);
    const CommandResult r = run_command(python + " -B " SUITE_SOURCE_DIR "/tests/cli/dirsig_render/read_las.py '" +
                                        (folder_ / packets) + "'");
    EXPECT_EQ(r.code, 0) << r.err << r.out;
    EXPECT_THAT(r.out, HasSubstr("80 points and 40 waveforms agree"));
  }
}

}  // namespace
}  // namespace suite::detect_test
