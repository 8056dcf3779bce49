// Damaged texts of laser radars: an instrument whose first and last pulses have poses, or one located Error.
#include "lidar/lidar_text.h"

#include <cctype>

#include "lidar/pulse_train.h"
#include "support/fuzz.h"

namespace suite::lidar_text_test {
namespace {

constexpr const char* kText = R"(kind: lidar
name: als
position_m: [0, 0, 100]
look_at_m: [10, 0, 0]
attachments: [{offset_m: [0, 0, 1], rotate_deg: [1, 2, 3], mount: {kind: whisk, amplitude_deg: 2, rate_hz: 3}}]
laser: {wavelength_um: 1.064, pulse_energy_j: 1.5e-4, rate_hz: 1000, burst: {pulses: 3, rate_hz: 30000}, stokes: [1, 0, 0, 0],
        beam: {kind: gaussian, waist_mm: 2, m2: 2}, place: {offset_m: [0, 1, 0]}}
receiver: {aperture_mm: 150, obscuration: 0.2, throughput: 0.9, array: {columns: 4, rows: 2, pitch_um: 50, focal_length_mm: 400}, scan_lag: true}
scanner: {kind: rotating_head, rotation_hz: 10, elevations_deg: [-15, 0, 15], firing_us: [0, 2, 4]}
gate: {start_m: 9, stop_m: 110, bin_ns: 0.5}
tasks: [{start: 0, stop: 1}, {start: 2, pulses: 5}]
pulses_in_air: unfold
detectors: []
paths: 32
orders: 4
)";

void read_and_use(std::string_view text) {
  SensorContext c;
  c.track = [](const Params& p) -> TrackPtr { throw p.error("no motions here"); };
  c.position = [](const Params& p) {
    const auto [x, y, z] = p.at("position_m").as_vec3();
    return Vec3{x, y, z};
  };
  c.time = [](const Params& p) { return p.as_number(); };
  const LidarInstrument i = read_lidar(Params::parse_text(text, "fuzz.yaml"), c);
  EXPECT_TRUE(fault_of(i).empty());
  ASSERT_GT(i.pulses->size(), uint64_t{0});
  for (const uint64_t k : {uint64_t{0}, i.pulses->size() - 1})
    if (const auto pulse = i.pulses->pulse(k, 1e-6)) {
      EXPECT_TRUE(finite(pulse->emission.translation) && finite(pulse->reception.vector({0, 0, -1})));
    }
}

TEST(FuzzLidar, Text) {
  const auto reading = [](std::span<const std::byte> bytes) {
    read_and_use({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  };
  test::fuzz(test::bytes_of(kText), reading, 1, 400,
             {"kind: galvo", "divergence", "1e300", "-1", "[]", "{}", "null", "fixed", "motion: {}"});
}

// Every number in turn as something extreme: refused with a place, or read within half a second.
TEST(FuzzLidar, ExtremeNumbers) {
  const std::string text = kText;
  size_t refused = 0, taken = 0;
  for (size_t at = 0; at < text.size(); ++at) {
    if (!std::isdigit(text[at]) || (text[at - 1] != ' ' && text[at - 1] != '[')) continue;
    const size_t end = text.find_first_not_of("0123456789.e+-", at);
    for (const char* number : {"0", "-1", "1.0e-9", "1000000", "1.0e+30"}) {
      const double before = test::cpu_seconds();
      try {
        read_and_use(text.substr(0, at) + number + text.substr(end));
        ++taken;
      } catch (const Error& e) {
        ++refused;
        EXPECT_FALSE(e.where().file.empty()) << e.message();
      }
      EXPECT_LT(test::cpu_seconds() - before, 0.5) << text.substr(at - 20, 40) << " = " << number;
    }
  }
  std::printf("%zu refused, %zu taken\n", refused, taken);
  EXPECT_GT(refused, size_t{50});
  EXPECT_GT(taken, size_t{50});
}

}  // namespace
}  // namespace suite::lidar_text_test
