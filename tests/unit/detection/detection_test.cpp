// The stage: every kind of detector over responses, the ideal beside the noisy, order and blocks, faults, GPS time.
#include "detection/detection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "math/stats.h"
#include "support/message_of.h"
#include "support/response_kit.h"

namespace suite::detection_test {
namespace {

using namespace test;
using testing::HasSubstr;

constexpr const char* kAll = R"(
pulse: {kind: gaussian, fwhm_ns: 2}
detectors:
  - {kind: waveform, name: full, quantum_efficiency: 0.8, gain: 50, ionisation_ratio: 0.02, amplifier_noise_e: 80, receiver_fwhm_ns: 1,
     sample_ns: 0.5, bits: 12, gain_e_per_dn: 10, offset_dn: 100, returns: {by: gaussian, threshold_dn: 40}}
  - {kind: linear, name: edge, quantum_efficiency: 0.8, gain: 50, excess_noise: 3, amplifier_noise_e_per_ns: 80, receiver_fwhm_ns: 1,
     returns: {by: threshold, threshold_e_per_ns: 3000, hysteresis_e_per_ns: 1000}}
  - {kind: geiger, name: frames, mode: framed, detection_efficiency: 0.3, dark_rate_hz: 2.0e4}
  - {kind: photon_counting, name: photons, detection_efficiency: 0.3, pixels_per_spot: 16, dead_time_ns: 3}
)";

DetectionSpec spec_of(const std::string& text) {
  const Params p = Params::parse_text(text, "d.yaml");
  DetectionSpec s = read_detection(p, p, [](const Params& q) -> PulseTable { throw q.error("no files here"); });
  p.reject_unread();
  return s;
}

struct Seen {
  std::vector<std::vector<double>> times;  // of each detector, all returns
  std::vector<std::vector<double>> ideal;
  std::vector<RunningStats> sums{4};  // of samples less ideal ones
};
Seen run(const DetectionSpec& spec, size_t block, size_t pulses, double photons = 400) {
  const ResponseHead head = response_head();
  Seen seen{std::vector<std::vector<double>>(spec.detectors.size()),
            std::vector<std::vector<double>>(spec.detectors.size())};
  DetectionRun stage(head, spec, [&](DetectedPulse&& p) {
    for (const PixelRecord& r : p.records) {
      for (const LidarReturn& one : r.returns) seen.times[p.detector].push_back(one.time - p.pulse().start);
      for (const LidarReturn& one : r.ideal_returns) seen.ideal[p.detector].push_back(one.time - p.pulse().start);
      double sum = 0;
      if (spec.detectors[p.detector]->sample_unit() == "counts")
        for (size_t k = 0; k < r.samples.size(); ++k) sum += r.samples[k] - r.ideal_samples[k];
      seen.sums[p.detector].add(sum);
    }
  });
  for (size_t p = 0; p < pulses; p += block) stage.take(response_block(head, p, std::min(block, pulses - p), photons));
  stage.finish();
  return seen;
}

TEST(Detection, EveryKindFindsRoofAndGround) {
  const DetectionSpec spec = spec_of(kAll);
  constexpr size_t kPulses = 60;
  const Seen seen = run(spec, 7, kPulses, 2000);
  const double roof = 10.05e-9, ground = 50.05e-9;
  ASSERT_EQ(seen.times[0].size(), 2 * kPulses);  // Gaussians
  RunningStats first, second;
  for (size_t k = 0; k < seen.times[0].size(); k += 2) first.add(seen.times[0][k]), second.add(seen.times[0][k + 1]);
  EXPECT_NEAR(first.mean(), roof, 4 * first.stderr_of_mean());
  EXPECT_NEAR(second.mean(), ground, 4 * second.stderr_of_mean());
  ASSERT_EQ(seen.times[1].size(), 2 * kPulses);  // edges come before their peaks
  EXPECT_LT(seen.times[1][1], ground);
  // -sigma sqrt(2 ln(A / level)), peak A of 60 000 e through a FWHM of sqrt(5) ns.
  const double sigma = std::sqrt(5.0) / kFwhmOfDeviation, peak = 60000 / (sigma * std::sqrt(2 * kPi));
  EXPECT_NEAR((seen.ideal[1][1] - ground) * 1e9, -sigma * std::sqrt(2 * std::log(peak / 3000)), 6e-3);
  EXPECT_NEAR(seen.ideal[0][0], roof, 2e-12);
  EXPECT_NEAR(seen.ideal[0][1], ground, 2e-12);
  EXPECT_LE(seen.times[2].size(), kPulses);       // one count a gate
  EXPECT_GT(seen.times[3].size(), 20 * kPulses);  // of 600 primaries
  // Noise is about the ideal: 4 sigma, and not about 1 % beside it.
  EXPECT_NEAR(seen.sums[0].mean(), 0, 4 * seen.sums[0].stderr_of_mean());
}

TEST(Detection, BlocksAndOrderDoNotMatter) {
  const DetectionSpec spec = spec_of(kAll);
  const Seen a = run(spec, 1, 9), b = run(spec, 4, 9), c = run(spec, 9, 9);
  EXPECT_EQ(a.times, b.times);
  EXPECT_EQ(a.times, c.times);
  DetectionSpec other = spec_of(kAll);
  other.seed = 2;
  EXPECT_NE(run(other, 4, 9).times, a.times);
}

// Electrons of the front end: mean and variance M^2 F N and of the amplifier, in counts; 4 sigma.
TEST(Detection, NoiseOfTheDigitiser) {
  const DetectionSpec spec = spec_of(
      "{pulse: {kind: gaussian, fwhm_ns: 2}, detectors: [{kind: waveform, quantum_efficiency: 1, dark_rate_hz: 2.0e10, "
      "gain: 10, "
      "excess_noise: 3.52, amplifier_noise_e: 30, sample_ns: 1, bits: 14, gain_e_per_dn: 2, offset_dn: 200}]}");
  RunningStats counts;
  const ResponseHead head = response_head();
  DetectionRun stage(head, spec, [&](DetectedPulse&& p) {
    const PixelRecord& r = p.records[0];
    for (size_t k = 150; k < 200; ++k) counts.add(r.samples[k]);
    EXPECT_NEAR(r.ideal_samples[170], 200 + 20.1 * 10 / 2, 1e-9);  // 20 dark and 0.1 passive primaries
  });
  stage.take(response_block(head, 0, 200));
  stage.finish();
  const double n = 20.1, variance = (n * 100 * 3.52 + 900) / 4 + 1.0 / 12, total = static_cast<double>(counts.n());
  EXPECT_NEAR(counts.mean(), 200 + n * 10 / 2, 4 * std::sqrt(variance / total));
  EXPECT_NEAR(counts.variance(), variance, 4 * 1.3 * variance * std::sqrt(2 / total));
  EXPECT_GT(std::fabs(counts.variance() - (n * 100 + 900) / 4), 4 * 1.3 * variance * std::sqrt(2 / total));  // F = 1
}

// A retro-reflector, 1e6 times a matte plate: the converter is at its end, and stays there while it recovers.
TEST(Detection, SaturationAndRecovery) {
  const DetectionSpec spec = spec_of(
      "{pulse: {kind: gaussian, fwhm_ns: 2}, detectors: [{kind: waveform, quantum_efficiency: 0.8, gain: 50, "
      "sample_ns: 1, bits: 8, "
      "gain_e_per_dn: 10, offset_dn: 20, recovery_ns: 15}]}");
  const ResponseHead head = response_head();
  size_t full = 0, last = 0;
  DetectionRun stage(head, spec, [&](DetectedPulse&& p) {
    for (size_t k = 0; k < p.records[0].samples.size(); ++k)
      if (p.records[0].samples[k] == 255) ++full, last = k;
    EXPECT_GT(p.records[0].ideal_samples[50], 1e6);
  });
  stage.take(response_block(head, 0, 1, 4e8));
  stage.finish();
  EXPECT_GT(last, size_t{50 + 15});
  EXPECT_LT(last, size_t{50 + 15 + 10});
  EXPECT_GT(full, size_t{20});
}

// A scan that goes one way jumps from high to low ground at the ends of its lines, and back: a gate that follows loses
// the first pulse behind each jump, which it counts, and no others. (It stayed where it had been for good.)
TEST(Detection, AFollowingGateFindsTheGroundAgain) {
  const DetectionSpec spec = spec_of(
      "{pulse: {kind: gaussian, fwhm_ns: 2}, gate: {start_m: 900, stop_m: 1200, follow: {ahead_m: 15, behind_m: 15, "
      "pulses: 3}}, detectors: [{kind: linear, quantum_efficiency: 0.8, gain: 50, receiver_fwhm_ns: 1, returns: {by: "
      "threshold, threshold_e_per_ns: 3000}}]}");
  const ResponseHead head = response_head();
  std::vector<uint64_t> silent;
  DetectionRun stage(head, spec, [&](DetectedPulse&& p) {
    if (p.records[0].returns.empty()) silent.push_back(p.number());
  });
  ResponseBlock block = response_block(head, 0, 40, 2000);
  for (size_t p = 0; p < 40; ++p)
    if (p / 10 % 2 == 1) block.pulses[p].start += 2 * 60 / kSpeedOfLight;
  stage.take(std::move(block));
  stage.finish();
  EXPECT_EQ(silent, (std::vector<uint64_t>{10, 20, 30}));
  EXPECT_EQ(stage.beside_gate(0), 3u);
}

// The walk of a framed detector with 10 primaries, which its ideal answer tells.
TEST(Detection, IdealOfAFramedDetector) {
  const DetectionSpec spec = spec_of(
      "{pulse: {kind: gaussian, fwhm_ns: 1}, gate: {start_m: 995, stop_m: 1005}, detectors: [{kind: geiger, mode: "
      "framed, "
      "detection_efficiency: 3.33333333e-6, step_ns: 0.01}]}");
  const Seen seen = run(spec, 5, 5, 4e6);
  ASSERT_EQ(seen.ideal[0].size(), size_t{5});
  EXPECT_NEAR((seen.ideal[0][0] - 50.05e-9) * kSpeedOfLight / 2 * 1e3, -95.77,
              0.1);  // passive light blocks some 0.01 %
}

TEST(Detection, TruthOfAReturn) {
  const ResponseHead head = response_head();
  const ResponseBlock b = response_block(head, 0, 1);
  const ResponsePulse& p = b.pulses[0];
  const ReturnTruth ground = truth_of(head, {head, b, 0}, p.start + 50e-9, 2e-9),
                    roof = truth_of(head, {head, b, 0}, p.start + 10e-9, 2e-9);
  EXPECT_EQ(head.channels[static_cast<size_t>(ground.tag)], "tag:grass");
  EXPECT_EQ(head.channels[static_cast<size_t>(roof.tag)], "tag:roof");
  EXPECT_NEAR(ground.multiple, 0.05 / 0.75, 1e-12);
  EXPECT_EQ(truth_of(head, {head, b, 0}, p.start + 30e-9, 2e-9).tag, -1);
}

TEST(Detection, WhatIsRefused) {
  const auto message = [](const std::string& text) { return message_of([&] { spec_of(text); }); };
  EXPECT_THAT(message("{pulse: {kind: gaussian, fwhm_ns: 2}, detectors: [{kind: gieger}]}"),
              HasSubstr("d.yaml:1:58: error: unknown kind of detector 'gieger'; did you mean 'geiger'?"));
  EXPECT_THAT(message("{pulse: {kind: gauss, fwhm_ns: 2}, detectors: []}"), HasSubstr("d.yaml:1:16"));
  EXPECT_THAT(message("{pulse: {kind: impulse}, detectors: [{kind: linear, quantum_efficiency: 1, returns: {by: "
                      "threshold, threshold_e_per_ns: 5}}]}"),
              HasSubstr("without a width has no edge"));
  EXPECT_THAT(message("{pulse: {kind: impulse}, detectors: [{kind: geiger, mode: framed, detection_efficiency: 1, "
                      "dead_time_ns: 5}]}"),
              HasSubstr("dead_time_ns"));  // a framed pixel has none: not read
  EXPECT_THAT(
      message(
          "{pulse: {kind: gaussian, fwhm_ns: 1}, detectors: [{kind: geiger, mode: framed, detection_efficiency: 1}, "
          "{kind: geiger, mode: framed, detection_efficiency: 1}]}"),
      HasSubstr("two detectors are called 'geiger'"));
  EXPECT_THAT(
      message_of([] {
        run(spec_of(
                "{pulse: {kind: gaussian, fwhm_ns: 1}, gate: {start_m: 0, stop_m: 1.0e11}, detectors: [{kind: geiger, "
                "mode: framed, detection_efficiency: 1}]}"),
            1, 1);
      }),
      HasSubstr("pulse 0, detector 'geiger': a gate of"));
}

// Over midnight and a leap second GPS time goes on; 2026-11-28 is 479 859 218 s adjusted.
TEST(Detection, GpsTime) {
  const auto at = [](const Utc& utc) { return adjusted_gps_time(instant_from_utc(utc)); };
  EXPECT_EQ(at({2026, 11, 28, 0, 0, 0}), 479859218.0);
  EXPECT_EQ(at({1980, 1, 6, 0, 0, 0}), -1e9);
  EXPECT_NEAR(at({2026, 11, 28, 0, 0, 0.25}) - at({2026, 11, 27, 23, 59, 59.75}), 0.5, 1e-7);
  EXPECT_NEAR(at({2017, 1, 1, 0, 0, 0.25}) - at({2016, 12, 31, 23, 59, 59.75}), 1.5, 1e-7);  // 23:59:60 lies between
  EXPECT_NEAR(at({2016, 12, 31, 23, 59, 60.5}) - at({2016, 12, 31, 23, 59, 59.5}), 1, 1e-7);
}

}  // namespace
}  // namespace suite::detection_test
