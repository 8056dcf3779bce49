// Real air that knows the scene, for tests against paths that are scattered in the same layers every time.
#pragma once
#include <algorithm>
#include <cmath>

#include "air/air_spec.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test {

// z-tests of all rays and bands at once; 0.5 % is allowed for what the field's tables are off.
constexpr double kAllowed = 0.005, kSigmas = 4;  // of 12 values: 8e-4
inline double largest_z(const CaptureResult& a, const CaptureResult& b, double allowed = kAllowed) {
  double largest = 0;
  for (size_t i = 0; i < a.radiance.size(); ++i) {
    const double off = std::fabs(a.radiance[i] - b.radiance[i]) - allowed * b.radiance[i];
    largest = std::max(largest, off / std::hypot(a.standard_error[i], b.standard_error[i]));
  }
  return largest;
}

// The standard profile with haze of an optical depth.
inline AirSpec haze(double depth) {
  AirSpec air;
  air.profile = standard_profile("us_standard");
  air.aerosol = AirSpec::Aerosol{};
  air.aerosol->profile = air.aerosol->profile.with_depth(depth);
  return air;
}

// From 200 km above, towards a place.
inline Ray from_space(Vec3 to, double zenith_deg, double azimuth) {
  const Dir d = -dir_from_angles(zenith_deg * kDegree, azimuth);
  return {to - d * 2e5, d, 0};
}

}  // namespace suite::test
