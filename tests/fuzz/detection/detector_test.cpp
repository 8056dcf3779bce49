// Damaged texts of detectors: detectors or one located Error; what was read detects a pulse, or why not is said.
#include "detection/detection.h"

#include <cctype>

#include "support/fuzz.h"
#include "support/response_kit.h"

namespace suite::detector_test {
namespace {

constexpr const char* kText = R"(seed: 3
pulse: {kind: table, time_ns: [0, 1, 3], power: [0, 2, 0]}
gate: {start_m: 980, stop_m: 1010, follow: {ahead_m: 20, behind_m: 8, pulses: 3}}
pulses_in_air: fold
detectors:
  - {kind: waveform, name: a, quantum_efficiency: 0.8, gain: 50, ionisation_ratio: 0.02, amplifier_noise_e: 80, receiver_fwhm_ns: 1,
     sample_ns: 1, bits: 12, gain_e_per_dn: 10, offset_dn: 100, recovery_ns: 5, returns: {by: gaussian, threshold_dn: 40, most: 4}}
  - {kind: linear, name: b, quantum_efficiency: 0.8, gain: 5, excess_noise: 3, receiver_fwhm_ns: 1, step_ns: 0.5,
     returns: {by: constant_fraction, threshold_e_per_ns: 30, fraction: 0.5, delay_ns: 2}}
  - {kind: geiger, name: c, mode: asynchronous, detection_efficiency: 0.3, dark_rate_hz: 2.0e4, dead_time_ns: 40, paralysable: true,
     afterpulse: {probability: 0.1, mean_ns: 20}, crosstalk: 0.01, jitter_tail: {share: 0.1, mean_ns: 1}}
  - {kind: photon_counting, name: d, detection_efficiency: 0.1, pixels_per_spot: 4, dead_time_ns: 3, resolution_ns: 1}
)";

DetectionSpec read(std::string_view text) {
  const Params p = Params::parse_text(text, "fuzz.yaml");
  DetectionSpec spec = read_detection(p, p, [](const Params& q) -> PulseTable { throw q.error("no files here"); });
  p.reject_unread();
  return spec;
}

TEST(FuzzDetection, Text) {
  const auto reading = [](std::span<const std::byte> bytes) {
    read({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  };
  test::fuzz(test::bytes_of(kText), reading, 1, 300,
             {"kind: geiger", "impulse", "1e300", "-1", "[]", "{}", "null", "all", "fold"});
}

// Every number in turn as something extreme: refused with a place, or a pulse is detected within five seconds (two on
// an idle machine); sanitizers take ten times as long.
#ifdef __SANITIZE_ADDRESS__
constexpr double kMostSeconds = 50;
#else
constexpr double kMostSeconds = 5;
#endif
TEST(FuzzDetection, ExtremeNumbers) {
  const std::string text = kText;
  const ResponseHead head = test::response_head();
  size_t refused = 0, detected = 0;
  for (size_t at = 0; at < text.size(); ++at) {
    if (!std::isdigit(text[at]) || (text[at - 1] != ' ' && text[at - 1] != '[')) continue;
    const size_t end = text.find_first_not_of("0123456789.e+-", at);
    for (const char* number : {"0", "1.0e-4", "1000000", "1.0e+30"}) {
      const std::string changed = text.substr(0, at) + number + text.substr(end);
      const double before = test::cpu_seconds();
      try {
        const DetectionSpec spec = read(changed);
        DetectionRun run(head, spec, [](DetectedPulse&&) {});
        run.take(test::response_block(head, 0, 2));
        run.finish();
        ++detected;
      } catch (const Error& e) {
        ++refused;
        EXPECT_FALSE(e.message().empty());
      }
      EXPECT_LT(test::cpu_seconds() - before, kMostSeconds) << text.substr(at - 20, 40) << " = " << number;
    }
  }
  std::printf("%zu refused, %zu detected\n", refused, detected);
  EXPECT_GT(refused, size_t{50});
  EXPECT_GT(detected, size_t{50});
}

}  // namespace
}  // namespace suite::detector_test
