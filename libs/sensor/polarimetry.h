// What sensors that see polarisation are given, and what they make of their results.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/params.h"
#include "sensor/delivery.h"

namespace suite {

// Keys stokes: [i, q, u, v] | linear (i, q, u), stokes_frame: meridian | image | scattering_plane, and
// analyser: a train (analyser.h). Adds the channels of Q, U, V and `depolarised`.
// Nothing where neither stokes nor analyser is given. Error, located: an unknown component, or one twice; no i; a frame
// or an extinction without what it is for.
std::optional<Polarimetry> read_polarimetry(const Params& params, std::vector<std::string>& channels);

// Degree and angle of linear polarisation of what Q and U say, with the standard errors of the estimate.
struct LinearPolarisation {
  double degree, degree_error, debiased;  // 1
  double angle, angle_error;              // deg, [0, 180) from the first axis of the frame towards the second
  bool undefined;                         // the degree is below three of its errors: the angle means nothing
};
// S: I, Q, U; C: covariances of their errors, II, IQ, IU, QQ, QU, UU. The degree is biased upwards by noise; debiased
// is p - b^2 (1 - exp(-p^2/b^2)) / (2 p) with b the error (S. Plaszczynski et al., MNRAS 439, 2014). NaN where I is not
// positive; where an error is infinite so are these, and debiased is 0.
LinearPolarisation linear_polarisation(const double (&S)[3], const double (&C)[6]);
// The region of a confidence about (Q, U) is where d' C^-1 d is not above this, d being what Q and U are off by and C a
// covariance of so many degrees of freedom, above 1 (H. Hotelling 1931: n (a^(-2 / (n - 1)) - 1), a = 1 - confidence).
double joint_reach(double confidence, double degrees);
bool in_region(double q_off, double u_off, const double (&C)[6], double reach);

// Number of a channel; that of all where there is none of the name.
size_t channel_of(std::span<const std::string> channels, const char* name);
// Covariances of I, Q and U of a pixel: variances as the errors have them, correlations as the groups of samples do.
void covariances(const CaptureResult& r, size_t problem, size_t band, const double (&error)[3], double (&C)[6]);
// Of a delivery whose result has Q and U: bands dolp, dolp_error, dolp_debiased, aolp, aolp_error, aolp_undefined of
// each band, share of the light that counts as depolarised because no matrix is known; a product `covariance` of II,
// IQ, IU, QQ, QU and UU. Nothing else.
void add_polarisation(Delivery& delivery);
// In words, of the header.
std::string text_of(const Polarimetry& how);

}  // namespace suite
