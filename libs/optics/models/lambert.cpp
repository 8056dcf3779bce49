// Perfectly diffuse reflection and transmission.
// Based on: Goodenough & Brown, equations 7-9 (w = R/pi cos, cosine sampling); the bi-Lambertian leaf is the usual one
// of canopy work (Ross 1981): both sides reflect rho and pass tau, each diffusely.
#include "math/warps.h"
#include "optics/models/common.h"
#include "optics/models/rows.h"

namespace suite {

namespace {

class Lambert final : public ScatterModel {
 public:
  Lambert(const ModelSpec& spec, const SpectralState& state)
      : rho_(state.sample(spec.curves.at("reflectance"))), tau_(state.sample(spec.curves.at("transmittance"))) {
    for (const size_t k : state.knots) {
      const double sum = rho_[k] + tau_[k];
      reflect_probability_.push_back(sum > 0 ? rho_[k] / sum : 1.0);
    }
    float ratio = -1;
    for (size_t i = 0; i < rho_.size(); ++i) {
      if (rho_[i] + tau_[i] > 1 + 1e-6f)
        throw Error(
            strf("reflectance %g + transmittance %g at %g um exceeds 1", rho_[i], tau_[i], state.bins[i].center_um()));
      if (tau_[i] > 0) opaque_ = false;
      if (rho_[i] + tau_[i] <= 0) continue;
      const float share = rho_[i] / (rho_[i] + tau_[i]);
      if (ratio >= 0 && share != ratio) uniform_ = false;
      ratio = share;
    }
  }

  void eval(Dir out, Dir in, std::span<float> w) const override {
    const std::vector<float>& r = out.z * in.z > 0 ? rho_ : tau_;
    const float scale = out.z * in.z == 0 ? 0.0f : static_cast<float>(std::fabs(in.z) / kPi);
    for (size_t i = 0; i < w.size(); ++i) w[i] = r[i] * scale;
  }
  std::optional<Factored> factored(Dir out, Dir in) const override {
    return Factored{out.z * in.z == 0 ? 0.0f : static_cast<float>(std::fabs(in.z) / kPi),
                    (out.z * in.z > 0 ? rho_ : tau_).data()};
  }
  void total(Dir out, std::span<float> W) const override {
    for (size_t i = 0; i < W.size(); ++i) W[i] = out.z == 0 ? 0.0f : rho_[i] + tau_[i];
  }
  std::optional<Sample> sample(Dir out, Vec2 u, double lobe_u, int knot) const override {
    if (out.z == 0) return std::nullopt;
    const bool reflect = lobe_u < reflect_probability_[knot];
    Dir in = cosine_hemisphere(u);
    if (!(in.z > 0)) return std::nullopt;
    if (reflect != (out.z > 0)) in.z = -in.z;
    return Sample{in, reflect ? 0 : 1, false};
  }
  void pdf(Dir out, Dir in, std::span<float> p) const override {
    const bool reflect = out.z * in.z > 0;
    const double base = out.z * in.z == 0 ? 0.0 : std::fabs(in.z) / kPi;
    for (size_t k = 0; k < p.size(); ++k)
      p[k] = static_cast<float>(base * (reflect ? reflect_probability_[k] : 1 - reflect_probability_[k]));
  }
  bool spectrally_uniform_shape() const override { return uniform_; }
  bool single_lobe() const override { return opaque_; }
  const float* diffuse() const override { return opaque_ ? rho_.data() : nullptr; }
  Polarised mueller(Dir, Dir, std::span<Mueller> m) const override { return depolarised(m); }
  bool opaque() const override { return opaque_; }

 private:
  std::vector<float> rho_, tau_;
  std::vector<double> reflect_probability_;  // per knot
  bool uniform_ = true, opaque_ = true;
};

std::vector<ModelSpec> examples() {
  const Curve green({0.3, 0.5, 0.7, 1.0, 2.6}, {0.05, 0.1, 0.05, 0.5, 0.2}, Outside::hold);
  const Curve through({0.3, 0.7, 1.0, 2.6}, {0.01, 0.02, 0.45, 0.1}, Outside::hold);
  return {{"lambert", {}, {{"reflectance", Curve::constant(0.5)}, {"transmittance", Curve::constant(0)}}, {}, nullptr},
          {"lambert", {}, {{"reflectance", green}, {"transmittance", through}}, {}, nullptr}};
}

}  // namespace

ModelRow lambert_row() {
  using P = Parameter;
  return {{"lambert", "perfectly diffuse reflection and transmission (Lambert 1760)", "1/sr", make_model<Lambert>},
          {{"reflectance", P::Kind::curve, "1", "hemispherical reflectance of both sides", 0, 1},
           {"transmittance", P::Kind::curve, "1", "hemispherical transmittance, diffuse", 0, 1, false, 0}},
          true,
          examples};
}

}  // namespace suite
