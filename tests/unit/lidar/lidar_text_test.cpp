// The text of a laser radar: what it becomes, and what is refused, with its line.
#include "lidar/lidar_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lidar/pulse_train.h"
#include "spectral/planck.h"

namespace suite::lidar_text_test {
namespace {

using testing::HasSubstr;

constexpr const char* kText = R"(kind: lidar
name: als
motion: {speed: 60}
laser:
  wavelength_um: 1.064
  pulse_energy_j: 1.5e-4
  rate_hz: 100000
  beam: {kind: gaussian, full_angle_1_e2_mrad: 0.5}
receiver: {aperture_mm: 150, throughput: 0.9, field_of_view_mrad: 0.8, filter_nm: 1}
scanner: {kind: galvo, half_angle_deg: 15, rate_hz: 50}
gate: {start_m: 900, stop_m: 1100, bin_ns: 0.5}
tasks: [{start: 0, stop: 1}]
)";

SensorContext context() {
  SensorContext c;
  c.track = [](const Params& p) { return straight_track({{0, 0, 1000}, kPi / 2, 0, p.number("speed"), 0, nullptr}); };
  c.position = [](const Params& p) {
    const auto [x, y, z] = p.at("position_m").as_vec3();
    return Vec3{x, y, z};
  };
  c.time = [](const Params& p) { return p.as_number(); };
  return c;
}

LidarInstrument read(const std::string& text, std::vector<std::string> settings = {}) {
  std::vector<Where> origins;
  int line = 0;
  for (const char c : text + "\n")
    if (c == '\n') origins.push_back({"sim.yaml", ++line, 1, {}, -1});
  const Params p = Params::parse_made(text, "sim.yaml", origins, settings);
  LidarInstrument i = read_lidar(p, context());
  p.reject_unread();
  return i;
}

void refused(std::vector<std::string> settings, const std::string& what, const std::string& hint = "") {
  try {
    read(kText, settings);
    ADD_FAILURE() << settings[0] << " is taken";
  } catch (const Error& e) {
    EXPECT_THAT(e.message(), HasSubstr(what)) << settings[0];
    EXPECT_THAT(e.hint(), HasSubstr(hint)) << settings[0];
    EXPECT_FALSE(e.where().file.empty()) << settings[0];
  }
}

TEST(LidarText, WhatItBecomes) {
  const LidarInstrument i = read(kText);
  EXPECT_EQ(i.name, "als");
  EXPECT_EQ(i.laser.beam.kind, BeamProfile::Kind::gaussian);
  EXPECT_DOUBLE_EQ(i.laser.beam.full_angle_1_e2, 5e-4);
  EXPECT_DOUBLE_EQ(i.receiver.aperture, 0.15);
  EXPECT_DOUBLE_EQ(i.receiver.field_of_view, 8e-4);
  EXPECT_DOUBLE_EQ(i.receiver.filter_um, 1e-3);
  EXPECT_NEAR(i.gate.start, 1800 / kSpeedOfLight, 1e-18);
  EXPECT_NEAR(i.gate.bin, 5e-10, 1e-20);
  EXPECT_EQ(i.pulses->size(), 100000u);  // up to the stop, without it
  EXPECT_DOUBLE_EQ(i.pulses->pulse(3)->energy, 1.5e-4);
  EXPECT_DOUBLE_EQ(i.pulses->pulse(3)->start, i.gate.start);
  EXPECT_TRUE(fault_of(i).empty());
}

TEST(LidarText, OtherWays) {
  EXPECT_EQ(read(kText, {"tasks=[{start: 1, pulses: 7}, {start: 3, stop: 3}]"}).pulses->size(), 8u);
  EXPECT_NEAR(read(kText, {"gate={start_ns: 10, stop_m: 30}"}).gate.start, 1e-8, 1e-20);
  // 2 M2 wavelength / (pi waist)
  EXPECT_NEAR(read(kText, {"laser.beam={kind: gaussian, waist_mm: 2, m2: 1.5}"}).laser.beam.full_angle_1_e2,
              3 * 1.064e-6 / (kPi * 2e-3), 1e-12);
  EXPECT_DOUBLE_EQ(read(kText, {"laser.beam={kind: top_hat, half_angle_mrad: 8}"}).laser.beam.half_angle, 8e-3);
  EXPECT_DOUBLE_EQ(read(kText, {"laser.average_power_w=15", "laser.pulse_energy_j=null"}).pulses->pulse(0)->energy,
                   1.5e-4);
  const LidarInstrument array =
      read(kText, {"receiver={aperture_mm: 100, array: {columns: 32, rows: 8, pitch_um: 50, focal_length_mm: 400}}"});
  EXPECT_EQ(array.receiver.columns * array.receiver.rows, 256u);
  const LidarInstrument still =
      read(kText, {"motion=null", "position_m=[0, 0, 2]", "look_at_m=[10, 0, 2]", "scanner=null"});
  EXPECT_LT(length(still.pulses->pulse(0)->emission.vector({0, 0, -1}) - Vec3{1, 0, 0}), 1e-9);
}

TEST(LidarText, Refused) {
  refused({"laser.beam={kind: gaussian, divergence: 0.5}"}, "which angle", "full_angle_1_e2_mrad");
  refused({"laser.beam_divergence_mrad=1"}, "which angle", "half_angle_mrad");
  refused({"laser.beam={kind: gaussian}"}, "full_angle_1_e2_mrad");
  refused({"laser.rate_khz=3"}, "unknown key 'rate_khz'", "rate_hz");
  refused({"laser.pulse_energy_j=null"}, "pulse_energy_j");
  refused({"laser.average_power_w=3"}, "exclude each other");
  refused({"laser.stokes=[1, 0.5, 0, 0]", "start_from=laser"}, "begin at the receiver");
  refused({"receiver.analysers=[linear_0, linear_30]"}, "linear_30", "linear_0");
  refused({"receiver.analysers=[linear_0, linear_0]"}, "twice");
  refused({"laser.stokes=[1, 1, 1, 0]"}, "no light");
  refused({"receiver.aperture_mm=0"}, "outside");
  refused({"receiver.array={columns: 4, rows: 4, pitch_um: 50, focal_length_mm: 400}"}, "exclude each other");
  refused({"gate={start_m: 900, start_ns: 3, stop_m: 1100}"}, "exclude each other");
  refused({"gate={stop_m: 1100}"}, "'start_m' is missing", "start_ns");
  refused({"gate={start_m: 1100, stop_m: 900}"}, "the gate must start");
  refused({"gate={start_m: 0, stop_m: 1400000, bin_ns: 0.0001}"}, "range bins, at most 1e8");
  refused({"scanner={kind: galva}"}, "galva");
  refused({"scanner={kind: rotating_head, rotation_hz: 10, elevations_deg: [0, 1], firing_us: [0, 11]}"},
          "channel 1 fires", "lower rate_hz");
  refused({"tasks=[{start: 0, stop: 1}, {start: 0.5, stop: 2}]"}, "before the last one ends");
  refused({"tasks=[{start: 2, stop: 1}]"}, "stops before it starts");
  refused({"tasks=[{start: 0, stop: 1e9}]"}, "pulses in one task");
  refused({"scanner={kind: flash, columns: 4096, rows: 4096, pitch_um: 10, focal_length_mm: 100}"},
          "of all tasks and channels");
  refused({"tasks=[]"}, "at least one task");
  refused({"paths=1"}, "outside");
  refused({"start_from=camera"}, "camera");
  refused({"motion=null"}, "'motion' is missing", "look_at_m");
  refused({"laser.burst={pulses: 3, rate_hz: 1.0e+5}"}, "longer than");
}

// Light that comes after the next pulse is folded by the user's word, or refused where it could come.
TEST(LidarText, Ambiguity) {
  const std::string far = "gate={start_m: 900, stop_m: 1600}";  // 1498.96 m at 100 kHz
  EXPECT_NO_THROW(read(kText, {far}));                          // responses keep the pulse that light belongs to
  for (const char* how : {"fold", "unfold", "refuse"}) {
    const std::string text = std::string(kText) + "detectors: [{kind: geiger}]\npulses_in_air: " + how + "\n";
    const std::vector<std::string> set{far};
    EXPECT_NO_THROW(read_lidar(Params::parse_made(text, "t.yaml", std::vector<Where>(20), set), context())) << how;
  }
  refused({far, "detectors=[{kind: geiger}]"}, "unambiguous range 1498.96 m", "fold");
  const std::string heads = "scanner={kind: line_array, lasers: 3, spacing_deg: 1}";
  refused({heads, "detectors=[{kind: geiger}]", "pulses_in_air=fold"}, "not folded");
}

}  // namespace
}  // namespace suite::lidar_text_test
