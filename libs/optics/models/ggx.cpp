// Rough metal: a GGX micro-facet surface of perfect conductors' mirrors, isotropic or anisotropic.
// Assumes: the same on both sides, nothing transmitted. What meets one facet is exact for Smith's surface. What meets
// more is a second lobe, missed(out) missed(in) / integral of missed, which closes the energy (at reflectance 1 the
// total is 1) and is reciprocal. For real metals `missed` is multiplied with the mean product of reflectances that
// light from a direction meets.
// Neglected: the second lobe's own shape, and that facets met one after the other depend on each other. Against exact
// walks up to 0.061 of the light leaves in wrong directions (aluminium, roughness 0.6 by 0.15; mostly below 0.02), and
// totals agree within 0.006 (tests/physics/optics/rough_energy_test.cpp prints both).
// Based on: B. Walter et al. 2007, equation 20; E. Heitz 2014 (height-correlated shadowing), 2018 (visible normals);
// C. Kulla & A. Conty, "Revisiting physically based shading at Imageworks", SIGGRAPH course, 2017 (second lobe); E.
// Heitz et al. 2016 (what it stands for: the walks of ggx_tables.h).
#include <cmath>

#include "optics/fresnel.h"
#include "optics/microfacet.h"
#include "optics/models/common.h"
#include "optics/models/ggx_tables.h"
#include "optics/models/rows.h"

namespace suite {

namespace {

class GgxConductor final : public ScatterModel {
 public:
  GgxConductor(const ModelSpec& spec, const SpectralState& state)
      : f0_(state.sample(spec.curves.at("f0"))),
        n_(state.sample(spec.curves.at("n"))),
        k_(state.sample(spec.curves.at("k"))),
        facets_{spec.numbers.at("roughness"),
                spec.numbers.at("roughness_y") > 0 ? spec.numbers.at("roughness_y") : spec.numbers.at("roughness")} {
    if (facets_.ay < 1e-4)
      throw Error("model 'ggx': roughness_y is below 1e-4", "give 1e-4 to 1, or 0 for the same as roughness");
    const float n_low = *std::min_element(n_.begin(), n_.end()), n_high = *std::max_element(n_.begin(), n_.end());
    const bool given_f0 = *std::max_element(f0_.begin(), f0_.end()) > 0;
    indexed_ = n_high > 0;
    if (indexed_ && !(n_low > 0)) throw Error("model 'ggx': n must be above 0 everywhere");
    if (indexed_ == given_f0) throw Error("model 'ggx' needs f0, or n and k, but not both");
    tables_ = GgxTables::of({facets_.ax, facets_.ay});
    tabulate();
    const std::vector<float>&first = indexed_ ? n_ : f0_, &second = indexed_ ? k_ : f0_;
    auto constant = [](const std::vector<float>& v) {
      return std::all_of(v.begin(), v.end(), [&](float x) { return x == v[0]; });
    };
    uniform_ = constant(first) && constant(second);
  }

  void eval(Dir out, Dir in, std::span<float> w) const override {
    if (!same_side(out, in)) return zero(w);
    const Dir o = up(out), i = up(in), h = normalized(o + i);
    const double shape = facets_.density(h) * facets_.shadowing(o, i) / (4 * o.z), c = dot(o, h);
    thread_local std::vector<float> from, to;
    from.resize(w.size());
    to.resize(w.size());
    again_.at(o, from);
    again_.at(i, to);
    for (size_t b = 0; b < w.size(); ++b)
      w[b] = finite_float(reflectance(c, b) * shape +
                          std::max(0.0f, from[b]) * std::max(0.0f, to[b]) * again_scale_[b] * i.z);
  }
  void total(Dir out, std::span<float> W) const override {
    if (out.z == 0) return zero(W);
    total_.at(up(out), W);
  }
  std::optional<Sample> sample(Dir out, Vec2 u, double lobe_u, int) const override {
    if (out.z == 0) return std::nullopt;
    const Dir o = up(out);
    const bool again = lobe_u < tables_->missed(o);
    const Dir h = again ? Dir{} : facets_.visible_normal(o, u);
    const Dir in = again ? tables_->lobe().sample(u) : normalized(h * (2 * dot(o, h)) - o);
    if (!(in.z > 0)) return std::nullopt;
    return Sample{out.z > 0 ? in : Dir{in.x, in.y, -in.z}, again ? 1 : 0, false};
  }
  void pdf(Dir out, Dir in, std::span<float> p) const override {
    if (!same_side(out, in)) return zero(p);
    const Dir o = up(out), i = up(in), h = normalized(o + i);
    const double again = tables_->missed(o), once = facets_.masking(o) * facets_.density(h) / (4 * o.z);
    std::fill(p.begin(), p.end(), finite_float((1 - again) * once + again * tables_->lobe().pdf(i.z)));
  }
  bool spectrally_uniform_shape() const override { return uniform_; }
  bool isotropic() const override { return facets_.ax == facets_.ay; }

