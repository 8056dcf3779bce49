// Rough metal: a GGX micro-facet surface of perfect conductors' mirrors, isotropic or anisotropic (facet_mirror.h).
#include <algorithm>

#include "optics/microfacet.h"
#include "optics/models/facet_mirror.h"
#include "optics/models/rows.h"

namespace suite {

namespace {

Ggx facets_of(const ModelSpec& spec) {
  const double along = spec.numbers.at("roughness"), across = spec.numbers.at("roughness_y");
  const Ggx facets{along, across > 0 ? across : along};
  if (facets.ay < 1e-4)
    throw Error("model 'ggx': roughness_y is below 1e-4", "give 1e-4 to 1, or 0 for the same as roughness");
  return facets;
}

FacetColour colour_of(const ModelSpec& spec, const SpectralState& state) {
  FacetColour colour{state.sample(spec.curves.at("f0")), state.sample(spec.curves.at("n")),
                     state.sample(spec.curves.at("k"))};
  const bool given_f0 = *std::max_element(colour.f0.begin(), colour.f0.end()) > 0;
  if (colour.indexed() && !(*std::min_element(colour.n.begin(), colour.n.end()) > 0))
    throw Error("model 'ggx': n must be above 0 everywhere");
  if (colour.indexed() == given_f0) throw Error("model 'ggx' needs f0, or n and k, but not both");
  return colour;
}

class GgxConductor final : public ScatterModel {
 public:
  GgxConductor(const ModelSpec& spec, const SpectralState& state) : mirror_(colour_of(spec, state), facets_of(spec)) {}
  void eval(Dir out, Dir in, std::span<float> w) const override { mirror_.eval(out, in, w); }
  void total(Dir out, std::span<float> W) const override { mirror_.total(out, W); }
  std::optional<Sample> sample(Dir out, Vec2 u, double lobe_u, int knot) const override {
    return mirror_.sample(out, u, lobe_u, knot);
  }
  void pdf(Dir out, Dir in, std::span<float> p) const override { mirror_.pdf(out, in, p); }
  Polarised mueller(Dir out, Dir in, std::span<Mueller> m) const override { return mirror_.mueller(out, in, m); }
  bool spectrally_uniform_shape() const override { return mirror_.spectrally_uniform_shape(); }
  bool isotropic() const override { return mirror_.isotropic(); }

 private:
  FacetMirror<Ggx> mirror_;
};

std::vector<ModelSpec> ggx_examples() {
  // Aluminium-like and gold-like (after Rakic 1998), coarse.
  const Curve n({0.4, 0.6, 0.8, 1.0, 2.0}, {0.49, 1.2, 2.7, 1.35, 2.2}, Outside::hold);
  const Curve k({0.4, 0.6, 0.8, 1.0, 2.0}, {4.86, 7.26, 8.3, 9.6, 20.8}, Outside::hold);
  const Curve gold({0.4, 0.5, 0.6, 1.0}, {0.38, 0.5, 0.9, 0.97}, Outside::hold);
  auto metal = [](double rough, double rough_y, std::map<std::string, Curve> curves) {
    return ModelSpec{"ggx", {{"roughness", rough}, {"roughness_y", rough_y}}, std::move(curves), {}, nullptr};
  };
  return {metal(0.2, 0, {{"n", n}, {"k", k}}), metal(0.5, 0.1, {{"f0", gold}}),
          metal(1, 0, {{"f0", Curve::constant(1)}}), metal(1e-3, 0, {{"n", n}, {"k", k}})};
}

}  // namespace

ModelRow ggx_row() {
  using P = Parameter;
  return {{"ggx",
           "rough metal, GGX micro-facets (Walter 2007); loses no energy: what meets several facets is a lobe of its "
           "own (Kulla & "
           "Conty 2017), which sends up to 6 % of the light astray",
           "1/sr", make_model<GgxConductor>},
          {{"f0", P::Kind::curve, "1", "reflectance at normal incidence (Schlick); or give n and k", 0, 1, false, 0},
           {"n", P::Kind::curve, "1", "real part of the refractive index", 0, 100, false, 0},
           {"k", P::Kind::curve, "1", "imaginary part of the refractive index, absorbing positive", 0, 200, false, 0},
           {"roughness", P::Kind::number, "1", "GGX alpha (along x when anisotropic)", 1e-4, 1},
           {"roughness_y", P::Kind::number, "1", "GGX alpha along y; 0 = as along x", 0, 1, false, 0}},
          true,
          ggx_examples};
}

}  // namespace suite
