// The diffuse light in plane layers of air with its polarisation: I, Q and U, and V where it is asked for, under a sun,
// over a Lambert ground, at one wavelength.
//
// Assumes and counts as discrete_ordinates.h does (levels, depths, cosines of travel, secants, tops; delta-M), but that
// nothing emits. Stokes vectors are those of meridian frames (math/mueller.h), with phi the azimuth of
// travel from that of the beam.
// Method: Gauss's rule over each hemisphere, and the cosines of views as nodes without weight; layers by
// stokes_layer.h, joined by adding. Radiances take single scattering from the caller's matrices instead of the
// truncated ones (TMS). Error (tests/physics/air/stokes_field_test.cpp): 16 streams against the tables of Natraj et al.
// 2009, molecules of depth 0.1 to 0.5: 1e-3 of I; against PSTAR on spheroids with a strong forward peak (IPRT A4): 1 %
// of I, 36 streams 0.3 %.
//
// Based on: J. de Haan, P. Bosma, J. Hovenier, "The adding method for multiple scattering calculations of polarized
// light", Astron. Astrophys. 183, 1987; T. Nakajima, M. Tanaka 1988 (TMS, discrete_ordinates.h).
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "air/discrete_ordinates.h"
#include "air/greek_matrix.h"
#include "air/stokes_functions.h"

namespace suite {

struct StokesAirLayer {
  double depth = 0, albedo = 0;         // as DiffuseLayer
  const GreekMatrix* matrix = nullptr;  // of a1_0 = 1; null: isotropic
};

struct StokesProblem {
  std::span<const StokesAirLayer> layers;  // at least one
  DiffuseBeam beam;
  double ground_albedo = 0;  // 0..1
  int orders = 64;           // azimuth modes at most; fewer where the matrices have no more degrees
};

class StokesField {
 public:
  // What the light is told by: I, as the scalar field has it, in which nothing is polarised; I, Q and U; or V as well.
  enum class Light { intensity, polarised, circular };
  // views: cosines > 0 of directions in which radiance() is wanted, up and down. Error: streams not even or not within
  // 4..40; nodes and views, times 3 (or 4) components, above 64 a hemisphere.
  StokesField(Light light, int streams, std::vector<double> views = {});
  ~StokesField();
  StokesField(StokesField&&) noexcept;
  StokesField& operator=(StokesField&&) noexcept;

  // Error: values out of their ranges; a secant times its layer's depth below -100, as in discrete_ordinates.h.
  void solve(const StokesProblem& problem);

  // Everything below is of the last solve().
  int orders() const;
  double depth_scale(int layer) const;    // scaled depth / depth
  double single_albedo(int layer) const;  // of the scaled layer, its matrix truncated
  double beam(int level) const;           // irradiance across the beam, attenuated by the scaled depth
  // At the top (level = layer) or the bottom of a layer; direct: of the beam.
  DiffuseFluxes fluxes(int level) const;
  enum class Way { up, down };
  // Diffuse light that travels along a view. single: for each layer what its whole matrix makes of the beam, 1/sr (as
  // scattered_once); empty: the truncated ones stand.
  Stokes radiance(int level, size_t view, Way way, double phi, std::span<const Stokes> single) const;
  // What a unit of scaled depth of a layer scatters, at its end, of light that has been scattered or reflected before:
  // X_m of I, Q, U and V, m = order < orders(), into directions told by Pi of that order (of `streams` degrees).
  enum class End { top, bottom };
  StokesMode source(int layer, End end, int order, const StokesFunctions& direction) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace suite
