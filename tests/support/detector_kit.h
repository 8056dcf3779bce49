// Detectors of images from text, under even light, and what their readings are held against.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "math/stats.h"
#include "sensor/detectors/detectors.h"

namespace suite::test {

// A detector of `keys`, "kind: emccd, em_gain: 300, ..."; quantum efficiency 1 unless they say.
inline ReadDetector detector_of(const std::string& keys) {
  const std::string qe = keys.find("quantum_efficiency") == std::string::npos ? "quantum_efficiency: 1, " : "";
  const Params params = Params::parse_text("detector: {" + qe + keys + "}", "detector.yaml");
  SensorContext context;
  context.curve = [](const Params& p) {
    if (p.kind() == Params::Kind::map)
      return Curve(p.at("wavelength_um").as_numbers(), p.at("value").as_numbers(), Outside::zero);
    return Curve::constant(p.as_number());
  };
  auto made = read_detector(params, context);
  params.reject_unread();
  return *made;
}

// The same mean electrons on every pixel of an array of 10 um pixels, for 1 s.
inline ArrayLight even_light(uint32_t columns, uint32_t rows, double electrons, uint64_t read_out = 0) {
  ArrayLight light;
  light.columns = columns, light.rows = rows;
  light.electrons.assign(size_t{columns} * rows, electrons);
  light.exposure = 1;
  light.pitch = {1e-5, 1e-5};
  light.read_out = read_out;
  for (uint32_t r = 0; r < rows; ++r)
    for (uint32_t c = 0; c < columns; ++c) light.sites.push_back({hash_of(r, c), c, 0, false});
  return light;
}

// Standard errors that a number may be off, and the least chance of a histogram.
inline constexpr double kSure = 4.5, kChance = 1e-4;

inline RunningStats stats_of(const std::vector<double>& values) {
  RunningStats s;
  for (const double v : values) s.add(v);
  return s;
}
// Mean and variance, of a distribution whose fourth moment makes the variance's error `kurtosis` (3 = normal).
inline void expect_moments(const std::vector<double>& values, double mean, double variance, double kurtosis = 3) {
  const RunningStats s = stats_of(values);
  const auto n = static_cast<double>(values.size());
  EXPECT_NEAR(s.mean(), mean, kSure * std::sqrt(variance / n));
  EXPECT_NEAR(s.variance() / variance, 1, kSure * std::sqrt((kurtosis - 1) / n));
}
// Chance of a histogram with these upper ends of its cells (the last cell has no end), for a distribution function.
template <class Below>
double chance(const std::vector<double>& values, const std::vector<double>& ends, const Below& below) {
  std::vector<double> observed(ends.size() + 1, 0), expected;
  for (const double v : values)
    ++observed[static_cast<size_t>(std::upper_bound(ends.begin(), ends.end(), v) - ends.begin())];
  double before = 0;
  for (const double end : ends) {
    const double p = below(end);
    expected.push_back((p - before) * static_cast<double>(values.size()));
    before = p;
  }
  expected.push_back((1 - before) * static_cast<double>(values.size()));
  return chi_square_test(observed, expected, 10);
}

// Signal over noise of so many electrons.
inline double snr(const std::string& keys, double n) {
  const DetectorNoise noise = detector_of(keys).reader->noise(1, 1e-10);
  return n / std::sqrt(noise.constant + noise.linear * n);
}

}  // namespace suite::test