 private:
  double reflectance(double c, size_t bin) const {
    return indexed_ ? fresnel_conductor(c, n_[bin], k_[bin]) : fresnel_schlick(c, f0_[bin]);
  }
  // W(out): the distribution of cosines at the facets times F of every wavelength, and the second lobe.
  void tabulate() {
    constexpr size_t angles = GgxTables::kAngles;
    std::vector<float> fresnel(f0_.size() * angles);
    for (size_t b = 0; b < f0_.size(); ++b) {
      const std::span<float> row{fresnel.data() + b * angles, angles};
      for (size_t a = 0; a < angles; ++a) row[a] = static_cast<float>(reflectance(GgxTables::cosine(a), b));
    }
    again_ = DirectionalTable(facets_.ax, facets_.ay, GgxTables::kRows, f0_.size(), [&](Dir o, std::span<float> A) {
      for (size_t b = 0; b < A.size(); ++b)
        A[b] = static_cast<float>(tables_->missed(o) * tables_->repeated(o, {fresnel.data() + b * angles, angles}));
    });
    scale_again();
    total_ = DirectionalTable(facets_.ax, facets_.ay, GgxTables::kRows, f0_.size(), [&](Dir o, std::span<float> W) {
      std::vector<float> once(angles);
      tables_->single(o, once);
      for (size_t b = 0; b < W.size(); ++b) {
        double sum = again_.at(o, b);
        for (size_t a = 0; a < angles; ++a) sum += once[a] * fresnel[b * angles + a];
        W[b] = static_cast<float>(sum);
      }
    });
  }

  // Integrals of the second lobe's share over the hemisphere, in steps even in the cube root of the cosine: of smooth
  // surfaces only grazing directions miss anything.
  void scale_again() {
    constexpr int steps = 1024;
    const int azimuths = isotropic() ? 1 : 32;
    std::vector<float> share(f0_.size());
    again_scale_.assign(f0_.size(), 0);
    for (int s = 0; s < steps * azimuths; ++s) {
      const double low = std::pow(static_cast<double>(s / azimuths) / steps, 3),
                   high = std::pow((s / azimuths + 1.0) / steps, 3), mu = 0.5 * (low + high);
      again_.at(dir_from_angles(std::acos(mu), kPi / 2 * (s % azimuths + 0.5) / azimuths), share);
      for (size_t b = 0; b < share.size(); ++b)
        again_scale_[b] += kPi * (high * high - low * low) / azimuths * std::max(0.0f, share[b]);
    }
    for (double& x : again_scale_) x = x > 0 ? 1 / x : 0;
  }

  std::vector<float> f0_, n_, k_;
  std::vector<double> again_scale_;  // 1 / integral of again_ times cosine
  Ggx facets_;
  std::shared_ptr<const GgxTables> tables_;
  bool indexed_ = false, uniform_ = false;
  DirectionalTable total_, again_;  // again_: share of the second lobe
};

std::vector<ModelSpec> examples() {
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
          examples};
}

}  // namespace suite
