// What any scattering function of a surface must answer, for all wavelengths of a spectral state at once.
//
// Based on: Goodenough & Brown, section IV-B (weighting operator w = BSDF |cos|, its integral W, sampling of w / W) and
// IV-D (evaluation, integration, sampling). Beyond the paper: the shape is drawn at one of a few wavelength knots and
// weighed with all of their densities (one-sample balance heuristic; Wilkie et al. 2014, West et al. 2020).
#pragma once
#include <optional>
#include <span>

#include "math/mueller.h"
#include "math/vec.h"

namespace suite {

inline constexpr int kMaxKnots = 8;

// All directions are unit vectors in the local shading frame (z = normal of the front side) and point away from the
// surface. out.z > 0 looks at the front, out.z < 0 at the back; in.z of the same sign is reflection, of the other sign
// transmission. At exactly 0 (grazing) a model returns zeros and no sample.
//
// Spans over wavelengths have the size of the baked state (SpectralState::size()); spans over knots have size
// SpectralState::knots.size(). Every verb is const and safe to call from many threads.
class ScatterModel {
 public:
  struct Sample {
    Dir in;
    int lobe = 0;        // which part of the model was drawn (truth, delta_weight)
    bool delta = false;  // a Dirac lobe: eval and pdf do not know it, delta_weight and delta_probability do
  };

  virtual ~ScatterModel() = default;

  // w(out, in) = BSDF |cos in|, 1/sr, without Dirac lobes. Finite, >= 0.
  virtual void eval(Dir out, Dir in, std::span<float> w) const = 0;
  // The same as a number times a spectrum that outlives the model's use, when it factors so at these directions: spares
  // a pass over the wavelengths. Nothing = use eval.
  struct Factored {
    float scale;
    const float* spectrum;  // one value per bin
  };
  virtual std::optional<Factored> factored(Dir out, Dir in) const;
  // W(out) = integral of w over all `in`, Dirac lobes included. 0 <= W <= 1 (times the squared index ratio across an
  // interface, where radiance is carried as L / n^2).
  virtual void total(Dir out, std::span<float> W) const = 0;
  // Draws `in` with the density pdf(...)[knot] (or a Dirac lobe with delta_probability). u: two uniform numbers in
  // [0, 1)^2; lobe_u: one more, which chooses among lobes. Nothing when the surface absorbs or the draw is invalid: the
  // path ends there with weight 0 (densities then integrate to less than 1, which is unbiased).
  virtual std::optional<Sample> sample(Dir out, Vec2 u, double lobe_u, int knot) const = 0;
  // Density per steradian, at each knot, of what sample(out, ., ., knot) really does; Dirac lobes excluded.
  virtual void pdf(Dir out, Dir in, std::span<float> p) const = 0;

  // Dirac lobes. weight: the integral of w over lobe `lobe` when its direction is the one drawn at `knot`, for every
  // wavelength (0 where that wavelength would go elsewhere, as in dispersive refraction). probability: for each knot,
  // the probability that sample(out, ., ., that knot) draws this lobe in the same direction as `knot` does.
  virtual void delta_weight(Dir out, int lobe, int knot, std::span<float> weight) const;
  virtual void delta_probability(Dir out, int lobe, int knot, std::span<float> probability) const;
  virtual bool has_delta() const { return false; }

  // True when the ratio of eval at any two wavelengths does not depend on direction: knots need not be mixed.
  virtual bool spectrally_uniform_shape() const { return false; }
  // True when sample() ignores lobe_u.
  virtual bool single_lobe() const { return false; }
  // Reflectance per bin when the model is nothing but an opaque Lambert surface, else null.
  virtual const float* diffuse() const { return nullptr; }
  // True when nothing ever passes to the other side.
  virtual bool opaque() const { return true; }
  // True when turning both directions about z changes nothing: the tangent of the surface does not matter.
  virtual bool isotropic() const { return true; }

  // Polarisation: Mueller matrices over their m11, which is what eval (or delta_weight) says, one a bin, between the
  // meridian frames of the local shading frame (math/mueller.h). What a model knows no matrix of counts as an ideal
  // depolariser.
  struct Polarised {
    bool grey = true;    // m[0] holds for all bins; the others are not set
    double unknown = 1;  // share of w, over all bins, whose matrix the model does not know
  };
  // Default: depolarises, and says that it does not know better.
  virtual Polarised mueller(Dir out, Dir in, std::span<Mueller> m) const;
  virtual Polarised delta_mueller(Dir out, int lobe, int knot, std::span<Mueller> m) const;
};

}  // namespace suite
