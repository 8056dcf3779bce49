// What an audit of temperatures found (heat_audit.h).
#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

#include "math/vec.h"

namespace suite {

struct AuditProbe {
  uint32_t face = 0;
  Vec3 at;                    // m, ENU
  double time = 0;            // s
  double found = 0;           // K, of the element
  double walked[2] = {0, 0};  // K, of the place by both walks
  double more[2] = {0, 0};    // K, of the place than its element, by both walks
};

struct HeatAudit {
  std::vector<AuditProbe> probes;
  double bias = 0, bias_error = 0;      // K, element minus place, mean over area and time, and its standard error
  double square = 0, square_error = 0;  // K2, mean square of element minus place
  double whole = 0, whole_error = 0;    // K, as bias, of temperatures that the walks find by themselves
  double rays = 0;
  size_t cut = 0;   // walks that were ended after kMostEvents
  size_t fast = 0;  // waits that were too long for how rates grew meanwhile
  static constexpr uint32_t kMostEvents = 4000000;
  static constexpr double kSure = 1.96;  // standard errors, 95 %

  // Of the spread of elements' errors, K: 0 when the interval of `square` holds 0.
  double spread() const { return square > kSure * square_error ? std::sqrt(square) : 0; }
  bool biased() const { return std::fabs(bias) > kSure * bias_error; }
};

}  // namespace suite
