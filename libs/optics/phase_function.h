// How a medium scatters: densities over the scattering angle for all wavelengths of a spectral state, and the one table
// of such functions.
//
// The scattering angle is between the way the light comes from and the way it leaves, both seen as directions of
// travel: with directions that point away from the point, cos = -dot(out, in); 1 is straight on. Phase functions
// integrate to 1 over the sphere (the single-scattering albedo belongs to the medium) and depend on that angle alone,
// so they are reciprocal.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "optics/models.h"

namespace suite {

inline double scattering_cosine(Dir out, Dir in) { return -dot(out, in); }

class PhaseFunction {
 public:
  virtual ~PhaseFunction() = default;
  // 1/sr, one value per wavelength. cos_scatter in [-1, 1]. Finite, >= 0.
  virtual void eval(double cos_scatter, std::span<float> p) const = 0;
  // Cosine drawn with density 2 pi pdf[knot]; u in [0, 1).
  virtual double sample(double u, int knot) const = 0;
  // 1/sr at each knot, of what sample does: equals eval there.
  virtual void pdf(double cos_scatter, std::span<float> p) const = 0;
  // Mean cosine at each wavelength.
  virtual void asymmetry(std::span<float> g) const = 0;
  // True when eval gives the same number at all wavelengths.
  virtual bool spectrally_uniform() const { return false; }
  // Mueller matrices over P11 in the plane of scattering (math/mueller.h), one a wavelength, or b[0] for all of them.
  // Default: depolarises, and says that it does not know better.
  virtual ScatterModel::Polarised polarised(double cos_scatter, std::span<PlaneBlocks> b) const;
};

// The direction `in` for an outgoing direction, a cosine from sample() and one more uniform number for the azimuth.
Dir scattered_direction(Dir out, double cos_scatter, double u);

struct PhaseRow : RegistryRow<std::unique_ptr<const PhaseFunction>(const ModelSpec& spec, const SpectralState& state)> {
  std::vector<Parameter> parameters;
  std::vector<ModelSpec> (*examples)();
};
const Registry<PhaseRow>& phases();
// As check_model and bake of the surface models.
void check_phase(ModelSpec& spec, const Where& where = {});
std::unique_ptr<const PhaseFunction> bake_phase(const ModelSpec& spec, const SpectralState& state);

}  // namespace suite
