// A rough interface between air (front) and a transparent medium (back): GGX micro-facets that reflect and refract.
// Assumes: isotropic; radiance is scaled by the squared index ratio across the interface, so W seen from the dense side
// may exceed 1. What meets one facet is exact for Smith's surface; chains of refractions that go nearly straight on are
// counted with its transmitted lobe (rough_interface.h). The rest of what meets several facets is a second lobe on both
// sides that closes the energy: its share in each direction, and how much of it is reflected, are those of walks over
// the micro-surface; its shape is a product of a function of `out` and one of `in`, which is reciprocal.
// Neglected: the second lobe's own shape. Against exact walks, at indices 1.02 to 2.4, the share of the light that
// leaves in wrong directions is below 0.04 from above for roughness up to 0.3 and angles up to 63 deg, below 0.14 for
// roughness up to 0.3 anywhere, and up to 0.31 at roughness 1 (index 1.33, 85 deg). The reflected share agrees within
// 0.01 from index 1.33 on, within 0.032 at 1.02 (tests/physics/optics/rough_energy_test.cpp prints both).
//
// Based on: B. Walter, S. Marschner, H. Li, K. Torrance, "Microfacet models for refraction through rough surfaces",
// EGSR 2007, equations 16, 17, 20, 21; E. Heitz 2018 (visible normals); E. Heitz et al. 2016 (shadowing of
// transmission, walks); C. Kulla & A. Conty, "Revisiting physically based shading at Imageworks", SIGGRAPH course, 2017
// (a second lobe that closes the energy; here over both sides).
#include <array>
#include <cmath>

#include "optics/fresnel.h"
#include "optics/fresnel_mueller.h"
#include "optics/microfacet.h"
#include "optics/models/common.h"
#include "optics/models/polar_lobe.h"
#include "optics/models/rough_interface.h"
#include "optics/models/rows.h"

namespace suite {

namespace {

using Again = RoughInterface::Again;

double mix(double a, double b, double t) { return a + (b - a) * t; }
size_t side_of(Dir d) { return d.z > 0 ? 0 : 1; }

class GgxDielectric final : public ScatterModel {
 public:
  GgxDielectric(const ModelSpec& spec, const SpectralState& state)
      : facets_{spec.numbers.at("roughness"), spec.numbers.at("roughness")}, knots_(state.knots) {
    const std::vector<float> index = state.sample(spec.curves.at("index"));
    const double low = *std::min_element(index.begin(), index.end()),
                 high = *std::max_element(index.begin(), index.end());
    uniform_ = low == high;
    // One index at all wavelengths has its own table; several stand between shared ones, also where a state sees one of
    // them only: the tables of many states are few.
    const int first = RoughInterface::node_below(low), last = RoughInterface::node_below(high) + 1;
    const bool one = spec.curves.at("index").is_constant();
    if (one) tables_.push_back(RoughInterface::of({facets_.ax, low}));
    for (int n = first; n <= last && !one; ++n)
      tables_.push_back(RoughInterface::of({facets_.ax, RoughInterface::node(n)}));
    for (const float i : index) places_.push_back(place(i, first));
    const RoughInterface& middle = *tables_[tables_.size() / 2];
    const double squared = std::pow(places_[state.reference_bin()].index, 2);
    for (const int side : {0, 1}) {
      const double scale = side == 0 ? 1 : squared;
      lobes_.emplace_back([&](double mu) {
        const Again a = middle.again(side, mu);
        return std::max(0.0, a.missed - a.through / scale);
      });
      lobes_.emplace_back([&](double mu) { return middle.again(side, mu).through; });
    }
  }

