// The azimuth modes of scattering matrices: what a matrix (greek_matrix.h) makes of the m-th mode of light.
//
// Light is written I, Q = sum X_m cos(m phi) and U, V = sum X_m sin(m phi), phi from the azimuth in which the beam
// travels; unpolarised beams and grounds without a preferred direction make no other. For cosines of travel mu, mu' the
// kernel is
//   K_m(mu, mu') = sum over l of Pi_l(mu) B_l Pi_l(mu')^T,
//   Pi = (P 0 0 0; 0 R -T 0; 0 -T R 0; 0 0 0 P),  B = (a1 b1 0 0; b1 a2 0 0; 0 0 a3 b2; 0 0 -b2 a4)
// so that the matrix, 1/(4 pi) over the sphere, takes X_m(mu') to 1/2 integral K_m X_m dmu'. Where V is left out, what
// it gives back to I, Q and U is less than 1e-5 of I under air.
//
// Based on: C. Siewert, "A discrete-ordinates solution for radiative-transfer models that include polarization
// effects", J. Quant. Spectrosc. Radiat. Transfer 64, 2000.
#pragma once
#include <vector>

#include "air/greek_matrix.h"

namespace suite {

// The m-th mode of light at one cosine.
struct StokesMode {
  double i = 0, q = 0, u = 0, v = 0;
};
inline StokesMode operator*(double s, const StokesMode& x) { return {s * x.i, s * x.q, s * x.u, s * x.v}; }
inline StokesMode& operator+=(StokesMode& to, const StokesMode& x) {
  to.i += x.i, to.q += x.q, to.u += x.u, to.v += x.v;
  return to;
}

// Pi of one order at one cosine of travel, degree by degree; and B.
class StokesFunctions {
 public:
  StokesFunctions(int order, double mu, size_t degrees);
  size_t degrees() const { return rows_.size(); }
  StokesMode times(size_t degree, const StokesMode& x) const {  // Pi is symmetric
    const Row& r = rows_[degree];
    return {r.P * x.i, r.R * x.q - r.T * x.u, r.R * x.u - r.T * x.q, r.P * x.v};
  }
  static StokesMode scattered(const GreekMatrix::Degree& b, const StokesMode& x) {
    return {b.a1 * x.i + b.b1 * x.q, b.b1 * x.i + b.a2 * x.q, b.a3 * x.u + b.b2 * x.v, b.a4 * x.v - b.b2 * x.u};
  }

 private:
  struct Row {
    double P = 0, R = 0, T = 0;
  };
  std::vector<Row> rows_;
};

// K_m x, from one direction to another; functions of one order.
StokesMode scattered(const GreekMatrix& matrix, const StokesFunctions& out, const StokesFunctions& in,
                     const StokesMode& x);
// What the matrix, 1/sr, makes of a beam of unpolarised light.
StokesMode of_beam(const GreekMatrix& matrix, int order, const StokesFunctions& out, const StokesFunctions& beam);

}  // namespace suite
