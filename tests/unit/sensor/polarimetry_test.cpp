#include "sensor/polarimetry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "math/sampling.h"

namespace suite::polarimetry_test {
namespace {

using testing::ElementsAre, testing::HasSubstr;

std::vector<std::string> channels_of(const std::string& text) {
  std::vector<std::string> channels{"radiance"};
  read_polarimetry(Params::parse_text(text, "x.yaml"), channels);
  return channels;
}
std::string refused(const std::string& text) {
  try {
    channels_of(text);
  } catch (const Error& e) {
    return e.message() + "; " + e.hint();
  }
  return "";
}

TEST(Polarimetry, ChannelsAreThoseAskedForAndWhatIsNotKnown) {
  EXPECT_THAT(channels_of("{stokes: linear}"), ElementsAre("radiance", "stokes_q", "stokes_u", "depolarised"));
  EXPECT_THAT(channels_of("{stokes: [i, v, q]}"), ElementsAre("radiance", "stokes_q", "stokes_v", "depolarised"));
  EXPECT_THAT(channels_of("{analyser: {polarizer_deg: 45}}"), ElementsAre("radiance", "depolarised"));
  EXPECT_THAT(channels_of("{bands: []}"), ElementsAre("radiance"));
}
TEST(Polarimetry, WhatCannotBeIsRefused) {
  EXPECT_THAT(refused("{stokes: [q, u]}"), HasSubstr("the intensity is missing"));
  EXPECT_THAT(refused("{stokes: [i, q, q]}"), HasSubstr("'q' is listed twice"));
  EXPECT_THAT(refused("{stokes: [i, w]}"), HasSubstr("w"));
  EXPECT_THAT(refused("{stokes_frame: image}"), HasSubstr("nothing is measured in this frame"));
  EXPECT_THAT(refused("{analyser: {polarizer_deg: 0, axis_deg: 3}}"), HasSubstr("there is no retarder"));
  EXPECT_THAT(refused("{analyser: {polarizer_deg: 0, extinction: 0.5}}"), HasSubstr("0.5 is outside the valid range"));
  EXPECT_THAT(refused("{stokes: linear, stokes_frame: up}"), HasSubstr("known: meridian, image, scattering_plane"));
}
// A retarder of 90 deg at 45 deg before a polarizer passes all of one circular state and nothing of the other (Hecht,
// Optics, section 8.13): V = +1 turns counter-clockwise as the receiver sees it.
TEST(Polarimetry, AQuarterWavePlateAndAPolarizerTellCircularLight) {
  std::vector<std::string> channels{"radiance"};
  const auto how = read_polarimetry(
      Params::parse_text("{analyser: {polarizer_deg: 0, retarder_deg: 90, axis_deg: 45}}", "x.yaml"), channels);
  ASSERT_TRUE(how && how->analyser);
  const double left = (*how->analyser * Stokes{1, 0, 0, 1})[0], right = (*how->analyser * Stokes{1, 0, 0, -1})[0];
  EXPECT_NEAR(std::max(left, right), 1, 1e-12);
  EXPECT_NEAR(std::min(left, right), 0, 1e-12);
  EXPECT_NEAR((*how->analyser * Stokes{1, 0, 0, 0})[0], 0.5, 1e-12);
  EXPECT_GT(least_coherency(*how->analyser), -1e-12);
}
// Diattenuation (e - 1)/(e + 1) of an extinction ratio e.
TEST(Polarimetry, ExtinctionIsADiattenuation) {
  const struct { double extinction, diattenuation; } rows[] = {{50, 0.9607843}, {300, 0.9933555}};
  for (const auto& r : rows) {
    const Mueller m = polarizer(0, 1 / r.extinction);
    EXPECT_NEAR(m(0, 1) / m(0, 0), r.diattenuation, 1e-7);
  }
}
// Noise of sigma sqrt(2)/50 in Q and U: the degree's mean is Rice's (0.035449 where there is none, 0.202010 at 0.2);
// what is left of the bias at 0.2 is less than a tenth. 4e5 draws: 2e-4 is 4 standard errors.
TEST(Polarimetry, NoiseRaisesTheDegreeAndIsTakenOff) {
  const double sigma = std::sqrt(2.0) / 50;
  const double C[6] = {0, 0, 0, sigma * sigma, 0, sigma * sigma};
  const struct { double degree, mean; } rows[] = {{0, 0.035449}, {0.05, 0.058862}, {0.2, 0.202010}};
  for (const auto& r : rows) {
    Pcg32 random(3);
    constexpr int n = 400000;
    double raw = 0, debiased = 0;
    for (int i = 0; i < n; ++i) {
      const double size = sigma * std::sqrt(-2 * std::log1p(-random.uniform())), turn = 2 * kPi * random.uniform();
      const LinearPolarisation p = linear_polarisation({1, r.degree + size * std::cos(turn), size * std::sin(turn)}, C);
      raw += p.degree / n, debiased += p.debiased / n;
    }
    EXPECT_NEAR(raw, r.mean, 2e-4) << r.degree;
    EXPECT_LT(debiased, raw) << r.degree;
    if (r.degree == 0.2) {
      EXPECT_NEAR(debiased, r.degree, 2e-4);
    }
  }
}
// Regression: along an axis of the frame the error was 0, elsewhere the debiased degree no number.
TEST(Polarimetry, UnknownErrorsStayUnknown) {
  const double C[6] = {INFINITY, 0, 0, INFINITY, 0, INFINITY};
  for (const double u : {0.0, 0.2}) {
    const LinearPolarisation p = linear_polarisation({1, 0.3, u}, C);
    EXPECT_NEAR(p.degree, std::hypot(0.3, u), 1e-15);
    EXPECT_EQ(p.degree_error, INFINITY);
    EXPECT_EQ(p.angle_error, INFINITY);
    EXPECT_EQ(p.debiased, 0);
    EXPECT_TRUE(p.undefined);
  }
}
TEST(Polarimetry, ErrorsFollowTheCovariances) {
  // Along U alone: the error of the degree is that of U over I, of the angle that of Q.
  const double C[6] = {0, 0, 0, 1e-4, 0, 4e-4};
  const LinearPolarisation p = linear_polarisation({1, 0, 0.5}, C);
  EXPECT_NEAR(p.degree, 0.5, 1e-15);
  EXPECT_NEAR(p.angle, 45, 1e-12);
  EXPECT_NEAR(p.degree_error, 0.02, 1e-12);
  EXPECT_NEAR(p.angle_error * kDegree, 0.5 * 0.01 / 0.5, 1e-12);
  EXPECT_FALSE(p.undefined);
  // Errors of I and U that go together leave the degree alone.
  const double together[6] = {4e-4, 0, 2e-4, 0, 0, 1e-4};
  EXPECT_NEAR(linear_polarisation({1, 0, 0.5}, together).degree_error, 0, 1e-12);
  EXPECT_TRUE(linear_polarisation({1, 0, 0.05}, C).undefined);
  EXPECT_TRUE(std::isnan(linear_polarisation({0, 0, 0}, C).degree));
}

}  // namespace
}  // namespace suite::polarimetry_test
