// Bins under real air: widths of intervals, g-points, and what stands for an interval.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "scheduler/air_bins.h"
#include "support/message_of.h"

namespace suite::air_bins_test {
namespace {

AirSpec air() {
  AirSpec a;
  a.profile = standard_profile("us_standard");
  a.gases = shared_builtin_gases();
  return a;
}

TEST(AirBins, IntervalsAreNarrowAndSplitWhereGasesAbsorb) {
  const std::vector<Band> bands{Band::rectangular("oxygen", 0.762, 0.03), Band::rectangular("clear", 0.865, 0.03),
                                Band::rectangular("water", 6.3, 0.5)};
  const SpectralState state = make_state(bands, 0.01);
  const AirBins bins = bins_in_air(air(), state, bands);
  double sum = 0;
  size_t split = 0, whole = 0;
  for (size_t i = 0; i < bins.state.size(); ++i) {
    const Bin& b = bins.state.bins[i];
    const double widest = std::max(0.01, 15e-4 * b.center_um() * b.center_um());
    EXPECT_LT(b.high_um - b.low_um, 1.05 * widest);
    EXPECT_LE(b.high_um - b.low_um, 0.0151);  // half of the narrowest band
    sum += b.weight;
    const bool alone = b.g == 0 && (i + 1 == bins.state.size() || bins.state.bins[i + 1].g == 0);
    ++(alone ? whole : split);
    EXPECT_TRUE(alone || std::fabs(b.center_um() - 0.865) > 0.005) << b.center_um();
  }
  EXPECT_NEAR(sum, static_cast<double>(bins.intervals.size()), 1e-9);
  EXPECT_GT(split, whole);
  for (const size_t knot : bins.state.knots) EXPECT_EQ(bins.state.bins[knot].g, 0u);
  const BandProjection projection(bins.state, bands);
  for (size_t band = 0; band < bands.size(); ++band) {
    double whole_band = 0;
    for (size_t i = 0; i < bins.state.size(); ++i) whole_band += projection.weight(band, i);
    EXPECT_NEAR(whole_band, 1, 1e-9);
  }
}

TEST(AirBins, UsersMakeThemNarrower) {
  const std::vector<Band> bands{Band::rectangular("wide", 0.7, 0.1)};
  SpectralState state = make_state(bands, 0.01);
  state.choice = {1e-3, 0.004, 4};
  for (const Bin& b : bins_in_air(air(), state, bands).intervals.bins) EXPECT_LE(b.high_um - b.low_um, 0.0040001);
  state = make_state(bands, 0.005);
  for (const Bin& b : bins_in_air(air(), state, bands).intervals.bins) EXPECT_LE(b.high_um - b.low_um, 0.0050001);
}

// Bands side by side, 4 nm wide, and bins of the same width.
struct SideBySide {
  std::vector<Band> bands;
  SpectralState state;
};
SideBySide side_by_side(Band (*make)(std::string, double, double)) {
  SideBySide s;
  for (int i = 0; i < 60; ++i) s.bands.push_back(make("b" + std::to_string(i), 0.522 + 0.004 * i, 0.004));
  s.state = make_state(s.bands, 0.004);
  return s;
}

TEST(AirBins, EvenBinsOfEvenBandsStayWhole) {
  const SideBySide s = side_by_side(Band::rectangular);
  ASSERT_EQ(s.state.size(), 60u);
  const AirBins bins = bins_in_air(air(), s.state, s.bands);
  EXPECT_EQ(bins.intervals.bins, s.state.bins);
  EXPECT_GT(bins.state.size(), 80u);  // gases split some of them
  // Where bins are to be chosen, all are halves.
  SpectralState chosen = s.state;
  chosen.choice = {1e-3, 0, 4};
  EXPECT_GE(bins_in_air(air(), chosen, s.bands).intervals.size(), 119u);
}

TEST(AirBins, EvenBinsOfOtherBandsStayWholeWhereGasesAreAlike) {
  SideBySide s = side_by_side(Band::triangular);
  s.state = make_state(s.bands, 0.006);
  const AirBins bins = bins_in_air(air(), s.state, s.bands);
  size_t whole = 0, halves = 0;
  for (size_t i = 0, at = 0; i < s.state.size(); ++i) {
    const Bin &b = s.state.bins[i], &first = bins.intervals.bins[at++];
    EXPECT_EQ(first.low_um, b.low_um);
    if (first.high_um == b.high_um) {
      ++whole;
      continue;
    }
    ++halves;
    EXPECT_EQ(bins.intervals.bins[at++].high_um, b.high_um);
    EXPECT_GT(b.high_um, 0.565);  // nothing but ozone below
  }
  EXPECT_GT(whole, 10u);
  EXPECT_GT(halves, 5u);
}

TEST(AirBins, BandsThatGasesAreNotKnownForAreNamed) {
  const std::vector<Band> bands{Band::rectangular("deep", 0.15, 0.01), Band::rectangular("near", 0.5, 0.01)};
  const std::string message = message_of([&] { bins_in_air(air(), make_state(bands, 0.01), bands); });
  EXPECT_NE(message.find("gases are known from 0.2 to 1000 um"), std::string::npos) << message;
  EXPECT_NE(message.find("reach beyond: 'deep' (0.145 to 0.155 um)"), std::string::npos) << message;
  EXPECT_EQ(message.find("'near'"), std::string::npos) << message;
}

}  // namespace
}  // namespace suite::air_bins_test
