// What the air does to light between two points: transmittance and path radiance; and the same air as layers, for walks
// through air and media together. One interface, so that atmospheres computed by other programs can stand in for the
// layered one here.
//
// The layered atmosphere assumes: plane-parallel homogeneous layers; sunlight and moonlight scattered once on the way
// (no multiple scattering, nothing scattered from the ground); the beam to the scattering points is not shadowed by the
// scene; no refraction. Within these, transmittance and path radiance are closed forms, exact for the layers.
// Based on: single scattering and emission of a layer, e.g. K.-N. Liou, "An
// introduction to atmospheric radiation", 2002, equations 3.4.9 and 4.2.9.
#pragma once
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "air/shells.h"
#include "light/light.h"
#include "math/stokes_parts.h"
#include "math/vec.h"
#include "optics/model_spec.h"
#include "spectral/state.h"

namespace suite {

class SkyThroughWater;

struct AtmosphereSpec {
  // Ascending heights above sea level, m, that bound the layers; the lowest layer goes on below the first.
  std::vector<double> heights = {0,    1e3,  2e3,  3e3,  4e3,  5e3,  6e3,  8e3,  10e3,
                                 12e3, 15e3, 18e3, 22e3, 26e3, 32e3, 40e3, 50e3, 80e3};
  std::vector<double> temperature_k = {};  // of each layer; empty = U.S. Standard Atmosphere 1976
  double scene_height = 0;                 // of the scene's z = 0 above sea level, m
  bool rayleigh = true;
  double pressure = 101325;  // at sea level, Pa
  struct Aerosol {
    double depth_550 = 0;  // vertical optical depth at 0.55 um, all layers
    double angstrom = 1.3, scale_height = 2000;
    Curve albedo = Curve::constant(0.95);  // of single scattering
    ModelSpec phase;                       // a row of phases()
  };
  std::optional<Aerosol> aerosol;
  // Absorption. Vertical optical depth of the whole column spread with a scale height, or of every layer by itself.
  struct Gas {
    std::string name;
    Curve column;
    double scale_height = 0;
    std::vector<Curve> layers;  // when not empty: one per layer, and `column` is not used
  };
  std::vector<Gas> gases;
  Where where = {};  // in the text
};

class AirVertices;
class PolarisedAir;

class Atmosphere {
 public:
  virtual ~Atmosphere() = default;
  // From a point along a unit direction for `distance` (m, infinity allowed). Points are scene ENU. T: per bin, 0..1.
  // To infinity, T is that of light which comes from outside, whose true direction, without air, is the given one.
  virtual void transmittance(Vec3 from, Dir direction, double distance, std::span<float> T) const = 0;
  // The same, and the radiance S that the air of the segment sends back to `from`, W/(m2 sr um).
  virtual void path(Vec3 from, Dir direction, double distance, std::span<float> T, std::span<float> S) const = 0;

  // About how much S changes with the direction at most, over itself, 1/rad; infinity: not known.
  virtual double steepness(Dir) const { return std::numeric_limits<double>::infinity(); }

  // The parts of path(): their sum is S, but where that comes from a table, to its accuracy. False where they are not
  // known.
  struct Parts {
    std::span<float> transmittance;
    std::span<float> thermal;           // emitted, and scattered no more
    std::span<float> single, multiple;  // of the beams, scattered once; everything else
  };
  virtual bool parts(Vec3, Dir, double, const Parts&) const { return false; }
  // Water vapour on a way, kg/m2; 0 where it is not known.
  virtual double water(Vec3, Dir, double) const { return 0; }
  // Whether T to infinity is that of a bent way, and so not the one of the segment.
  virtual bool bends() const { return false; }

  // The same as path() to infinity, from places where light that is scattered at surfaces goes on; may be less exact
  // and quicker.
  virtual void skylight(Vec3 from, Dir direction, std::span<float> T, std::span<float> S) const {
    path(from, direction, std::numeric_limits<double>::infinity(), T, S);
  }

  // S of skylight() alone, in the mean over directions near by: where that is interpolated in a table it may be one of
  // the values there, drawn with its weight (by the direction's last digits). In S, or where it stays as long as the
  // air. scratch: per bin.
  virtual const float* sky_radiance(Vec3 from, Dir direction, std::span<float> scratch, std::span<float> S) const {
    skylight(from, direction, scratch, S);
    return S.data();
  }

  // The layers; above the last height, or without any, there is no air.
  virtual const Shells& shells() const = 0;
  // Extinction of a layer, per bin, 1/m.
  virtual std::span<const float> extinction(size_t layer) const = 0;
  // What it sends out along a ray from a point in it over its extinction, without the beams' light that it scatters
  // once: emission, and what it scatters more often where the atmosphere knows it. Per bin, W/(m2 sr um).
  virtual void source(size_t layer, Vec3 from, Dir direction, std::span<float> source) const = 0;
  // Light from above that the layers scatter once.
  virtual size_t beams() const = 0;
  // What the air sends from outside, as a light that can be asked for: only its directions and their densities, the
  // radiance is that of path() to infinity. Null = met by chance only.
  virtual const Light* sky() const { return nullptr; }
  // For places under water; null where sky() is.
  virtual const SkyThroughWater* sky_through_water() const { return nullptr; }
  // 1/sr, with which sky() draws a direction.
  virtual double sky_density(Dir) const { return 0; }
  // Where its light is that over an even ground: places in the air for paths that find what the scene makes of it
  // (air_vertices.h). Null = none are needed, or wanted.
  virtual const AirVertices* vertices() const { return nullptr; }
  // What is known of the polarisation of its light, made when first asked for, with V or without. Null = nothing.
  virtual const PolarisedAir* polarisation(StokesParts = StokesParts::linear) const { return nullptr; }
  // One of them along a ray that goes from a point in a layer in a unit direction. Per bin.
  struct BeamAlong {
    std::span<float> scattered;  // what the layer would send back to `from` if nothing dimmed it, W/(m3 sr um)
    std::span<float> depth;      // optical depth of the beam where it comes to `from`
    std::span<float> slope;      // growth of that along the ray within the layer, 1/m
  };
  virtual void beam(size_t beam, size_t layer, Vec3 from, Dir direction, BeamAlong along) const = 0;
};

// The longest way through air, m: a level ray leaves a flat layer nowhere.
inline constexpr double kLongestInAir = 1e9;
// Mean of exp(-t - x s) over s in 0..1.
inline float mean_falling(float t, float x) {
  const float near = std::exp(-t);
  return std::fabs(x) < 2e-2f ? near * (1 - x * (0.5f - x * (1 / 6.0f))) : (near - std::exp(-t - x)) / x;
}

// The beams' spectra must live as long. Error: heights not ascending, more than 200 layers, lists of the wrong length,
// negative depths, albedo above 1.
std::unique_ptr<const Atmosphere> make_layered_atmosphere(const AtmosphereSpec& spec, const SpectralState& state,
                                                          std::vector<Beam> beams);

}  // namespace suite
