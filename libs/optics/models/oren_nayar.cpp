// A rough matte surface of V-shaped grooves, each facet Lambert: flatter than Lambert towards the limb, brighter
// towards the light. Assumes: the qualitative model without interreflection; the same on both sides, nothing
// transmitted. Based on: M. Oren & S. Nayar, "Generalization of Lambert's reflectance model", SIGGRAPH 1994,
// equation 30. The total is its integral in closed form (the two ranges theta_i < theta_o and theta_i > theta_o are
// elementary).
#include <cmath>

#include "math/share.h"
#include "optics/models/cosine_lobe.h"
#include "optics/models/rows.h"

namespace suite {

namespace {

class OrenNayar final : public CosineLobe {
 public:
  OrenNayar(const ModelSpec& spec, const SpectralState& state) : rho_(state.sample(spec.curves.at("reflectance"))) {
    const double s2 = std::pow(spec.numbers.at("sigma"), 2);
    a_ = 1 - 0.5 * s2 / (s2 + 0.33);
    b_ = 0.45 * s2 / (s2 + 0.09);
    double most = 0;
    for (int deg = 0; deg <= 900; ++deg) most = std::max(most, albedo(std::cos(deg * 0.1 * kDegree)));
    for (const float r : rho_)
      if (as_share(r * most) > 1)
        throw Error(strf("model 'oren_nayar': reflectance %g with sigma %g returns up to %.4f of the light", r,
                         spec.numbers.at("sigma"), r * most),
                    strf("the model is not bounded; reflectance up to %.4f is possible", 1 / most));
  }

  void eval(Dir out, Dir in, std::span<float> w) const override {
    if (!same_side(out, in)) return zero(w);
    const double mo = std::fabs(out.z), mi = std::fabs(in.z), s = out.x * in.x + out.y * in.y;
    const double shape = (a_ + b_ * std::max(0.0, s) / std::max(mo, mi)) * mi / kPi;
    for (size_t i = 0; i < w.size(); ++i) w[i] = static_cast<float>(rho_[i] * shape);
  }
  void total(Dir out, std::span<float> W) const override {
    const double a = out.z == 0 ? 0 : albedo(std::min(1.0, std::fabs(out.z)));
    for (size_t i = 0; i < W.size(); ++i) W[i] = static_cast<float>(rho_[i] * a);
  }

 private:
  // a + (b / pi) [sin (theta - sin cos) + (2/3) tan (1 - sin^3)]
  double albedo(double c) const {
    const double s = std::sqrt(std::max(0.0, 1 - c * c)), theta = std::atan2(s, c);
    const double limb = c > 1e-6 ? 2.0 / 3 * s / c * (1 - s * s * s) : 0;  // tends to c as c goes to 0
    return a_ + b_ / kPi * (s * (theta - s * c) + limb);
  }
  std::vector<float> rho_;
  double a_ = 1, b_ = 0;
};

}  // namespace

ModelRow oren_nayar_row() {
  using P = Parameter;
  return {{"oren_nayar", "rough matte surface of Lambert grooves (Oren & Nayar 1994)", "1/sr", make_model<OrenNayar>},
          {{"reflectance", P::Kind::curve, "1", "reflectance of the facets", 0, 1},
           {"sigma", P::Kind::number, "rad", "standard deviation of the slope angle", 0, 1.5707}},
          true,
          []() -> std::vector<ModelSpec> {
            const Curve soil({0.3, 1.0, 2.6}, {0.1, 0.3, 0.5}, Outside::hold);
            return {{"oren_nayar", {{"sigma", 0.35}}, {{"reflectance", soil}}, {}, nullptr},
                    {"oren_nayar", {{"sigma", 1.5}}, {{"reflectance", Curve::constant(0.9)}}, {}, nullptr}};
          }};
}

}  // namespace suite
