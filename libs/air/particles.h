// What floats in the air, by name: aerosols, drops of clouds, ice, and spheres and phase functions that a user brings;
// one answer for all, made once per spectral state.
//
// Sources. Extinction, absorption and humidity growth of rural, maritime, urban, free_troposphere: E. Shettle & R.
// Fenn, "Models for the Aerosols of the Lower Atmosphere and the Effects of Humidity Variations on Their Optical
// Properties", AFGL-TR-79-0214, 1979, and of stratosphere (background, 75 % sulphuric acid), as tabulated in LOWTRAN 7
// (F. Kneizys and others, AFGL-TR-88-0177, 1988) at 40 wavelengths and 0, 70, 80, 99 % relative humidity; between them
// logarithmic, in humidity over ln(1 - h) as there. Their phase functions are Mie's for the published sizes, with the
// one index that meets the published albedo and asymmetry best (scripts/bake_particles prints how well: see README.md).
// Particles of soot and salt side by side thus count as alike spheres; their scattering matrices are not known. desert:
// D. Longtin and others, AFGL-TR-88-0112, 1988, by wind speed, with a Henyey-Greenstein function of the published
// asymmetry. water (with scattering matrices): spheres of water (n: G.
// Hale & M. Querry 1973; k: D. Segelstein 1981 up to 2 um), gamma distribution of effective variance 0.1, effective
// radii 2 .. 32 um. ice: B. Baum and others, "Ice cloud bulk single-scattering property models", JQSRT 146, 2014,
// general habit mixture, effective radii 5 .. 60 um, as in ECMWF's ecRad; Henyey-Greenstein functions of its asymmetry:
// no halo and no backscattering peak (the habits are severely rough).
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/registry.h"
#include "math/mueller.h"

namespace suite {

// Per wavelength; the phase function over phase_cosines() (air/phase_grid.h).
class ParticleOptics {
 public:
  size_t size() const { return albedo_.size(); }
  // Aerosols: over the extinction at 0.55 um. Drops and ice: m2/kg of water.
  double extinction(size_t w) const { return extinction_.at(w); }
  double albedo(size_t w) const { return albedo_.at(w); }
  // Mean cosine of the phase function.
  double asymmetry(size_t w) const { return asymmetry_.at(w); }
  // 1/sr, 1 over the sphere.
  std::span<const float> phase(size_t w) const;
  // Legendre moments, [0] = 1, [1] = asymmetry, of the phase function as it is sampled.
  std::vector<double> moments(size_t w, size_t count) const;

  // phase: 1/sr at phase_cosines(), any scale. Error when it is negative or all zero, extinction or albedo out of
  // range.
  void add(double extinction, double albedo, std::span<const double> phase);

  // Scattering matrices over P11 in the plane of scattering, at phase_cosines(), of an entry: made when they are asked
  // for, by paths that carry polarisation. None: they are not known, and such light depolarises.
  using Matrices = std::function<std::vector<PlaneBlocks>(size_t w)>;
  void know_matrices(Matrices matrices) { matrices_ = std::move(matrices); }
  const Matrices& matrices() const { return matrices_; }

 private:
  std::vector<double> extinction_, albedo_, asymmetry_;
  std::vector<float> phase_;
  Matrices matrices_;
};

struct ParticleData;  // air/particle_data.h
struct SphereSpec;    // air/spheres.h

struct ParticleSpec {
  std::string name = "rural";                           // of particle_kinds()
  double relative_humidity = 0.7;                       // 0 .. 0.99; beyond 0.99 aerosols are fog
  double wind_m_s = 10;                                 // of the desert, 0 .. 30
  double effective_radius_um = 10;                      // of drops and ice
  std::shared_ptr<const ParticleData> data = nullptr;   // what a user brings, in place of all that
  std::shared_ptr<const SphereSpec> spheres = nullptr;  // or says of spheres
};

struct ParticleKind : RegistryRow<ParticleOptics(const ParticleSpec&, std::span<const double> wavelengths_um)> {
  double low_um, high_um;  // wavelengths
  bool aerosol;            // extinction is relative to that at 0.55 um
};
const Registry<ParticleKind>& particle_kinds();

// At each wavelength. Error: an unknown name; humidity, wind or radius outside its range; a wavelength outside the
// table (named).
ParticleOptics particle_optics(const ParticleSpec& spec, std::span<const double> wavelengths_um);

// A user's phase function, angles in rad ascending from 0 to pi, values >= 0 of any scale, linear in the cosine
// between: the same at all wavelengths, on the grid. Error: fewer than two angles, a wrong order, not from 0 to pi.
std::vector<double> gridded_phase(std::span<const double> angles, std::span<const double> values);
// A user's scattering matrices over P11, likewise: as many as angles, which are those of a phase function.
std::vector<PlaneBlocks> gridded_matrices(std::span<const double> angles, std::span<const PlaneBlocks> over_first);
// Henyey-Greenstein on the grid, |g| <= 0.99.
std::vector<double> gridded_hg(double asymmetry);
// The sum of (2 l + 1) / (4 pi) m_l P_l on the grid, 1/sr; it may be negative where the series ends too early.
std::vector<double> gridded_moments(std::span<const double> moments);

}  // namespace suite
