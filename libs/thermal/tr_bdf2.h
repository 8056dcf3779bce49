// TR-BDF2 as a singly diagonally implicit scheme of second order, L-stable, with an embedded third-order result.
// Source: M. E. Hosea, L. F. Shampine, "Analysis and implementation of TR-BDF2", Appl. Num. Math. 20, 1996, table 1.
#pragma once

namespace suite::tr_bdf2 {

inline constexpr double kRoot2 = 1.41421356237309504880;
// The middle stage lies at kGamma of the step; both stages solve with kD of it; the result weighs the rates at the
// begin, in the middle and at the end by kW, kW, kD.
inline constexpr double kGamma = 2 - kRoot2, kD = kGamma / 2, kW = kRoot2 / 4;
// Weights of the three rates in the difference to the embedded result.
inline constexpr double kError1 = (1 - kW) / 3 - kW, kError2 = (3 * kW + 1) / 3 - kW, kError3 = kD / 3 - kD;

}  // namespace suite::tr_bdf2
