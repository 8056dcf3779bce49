// Range bins: sums, centroids and variances of deposits; places of returns; folded pulses; gates.
#include "detection/response.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "detection/gate.h"
#include "detection/pulses_in_air.h"
#include "detection/range_bins.h"
#include "math/sampling.h"
#include "math/stats.h"
#include "support/message_of.h"
#include "support/response_kit.h"

namespace suite::response_test {
namespace {

using namespace test;
using testing::HasSubstr;

// Any place within the gate: the sum is exact, and so is the centroid, half a bin from the ends.
TEST(RangeBins, SumsAndCentroidsAreExact) {
  const ResponseHead head = response_head();
  Pcg32 random(1);
  double nearest_error = 0;  // of the rule that it must not be: the nearest bin
  for (int n = 0; n < 200; ++n) {
    const double arrival = 1e-6 + head.bin * (1 + 1900 * random.uniform());
    RangeBins bins(head, 1e-6, 2);
    bins.deposit(0, arrival, 3, false, 2), bins.deposit(1, arrival, 3, false, 2);
    ResponseBlock b;
    b.pulses.push_back({0, 1, 1, 1e-6, {}, {}});
    bins.end_row(b);
    ASSERT_EQ(fault_of(head, b), "");
    double sum = 0, first = 0;
    const ResponseRow row(head, b, 0);
    for (size_t k = 0; k < row.size(); ++k) {
      sum += row.photons(k), first += row.photons(k) * arrival_of_bin(head, row.pulse(), row.bin(k));
      EXPECT_EQ(row.value(k, 2), row.value(k, kSingle));
    }
    EXPECT_NEAR(sum, 3, 1e-12);
    EXPECT_NEAR(first / sum, arrival, 1e-18);
    const double nearest = 1e-6 + (std::floor((arrival - 1e-6) / head.bin) + 0.5) * head.bin;
    nearest_error = std::max(nearest_error, std::fabs(nearest - arrival));
  }
  EXPECT_GT(nearest_error, 4e-11);
}

TEST(RangeBins, VariancesAreThoseOfTheMean) {
  const ResponseHead head = response_head();
  constexpr int kScrambles = 8, kRuns = 400;
  Pcg32 random(2);
  RunningStats values, variances;
  for (int run = 0; run < kRuns; ++run) {
    RangeBins bins(head, 0, kScrambles);
    for (int s = 0; s < kScrambles; ++s) bins.deposit(s, 10.5e-10, random.uniform(), true);
    ResponseBlock b;
    bins.end_row(b);
    values.add(b.value[kMultiple]), variances.add(b.variance[kMultiple]);
  }
  // Uniform numbers: 1/12 a scramble. 4 standard errors of a mean of 400 variances.
  EXPECT_NEAR(variances.mean(), 1.0 / 12 / kScrambles, 4 * variances.stderr_of_mean());
  EXPECT_NEAR(values.variance(), 1.0 / 12 / kScrambles, 4 * values.variance() * std::sqrt(2.0 / kRuns));
  EXPECT_GT(std::fabs(variances.mean() - 1.1 / 12 / kScrambles), 4 * variances.stderr_of_mean());  // negative control
}

TEST(RangeBins, OutsideOfTheGateAndNeverReached) {
  const ResponseHead head = response_head();
  RangeBins bins(head, 1e-6, 2);
  bins.deposit(0, 0.9e-6, 5, false), bins.deposit(1, 1e-6 + head.bin * (head.bins + 0.5), 5, false);
  EXPECT_DOUBLE_EQ(bins.outside(), 5);
  ResponseBlock b;
  bins.end_row(b);
  EXPECT_TRUE(std::isnan(b.bound[0]));  // nothing is known
  bins.deposit(0, 1.05e-6, 4, false);
  bins.end_row(b);
  EXPECT_DOUBLE_EQ(b.bound[1], 3 * 4 / 2.0);  // rule of three times the largest contribution to the mean
}

// |P - E| + |P - R| = c t for any geometry; monostatic r = c t / 2.
TEST(Response, PlacesOfReturns) {
  ResponseHead head = response_head();
  ResponsePulse p = response_pulse(0);
  const double arrival = 6.6e-6;
  EXPECT_NEAR(length(*place_of_return(head, p, 0, arrival) - p.emission.translation), kSpeedOfLight * arrival / 2,
              1e-9);
  p.reception.translation = {300, -200, 1050};
  p.emission.rotation = quat_about({1, 0, 0}, 0.3);
  for (const PlacesAlong along : {PlacesAlong::beam, PlacesAlong::pixel}) {
    head.along = along, head.group_index = 1.00028;
    const Vec3 at = *place_of_return(head, p, 0, arrival);
    EXPECT_NEAR(length(at - p.emission.translation) + length(at - p.reception.translation),
                kSpeedOfLight * arrival / head.group_index, 1e-9);
  }
  EXPECT_FALSE(place_of_return(head, p, 0, 1e-6));  // shorter than the baseline
}

// 10 kHz and a target at 20 km: 133.4 us fold to 33.4 us of the next pulse.
TEST(PulsesInAir, FoldUnfoldRefuse) {
  ResponseHead head = response_head();
  ResponseBlock b = response_block(head, 0, 3);
  const double far = 2 * 20000 / kSpeedOfLight, interval = 1e-4;
  for (size_t p = 0; p < 3; ++p) b.pulses[p].time = static_cast<double>(p) * interval, b.pulses[p].start = far - 50e-9;
  FoldedRows fold(head, PulsesInAir::fold), unfold(head, PulsesInAir::unfold), refuse(head, PulsesInAir::refuse);
  EXPECT_TRUE(fold.arrivals({head, b, 0}, interval).empty());
  const std::vector<PhotonArrival> folded = fold.arrivals({head, b, 1}, 2 * interval);
  ASSERT_EQ(folded.size(), size_t{2});
  EXPECT_NEAR(folded[1].time, far + 0.05e-9 - interval, 1e-15);
  EXPECT_DOUBLE_EQ(folded[1].photons, 300);
  EXPECT_NEAR(unfold.arrivals({head, b, 0}, interval)[1].time, far + 0.05e-9, 1e-15);
  EXPECT_THAT(message_of([&] {
                refuse.arrivals({head, b, 0}, interval);
              }),
              HasSubstr("ranges beyond 14989.6 m are ambiguous"));
  EXPECT_THAT(message_of([&] { refuse.arrivals({head, b, 0}, -1); }), HasSubstr("not before the one behind it"));
}

TEST(Gates, FollowWhatCameBack) {
  const GateSpec spec = read_gate(Params::parse_text(
      "gate: {start_m: 900, stop_m: 1200, follow: {ahead_m: 30, behind_m: 15, pulses: 3}}", "g.yaml"));
  Gate gate(spec);
  const double metre = 2 / kSpeedOfLight;
  EXPECT_NEAR(gate.window({0, 1}).start, 900 * metre, 1e-15);
  for (const double range : {1000.0, 1010.0, 1040.0, 1020.0}) gate.learn(std::vector<double>{range * metre});
  // The median of the last three.
  EXPECT_NEAR(gate.window({0, 1}).start, 990 * metre, 1e-15);
  EXPECT_NEAR(gate.window({0, 1}).stop, 1035 * metre, 1e-15);
  // Nothing came back: it searches again, and forgets.
  gate.learn({});
  EXPECT_NEAR(gate.window({0, 1}).start, 900 * metre, 1e-15);
  EXPECT_NEAR(gate.window({0, 1}).stop, 1200 * metre, 1e-15);
  gate.learn(std::vector<double>{1100 * metre});
  EXPECT_NEAR(gate.window({0, 1}).start, 1070 * metre, 1e-15);
  EXPECT_THAT(message_of([] { read_gate(Params::parse_text("gate: {start_m: 9, stop_m: 3}", "g.yaml")); }),
              HasSubstr("g.yaml:1:7: error: the gate ends before it begins"));
}

}  // namespace
}  // namespace suite::response_test
