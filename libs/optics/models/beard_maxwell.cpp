// Materials of the Nonconventional Exploitation Factors data base: facets under shadowing and obscuration, a Lambert
// part and a volume.
// Assumes: the same on both sides, nothing transmitted, unpolarised light; evaluated at 85 deg beyond it (ground.h).
// Based on: J. Maxwell, J. Beard et al., "Bidirectional reflectance model validation and utilization", AFAL-TR-73-303,
// 1973; H. Westlund & G. Meyer, "A BRDF database employing the Beard-Maxwell reflection model", Graphics Interface
// 2002, equation 10: R(beta) / R(0) f_fs(theta) cos^2(theta) / (cos_i cos_o) S + rho_D + 2 rho_V / (cos_i + cos_o),
// f_fs what comes back to where it came from. Checked against public code: S with omega and tau in radians as
// Maxwell_Beard_Shadow_Function of SCATMECH 7 (T. Germer, NIST) has it, and the equation as readers of such files quote
// it. From memory of the literature, with no public text found to check it: Cauchy's slopes and how the data base
// scales them by its bias, Gaussian ones after J. Shell, "Polarimetric remote sensing in the visible to near infrared",
// RIT 2005, section 3.
#include "optics/models/fitted_facets.h"
#include "optics/models/rows.h"

namespace suite {

namespace {

FacetRule rule_of(const ModelSpec& spec, FacetRule::Slopes slopes) {
  FacetRule rule;
  rule.slopes = slopes;
  rule.shadows = FacetRule::Shadows::obscuration;
  rule.sigma = spec.numbers.at("sigma");
  rule.bias = spec.numbers.at("bias");
  rule.tau = spec.numbers.at("tau_deg") * kDegree;
  rule.omega = spec.numbers.at("omega_deg") * kDegree;
  return rule;
}

std::unique_ptr<const ScatterModel> make_beard(const ModelSpec& spec, const SpectralState& state) {
  return std::make_unique<FittedFacets>(rule_of(spec, FacetRule::Slopes::cauchy), spec, state);
}
std::unique_ptr<const ScatterModel> make_shell(const ModelSpec& spec, const SpectralState& state) {
  return std::make_unique<FittedFacets>(rule_of(spec, FacetRule::Slopes::gaussian), spec, state);
}

std::vector<Parameter> parameters(double bias) {
  using P = Parameter;
  return {
      {"index", P::Kind::curve, "1", "refractive index", 0.05, 20},
      {"absorption", P::Kind::curve, "1", "its imaginary part", 0, 100, false, 0},
      {"sigma", P::Kind::number, "1", "width of the distribution of slopes", 0.005, 1},
      {"bias", P::Kind::number, "1", "factor of the distribution of slopes, B", 0, 10, false, bias},
      {"tau_deg", P::Kind::number, "deg", "of shadowing: how fast it grows off the hot direction", 0.1, 1000},
      {"omega_deg", P::Kind::number, "deg", "of obscuration: how fast it grows with the slope", 0.1, 1000},
      {"diffuse", P::Kind::curve, "1", "reflectance of the Lambert part (pi rho_D of the data base)", 0, 1, false, 0},
      {"volume", P::Kind::curve, "1/sr", "volume part, rho_V", 0, 1, false, 0}};
}

ModelSpec example(const char* model, double sigma, double bias, double tau, double diffuse, double volume) {
  return {model,
          {{"sigma", sigma}, {"bias", bias}, {"tau_deg", tau}, {"omega_deg", 40}},
          {{"index", Curve({0.4, 2.5}, {1.55, 1.45}, Outside::hold)},
           {"absorption", Curve::constant(0.1)},
           {"diffuse", Curve::constant(diffuse)},
           {"volume", Curve::constant(volume)}},
          {},
          nullptr};
}

}  // namespace

ModelRow beard_maxwell_row() {
  return {
      {"beard_maxwell",
       "materials of the NEF: facets of Cauchy's slopes, shadowed, over a volume (Maxwell & Beard 1973)", "1/sr",
       make_beard},
      parameters(0.1),
      true,
      []() -> std::vector<ModelSpec> {
        return {example("beard_maxwell", 0.2, 0.05, 20, 0.1, 0.03), example("beard_maxwell", 0.05, 0.01, 5, 0, 0.01)};
      }};
}

ModelRow shell_row() {
  return {{"shell", "facets of Gaussian slopes, shadowed, with a Lambert part and a volume (Shell 2005)", "1/sr",
           make_shell},
          parameters(1),
          true,
          []() -> std::vector<ModelSpec> {
            return {example("shell", 0.25, 0.8, 20, 0.05, 0.01), example("shell", 0.1, 0.5, 10, 0, 0)};
          }};
}

}  // namespace suite
