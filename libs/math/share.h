// Shares of a whole that were computed: one minus another, means, sums of parts.
#pragma once

namespace suite {

// What rounding may put a share beyond 0 or 1 by; more is a fault of what it was computed from.
inline constexpr double kShareRounding = 1e-9;

// The share without that rounding: 0 or 1 within 1e-9 beyond them. What lies farther outside (or is NaN) stays as it
// is, for whoever refuses it.
inline double as_share(double computed) {
  if (computed < 0 && computed >= -kShareRounding) return 0;
  if (computed > 1 && computed <= 1 + kShareRounding) return 1;
  return computed;
}

inline bool is_share(double computed) {
  const double share = as_share(computed);
  return share >= 0 && share <= 1;
}

}  // namespace suite
