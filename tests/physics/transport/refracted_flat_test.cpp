// The sun under flat water: light that is asked for through one smooth interface, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/flat_water_kit.h"

namespace suite::test::refracted_flat_test {
namespace {

void expect(const FlatWater& w, double half_angle, double zenith, uint32_t paths = 16384, double tolerance = 0.005) {
  const double truth = bed_radiance(w, half_angle, zenith);
  const auto r = see_bed(w, half_angle, zenith, paths);
  const double mean = r.radiance[0], error = r.standard_error[0];
  SCOPED_TRACE(testing::Message() << "disk " << half_angle / kDegree << " deg, zenith " << zenith / kDegree
                                  << " deg, index " << w.index << ", depth " << w.depth << " m, absorption "
                                  << w.absorption << ": " << mean << " +- " << error << " for " << truth);
  EXPECT_NEAR(mean, truth, tolerance * truth);
  EXPECT_NEAR(mean, truth, 5 * error + 2e-5 * truth);  // 8 scrambles, p = 0.002; floats where nothing varies
  EXPECT_LE(r.missing[0], 1e-3 * truth);               // flagged as not resolved beyond
}

TEST(RefractedFlat, TheKnownCase) {
  const FlatWater w;
  EXPECT_NEAR(bed_radiance(w, 0, 30 * kDegree), 0.0522, 5e-5);  // PHYSICS: 2 m, 30 and 20 degrees
  expect(w, 0, 30 * kDegree);
}

TEST(RefractedFlat, DisksAndSuns) {
  for (const double disk : {0.0, 0.27, 1.0, 10.0})
    for (const double zenith : {0.0, 30.0, 60.0, 75.0}) expect({}, disk * kDegree, zenith * kDegree);
}

TEST(RefractedFlat, AbsorbingWater) {
  for (const double absorption : {0.1, 1.0})
    for (const double disk : {0.0, 0.27}) expect({kWaterIndex, kWaterDepth, absorption}, disk * kDegree, 50 * kDegree);
}

// What connections own, chance leaves out: without them the same light is found by a wide disk alone.
TEST(RefractedFlat, ChanceAgreesWithAsking) {
  PipelineOptions chance;
  chance.refracted_sources = false;
  const double truth = bed_radiance({}, 10 * kDegree, 30 * kDegree);
  const auto r = see_bed({}, 10 * kDegree, 30 * kDegree, 131072, chance);
  EXPECT_NEAR(r.radiance[0], truth, 4.5 * r.standard_error[0]);
  EXPECT_LT(r.standard_error[0], 0.05 * truth);
  // Negative control: counted twice it would be twice as much.
  EXPECT_LT(r.radiance[0], 1.5 * truth);
  const auto asked = see_bed({}, 10 * kDegree, 30 * kDegree, 4096);
  // 0.2 was the bound before an eighth of the paths went to what the surface mirrors, which is nothing here.
  EXPECT_LT(asked.standard_error[0], 0.3 * r.standard_error[0]);
}

TEST(RefractedFlat, Extremes) {
  expect({1 + 1e-6}, 0, 30 * kDegree);
  expect({kWaterIndex, 1e-3}, 0, 30 * kDegree);
  expect({kWaterIndex, 1000}, 0, 30 * kDegree);
  expect({kWaterIndex, kWaterDepth, 5}, 0, 30 * kDegree);     // a way down and up of optical depth 21
  expect({kWaterIndex, kWaterDepth, 12.5}, 0, 30 * kDegree);  // and of 52
  expect({}, 0, 89.9 * kDegree, 65536);                       // Newton's steps beyond the horizon end starts
  expect({}, 0.27 * kDegree, 89.9 * kDegree);                 // half of the disk is below the horizon
  const auto horizon = see_bed({}, 0, 90 * kDegree, 256);
  EXPECT_LT(horizon.radiance[0], 1e-7);
}

}  // namespace
}  // namespace suite::test::refracted_flat_test
