// The slice of an isotropic surface seen along its normal: values over the angle from the normal alone. There the
// azimuth of the viewer means nothing, so values must not depend on that of the light, and near the normal they must
// not jump. What trees hold of that slice depends on the azimuth a little (measured data do, cells of the sphere are
// not rings, coding is lossy); the profile is its mean over azimuth, which keeps the integral over directions.
// Internal to libs/sqt and libs/sqt_fit.
#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "math/vec.h"
#include "sqt/aligned.h"
#include "sqt/log_scale.h"
#include "sqt/vectors.h"

namespace suite::sqt {

class PolarProfile {
 public:
  // Between a knot and the next.
  struct At {
    size_t knot = 0;
    float t = 0;  // [0, 1)
  };
  // Values of the slice, one a channel, on side `sheet`; d: a direction of the divided sphere, d.z >= 0.
  using Ask = std::function<void(size_t sheet, Dir d, std::span<float> f)>;

  PolarProfile() = default;
  // half: azimuths 0 to pi stand for all. scales: of each sheet, in which numbers are kept.
  PolarProfile(size_t channels, bool half, std::vector<LogScale> scales, const Ask& ask);
  bool empty() const { return numbers_.empty(); }

  // below: 1 - d.z. Sixteen knots an octave of it, even in between, down to lobes of 0.02 deg.
  static At locate(double below) {
    const uint32_t bits = std::bit_cast<uint32_t>(std::min(1.0f, static_cast<float>(below) + kFinest)) - kFirst;
    return {bits >> kShift, static_cast<float>(bits & ((1u << kShift) - 1)) * (1.0f / (1u << kShift))};
  }
  // Numbers of the sheet's scale.
  float number(size_t sheet, At at, size_t channel) const {
    const float* p = &numbers_[(sheet * kKnots + at.knot) * row_ + channel];
    return p[0] + at.t * (p[row_] - p[0]);
  }
  // The same of eight channels, to the same bits.
  EightFloats numbers(size_t sheet, At at, size_t channel) const {
    const float* p = &numbers_[(sheet * kKnots + at.knot) * row_ + channel];
    const EightFloats low = load<EightFloats>(p);
    return low + at.t * (load<EightFloats>(p + row_) - low);
  }
  float log2(size_t sheet, At at, size_t channel) const { return scales_[sheet].value(number(sheet, at, channel)); }

  // Integral of values times weight(1 - d.z) over both sheets' half spheres of d.
  double integral(size_t channel, const std::function<double(double)>& weight) const;
  // Makes that integral `wanted`; nothing where either is 0.
  void set_integral(size_t channel, const std::function<double(double)>& weight, double wanted);

 private:
  static constexpr int kOctaves = 24, kPerOctave = 4, kShift = 23 - kPerOctave;  // 2^4 knots an octave
  static constexpr float kFinest = 0x1p-24f;
  static constexpr uint32_t kFirst = std::bit_cast<uint32_t>(kFinest);
  static constexpr size_t kKnots = (size_t{kOctaves} << kPerOctave) + 2;
  static double below_at(size_t knot);
  size_t row_ = 0;
  std::vector<LogScale> scales_;
  std::vector<float> numbers_;  // [sheet][knot][channel, filled up to eight and eight more]
};

// Where a direction falls in a leaf of the aligned method.
struct LeafPlace {
  const int16_t* numbers = nullptr;  // of the slice and the first channel: value, slopes; null: nothing there
  size_t step = 0;                   // to those of the next channel
  float dx = 0, dy = 0;
};
// The profile of the first slice, or an empty one where there is none to make: of surfaces that are not isotropic, and
// of slices that do not begin at the normal.
PolarProfile polar_profile(const AlignedLayout& layout, bool isotropic, const std::vector<LogScale>& scales,
                           const std::function<LeafPlace(size_t sheet, Dir d)>& find);
// Cosine times stretch (lobe_map.h) of a view along the normal, over 1 - d.z.
std::function<double(double)> polar_weight(const AlignedLayout& layout);

}  // namespace suite::sqt
