// The radiometric chain of an instrument against closed forms, and what its detectors do to it.
#include <gtest/gtest.h>

#include <cmath>

#include "math/stats.h"
#include "math/variates.h"
#include "sensor/detector.h"
#include "spectral/planck.h"
#include "support/platform_kit.h"

namespace suite::detector_test {
namespace {

using test::PlatformKit;

SourceSpecs sun_at_60(double irradiance) {
  SourceSpecs s;
  s.add(SunSpec{dir_from_angles(60 * kDegree, 0.3), 0, Curve::constant(irradiance)});
  return s;
}
std::shared_ptr<Scene> plane(double reflectance) {
  return test::scene_of({test::quad(1000, 0, 0)}, {test::material("grey", test::lambert(reflectance))});
}

std::string camera(const std::string& detector, const std::string& lens = "", const std::string& array = "",
                   const std::string& bands = "{name: a, center_um: 0.6, fwhm_um: 0.2, shape: rectangular}") {
  return "kind: platform\nseed: 3\nmotion: {kind: static, position_m: [0, 0, 100]}\ntasks: [{start: 0}]\ntruth: "
         "[]\ninstruments:\n  - focal_length_mm: 100\n    f_number: 4\n" +
         lens + "    arrays: [{columns: 40, rows: 40, pitch_um: 10, integration_time_s: 0.002, paths: 4, " + array +
         "bands: [" + bands + "], detector: " + detector + "}]\n";
}

TEST(Chain, LambertPlaneThroughAnUnobscuredAperture) {
  // L = rho E cos z / pi; electrons per m2 = t integral (L / G#) QE lambda / (h c) dlambda; G# = (1 + 4 N^2) / (tau
  // pi).
  PlatformKit kit;
  kit.render(plane(0.3), sun_at_60(1500),
             camera("{quantum_efficiency: {wavelength_um: [0.4, 0.55, 0.8], value: [0.2, 0.9, 0.1]}, gain_e_per_dn: 1}",
                    "    throughput: 0.8\n"));
  const test::Shot& shot = kit.shots.at(0);
  const double L = 0.3 * 1500 * 0.5 / kPi, g = (1 + 4.0 * 16) / (0.8 * kPi);
  EXPECT_NEAR(g_number(4, 0.8), g, 1e-12);
  ASSERT_EQ(shot.result.bands, 1u);
  EXPECT_NEAR(shot.result.radiance[820] / L, 1, 1e-6);
  // QE is linear in pieces over 0.5..0.7 um: integral of QE lambda in closed form on both sides of 0.55 um.
  auto piece = [](double a, double b, double x0, double y0, double x1, double y1) {
    const double m = (y1 - y0) / (x1 - x0), c = y0 - m * x0;
    return m * (b * b * b - a * a * a) / 3 + c * (b * b - a * a) / 2;
  };
  const double integral = piece(0.5, 0.55, 0.4, 0.2, 0.55, 0.9) + piece(0.55, 0.7, 0.55, 0.9, 0.8, 0.1);  // um2
  const double expected = 0.002 * L / g * integral * 1e-6 / (kPlanckConstant * kSpeedOfLight);            // per m2
  const double electrons = shot.products.at(0).values[820] / (10e-6 * 10e-6);
  std::printf("electrons per m2: %.8g, closed form %.8g, relative difference %.2g\n", electrons, expected,
              electrons / expected - 1);
  EXPECT_NEAR(electrons / expected, 1, 1e-4);
}

TEST(Chain, Cos4FallsOffAndRadianceDoesNot) {
  PlatformKit kit;
  kit.render(plane(0.3), sun_at_60(1500),
             "kind: platform\nmotion: {kind: static, position_m: [0, 0, 100]}\ntasks: [{start: 0}]\ntruth: "
             "[]\ninstruments:\n  - focal_length_mm: 10\n    f_number: 4\n    cos4: true\n    arrays: [{columns: 41, "
             "rows: 1, pitch_um: 250, integration_time_s: 0.002, paths: 4, bands: [{name: a, center_um: 0.6, fwhm_um: "
             "0.2}], detector: {quantum_efficiency: 1, gain_e_per_dn: 1e6}}]\n");
  const test::Shot& s = kit.shots.at(0);
  const double x = 20 * 0.25 / 10, cosine = 1 / std::sqrt(1 + x * x);
  EXPECT_NEAR(s.products[0].values[40] / s.products[0].values[20], std::pow(cosine, 4), 1e-9);
  EXPECT_NEAR(s.result.radiance[40] / s.result.radiance[20], 1, 1e-6);
}

TEST(Detector, NoiseHasItsMomentsAndTheSeedItsBits) {
  // Mean m e-, read noise r: counts have mean m / g + bias and variance (m + r^2) / g^2 + 1/12.
  PlatformKit kit;
  const std::string text = camera(
      "{quantum_efficiency: 0.5, gain_e_per_dn: 4, read_noise_e: 20, bias_dn: 100, dark_current_e_s: 50000, bits: 16}");
  kit.render(plane(0.3), sun_at_60(5), text);
  kit.render(plane(0.3), sun_at_60(5), text);
  const auto& counts = kit.shots[0].products.at(1).values;
  EXPECT_EQ(counts, kit.shots[1].products.at(1).values);
  const double mean = kit.shots[0].products[0].values[0] + 100;
  RunningStats s;
  for (const double c : counts) s.add(c);
  const double variance = (mean + 400) / 16 + 1.0 / 12, n = static_cast<double>(counts.size());
  EXPECT_NEAR(s.mean(), mean / 4 + 100, 4 * std::sqrt(variance / n));
  EXPECT_NEAR(s.variance() / variance, 1, 4 * std::sqrt(2 / n));
  // Negative control: without the read noise the variance would be another.
  EXPECT_GT(std::fabs(s.variance() / (variance - 25) - 1), 4 * std::sqrt(2 / n));
}

// A blackbody seen by a thermal instrument: NETD = noise electrons / (dN/dT), N = t A / G# x integral of
// QE lambda / (h c) B dlambda, whose derivative is taken here by differences of a sum of its own.
TEST(Detector, NoiseEquivalentTemperatureDifference) {
  const double t = 1e-4, area = 1e-10, g = 65 / kPi, qe = 0.6;
  const auto electrons = [&](double kelvin) {
    double sum = 0;
    constexpr int n = 4000;
    for (int i = 0; i < n; ++i) {
      const double um = 8 + 4 * (i + 0.5) / n;
      sum += planck_radiance(um, kelvin) * um * 4 / n;
    }
    return t * area / g * qe * sum * 1e-6 / (kPlanckConstant * kSpeedOfLight);
  };
  const double N = electrons(300), slope = (electrons(300.5) - electrons(299.5));
  const std::string band = "{name: lw, center_um: 10, fwhm_um: 4, shape: rectangular}";
  auto body = plane(0);
  body->materials[0].temperature_k = 300;
  const auto run = [&](const std::string& more) {
    PlatformKit kit;
    const std::string text =
        camera(strf("{quantum_efficiency: 0.6, gain_e_per_dn: %.6g, read_noise_e: 300, %s}", N / 30000, more.c_str()),
               "", "spectral_error: 1.0e-5, ", band);
    std::string timed = text;
    timed.replace(timed.find("0.002"), 5, "0.0001");
    kit.render(body, {}, timed);
    const test::Shot shot = kit.shots.at(0);
    EXPECT_NEAR(shot.products[0].values[7] / N, 1, 1e-4);
    EXPECT_EQ(shot.products.at(2).name, "apparent_temperature");
    RunningStats s;
    for (const double kelvin : shot.products[2].values) s.add(kelvin);
    return s;
  };
  const double gain = N / 30000, own = std::sqrt(N + 300.0 * 300.0 + gain * gain / 12) / slope;
  const RunningStats bare = run("background_k: 300"), noisy = run(strf("background_k: 300, netd_k: %.6g", 3 * own));
  const double sure = 4.5 * std::sqrt(0.5 / 1600);  // of a standard deviation of 1600
  std::printf("%.4g electrons, NETD %.5f K (closed form %.5f), asked for %.5f: %.5f\n", N, std::sqrt(bare.variance()),
              own, 3 * own, std::sqrt(noisy.variance()));
  EXPECT_NEAR(std::sqrt(bare.variance()) / own, 1, sure);
  EXPECT_NEAR(std::sqrt(noisy.variance()) / (3 * own), 1, sure);
  EXPECT_NEAR(bare.mean(), 300, 4.5 * own / 40 + 0.002);
  EXPECT_NEAR(noisy.mean(), 300, 4.5 * 3 * own / 40 + 0.002);
  // Negative control: the read noise alone would be another.
  EXPECT_GT(std::fabs(std::sqrt(bare.variance()) * slope / 300 - 1), sure);
  EXPECT_THROW(run(strf("background_k: 300, netd_k: %.6g", 0.9 * own)), Error);
}

TEST(Detector, PoissonHasItsMeanAndVarianceOnBothBranches) {
  for (const double mean : {0.3, 7.0, 29.0, 31.0, 400.0, 1e6}) {
    Pcg32 random(11, static_cast<uint64_t>(mean * 10));
    RunningStats s;
    constexpr int n = 200000;
    for (int i = 0; i < n; ++i) s.add(poisson(mean, random));
    EXPECT_NEAR(s.mean(), mean, 4.5 * std::sqrt(mean / n)) << mean;
    EXPECT_NEAR(s.variance() / mean, 1, 4.5 * std::sqrt((2 + 1 / mean) / n)) << mean;
  }
}

TEST(Detector, FullWellBitsAndBadPixels) {
  PlatformKit kit;
  kit.render(plane(0.3), sun_at_60(1500),
             camera("{quantum_efficiency: 1, gain_e_per_dn: 1, full_well_e: 500, shot_noise: false, bits: 12}"));
  for (const double c : kit.shots[0].products[1].values) EXPECT_EQ(c, 500);
  kit.render(plane(0.3), sun_at_60(1500),
             camera("{quantum_efficiency: 1, gain_e_per_dn: 0.01, shot_noise: false, bits: 12, bad_pixels: [[3, 2]], "
                    "hot_fraction: 0.05, dead_fraction: 0.05}"));
  size_t dead = 0, full = 0;
  for (const double c : kit.shots[1].products[1].values) dead += c == 0, full += c == 4095;
  EXPECT_EQ(kit.shots[1].products[1].values[2 * 40 + 3], 0);
  EXPECT_EQ(dead + full, 1600u);
  EXPECT_NEAR(static_cast<double>(dead), 80, 40);
}

TEST(Detector, TdiGainsItsNumberOfStagesAndItsRoot) {
  // n stages collect n times the electrons of one, so the signal-to-noise ratio of shot noise grows by sqrt(n).
  PlatformKit kit;
  auto text = [](int stages) {
    return strf(
        "kind: platform\nmotion: {kind: straight, position_m: [0, 0, 100], heading_deg: 0, speed_m_s: 5}\ntasks: "
        "[{start: 0, stop: 0.512}]\ntruth: []\ninstruments:\n  - focal_length_mm: 100\n    f_number: 4\n"
        "    arrays: [{columns: 16, pitch_um: 10, integration_time_s: 0.002, readout: {kind: line, line_rate_hz: 500}, "
        "tdi: {stages: %d}, paths: 4, bands: [{name: a, center_um: 0.6, fwhm_um: 0.2}], detector: {quantum_efficiency: "
        "0.5, gain_e_per_dn: 1}}]\n",
        stages);
  };
  std::vector<double> signal, snr;
  for (const int stages : {1, 16}) {
    kit.shots.clear();
    kit.render(plane(0.3), sun_at_60(4), text(stages));
    RunningStats s, e;
    for (const test::Shot& shot : kit.shots) {
      for (const double c : shot.products.at(1).values) s.add(c);
      for (const double v : shot.products.at(0).values) e.add(v);
    }
    ASSERT_EQ(s.n(), 4096u);
    signal.push_back(e.mean());
    snr.push_back(s.mean() / std::sqrt(s.variance()));
  }
  EXPECT_NEAR(signal[1] / signal[0], 16, 1e-6);
  std::printf("TDI of 16 stages: signal x %.4f, signal-to-noise x %.3f (closed form 4)\n", signal[1] / signal[0],
              snr[1] / snr[0]);
  EXPECT_NEAR(snr[1] / snr[0], 4, 4 * 4 * std::sqrt(1.0 / 4096));
}

TEST(Detector, ChipsHaveTheirOwnResponsesAndGains) {
  PlatformKit kit;
  kit.render(plane(0.3), sun_at_60(1500),
             "kind: platform\nmotion: {kind: static, position_m: [0, 0, 100]}\ntasks: [{start: 0}]\ntruth: [material, "
             "instance, range, location, paths, hits, reflectance]\ninstruments:\n  - "
             "focal_length_mm: 100\n    f_number: 4\n    arrays:\n      - rows: 3\n        pitch_um: 10\n        "
             "integration_time_s: 0.001\n        paths: 4\n"
             "        bands: [{name: a, center_um: 0.6, fwhm_um: 0.1, shape: rectangular}]\n"
             "        chips: [{columns: 5, offset_mm: [-0.05, 0], gain: 1.5}, {columns: 7, offset_mm: [0.06, 0.2], "
             "bands: [{name: a, center_um: 0.6, fwhm_um: 0.2, shape: rectangular}]}]\n"
             "        detector: {quantum_efficiency: 0.5, gain_e_per_dn: 1, shot_noise: false}\n");
  ASSERT_EQ(kit.shots.size(), 1u);
  const test::Shot& s = kit.shots[0];
  EXPECT_EQ(s.result.columns, 12u);
  EXPECT_EQ(s.result.rows, 3u);
  const auto& e = s.products[0].values;
  for (int row = 0; row < 3; ++row) {
    EXPECT_NEAR(e[static_cast<size_t>(12 * row + 8)] / e[static_cast<size_t>(12 * row + 2)], 2 / 1.5,
                1e-6);  // twice the width, no gain
    EXPECT_NEAR(s.result.radiance[static_cast<size_t>(12 * row + 8)],
                s.result.radiance[static_cast<size_t>(12 * row + 2)], 1e-4);
  }
  // Truth stands beside each other too: the second chip looks 0.2 mm further up, 0.2 m on the ground.
  const size_t north = 4, columns = s.result.truth_names.size();
  ASSERT_EQ(s.result.truth_names[north], "north [m]");
  EXPECT_EQ(columns, 9u);  // and of reflectance only the listed band's
  EXPECT_NEAR(s.result.truth[8 * columns + north] - s.result.truth[2 * columns + north], 0.2, 1e-3);
}

}  // namespace
}  // namespace suite::detector_test
