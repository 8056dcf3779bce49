// The diffuse light in plane layers of air: fluxes, radiances, and the light that a volume scatters, at one wavelength.
//
// Assumes: plane layers, each uniform but for a Planck radiance linear in its depth; light without polarisation; a
// Lambert ground. The beam may run through a round Earth: it enters by secants alone.
// Units: radiances in one unit of the caller's per sr, irradiances in the same per cross-section (W/m2/um, say).
// Depths are optical. Level l is the top of layer l, layers counted from the top. Cosines mu are positive upwards, of
// the direction in which light travels; phi is measured from the azimuth in which the beam travels.
// Method: discrete ordinates, Gauss's rule over each hemisphere; every layer solved by its modes (layer_modes.h),
// layers joined by adding from the ground up, which no depth makes unstable. The strongest forward scattering, chi_S of
// S streams, counts as not scattered (delta-M): depth, albedo and moments are scaled by it, and so are all diffuse
// results except the flux of the direct beam; sums of direct and diffuse light need nothing. Radiances contain single
// scattering with the caller's phase function instead of the truncated one.
// Error of 16 streams against 64, suns of 17 to 53 degrees, scattering angles of 15 to 165 degrees: radiances 0.2 % for
// haze L, 2 % for the large drops of cloud C.1, fluxes 0.02 and 0.2 %; of 8 streams 5 % and 1 %. Nearer to the sun
// light scattered twice within the peak is missing (a cloud of depth 1: half of the light of the sun's very direction),
// and opposite to it the glory is up to 5 % too bright.
//
// Based on: S. Chandrasekhar, "Radiative transfer", 1950; K. Stamnes, S.-C. Tsay, W. Wiscombe, K. Jayaweera, Appl. Opt.
// 27, 1988; W. Wiscombe, "The delta-M method", J. Atmos. Sci. 34, 1977; T. Nakajima, M. Tanaka, "Algorithms for
// radiative intensity calculations in moderately thick atmospheres using a truncation approximation", J. Quant.
// Spectrosc. Radiat. Transfer 40, 1988 (TMS); A. Dahlback, K. Stamnes, "A new spherical model for computing the
// radiation field available for photolysis and heating at twilight", Planet. Space Sci. 39, 1991 (secants).
#pragma once
#include <memory>
#include <span>
#include <vector>

namespace suite {

struct DiffuseLayer {
  double depth = 0;   // >= 0, at most 1e9
  double albedo = 0;  // of single scattering, 0..1
  // chi_0 = 1, chi_1 = asymmetry, ..., |chi_l| <= 1; missing ones are 0; none at all: isotropic.
  std::span<const double> moments;
  double planck_top = 0, planck_bottom = 0;  // radiance of a black body, >= 0
};

// A sun.
struct DiffuseBeam {
  double irradiance = 0;  // across the beam, >= 0
  double cosine = 1;      // of its zenith angle, -1..1; not positive only with secants
  // Mean secant of the beam's path in each layer, of any sign: over a depth x, scaled or not, it falls by
  // exp(-secant x). Empty: 1 / cosine, a flat Earth.
  std::span<const double> secants;
  // Transmittance of the beam from outside down to the top of each layer, where the shadow of the Earth begins or ends:
  // the scaled beam starts anew from it. Negative: what the layer above leaves. Empty: so everywhere.
  std::span<const double> tops;
};

struct DiffuseProblem {
  std::span<const DiffuseLayer> layers;  // at least one; like the beam's spans read during the call only
  DiffuseBeam beam;
  double top_radiance = 0;     // isotropic, from above, >= 0
  double ground_albedo = 0;    // 0..1
  double ground_emission = 0;  // radiance, >= 0
  // Azimuth orders end when the sources of two in succession are below this part of that of order 0; the radiance is
  // then off by less (haze L, cloud C.1: at most 0.4 of it). Infinite: the mean over azimuths alone, which is all that
  // fluxes and views straight up or down have.
  double azimuth_tolerance = 3e-4;
};

// A point in the air: so far down in a layer, 0 (its top) to 1, by optical depth.
struct DiffusePlace {
  int layer = 0;
  double fraction = 0;
};

struct DiffuseFluxes {
  double up = 0, down = 0;    // through a horizontal area, diffuse
  double direct = 0;          // of the beam, downwards; negative for a sun below the horizon
  double mean_intensity = 0;  // over all directions, with the beam
};

// Directions for which sources are wanted again and again.
class SourceAngles {
 public:
  // -1 <= mu <= 1; streams as of the solver. Error: another mu.
  SourceAngles(int streams, std::span<const double> mu);
  int size() const { return size_; }

