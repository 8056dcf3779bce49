// Beams and fields by themselves: what is drawn has the density that is told, and that adds up to 1.
#include <gtest/gtest.h>

#include "lidar/field.h"
#include "lidar/first_direction.h"
#include "math/sampling.h"

namespace suite::test::beam_test {
namespace {

BeamProfile top_hat(double half, double waist = 0) {
  BeamProfile p;
  p.kind = BeamProfile::Kind::top_hat;
  p.half_angle = half, p.waist = waist;
  return p;
}
BeamProfile gaussian(double full, double waist = 0) {
  BeamProfile p;
  p.full_angle_1_e2 = full, p.waist = waist;
  return p;
}
// Brighter to the right and below.
BeamProfile image() {
  BeamProfile p;
  p.kind = BeamProfile::Kind::image;
  p.columns = 3, p.rows = 2, p.cell = 0.05;
  p.image = {1, 0, 2, 3, 4, 5};
  return p;
}

// The share of the energy in a quarter of the tangent plane and within a radius, by the density and by draws.
TEST(LaserBeam, DrawsByItsDensity) {
  struct Case {
    const char* name;
    BeamProfile profile;
    double distance;
  };
  for (const Case& c : {Case{"top hat", top_hat(0.1), 100},
                        {"top hat with a waist", top_hat(0.05, 0.05), 1},
                        {"Gaussian", gaussian(0.2), 100},
                        {"Gaussian with a waist", gaussian(0.1, 0.05), 1},
                        {"image", image(), 100}}) {
    const LaserBeam beam(c.profile);
    constexpr int n = 1200;
    constexpr double edge = 0.5, radius = 0.06;
    double all = 0, quarter = 0, within = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double x = edge * (2 * (i + 0.5) / n - 1), y = edge * (2 * (j + 0.5) / n - 1);
        const double r2 = x * x + y * y, cosine = 1 / std::sqrt(1 + r2);
        const double e = beam.density(Vec3{x, y, -1} * cosine, c.distance) * cosine * cosine * cosine * 4 * edge *
                         edge / (double{n} * n);
        all += e;
        if (x > 0 && y > 0) quarter += e;
        if (r2 < radius * radius) within += e;
      }
    EXPECT_NEAR(all, 1, 5e-3) << c.name;
    const SampleStream stream(3, 0, 0);
    constexpr uint32_t draws = 4096;
    double in_quarter = 0, in_radius = 0;
    for (uint32_t k = 0; k < draws; ++k) {
      const auto u = stream.draw(k, 0);
      const Dir d = beam.sample({u[0], u[1]}, c.distance);
      EXPECT_GT(beam.density(d, c.distance), 0) << c.name;
      in_quarter += d.x > 0 && d.y > 0;
      in_radius += std::hypot(d.x, d.y) < -d.z * radius;
    }
    // 4 standard deviations of independent draws, of which these are strata.
    EXPECT_NEAR(in_quarter / draws, quarter, 4 * std::sqrt(0.25 / draws) + 5e-3) << c.name;
    EXPECT_NEAR(in_radius / draws, within, 4 * std::sqrt(0.25 / draws) + 5e-3) << c.name;
  }
}

// Rays that start in the waist meet a plane by the same density.
TEST(LaserBeam, StartsLikeItsDensityAtAnyDistance) {
  for (const BeamProfile& profile : {top_hat(0.01, 0.03), gaussian(0.02, 0.03)})
    for (const double distance : {0.5, 3.0, 30.0}) {
      const LaserBeam beam(profile);
      const SampleStream stream(5, 0, 0);
      constexpr uint32_t draws = 8192;
      double starts = 0, samples = 0;
      for (uint32_t k = 0; k < draws; ++k) {
        const auto u = stream.draw(k, 0), v = stream.draw(k, 1);
        const LaserBeam::Start s = beam.start({u[0], u[1]}, {v[0], v[1]});
        const double t = distance / -s.direction.z;
        const Vec3 at = s.place + s.direction * t;
        const Dir d = beam.sample({u[2], u[3]}, distance);
        starts += at.x * at.x + at.y * at.y;
        samples += (d.x * d.x + d.y * d.y) / (d.z * d.z) * distance * distance;
      }
      EXPECT_NEAR(starts / samples, 1, 0.02) << distance;
    }
}

TEST(ReceiverField, PixelsAreWhereTheyAre) {
  LidarReceiver r;
  r.columns = 4, r.rows = 3, r.pitch = 1e-4, r.focal = 0.05, r.aperture = 0.025, r.throughput = 0.8,
  r.obscuration = 0.1;
  const ReceiverField field(r);
  EXPECT_EQ(field.pixels(), 12u);
  EXPECT_LT(field.middle(0).x, 0) << "the first pixel is above left";
  EXPECT_GT(field.middle(0).y, 0);
  const SampleStream stream(7, 0, 0);
  for (size_t pixel = 0; pixel < 12; ++pixel) {
    double photons = 0;
    for (uint32_t k = 0; k < 64; ++k) {
      const auto u = stream.draw(k, 0);
      const Dir d = field.sample(pixel, {u[0], u[1]});
      const auto seen = field.at(d);
      ASSERT_TRUE(seen);
      EXPECT_EQ(seen->pixel, pixel);
      photons += seen->importance / field.density(d) / 64;
    }
    // Of radiance 1: pixel area / G#.
    EXPECT_NEAR(photons, 1e-8 * kPi * 0.8 * 0.9 / (1 + 4 * 4.0), 1e-12 * photons + 1e-20);
  }
  EXPECT_FALSE(field.at({0, 0, 1}));
  EXPECT_FALSE(field.at(normalized(Vec3{0.1, 0, -1})));
}

// First directions of every way of drawing add up to the same importance: that of a pixel within the beam.
TEST(FirstDirection, IsUnbiasedFromAnyBaseline) {
  LidarReceiver r;
  r.field_of_view = 0.04;
  const ReceiverField field(r);
  const LaserBeam beam(gaussian(0.01));
  for (const double baseline : {0.0, 0.5, 30.0}) {
    PulseAtWork pulse;
    pulse.range = 100;
    const double tilt = std::atan2(baseline, 100);
    pulse.receiver = {quat_about({0, 1, 0}, tilt), {baseline, 0, 0}};
    const FirstDirection directions(beam, field, 50, 150, FirstDirection::InField::needed);
    const SampleStream stream(11, 0, 0);
    constexpr uint32_t draws = 16384;
    double sum = 0, squares = 0;
    for (uint32_t k = 0; k < draws; ++k) {
      const double x = directions.draw(pulse, 0, stream.draw(k, 0)).importance;
      sum += x, squares += x * x;
    }
    const double mean = sum / draws, error = std::sqrt((squares / draws - mean * mean) / draws);
    const double expected = kPi * r.aperture * r.aperture / 4 * field.solid_angle();
    EXPECT_NEAR(mean, expected, 4 * error) << baseline;
    EXPECT_LT(error, 0.05 * expected) << baseline;
  }
}

}  // namespace
}  // namespace suite::test::beam_test
