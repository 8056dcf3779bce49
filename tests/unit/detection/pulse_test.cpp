// Pulse shapes and waveforms against closed forms.
#include "detection/pulse_shape.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "detection/waveform.h"
#include "support/message_of.h"

namespace suite::pulse_test {
namespace {

using testing::HasSubstr;

TEST(PulseShape, WidthsAndCentroids) {
  const PulseShape gaussian = PulseShape::gaussian(2e-9), box = PulseShape::rectangular(3e-9),
                   triangle = PulseShape::table({5e-9, 6e-9, 8e-9}, {0, 4, 0});
  EXPECT_NEAR(gaussian.deviation(), 2e-9 / 2.3548200450309493, 1e-20);
  EXPECT_NEAR(gaussian.before(1e-9) - gaussian.before(-1e-9), std::erf(std::sqrt(std::log(2.0))), 1e-12);  // 0.7610
  EXPECT_NEAR(box.deviation(), 3e-9 / std::sqrt(12.0), 1e-20);
  // Of a triangle with corners a, c, b: centroid (a + b + c) / 3, variance (a2 + b2 + c2 - ab - ac - bc) / 18.
  const double a = 5, c = 6, b = 8, centroid = (a + b + c) / 3;
  EXPECT_NEAR(triangle.deviation() * 1e9, std::sqrt((a * a + b * b + c * c - a * b - a * c - b * c) / 18), 1e-9);
  EXPECT_NEAR(triangle.before((c - centroid) * 1e-9), (c - a) / (b - a), 1e-12);
  EXPECT_NEAR(triangle.fwhm() * 1e9, 1.5, 1e-9);
}

// A rectangle through a Gaussian receiver: (erf((t + L/2) / (s sqrt 2)) - erf((t - L/2) / (s sqrt 2))) / (2 L).
TEST(PulseShape, ThroughAReceiver) {
  EXPECT_NEAR(PulseShape::gaussian(3e-9).through(4e-9).fwhm(), 5e-9, 1e-20);  // widths add in squares
  const double length = 2e-9, fwhm = 1e-9, s = fwhm / kFwhmOfDeviation;
  const PulseShape box = PulseShape::rectangular(length).through(fwhm);
  EXPECT_NEAR(box.deviation(), std::hypot(length / std::sqrt(12.0), s), 2e-3 * box.deviation());
  const auto primitive = [&](double x) {  // of the erf above
    const double u = x / (s * std::sqrt(2.0));
    return x * std::erf(u) + s * std::sqrt(2 / 3.14159265358979323846) * std::exp(-u * u);
  };
  for (const double t : {-1.5e-9, -1e-9, -0.3e-9, 0.0, 0.8e-9}) {
    const double before = 0.5 + (primitive(t + length / 2) - primitive(t - length / 2)) / (2 * length);
    EXPECT_NEAR(box.before(t), before, 2e-4) << t;
  }
}

TEST(PulseShape, WhatIsRefused) {
  const Where where{"p.yaml", 3, 1, {}, -1};
  EXPECT_THAT(message_of([&] {
                PulseShape::table({1, 1}, {1, 1}, where);
              }),
              HasSubstr("p.yaml:3:1: error: value 1 of a pulse"));
  EXPECT_THAT(message_of([&] { PulseShape::table({1, 2}, {0, -1}, where); }), HasSubstr("without energy"));
  EXPECT_THAT(message_of([&] { samples_within(0, 1, 1e-12, where); }), HasSubstr("samples of 1e-12 s"));
  EXPECT_THAT(message_of([&] { samples_within(1, 1, 1e-12, where); }), HasSubstr("stop after start"));
}

// Half the ellipse of a plate under a top hat (physics of tilted targets) needs no model here: what must hold of any
// response is that energy and centroid pass, and that widths add in squares.
TEST(Waveform, EnergyCentroidAndWidthPass) {
  const std::vector<PhotonArrival> arrivals{{10e-9, 20, 4}, {14.3e-9, 60, 9}};
  const PulseShape pulse = PulseShape::gaussian(1.5e-9);
  const Expected e = expect_electrons(arrivals, 1e9, pulse, {0.5, 2e8}, samples_within(0, 40e-9, 0.25e-9));
  double sum = 0, first = 0, second = 0;
  for (size_t k = 0; k < e.grid.count; ++k) sum += e.signal[k], first += e.signal[k] * e.grid.middle(k);
  const double centroid = first / sum;
  for (size_t k = 0; k < e.grid.count; ++k) second += e.signal[k] * std::pow(e.grid.middle(k) - centroid, 2);
  EXPECT_NEAR(sum, 40, 1e-9);
  EXPECT_NEAR(centroid, (20 * 10e-9 + 60 * 14.3e-9) / 80, 1e-13);
  const double between = 0.25 * 0.75 * std::pow(4.3e-9, 2), own = std::pow(pulse.deviation(), 2),
               sample = std::pow(0.25e-9, 2) / 12;
  EXPECT_NEAR(second / sum, between + own + sample, 1e-5 * second / sum);
  EXPECT_NEAR(e.background, (0.5 * 1e9 + 2e8) * 0.25e-9, 1e-15);
  EXPECT_GT(e.variance[57], 0);
}

// 1 ps of pulse in samples of 1 ns, and 1 us in the same: neither loses energy.
TEST(Waveform, ShortestAndLongestPulse) {
  for (const double fwhm : {1e-12, 1e-6}) {
    const Expected e = expect_electrons(std::vector<PhotonArrival>{{5e-6, 100, 0}}, 0, PulseShape::gaussian(fwhm),
                                        {1, 0}, samples_within(0, 10e-6, 1e-9));
    double sum = 0;
    for (const double v : e.signal) sum += v;
    EXPECT_NEAR(sum, 100, 1e-8) << fwhm;
  }
}

}  // namespace
}  // namespace suite::pulse_test