 private:
  friend class DiscreteOrdinates;
  int streams_ = 0, size_ = 0;
  std::vector<std::vector<double>> legendre_;  // per order size x (streams - order)
};

// One an instance a thread: it keeps its storage from one solve to the next, and allocates only to grow. With S
// streams, L layers and M orders it keeps about 14 M L S^2 bytes: 3 MB for 16, 50 and 16.
class DiscreteOrdinates {
 public:
  struct State;  // ordinate_state.h
  // Error: streams not even or not within 4..64.
  explicit DiscreteOrdinates(int streams);
  ~DiscreteOrdinates();
  DiscreteOrdinates(DiscreteOrdinates&&) noexcept;
  DiscreteOrdinates& operator=(DiscreteOrdinates&&) noexcept;

  // Error: values outside their ranges; moments that no phase function has.
  void solve(const DiffuseProblem& problem);
  // Another sun over the same air and ground, at a third of the cost. Error: as solve().
  void set_beam(const DiffuseBeam& beam);
  // Another ground under the same air, at no cost: the ground's light is known for a radiance of 1, and light between
  // ground and air sums to 1 / (1 - albedo spherical_albedo()). Error: albedo not in 0..1, emission negative.
  void set_ground(double albedo, double emission);

  // Everything below is of the last solve(), set_beam() and set_ground(); after an Error only solve() may follow.
  int streams() const;
  int layers() const;
  int orders() const;               // azimuth orders solved, >= 1
  double ground_radiance() const;   // upwards, of the ground set last
  double spherical_albedo() const;  // of the air for isotropic light from below
  double transmittance() const;     // diffuse and direct, of isotropic light from below; the same from above
  double black_irradiance() const;  // on the ground were it black, diffuse and direct

  // Error (these and the following): a place outside the layers, a mu outside its range.
  DiffuseFluxes fluxes(DiffusePlace place) const;

  // What a unit of scaled depth scatters into a direction of light that has been scattered, reflected or emitted
  // before, per sr. -1 <= mu <= 1. Along a ray in the true (not scaled) depth multiply by depth_scale(); the ray is
  // then attenuated by the scaled depth too, as light within the forward peak is on its way. It may be negative by what
  // the truncated phase function rings.
  double source(DiffusePlace place, double mu, double phi) const;
  // The same in many directions, in parts: air[i * orders() + m] cos(m phi) summed over m is the source over a black
  // ground in direction i, and ground[i] that of a ground of radiance 1 and nothing else, so that
  // source = sum + ground_radiance() ground[i] whatever the ground. air of angles.size() * orders(), ground of
  // angles.size() or empty.
  void sources(DiffusePlace place, const SourceAngles& angles, std::span<double> air, std::span<double> ground) const;
  // What a unit of scaled depth emits, per sr.
  double emission(DiffusePlace place) const;
  // Irradiance across the beam, attenuated by the scaled depth: with the layer's phase function, 1/sr, and
  // single_albedo() the source of single scattering of a unit of scaled depth.
  double beam(DiffusePlace place) const;
  double single_albedo(int layer) const;
  double depth_scale(int layer) const;  // scaled depth / depth, 0..1
  // Moments of the diffuse radiance: for degrees l = order, order + 1, ... streams - 1 its cosine of azimuth of that
  // order integrated over mu = -1..1 against sqrt((l - m)! / (l + m)!) P_l^m. With the coefficients
  // (2 l + 1) chi_l albedo / 2 of whatever scatters at the place they give its source. order < orders().
  void moments(DiffusePlace place, int order, std::span<double> values) const;

  // Radiance that travels in a direction (|mu| >= 1e-8), without the beam itself. phase: the phase function of every
  // layer (1/sr, 1 over the sphere) at the one angle between beam and direction, for single scattering; empty: none of
  // that. Analytic over every layer; where 1 / |mu| is within 1e-4 of a mode's k the mean of two slants at 1e-4 to both
  // sides is taken (error some 1e-8).
  double radiance(DiffusePlace place, double mu, double phi, std::span<const double> phase) const;

 private:
  std::unique_ptr<State> state_;
};

}  // namespace suite
