// A rough interface between air (front) and a transparent medium (back): GGX micro-facets that reflect and refract.
// Assumes: isotropic, single scattering (the total tells what is lost); radiance is scaled by the squared index ratio
// across the interface, so W seen from the dense side may exceed 1.
// Based on: B. Walter, S. Marschner, H. Li, K. Torrance, "Microfacet models for refraction through rough surfaces",
// EGSR 2007, equations 16, 17, 20, 21; E. Heitz 2018 (visible normals). Shadowing: height-correlated for reflection,
// the product of both maskings for transmission (Walter, equation 23).
#include <array>
#include <cmath>

#include "optics/fresnel.h"
#include "optics/microfacet.h"
#include "optics/models/common.h"
#include "optics/models/directional_table.h"
#include "optics/models/rows.h"

namespace suite {

namespace {

constexpr size_t kRows = 193, kPoints = 16384, kIndices = 5;

class GgxDielectric final : public ScatterModel {
 public:
  GgxDielectric(const ModelSpec& spec, const SpectralState& state)
      : facets_{spec.numbers.at("roughness"), spec.numbers.at("roughness")}, knots_(state.knots) {
    const std::vector<float> index = state.sample(spec.curves.at("index"));
    index_.assign(index.begin(), index.end());
    low_ = *std::min_element(index_.begin(), index_.end());
    high_ = *std::max_element(index_.begin(), index_.end());
    tabulate();
  }

  void eval(Dir out, Dir in, std::span<float> w) const override {
    if (out.z == 0 || in.z == 0) return zero(w);
    if (same_side(out, in)) {
      const Dir o = up(out), i = up(in), h = normalized(o + i);
      const double shape = facets_.density(h) * facets_.shadowing(o, i) / (4 * o.z), c = dot(o, h);
      for (size_t b = 0; b < w.size(); ++b)
        w[b] = finite_float(fresnel_dielectric(c, ratio(out, index_[b])).reflectance * shape);
      return;
    }
    for (size_t b = 0; b < w.size(); ++b)
      w[b] = b > 0 && index_[b] == index_[b - 1] ? w[b - 1] : finite_float(transmitted(out, in, ratio(out, index_[b])));
  }
  void total(Dir out, std::span<float> W) const override {
    if (out.z == 0) return zero(W);
    std::array<float, kIndices> value;
    const std::span<float> nodes{value.data(), indices()};
    totals_[out.z > 0 ? 0 : 1].at(up(out), nodes);
    for (size_t b = 0; b < W.size(); ++b) {
      if (nodes.size() == 1) {
        W[b] = nodes[0];
        continue;
      }
      const double at = (index_[b] - low_) / (high_ - low_) * (kIndices - 1);
      const size_t n = std::min(kIndices - 2, static_cast<size_t>(at));
      const float t = static_cast<float>(at - static_cast<double>(n));
      W[b] = nodes[n] * (1 - t) + nodes[n + 1] * t;
    }
  }
  std::optional<Sample> sample(Dir out, Vec2 u, double lobe_u, int knot) const override {
    if (out.z == 0) return std::nullopt;
    const double eta = ratio(out, index_[knots_[static_cast<size_t>(knot)]]);
    const Dir o = up(out), h = facets_.visible_normal(o, u);
    const double c = dot(o, h);
    if (!(c > 0)) return std::nullopt;
    const Fresnel f = fresnel_dielectric(std::min(1.0, c), eta);
    const bool reflect = lobe_u < f.reflectance || f.transmittance == 0;
    Dir in = reflect ? h * (2 * c) - o : h * (c / eta - f.cos_transmitted) - o / eta;
    in = normalized(in);
    if (reflect ? !(in.z > 0) : !(in.z < 0)) return std::nullopt;
    if (out.z < 0) in.z = -in.z;
    return Sample{in, reflect ? 0 : 1, false};
  }
  void pdf(Dir out, Dir in, std::span<float> p) const override {
    if (out.z == 0 || in.z == 0) return zero(p);
    for (size_t k = 0; k < p.size(); ++k) {
      const double eta = ratio(out, index_[knots_[k]]);
      if (same_side(out, in)) {
        const Dir o = up(out), h = normalized(o + up(in));
        const double c = dot(o, h);
        p[k] = finite_float(fresnel_dielectric(c, eta).reflectance * facets_.visible_density(o, h) / (4 * c));
      } else {
        const auto r = refraction(out, in, eta);
        p[k] = r ? finite_float(r->transmittance * facets_.visible_density(up(out), r->h) * r->jacobian) : 0.0f;
      }
    }
  }
  bool spectrally_uniform_shape() const override { return low_ == high_; }
  bool opaque() const override { return false; }