  void eval(Dir out, Dir in, std::span<float> w) const override {
    if (out.z == 0 || in.z == 0) return zero(w);
    const bool reflected = same_side(out, in);
    const Dir o = up(out), i = up(in), h = reflected ? normalized(o + i) : o;
    const double shape = reflected ? facets_.density(h) * facets_.shadowing(o, i) / (4 * o.z) : 0, c = dot(o, h);
    const auto shadowing = reflected ? RoughInterface::Shadowing{} : RoughInterface::shadowing_across(facets_, o, i);
    Lookup from(*this, out), to(*this, in);
    for (size_t b = 0; b < w.size(); ++b) {
      const Place& p = places_[b];
      if (b > 0 && p.index == places_[b - 1].index) {
        w[b] = w[b - 1];
        continue;
      }
      const double eta = ratio(out, p.index);
      const double once = reflected ? fresnel_dielectric(c, eta).reflectance * shape
                                    : transmitted(out, in, eta) * shadowing.at(p.straight);
      w[b] = finite_float(once + (reflected ? again_reflected(from, to, p) : again_passed(from, to, p)) * i.z);
    }
  }
  void total(Dir out, std::span<float> W) const override {
    if (out.z == 0) return zero(W);
    const int side = static_cast<int>(side_of(out));
    for (size_t b = 0; b < W.size(); ++b) {
      const Place& p = places_[b];
      if (b > 0 && p.index == places_[b - 1].index) {
        W[b] = W[b - 1];
        continue;
      }
      const double mu = std::fabs(out.z), eta = ratio(out, p.index);
      const double back =
          mix(tables_[p.below]->reflected(side, mu, p.index), above(p).reflected(side, mu, p.index), p.t);
      W[b] = static_cast<float>(back + (1 - back) / (eta * eta));
    }
  }
  std::optional<Sample> sample(Dir out, Vec2 u, double lobe_u, int knot) const override {
    if (out.z == 0) return std::nullopt;
    const Place& p = places_[knots_[static_cast<size_t>(knot)]];
    const size_t side = side_of(out);
    const Again a = Lookup(*this, out).at(p);
    const double back = reflected_share(a, side, p);
    Dir in;
    bool reflect;
    if (lobe_u < a.missed) {
      reflect = lobe_u < back;
      in = lobe(reflect ? side : 1 - side, reflect).sample(u);
      if (!reflect) in.z = -in.z;
    } else {
      const double eta = ratio(out, p.index);
      const Dir o = up(out), h = facets_.visible_normal(o, u);
      const double c = dot(o, h);
      if (!(c > 0)) return std::nullopt;
      const Fresnel f = fresnel_dielectric(std::min(1.0, c), eta);
      reflect = lobe_u - a.missed < f.reflectance * (1 - a.missed) || f.transmittance == 0;
      in = normalized(reflect ? h * (2 * c) - o : h * (c / eta - f.cos_transmitted) - o / eta);
    }
    if (reflect ? !(in.z > 0) : !(in.z < 0)) return std::nullopt;
    if (out.z < 0) in.z = -in.z;
    return Sample{in, reflect ? 0 : 1, false};
  }
  void pdf(Dir out, Dir in, std::span<float> p) const override {
    if (out.z == 0 || in.z == 0) return zero(p);
    const bool reflect = same_side(out, in);
    const double drawn_again = lobe(side_of(in), reflect).pdf(std::fabs(in.z));
    Lookup from(*this, out);
    for (size_t k = 0; k < p.size(); ++k) {
      const Place& place = places_[knots_[k]];
      const Again a = from.at(place);
      const double back = reflected_share(a, side_of(out), place);
      p[k] = finite_float((1 - a.missed) * drawn_once(out, in, ratio(out, place.index)) +
                          (reflect ? back : a.missed - back) * drawn_again);
    }
  }
  // What meets one facet by Fresnel's amplitudes; the second lobe depolarises for want of a matrix.
  Polarised mueller(Dir out, Dir in, std::span<Mueller> m) const override {
    m[0] = Mueller::depolariser();
    if (out.z == 0 || in.z == 0) return {};
    const bool reflected = same_side(out, in);
    const Dir o = up(out), i = up(in), h = reflected ? normalized(o + i) : o;
    const double shape = reflected ? facets_.density(h) * facets_.shadowing(o, i) / (4 * o.z) : 0;
    const auto shadowing = reflected ? RoughInterface::Shadowing{} : RoughInterface::shadowing_across(facets_, o, i);
    Lookup from(*this, out), to(*this, in);
    const ScatteringPlane plane(out, in);
    MuellerSum sum;
    for (size_t b = 0; b < (uniform_ ? 1 : m.size()); ++b) {
      const Place& p = places_[b];
      const double eta = ratio(out, p.index);
      PlaneBlocks once = PlaneBlocks::of(0, 0, 0, 0);
      if (reflected) {
        once = fresnel_reflection(std::min(1.0, dot(o, h)), eta) * shape;
      } else if (const auto r = refraction(out, in, eta); r && r->transmittance > 0) {
        once = fresnel_transmission(std::min(1.0, dot(o, r->h)), eta) *
               (transmitted(out, in, eta) * shadowing.at(p.straight) / r->transmittance);
      }
      const double again = (reflected ? again_reflected(from, to, p) : again_passed(from, to, p)) * i.z;
      m[b] = sum.over(plane.matrix(once), 0, again);
    }
    return {uniform_, sum.unknown()};
  }
  bool spectrally_uniform_shape() const override { return uniform_; }
  bool opaque() const override { return false; }

 private:
  // Where the index of a bin stands among the tables, and what follows from it.
  struct Place {
    double index, t;
    size_t below;  // table; the one above is the next, or the same when there is one only
    double straight, through_integral;
    std::array<double, 2> reflected_integral;  // of reflected_share times cosine, of either side
  };
  Place place(double index, int first) const {
    Place p{index, 0, 0, 0, 0, {}};
    if (tables_.size() > 1) {
      const int n = RoughInterface::node_below(index);
      p.below = static_cast<size_t>(n - first);
      p.t = (index - RoughInterface::node(n)) / (RoughInterface::node(n + 1) - RoughInterface::node(n));
    }
    const RoughInterface &a = *tables_[p.below], &b = above(p);
    p.straight = mix(a.straight(), b.straight(), p.t);
    p.through_integral = mix(a.through_integral(), b.through_integral(), p.t);
    for (const int side : {0, 1})
      p.reflected_integral[static_cast<size_t>(side)] = mix(a.missed_integral(side), b.missed_integral(side), p.t) -
                                                        p.through_integral / (side == 0 ? 1 : index * index);
    return p;
  }
  const RoughInterface& above(const Place& p) const { return *tables_[std::min(p.below + 1, tables_.size() - 1)]; }

