// Curves, bands, states and projections: exact integrals, declared rules outside the range, quadrature that keeps
// constants and straight lines.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "spectral/curve.h"
#include "spectral/state.h"
#include "support/message_of.h"

namespace suite::spectral_test {
using testing::HasSubstr;

TEST(Curve, InterpolatesAndIntegratesItsPiecesExactly) {
  const Curve c({0.4, 0.5, 0.7}, {1, 3, 2}, Outside::error);
  EXPECT_DOUBLE_EQ(c.at(0.4), 1);
  EXPECT_DOUBLE_EQ(c.at(0.45), 2);
  EXPECT_DOUBLE_EQ(c.at(0.6), 2.5);
  EXPECT_DOUBLE_EQ(c.at(0.7), 2);
  EXPECT_NEAR(c.integral(0.4, 0.7), 0.2 + 0.5, 1e-15);
  EXPECT_NEAR(c.integral(0.45, 0.6), 0.05 * 2.5 + 0.1 * 2.75, 1e-15);
  EXPECT_NEAR(c.mean(0.45, 0.6), (0.05 * 2.5 + 0.1 * 2.75) / 0.15, 1e-14);
  EXPECT_NEAR(c.mean(0.45, 0.45), 2, 1e-14);
  EXPECT_NEAR(c.mean(0.45, 0.45 + 1e-12), 2, 1e-9);
  EXPECT_EQ(c.min(), 1);
  EXPECT_EQ(c.max(), 3);
}

TEST(Curve, TheOrderOfTheTableDoesNotMatter) {
  const Curve up({0.4, 0.5, 0.7}, {1, 3, 2}, Outside::error), down({0.7, 0.5, 0.4}, {2, 3, 1}, Outside::error);
  EXPECT_EQ(up.wavelength_um(), down.wavelength_um());
  EXPECT_EQ(up.value(), down.value());
}

TEST(Curve, OutsideItsRangeOnlyTheDeclaredRuleHolds) {
  const Curve strict({0.4, 0.8}, {1, 3}, Outside::error);
  EXPECT_THAT(message_of([&] { strict.at(0.3); }),
              HasSubstr("a curve from 0.4 to 0.8 um was asked at 0.3 um; declare 'outside: hold' or 'zero'"));
  EXPECT_THAT(message_of([&] { strict.mean(0.7, 0.9); }), HasSubstr("was asked from 0.7 to 0.9 um"));
  EXPECT_FALSE(strict.covers(0.3, 0.5));
  // An edge computed in floating point may miss by a rounding error.
  EXPECT_TRUE(strict.covers(0.4 - 1e-12, 0.8 + 1e-12));
  EXPECT_NEAR(strict.at(0.8 + 1e-12), 3, 1e-9);
  EXPECT_NEAR(strict.mean(0.8, 0.8 + 1e-12), 3, 1e-9);
  const Curve hold = strict.with_outside(Outside::hold), zero = strict.with_outside(Outside::zero);
  EXPECT_EQ(hold.at(0.1), 1);
  EXPECT_EQ(hold.at(9), 3);
  EXPECT_NEAR(hold.integral(0.3, 1.0), 0.1 + 0.8 + 0.6, 1e-14);
  EXPECT_EQ(zero.at(0.1), 0);
  EXPECT_NEAR(zero.integral(0.1, 9), 0.8, 1e-14);
  EXPECT_NEAR(zero.integral(0.1, 0.2), 0, 1e-15);
}

TEST(Curve, ConstantsAndScaledCopies) {
  const Curve c = Curve::constant(0.3);
  EXPECT_TRUE(c.is_constant());
  for (const double w : {0.01, 1.0, 500.0}) EXPECT_EQ(c.at(w), 0.3);
  EXPECT_NEAR(c.integral(0.5, 2.5), 0.6, 1e-15);
  EXPECT_TRUE(c.covers(0.001, 1e6));
  const Curve s = Curve({1, 2}, {1, 3}, Outside::error).scaled(0.5);
  EXPECT_EQ(s.at(2), 1.5);
  EXPECT_NEAR(s.integral(1, 2), 1, 1e-15);
}

TEST(Curve, BadTablesAreRefusedAtTheirPlace) {
  const Where where{"c.txt", 7, 0, {}, -1};
  EXPECT_THAT(message_of([&] {
                Curve({1, 2, 2}, {1, 1, 1}, Outside::hold, where);
              }),
              HasSubstr("c.txt:7: error: wavelengths are not monotonic: 2 um follows 2 um"));
  EXPECT_THAT(message_of([&] { Curve({1, 3, 2}, {1, 1, 1}, Outside::hold, where); }), HasSubstr("not monotonic"));
  EXPECT_THAT(message_of([&] { Curve({0, 1}, {1, 1}, Outside::hold, where); }), HasSubstr("not positive and finite"));
  EXPECT_THAT(message_of([&] { Curve({1, NAN}, {1, 1}, Outside::hold, where); }), HasSubstr("not positive and finite"));
  EXPECT_THAT(message_of([&] {
                Curve({1, 2}, {1, INFINITY}, Outside::hold, where);
              }),
              HasSubstr("the value at 2 um is not finite"));
  EXPECT_THAT(message_of([&] { Curve({1, 2}, {1}, Outside::hold, where); }), HasSubstr("found 1 and 2"));
  EXPECT_THAT(message_of([&] { Curve({}, {}, Outside::hold, where); }), HasSubstr("at least one"));
}

TEST(Band, ShapesHaveTheirCentreWidthAndArea) {
  const Band g = Band::gaussian("g", 0.55, 0.02), r = Band::rectangular("r", 0.55, 0.02),
             t = Band::triangular("t", 0.55, 0.02);
  EXPECT_NEAR(g.response.integral(0.4, 0.7), 0.02 * std::sqrt(std::acos(-1.0) / (4 * std::log(2.0))), 0.02 * 1e-4);
  EXPECT_NEAR(r.response.integral(0.4, 0.7), 0.02, 1e-12);
  EXPECT_NEAR(t.response.integral(0.4, 0.7), 0.02, 1e-12);
  EXPECT_NEAR(r.low_um(), 0.54, 1e-12);
  // A table of the shape gives back centre and width.
  for (const Band& band : {g, t}) {
    const Band again = Band::tabulated("x", band.response);
    EXPECT_NEAR(again.center_um, 0.55, 1e-9);
    EXPECT_NEAR(again.fwhm_um, 0.02, 1e-5);
  }
  EXPECT_NEAR(Band::tabulated("x", r.response).fwhm_um, 0.02, 1e-12);
}

TEST(Band, TablesLoseTheirDarkEndsAndAreCheckedAtTheirPlace) {
  const Band b =
      Band::tabulated("b", Curve({0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}, {0, 0, 1, 1, 0, 0, 0}, Outside::error));
  EXPECT_EQ(b.low_um(), 0.4);
  EXPECT_EQ(b.high_um(), 0.7);
  EXPECT_NEAR(b.center_um, 0.55, 1e-12);
  EXPECT_NEAR(b.fwhm_um, 0.2, 1e-12);
  const Where where{"b.txt", 2, 0, {}, -1};
  EXPECT_THAT(message_of([&] {
                Band::tabulated("b", Curve({1, 2}, {0, -1}, Outside::error), where);
              }),
              HasSubstr("b.txt:2: error: band 'b': the response is negative"));
  EXPECT_THAT(message_of([&] {
                Band::tabulated("b", Curve({1, 2}, {0, 0}, Outside::error), where);
              }),
              HasSubstr("zero everywhere"));
  EXPECT_THROW(Band::gaussian("b", 0, 1), Error);
  EXPECT_THROW(Band::gaussian("b", 0.5, 0), Error);
  EXPECT_THROW(Band::rectangular("b", 0.5, 1.0), Error);
  EXPECT_THROW(Band::triangular("b", NAN, 0.1), Error);
}

namespace {
std::vector<Band> uas_bands() {
  return {Band::gaussian("blue", 0.475, 0.02), Band::gaussian("green", 0.56, 0.02), Band::gaussian("red", 0.668, 0.01),
          Band::gaussian("edge", 0.717, 0.01), Band::gaussian("nir", 0.84, 0.04)};
}
}  // namespace

TEST(State, BinsAscendCoverTheBandsAndRespectTheStep) {
  const std::vector<Band> bands = uas_bands();
  for (const double step : {0.001, 0.005, 0.01, 0.02}) {
    const SpectralState s = make_state(bands, step);
    double covered = 0;
    for (size_t i = 0; i < s.bins.size(); ++i) {
      const double width = s.bins[i].high_um - s.bins[i].low_um;
      EXPECT_GT(width, 0.24 * step);
      EXPECT_LE(width, 1.5 * step);
      if (i) {
        EXPECT_GE(s.bins[i].low_um, s.bins[i - 1].high_um);
      }
      covered += width;
    }
    double supports = 0;  // green and blue do not touch at these widths, red and edge do
    std::vector<std::pair<double, double>> spans;
    for (const Band& b : bands) spans.emplace_back(b.low_um(), b.high_um());
    for (size_t i = 0; i < spans.size(); ++i)
      supports += spans[i].second - std::max(spans[i].first, i ? spans[i - 1].second : 0.0);
    EXPECT_NEAR(covered, supports, 1e-12);
    EXPECT_EQ(s.low_um, s.bins.front().low_um);
    EXPECT_EQ(s.high_um, s.bins.back().high_um);
  }
}

TEST(State, KnotsStartWithTheReferenceAreDistinctAndNearEveryBin) {
  const std::vector<Band> bands = uas_bands();
  for (const double reference : {0.0, 0.46, 0.56, 0.6, 0.9, 5.0})
    for (size_t count = 1; count <= 10; ++count) {
      const SpectralState s = make_state(bands, 0.005, reference, count);
      EXPECT_EQ(s.knots.size(), std::min<size_t>(count, 8));
      EXPECT_EQ(std::set<size_t>(s.knots.begin(), s.knots.end()).size(), s.knots.size());
      EXPECT_EQ(s.reference_bin(), s.knots[0]);
      for (const Bin& bin : s.bins)
        EXPECT_GE(std::fabs(bin.center_um() - s.reference_um),
                  std::fabs(s.bins[s.knots[0]].center_um() - s.reference_um));
      const std::vector<int> nearest = s.knot_of_bin();
      for (size_t b = 0; b < s.bins.size(); ++b)
        for (const size_t k : s.knots) {
          const double own = std::fabs(s.bins[s.knots[nearest[b]]].center_um() - s.bins[b].center_um());
          EXPECT_LE(own, std::fabs(s.bins[k].center_um() - s.bins[b].center_um()) + 1e-15);
          if (count >= 2) {
            EXPECT_LE(own, (s.high_um - s.low_um) / static_cast<double>(s.knots.size()));
          }
        }
    }
}

TEST(State, OneNarrowBandHasAtLeastOneBin) {
  const SpectralState s = make_state(std::vector<Band>{Band::rectangular("x", 0.55, 1e-4)}, 0.01);
  EXPECT_GE(s.bins.size(), 1u);
  EXPECT_EQ(s.knots.size(), std::min<size_t>(4, s.bins.size()));
  EXPECT_NEAR(s.reference_um, 0.55, 1e-12);
}

TEST(State, ImpossibleRequestsAreRefused) {
  const std::vector<Band> bands = uas_bands();
  EXPECT_THAT(message_of([&] { make_state({}, 0.01); }), HasSubstr("at least one band"));
  EXPECT_THAT(message_of([&] { make_state(bands, 0); }), HasSubstr("must be positive"));
  EXPECT_THAT(message_of([&] { make_state(bands, NAN); }), HasSubstr("must be positive"));
  EXPECT_THAT(message_of([&] { make_state(bands, 1e-9); }), HasSubstr("at most 100000 are carried"));
}

TEST(State, SamplesAreBinAverages) {
  const SpectralState s = make_state(uas_bands(), 0.005);
  const Curve line({0.3, 1.0}, {0.3, 1.0}, Outside::error);
  const std::vector<float> v = s.sample(line);
  for (size_t i = 0; i < v.size(); ++i) EXPECT_NEAR(v[i], s.bins[i].center_um(), 1e-7);
  EXPECT_THROW(s.sample(Curve({0.5, 0.6}, {1, 1}, Outside::error)), Error);
}

TEST(Projection, KeepsConstantsAndStraightLines) {
  std::vector<Band> bands = uas_bands();
  bands.push_back(Band::tabulated("odd", Curve({0.5, 0.52, 0.6, 0.61}, {0.1, 1, 0.2, 0}, Outside::error)));
  bands.push_back(Band::rectangular("wide", 0.65, 0.5));
  for (const double step : {0.001, 0.01}) {
    const SpectralState s = make_state(bands, step);
    const BandProjection p(s, bands);
    ASSERT_EQ(p.bands(), bands.size());
    std::vector<double> constant(s.size(), 0.7), line(s.size()), out(bands.size());
    for (size_t i = 0; i < s.size(); ++i) line[i] = 2 + s.bins[i].center_um();
    p.apply(constant, out);
    for (const double v : out) EXPECT_NEAR(v, 0.7, 1e-14);
    p.apply(line, out);
    for (size_t b = 0; b < bands.size(); ++b) {
      double sum = 0;
      for (size_t i = 0; i < s.size(); ++i) sum += p.weight(b, i);
      EXPECT_NEAR(sum, 1, 1e-12);
      // The mean wavelength of the response; bins blur it by at most the square of the step over the width.
      const double center = Band::tabulated("x", bands[b].response).center_um;
      EXPECT_NEAR(out[b], 2 + center, step * step / bands[b].fwhm_um) << bands[b].name;
    }
  }
}

// The g-points of an interval share what the interval counts by their weights.
TEST(Projection, GPointsShareTheirInterval) {
  const std::vector<Band> bands{Band::gaussian("a", 0.55, 0.02)};
  const SpectralState whole = make_state(bands, 0.005);
  SpectralState state = whole;
  const size_t k = whole.size() / 2;
  Bin low = whole.bins[k], high = low;
  low.weight = 0.3, high.weight = 0.7, high.g = 1;
  state.bins[k] = low;
  state.bins.insert(state.bins.begin() + static_cast<long>(k) + 1, high);
  place_knots(state, 4);
  const BandProjection all(whole, bands), split(state, bands);
  EXPECT_NEAR(split.weight(0, k), 0.3 * all.weight(0, k), 1e-15);
  EXPECT_NEAR(split.weight(0, k + 1), 0.7 * all.weight(0, k), 1e-15);
  double sum = 0;
  for (size_t b = 0; b < state.size(); ++b) sum += split.weight(0, b);
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_NE(state.key(), whole.key());
  SpectralState other = state;
  other.bins[k].weight = 0.4;
  EXPECT_NE(other.key(), state.key());
}

TEST(Projection, TakesTheSharesOfAState) {
  const std::vector<Band> bands{Band::rectangular("a", 0.5, 0.1), Band::rectangular("b", 0.55, 0.1)};
  SpectralState s = make_state(bands, 0.05);
  ASSERT_EQ(s.size(), 3u);
  s.shares = {0.25, 0.75, 0, 0, 0.5, 0.5};
  const BandProjection p(s, bands);
  EXPECT_FALSE(p.identity());
  std::vector<double> out(2);
  p.apply(std::vector<double>{1, 2, 4}, out);
  EXPECT_DOUBLE_EQ(out[0], 1.75);
  EXPECT_DOUBLE_EQ(out[1], 3);
  EXPECT_EQ(p.weight(1, 0), 0);
  s.shares.pop_back();
  EXPECT_THAT(message_of([&] { BandProjection(s, bands); }), HasSubstr("5 shares for 2 bands and 3 bins"));
  s.shares = {0, 0, 0, 0, 0.5, 0.5};
  EXPECT_THAT(message_of([&] { BandProjection(s, bands); }), HasSubstr("band 'a' is not covered"));
}

TEST(BandMean, IsExactForPiecewiseLinearCurves) {
  // A triangle from 1 to 3 um of area 1; the mean distance from its middle is 2 (1/2 - 1/3) = 1/3.
  const Band band = Band::triangular("t", 2, 1);
  EXPECT_NEAR(band_mean(band, Curve({0.5, 2, 3.5}, {1.5, 0, 1.5}, Outside::error)), 1.0 / 3, 1e-14);
  EXPECT_EQ(band_mean(band, Curve::constant(0.7)), 0.7);
  // Outside its range this curve is 0: half of the triangle is lit.
  EXPECT_NEAR(band_mean(band, Curve({2, 4}, {1, 1}, Outside::zero)), 0.5, 1e-14);
  EXPECT_THROW(band_mean(band, Curve({2, 4}, {1, 1}, Outside::error)), Error);
}

TEST(Projection, ABandOutsideTheStateIsRefused) {
  const std::vector<Band> bands = uas_bands(), other{Band::gaussian("swir", 1.6, 0.05)};
  EXPECT_THAT(message_of([&] { BandProjection(make_state(bands, 0.01), other); }),
              HasSubstr("band 'swir' is not covered by the bins"));
}

}  // namespace suite::spectral_test
