// One even layer of scattering air for a mode of polarised light: what it reflects, lets through and, lit by a beam,
// sends out.
//
// Light of n components goes up and n go down; with U of the way down counted the other way round a layer is the same
// from both sides. With depths t from the layer's top
//   dI+/dt = a I+ - b I- - q+ exp(-s t),  dI-/dt = -a I- + b I+ + q- exp(-s t)
// a, b and q over the cosines. Sums and differences of I+ and I- part into X = a - b and Y = a + b: over half a depth h
//   R + T = (1 - G)(1 + G)^-1, G = X tanh(sqrt(Y X) h) / sqrt(Y X);  R - T = (H - 1)(H + 1)^-1, H with X and Y changed.
// tanh(z)/z is a quotient of polynomials of z^2, within 1e-7 up to z = 1; thicker layers are doubled. What is conserved
// by X stays so to rounding. A beam's part is its particular solution less what the layer makes of that.
//
// Based on: H. van de Hulst, "A new look at multiple scattering", 1963 (doubling); W. Wiscombe, "On initialization,
// error and flux conservation in the doubling method", J. Quant. Spectrosc. Radiat. Transfer 16, 1976.
#pragma once
#include <vector>

namespace suite {

class StokesLayer {
 public:
  explicit StokesLayer(int most) : most_(most) { resize(); }
  // X, Y: n x n; depth >= 0; steepest: largest 1 / cosine. Sets reflection() and transmission(). n <= most.
  void set(const double* X, const double* Y, int n, double depth, double steepest);
  const double* reflection() const { return R_.data(); }
  const double* transmission() const { return T_.data(); }
  // What leaves at the top and at the bottom of what a beam of secant s is scattered to: q up and down at the top.
  // After set().
  void respond(const double* q_up, const double* q_down, double secant, double* up, double* down);

 private:
  void resize();
  void half(const double* A, const double* B, double h, double* out);  // (1 - G)(1 + G)^-1, G of A = X and B = Y
  void double_up();
  bool particular(double secant, const double* sum, const double* difference);

  int most_, n_ = 0;
  double depth_ = 0;
  std::vector<double> X_, Y_, XY_, R_, T_, a_, b_, c_, p_sum_, p_difference_;
  std::vector<int> pivot_;
};

}  // namespace suite