  // What light that meets several facets does at one direction, for one bin after the other.
  class Lookup {
   public:
    Lookup(const GgxDielectric& model, Dir d)
        : model_(model), side_(static_cast<int>(side_of(d))), mu_(std::fabs(d.z)) {}
    Again at(const Place& p) {
      if (!found_ || below_ != p.below) {
        low_ = model_.tables_[p.below]->again(side_, mu_);
        high_ = model_.tables_.size() == 1 ? low_ : model_.above(p).again(side_, mu_);
        below_ = p.below;
        found_ = true;
      }
      return {mix(low_.missed, high_.missed, p.t), mix(low_.through, high_.through, p.t)};
    }
    double reflected(const Place& p) { return reflected_share(at(p), static_cast<size_t>(side_), p); }
    int side() const { return side_; }

   private:
    const GgxDielectric& model_;
    int side_;
    double mu_;
    bool found_ = false;
    size_t below_ = 0;
    Again low_{}, high_{};
  };
  static double reflected_share(const Again& a, size_t side, const Place& p) {
    return std::max(0.0, a.missed - a.through / (side == 0 ? 1 : p.index * p.index));
  }
  // The second lobe, without the cosine.
  static double again_reflected(Lookup& from, Lookup& to, const Place& p) {
    const double all = p.reflected_integral[static_cast<size_t>(from.side())];
    return all > 0 ? from.reflected(p) * to.reflected(p) / all : 0;
  }
  static double again_passed(Lookup& from, Lookup& to, const Place& p) {
    const double all = p.through_integral * (from.side() == 0 ? p.index * p.index : 1);
    return all > 0 ? from.at(p).through * to.at(p).through / all : 0;
  }
  const PolarLobe& lobe(size_t side, bool reflect) const { return lobes_[2 * side + (reflect ? 0 : 1)]; }

  static double ratio(Dir out, double index) { return out.z > 0 ? index : 1 / index; }

  struct Refraction {
    Dir h;
    double transmittance, jacobian;  // d(omega_h) / d(omega_in)
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
    return Refraction{h, t, eta * eta * -ci / (s * s)};
  }
  // w of transmission by one facet, without shadowing.
  double transmitted(Dir out, Dir in, double eta) const {
    const auto r = refraction(out, in, eta);
    if (!r) return 0;
    const Dir o = up(out);
    // Radiance carried across: divided by eta^2, eta being the index beyond over the index on this side.
    return r->transmittance * dot(o, r->h) * facets_.density(r->h) / o.z * r->jacobian / (eta * eta);
  }
  // Density of what one facet sends from out to in.
  double drawn_once(Dir out, Dir in, double eta) const {
    const Dir o = up(out);
    if (!same_side(out, in)) {
      const auto r = refraction(out, in, eta);
      return r ? r->transmittance * facets_.visible_density(o, r->h) * r->jacobian : 0;
    }
    const Dir h = normalized(o + up(in));
    const double c = dot(o, h);
    return fresnel_dielectric(c, eta).reflectance * facets_.visible_density(o, h) / (4 * c);
  }

  Ggx facets_;
  std::vector<size_t> knots_;
  bool uniform_ = true;
  std::vector<std::shared_ptr<const RoughInterface>> tables_;  // at ascending indices
  std::vector<Place> places_;                                  // of the bins
  std::vector<PolarLobe> lobes_;  // to draw the second lobe with: upper side reflected, passed, lower side the same
};

}  // namespace

ModelRow ggx_dielectric_row() {
  using P = Parameter;
  return {{"ggx_dielectric",
           "rough transparent interface, GGX micro-facets (Walter 2007), dispersive; loses no energy: what meets "
           "several facets "
           "is a lobe of its own (shares after Heitz 2016), which sends up to 31 % of the light astray at roughness 1",
           "1/sr", make_model<GgxDielectric>},
          {{"index", P::Kind::curve, "1", "refractive index of the back side relative to the front side", 1.0001, 5},
           {"roughness", P::Kind::number, "1", "GGX alpha", 1e-3, 1}},
          false,
          []() -> std::vector<ModelSpec> {
            const Curve glass({0.4, 0.6, 0.9, 2.0}, {1.531, 1.516, 1.509, 1.495}, Outside::hold);
            return {{"ggx_dielectric", {{"roughness", 0.3}}, {{"index", Curve::constant(1.5)}}, {}, nullptr},
                    {"ggx_dielectric", {{"roughness", 0.05}}, {{"index", glass}}, {}, nullptr},
                    {"ggx_dielectric", {{"roughness", 0.8}}, {{"index", Curve::constant(2.4)}}, {}, nullptr}};
          }};
}

}  // namespace suite
