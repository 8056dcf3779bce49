// A smooth interface between air (front) and a transparent medium (back): Dirac lobes of reflection and refraction.
// Assumes: index of refraction relative to the front side, constant between the borders half-way from knot to knot: the
// wavelengths of one knot travel together, those of different knots part at refraction (dispersion). Radiance is scaled
// by the squared index ratio across the interface, so that W seen from the dense side may reach index^2.
// Based on: Fresnel's equations (Born & Wolf, section 1.5); Goodenough & Brown, equations 10-11 for Dirac lobes.
#include <cmath>

#include "optics/fresnel.h"
#include "optics/fresnel_mueller.h"
#include "optics/models/common.h"
#include "optics/models/rows.h"

namespace suite {

namespace {

constexpr int kReflect = 0, kRefract = 1;

class Dielectric final : public ScatterModel {
 public:
  Dielectric(const ModelSpec& spec, const SpectralState& state) : knot_of_bin_(state.knot_of_bin()) {
    const std::vector<float> index = state.sample(spec.curves.at("index"));
    for (const size_t k : state.knots) index_.push_back(index[k]);
    for (const double n : index_) uniform_ = uniform_ && n == index_[0];
  }

  void eval(Dir, Dir, std::span<float> w) const override { zero(w); }
  void pdf(Dir, Dir, std::span<float> p) const override { zero(p); }
  void total(Dir out, std::span<float> W) const override {
    for (size_t i = 0; i < W.size(); ++i) {
      const size_t k = static_cast<size_t>(knot_of_bin_[i]);
      const Fresnel f = fresnel(out, k);
      W[i] = out.z == 0 ? 0.0f : static_cast<float>(f.reflectance + f.transmittance * radiance_scale(out, k));
    }
  }
  std::optional<Sample> sample(Dir out, Vec2, double lobe_u, int knot) const override {
    if (out.z == 0) return std::nullopt;
    const size_t k = static_cast<size_t>(knot);
    const Fresnel f = fresnel(out, k);
    if (lobe_u < f.reflectance || f.transmittance == 0) return Sample{{-out.x, -out.y, out.z}, kReflect, true};
    const double eta = ratio(out, k);
    const Dir in = normalized({-out.x / eta, -out.y / eta, out.z > 0 ? -f.cos_transmitted : f.cos_transmitted});
    return Sample{in, kRefract, true};
  }
  void delta_weight(Dir out, int lobe, int knot, std::span<float> weight) const override {
    const auto at = [&](size_t k) {
      const Fresnel f = fresnel(out, k);
      return lobe == kReflect                         ? static_cast<float>(f.reflectance)
             : together(k, static_cast<size_t>(knot)) ? static_cast<float>(f.transmittance * radiance_scale(out, k))
                                                      : 0.0f;
    };
    if (uniform_) return std::fill(weight.begin(), weight.end(), at(0));
    float of_knots[kMaxKnots];
    for (size_t k = 0; k < index_.size(); ++k) of_knots[k] = at(k);
    for (size_t i = 0; i < weight.size(); ++i) weight[i] = of_knots[knot_of_bin_[i]];
  }
  void delta_probability(Dir out, int lobe, int knot, std::span<float> probability) const override {
    for (size_t k = 0; k < probability.size(); ++k) {
      const Fresnel f = fresnel(out, k);
      probability[k] = lobe == kReflect                         ? static_cast<float>(f.reflectance)
                       : together(k, static_cast<size_t>(knot)) ? static_cast<float>(1 - f.reflectance)
                                                                : 0.0f;
    }
  }
  Polarised delta_mueller(Dir out, int lobe, int knot, std::span<Mueller> m) const override {
    const auto at = [&](size_t k) {
      const double c = std::min(1.0, std::fabs(out.z)), eta = ratio(out, k);
      const Dir mirrored{-out.x, -out.y, out.z};
      PlaneBlocks blocks = fresnel_reflection(c, eta);
      Dir in = mirrored;
      if (lobe != kReflect) {
        // The plane is the same for all that goes through; the own knot's direction is that of the path.
        const size_t own = static_cast<size_t>(knot);
        const Fresnel f = fresnel(out, own);
        const double bent = ratio(out, own);
        in = normalized({-out.x / bent, -out.y / bent, out.z > 0 ? -f.cos_transmitted : f.cos_transmitted});
        blocks = fresnel_transmission(c, eta);
      }
      if (!(blocks.a > 0)) return Mueller::depolariser();
      return ScatteringPlane(out, in).matrix(blocks * (1 / blocks.a));
    };
    if (uniform_) {
      m[0] = at(0);
      return {true, 0};
    }
    Mueller of_knots[kMaxKnots];
    for (size_t k = 0; k < index_.size(); ++k) of_knots[k] = at(k);
    for (size_t i = 0; i < m.size(); ++i) m[i] = of_knots[knot_of_bin_[i]];
    return {false, 0};
  }
  bool has_delta() const override { return true; }
  bool spectrally_uniform_shape() const override { return uniform_; }
  bool opaque() const override { return false; }

 private:
  // Index beyond the interface over the index on the side of `out`.
  double ratio(Dir out, size_t knot) const { return out.z > 0 ? index_[knot] : 1 / index_[knot]; }
  Fresnel fresnel(Dir out, size_t knot) const {
    return fresnel_dielectric(std::min(1.0, std::fabs(out.z)), ratio(out, knot));
  }
  double radiance_scale(Dir out, size_t knot) const {
    const double eta = ratio(out, knot);
    return 1 / (eta * eta);
  }
  bool together(size_t a, size_t b) const { return index_[a] == index_[b]; }

  std::vector<int> knot_of_bin_;
  std::vector<double> index_;  // per knot
  bool uniform_ = true;
};

}  // namespace

ModelRow dielectric_row() {
  using P = Parameter;
  return {{"dielectric", "smooth transparent interface: reflection and refraction after Fresnel, dispersive", "1/sr",
           make_model<Dielectric>},
          {{"index", P::Kind::curve, "1", "refractive index of the back side relative to the front side", 1, 5}},
          false,
          []() -> std::vector<ModelSpec> {
            const Curve glass({0.4, 0.6, 0.9, 2.0}, {1.531, 1.516, 1.509, 1.495}, Outside::hold);
            return {{"dielectric", {}, {{"index", Curve::constant(1.5)}}, {}, nullptr},
                    {"dielectric", {}, {{"index", glass}}, {}, nullptr}};
          }};
}

}  // namespace suite
