// A leaf: both sides reflect and both let light through, each diffusely and each with its own spectrum.
// Assumes: Lambert on either side. front is where the normal points (the adaxial side).
// Based on: the bi-Lambertian leaf of canopy radiative transfer (J. Ross, 1981), with the sides told apart.
#include <cmath>

#include "math/warps.h"
#include "optics/models/common.h"
#include "optics/models/rows.h"

namespace suite {

namespace {

class Leaf final : public ScatterModel {
 public:
  // side 0: seen from the front. Light that is seen transmitted there entered at the back.
  Leaf(const ModelSpec& spec, const SpectralState& state)
      : reflect_{state.sample(spec.curves.at("reflectance_front")), state.sample(spec.curves.at("reflectance_back"))},
        transmit_{state.sample(spec.curves.at("transmittance_back")),
                  state.sample(spec.curves.at("transmittance_front"))},
        knots_(state.knots) {
    // Energy is a matter of the side where light enters.
    require_sum_below_one({&reflect_[0], &transmit_[1]}, "reflectance_front + transmittance_front", state);
    require_sum_below_one({&reflect_[1], &transmit_[0]}, "reflectance_back + transmittance_back", state);
    require_sum_below_one({&reflect_[0], &transmit_[0]}, "reflectance_front + transmittance_back", state);
    require_sum_below_one({&reflect_[1], &transmit_[1]}, "reflectance_back + transmittance_front", state);
    uniform_ = proportional(reflect_[0], transmit_[0]) && proportional(reflect_[1], transmit_[1]);
    for (const auto& t : transmit_)
      for (const float x : t) opaque_ = opaque_ && x == 0;
  }

  void eval(Dir out, Dir in, std::span<float> w) const override {
    if (out.z * in.z == 0) return zero(w);
    const std::vector<float>& r = (same_side(out, in) ? reflect_ : transmit_)[side(out)];
    const float scale = static_cast<float>(std::fabs(in.z) / kPi);
    for (size_t i = 0; i < w.size(); ++i) w[i] = r[i] * scale;
  }
  void total(Dir out, std::span<float> W) const override {
    for (size_t i = 0; i < W.size(); ++i) W[i] = out.z == 0 ? 0.0f : reflect_[side(out)][i] + transmit_[side(out)][i];
  }
  std::optional<Sample> sample(Dir out, Vec2 u, double lobe_u, int knot) const override {
    Dir in = cosine_hemisphere(u);
    if (out.z == 0 || !(in.z > 0)) return std::nullopt;
    const bool reflect = lobe_u < reflect_share(out, static_cast<size_t>(knot));
    if (reflect != (out.z > 0)) in.z = -in.z;
    return Sample{in, reflect ? 0 : 1, false};
  }
  void pdf(Dir out, Dir in, std::span<float> p) const override {
    if (out.z * in.z == 0) return zero(p);
    for (size_t k = 0; k < p.size(); ++k) {
      const double share = reflect_share(out, k);
      p[k] = static_cast<float>((same_side(out, in) ? share : 1 - share) * std::fabs(in.z) / kPi);
    }
  }
  bool spectrally_uniform_shape() const override { return uniform_; }
  Polarised mueller(Dir, Dir, std::span<Mueller> m) const override { return depolarised(m); }
  bool opaque() const override { return opaque_; }

 private:
  static size_t side(Dir out) { return out.z > 0 ? 0 : 1; }
  double reflect_share(Dir out, size_t knot) const {
    const double r = reflect_[side(out)][knots_[knot]], sum = r + transmit_[side(out)][knots_[knot]];
    return sum > 0 ? r / sum : 1;
  }
  std::vector<float> reflect_[2], transmit_[2];
  std::vector<size_t> knots_;
  bool uniform_ = true, opaque_ = true;
};

}  // namespace

ModelRow leaf_row() {
  using P = Parameter;
  return {{"leaf", "two-sided diffuse leaf with its own reflectance and transmittance on either side (after Ross 1981)",
           "1/sr", make_model<Leaf>},
          {{"reflectance_front", P::Kind::curve, "1", "hemispherical reflectance of the upper side", 0, 1},
           {"reflectance_back", P::Kind::curve, "1", "hemispherical reflectance of the lower side", 0, 1},
           {"transmittance_front", P::Kind::curve, "1", "of light that enters at the upper side", 0, 1},
           {"transmittance_back", P::Kind::curve, "1", "of light that enters at the lower side", 0, 1}},
          false,
          []() -> std::vector<ModelSpec> {
            const Curve front({0.4, 0.55, 0.65, 0.8, 2.0}, {0.05, 0.12, 0.05, 0.48, 0.2}, Outside::hold);
            const Curve back({0.4, 0.55, 0.65, 0.8, 2.0}, {0.08, 0.2, 0.1, 0.45, 0.25}, Outside::hold);
            const Curve through({0.4, 0.55, 0.65, 0.8, 2.0}, {0.01, 0.1, 0.02, 0.46, 0.25}, Outside::hold);
            return {{"leaf",
                     {},
                     {{"reflectance_front", front},
                      {"reflectance_back", back},
                      {"transmittance_front", through},
                      {"transmittance_back", through.scaled(0.9)}},
                     {},
                     nullptr}};
          }};
}

}  // namespace suite
