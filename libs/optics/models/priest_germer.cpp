// Painted and metal surfaces by the parameters of polarimetry: facets of Gaussian slopes, here for unpolarised light.
// Assumes: the same on both sides, nothing transmitted; the attenuation by cavities keeps the energy (without it, as
// first published, grazing views return more than all light).
// Based on: R. Priest & T. Germer, "Polarimetric BRDF in the microfacet model: theory and measurements", Military
// Sensing Symposia 2000, equation 2; the attenuation: K. Torrance & E. Sparrow, JOSA 57(9), 1967, as M. Hyde, J.
// Schmidt, M. Havrilla, "A geometrical optics polarimetric BRDF for dielectric and metallic surfaces", Opt. Express
// 17(24), 2009 add it, with a Lambert part. Checked against SCATMECH 7 (T. Germer, NIST): Facet_BRDF_Model with
// Gaussian slopes (whose s is sqrt(2) sigma) and Torrance_Sparrow_Shadow_Function.
#include "optics/models/fitted_facets.h"
#include "optics/models/rows.h"

namespace suite {

namespace {

std::unique_ptr<const ScatterModel> make(const ModelSpec& spec, const SpectralState& state) {
  FacetRule rule;
  rule.sigma = spec.numbers.at("sigma");
  ModelSpec full = spec;
  full.curves["volume"] = Curve::constant(0);
  return std::make_unique<FittedFacets>(rule, full, state);
}

ModelSpec example(double sigma, const Curve& index, double absorption, double diffuse) {
  return {"priest_germer",
          {{"sigma", sigma}},
          {{"index", index}, {"absorption", Curve::constant(absorption)}, {"diffuse", Curve::constant(diffuse)}},
          {},
          nullptr};
}

}  // namespace

ModelRow priest_germer_row() {
  using P = Parameter;
  return {{"priest_germer", "facets of Gaussian slopes with a Lambert part (Priest & Germer 2000, Hyde et al. 2009)",
           "1/sr", make},
          {{"index", P::Kind::curve, "1", "refractive index", 0.05, 20},
           {"absorption", P::Kind::curve, "1", "its imaginary part", 0, 100, false, 0},
           {"sigma", P::Kind::number, "1", "root mean square slope of the facets along an axis", 0.005, 1},
           {"diffuse", P::Kind::curve, "1", "reflectance of the Lambert part", 0, 1, false, 0}},
          true,
          []() -> std::vector<ModelSpec> {
            return {example(0.1, Curve({0.4, 2.5}, {1.5, 1.4}, Outside::hold), 0, 0.3),
                    example(0.3, Curve::constant(1.4), 3, 0), example(0.02, Curve::constant(1.5), 0.2, 0)};
          }};
}

}  // namespace suite
