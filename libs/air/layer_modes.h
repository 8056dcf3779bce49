// One plane layer of the discrete-ordinate equations, for one azimuth order: its modes, and how it answers light from
// outside and sources within.
//
// Written with the sum s and the difference d of the radiances up and down at the same slant, both weighted by
// sqrt(mu_i w_i), the equations are s' = A d - qd, d' = B s - qs over the depth x of the layer, with A and B symmetric
// and positive (B singular when the albedo is 1). With A = L L^T and L^T B L = V k^2 V^T the amplitudes f and g of
//   s = S f, d = D g,  S = L V, D = L^-T V, S^T D = 1
// follow f' = g - p, g' = k^2 f - q, one pair a mode: k = 0 is nothing special. Sources are p, q times exp(-x secant)
// (a beam), or q times a linear function (emission). Every integral over them is written so that no secant meets a k
// in a difference that is divided by.
//
// Based on: S. Chandrasekhar, "Radiative transfer", 1950 (reduction to half the order); T. Nakajima, M. Tanaka, "Matrix
// formulations for the transfer of solar radiation in a plane-parallel scattering atmosphere", J. Quant. Spectrosc.
// Radiat. Transfer 35, 1986 (symmetric form); K. Stamnes, S.-C. Tsay, W. Wiscombe, K. Jayaweera, "Numerically stable
// algorithm for discrete-ordinate-method radiative transfer", Appl. Opt. 27, 1988.
#pragma once

namespace suite::ordinates {

// Pointers into storage of the caller's: matrices n x n row by row, vectors of n.
template <class Number>
struct ModesOf {
  Number *S = nullptr, *D = nullptr, *k = nullptr;
  operator ModesOf<const Number>() const { return {S, D, k}; }
};
using Modes = ModesOf<const double>;

// a, b: the matrices A and B, destroyed. conservative: the smallest k is 0 exactly. False: not of a phase function.
bool find_modes(double* a, double* b, bool conservative, const ModesOf<double>& modes, int n);

// reflection and transmission of light from outside, for weighted radiances; depth >= 0. Both are symmetric. Error in
// each entry some 1e-16, and relative to itself in a reflection of a thin layer.
void layer_response(const Modes& modes, double depth, double* reflection, double* transmission, int n);

// Integrals of a source over the layer against the two shapes sinh(k (T - x)) / sinh(k T) and sinh(k x) / sinh(k T).
struct EndIntegrals {
  double top = 0, bottom = 0;
};
// Of exp(-x secant); secant of any sign with secant * depth >= -100.
EndIntegrals beam_integrals(double k, double secant, double depth);
// Of 1 - x / T (top) and of x / T (bottom), both against the first shape; against the second they change places.
EndIntegrals linear_integrals(double k, double depth);
// Of 1 - x / T and x / T against exp(-x / T slant) slant / T: what leaves the top of a layer that only emits.
EndIntegrals emission_integrals(double slant);

// Integral of exp(-a x) over 0..T; any a with a T >= -700.
double decay_integral(double a, double depth);

}  // namespace suite::ordinates
