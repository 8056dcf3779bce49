// Facets with the parameters that measured materials are published with (Priest & Germer, Maxwell & Beard as the NEF
// has it, Shell): Fresnel's reflectance on slopes of a given distribution, shadowing, and what comes from below.
//
//   f = R(beta) p(theta) S / (4 cos_o cos_i cos_theta) + diffuse / pi + 2 volume / (cos_o + cos_i)
//
// theta: of the half vector from the normal, beta: between either direction and the half vector.
#pragma once
#include <vector>

#include "optics/models/common.h"
#include "optics/models/directional_table.h"

namespace suite {

struct FacetRule {
  // p: gaussian bias exp(-t^2 / 2 sigma^2) / (2 pi sigma^2 cos^3), cauchy bias / (cos (sigma^2 + t^2)), t = tan theta.
  enum class Slopes { gaussian, cauchy } slopes = Slopes::gaussian;
  // S: cavity min(1, 2 cos_theta cos_o / cos_beta, 2 cos_theta cos_i / cos_beta), or obscuration
  // (1 + theta / omega exp(-2 beta / tau)) / (1 + theta / omega). With the latter f has no bound at the horizon and is
  // evaluated at 85 deg beyond it (ground.h).
  enum class Shadows { cavity, obscuration } shadows = Shadows::cavity;
  double sigma = 0.1, bias = 1, tau = 0.1, omega = 1;  // rad
};

class FittedFacets final : public ScatterModel {
 public:
  // Curves of spec: index, absorption, diffuse, volume. Error, naming the model: more than all of the light returns.
  FittedFacets(const FacetRule& rule, const ModelSpec& spec, const SpectralState& state);
  void eval(Dir out, Dir in, std::span<float> w) const override;
  void total(Dir out, std::span<float> W) const override;
  std::optional<Sample> sample(Dir out, Vec2 u, double lobe_u, int knot) const override;
  void pdf(Dir out, Dir in, std::span<float> p) const override;
  // Facets by Fresnel's amplitudes; what comes from below depolarises.
  Polarised mueller(Dir out, Dir in, std::span<Mueller> m) const override;

 private:
  struct Pair;  // of directions: what does not depend on the wavelength
  double body(size_t i) const { return diffuse_[i] + volume_[i]; }
  double body_total(Dir out, size_t i) const;
  double facet_share(Dir out, const DirectionalTable::Place& place, size_t knot) const;
  Dir seen_from(Dir out) const;
  double slope_density(double tangent2, double cosine) const;  // of sampled half vectors, 1/sr
  void integrate(Dir out, std::span<float> W) const;
  FacetRule rule_;
  std::vector<float> n_, k_, diffuse_, volume_;
  std::vector<size_t> knots_;
  DirectionalTable facets_;
};

}  // namespace suite
