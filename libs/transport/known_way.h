// Control variate for the air on sensors' rays that hardly differ: what it does on one of them is found exactly, and
// counts for the others of a wave with the difference found now and then, so that the mean stays that of finding
// it each time. A frame of many bands spends as much on its air as on its surfaces otherwise.
//
// With probability p a way is T = T0 + (T_exact - T0) / p, and S alike, else T0, S0. Ways count as hardly different
// where that changes a path's light by some 0.01 sqrt(1 / p - 1) at most, which is noise like all other.
// Based on: splitting a sum into a known part and a sampled rest, e.g. M. Kalos, P. Whitlock, "Monte Carlo methods",
// 2008, section 4.1.
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "light/atmosphere.h"
#include "math/sampling.h"

namespace suite {

class KnownWay {
 public:
  explicit KnownWay(size_t bins) : T_(bins), S_(bins) {}
  // What is known must not outlive a wave: which paths are in one does not depend on who runs it. It does depend on
  // where a run was cut: `--more` has the mean of one run of all paths, with other noise.
  void forget() { known_ = false; }
  // Atmosphere::path() in the mean. Below T = 1e-13 it may be 0.
  void path(const Atmosphere& air, Vec3 from, Dir d, double way, std::span<float> T, std::span<float> S) {
    const bool near = known_ && alike(from, d, way);
    if (near && !looks(from, d, way)) {
      std::copy(T_.begin(), T_.end(), T.begin());
      std::copy(S_.begin(), S_.end(), S.begin());
      return;
    }
    air.path(from, d, way, T, S);
    if (!near) return keep(air.steepness(d), from, d, way, T, S);
    for (size_t i = 0; i < T.size(); ++i) {
      const float t = T_[i] + kOneIn * (T[i] - T_[i]);
      T[i] = t < 0 ? 0 : t;
      S[i] = S_[i] + kOneIn * (S[i] - S_[i]);
    }
  }

 private:
  static constexpr int kOneIn = 16;
  static constexpr double kAlike = 0.01;    // of the depth, and of S
  static constexpr double kOpaque = 30;     // depth beyond which nothing counts
  static constexpr double kOutwards = 1e3;  // m over which ways out of the air change by their depth

  bool alike(Vec3 from, Dir d, double way) const {
    const double further = way == way_ ? 0 : std::fabs(way - way_);  // infinity from infinity
    const double change = depth_per_m_ * (further + length(from - from_)) + steepness_ * length(d - direction_);
    return change < kAlike;  // not where anything is infinite
  }
  // Whether the difference is found: by the last digits of the way.
  static bool looks(Vec3 from, Dir d, double way) {
    const auto bits = [](double v) { return std::bit_cast<uint64_t>(v); };
    const uint64_t there = hash_of(bits(d.x), bits(d.y), bits(way)), here = hash_of(bits(from.x), bits(from.y));
    return hash_of(there, here, bits(from.z)) % kOneIn == 0;
  }
  void keep(double steepness, Vec3 from, Dir d, double way, std::span<const float> T, std::span<const float> S) {
    known_ = steepness < std::numeric_limits<double>::infinity();
    if (!known_) return;
    from_ = from, direction_ = d, way_ = way, steepness_ = steepness;
    const double least = *std::min_element(T.begin(), T.end());
    const double depth = std::min(kOpaque, -std::log(std::max(least, std::exp(-kOpaque))));
    depth_per_m_ = std::max(depth, 0.0) / std::min(way, kOutwards);
    std::copy(T.begin(), T.end(), T_.begin());
    std::copy(S.begin(), S.end(), S_.begin());
  }

  bool known_ = false;
  Vec3 from_;
  Dir direction_;
  double way_ = 0, depth_per_m_ = 0, steepness_ = 0;
  std::vector<float> T_, S_;
};

}  // namespace suite