 private:
  static double ratio(Dir out, double index) { return out.z > 0 ? index : 1 / index; }
  size_t indices() const { return low_ == high_ ? 1 : kIndices; }

  struct Refraction {
    Dir h;
    double transmittance, jacobian, cos_in;  // d(omega_h) / d(omega_in); |in . h|
  };
  // The facet that refracts out into in, in the frame where out is above.
  static std::optional<Refraction> refraction(Dir out, Dir in, double eta) {
    if (eta == 1) return std::nullopt;  // nothing refracts: light goes straight on, which no facet normal describes
    const Dir o = up(out), i{in.x, in.y, -std::fabs(in.z)};
    Vec3 h = o + i * eta;
    const double size = length(h);
    if (!(size > 0)) return std::nullopt;
    h = h / (h.z > 0 ? size : -size);
    const double co = dot(o, h), ci = dot(i, h);
    if (!(co > 0 && ci < 0)) return std::nullopt;
    const double t = fresnel_dielectric(std::min(1.0, co), eta).transmittance, s = co + eta * ci;
    return Refraction{h, t, eta * eta * -ci / (s * s), -ci};
  }
  double transmitted(Dir out, Dir in, double eta) const {
    const auto r = refraction(out, in, eta);
    if (!r) return 0;
    const Dir o = up(out), i = up(in);
    // Radiance carried across: divided by eta^2, eta being the index beyond over the index on this side.
    return r->transmittance * facets_.visible_density(o, r->h) * r->jacobian * facets_.masking(i) / (eta * eta);
  }
  // W from either side at a few indices between the extremes: mean over visible normals of what each of them passes on.
  void tabulate() {
    const std::vector<Vec2> points = baking_points(kPoints);
    for (const int side : {0, 1})
      totals_[side] = DirectionalTable(facets_.ax, facets_.ay, kRows, indices(), [&](Dir o, std::span<float> W) {
        std::vector<double> sum(W.size());
        for (const Vec2 u : points) {
          const Dir h = facets_.visible_normal(o, u);
          for (size_t n = 0; n < W.size(); ++n) {
            const double index = low_ + (high_ - low_) * static_cast<double>(n) / (kIndices - 1);
            sum[n] += passed_on(o, h, side == 0 ? index : 1 / index);
          }
        }
        for (size_t n = 0; n < W.size(); ++n) W[n] = static_cast<float>(sum[n] / kPoints);
      });
  }
  double passed_on(Dir o, Dir h, double eta) const {
    const double c = dot(o, h);
    if (!(c > 0)) return 0;
    const Fresnel f = fresnel_dielectric(std::min(1.0, c), eta);
    const Dir r = h * (2 * c) - o, t = h * (c / eta - f.cos_transmitted) - o / eta;
    double sum = 0;
    if (r.z > 0) sum += f.reflectance * facets_.shadowing(o, r) / facets_.masking(o);
    if (f.transmittance > 0 && t.z < 0) sum += f.transmittance * facets_.masking(up(t)) / (eta * eta);
    return sum;
  }

  Ggx facets_;
  std::vector<size_t> knots_;
  std::vector<double> index_;
  double low_ = 1, high_ = 1;
  std::array<DirectionalTable, 2> totals_;
};

}  // namespace

ModelRow ggx_dielectric_row() {
  using P = ModelParameter;
  return {"ggx_dielectric",
          "rough transparent interface, GGX micro-facets that reflect and refract (Walter 2007), dispersive",
          {{"index", P::Kind::curve, "1", "refractive index of the back side relative to the front side", 1.0001, 5},
           {"roughness", P::Kind::number, "1", "GGX alpha", 1e-3, 1}},
          false,
          make_model<GgxDielectric>,
          []() -> std::vector<ModelSpec> {
            const Curve glass({0.4, 0.6, 0.9, 2.0}, {1.531, 1.516, 1.509, 1.495}, Outside::hold);
            return {{"ggx_dielectric", {{"roughness", 0.3}}, {{"index", Curve::constant(1.5)}}, {}, nullptr},
                    {"ggx_dielectric", {{"roughness", 0.05}}, {{"index", glass}}, {}, nullptr},
                    {"ggx_dielectric", {{"roughness", 0.8}}, {{"index", Curve::constant(2.4)}}, {}, nullptr}};
          }};
}

}  // namespace suite
