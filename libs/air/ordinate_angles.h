// Angles of the discrete ordinates: quadrature over a hemisphere and the associated Legendre functions on it.
//
// Based on: J. B. Sykes, "Approximate integration of the equation of transfer", MNRAS 111, 1951 (Gauss's rule over each
// hemisphere by itself); J. Dave, B. Armstrong, "Computations of high-order associated Legendre polynomials",
// J. Quant. Spectrosc. Radiat. Transfer 10, 1970 (upward recurrence in the degree).
#pragma once
#include <span>
#include <vector>

namespace suite {

struct GaussRule {
  std::vector<double> nodes, weights;  // on [0, 1], nodes falling; the weights sum to 1
};
// Gauss-Legendre with n >= 1 points, to rounding.
GaussRule gauss_rule(int n);

// sqrt((l - m)! / (l + m)!) P_l^m(mu) for l = m .. m + values.size() - 1, without the sign (-1)^m; |mu| <= 1.
void associated_legendre(int order, double mu, std::span<double> values);

}  // namespace suite
