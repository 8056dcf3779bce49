#include "motion/star_refraction.h"

#include <erfa.h>

#include <algorithm>
#include <cmath>

namespace suite {

namespace {

constexpr double kEarth = 6371e3;         // m
constexpr double kDeepest = -1e3;         // m, of a ray's lowest place
constexpr double kNothing = 1e-9;         // rad
constexpr double kPerKelvin = 4.4474e-6;  // H over the Earth's radius, as in eraRefco

// exp(y^2) erfc(y), y >= 0.
double scaled_erfc(double y) {
  constexpr double kFar = 5;
  if (y < kFar) return std::exp(y * y) * std::erfc(y);
  const double w = 1 / (2 * y * y);
  return (1 - w * (1 - 3 * w * (1 - 5 * w))) / (y * std::sqrt(kPi));
}

}  // namespace

StarRefraction::StarRefraction(const SceneFrame& frame, const SurfaceAir& air) : frame_(frame) {
  double a = 0, b = 0;
  const double share = kPerKelvin * air.temperature;
  eraRefco(air.pressure * 1e-2, air.temperature - 273.15, air.humidity, air.wavelength_um, &a, &b);
  at_origin_ = a / (1 - share);
  scale_ = share * kEarth;
}

double StarRefraction::refractivity(double height) const {
  return at_origin_ * std::exp(-(height - frame_.origin().height_m) / scale_);
}

double StarRefraction::bending(double height, double zenith) const {
  const double r = kEarth + height, sine = std::sin(zenith), cosine = std::fabs(std::cos(zenith)), depth = r / scale_;
  const double onwards =
      refractivity(height) * sine * std::sqrt(kPi / 2 * depth) * scaled_erfc(std::sqrt(depth / 2) * cosine);
  if (zenith <= kPi / 2) return onwards;
  // Both ways from the lowest place, less what lies behind the observer.
  const double lowest = std::max(kDeepest, r * sine - kEarth);
  return 2 * refractivity(lowest) * std::sqrt(kPi / 2 * (kEarth + lowest) / scale_) - onwards;
}

// seen + bending(seen) = bare, which rises: by false position.
double StarRefraction::seen_zenith(double height, double bare) const {
  double low = bare - bending(height, bare), high = bare;
  double off_low = low + bending(height, low) - bare, off_high = high - low;
  for (int i = 0; i < 60 && high - low > kNothing && off_low < 0; ++i) {
    const double middle = high - off_high * (high - low) / (off_high - off_low);
    const double off = middle + bending(height, middle) - bare;
    if (std::fabs(off) < kNothing) return middle;
    if (off > 0)
      high = middle, off_high = off, off_low *= 0.5;
    else
      low = middle, off_low = off, off_high *= 0.5;
  }
  return off_low < 0 ? 0.5 * (low + high) : low;
}

Dir StarRefraction::seen(Dir bare, Vec3 from) const {
  const Dir up = frame_.local_axes(from).z;
  const double zenith = angle_between(bare, up), height = frame_.geodetic_from_enu(from).height_m;
  const Vec3 level = bare - up * dot(bare, up);
  const double across = length(level);
  if (!(across > 0) || bending(height, zenith) < kNothing) return bare;
  const double lifted = seen_zenith(height, zenith);
  return normalized(level * (std::sin(lifted) / across) + up * std::cos(lifted));
}

}  // namespace suite
