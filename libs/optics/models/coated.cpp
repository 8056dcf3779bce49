// A body that scatters light evenly under a transparent skin of rough facets: plastic, varnish, the cuticle of a leaf.
// The skin mirrors (facet_mirror.h: normally distributed slopes, no energy lost); what enters is scattered, and leaves
// on either side, as the product of what the skin lets through from both directions: reciprocal, at reflectance +
// transmittance = 1 nothing is lost. Both sides are alike.
// Polarisation: facets by Fresnel's amplitudes; the body depolarises between a refraction in and a refraction out,
// which are those of the skin's mean plane (the light from inside leaves p-polarised at slant). Neglected: slopes in
// what is refracted; light that goes round between body and skin is part of reflectance and transmittance, which are
// shares of what has entered. Based on: L. Wolff, "Diffuse-reflectance model for smooth dielectric surfaces", JOSA A
// 11, 1994; S. Baek, D. Jeon, X. Tong, M. Kim, "Simultaneous acquisition of polarimetric SVBRDF and normals", ACM TOG
// 37(6), 2018; D. Rondeaux & M. Herman, "Polarization of light reflected by crop canopies", RSE 38, 1991 (cuticles).
#include <algorithm>
#include <cmath>

#include "math/warps.h"
#include "optics/models/facet_mirror.h"
#include "optics/models/gauss_facets.h"
#include "optics/models/rows.h"

namespace suite {

namespace {

FacetColour skin_of(const ModelSpec& spec, const SpectralState& state) {
  FacetColour colour{{}, state.sample(spec.curves.at("index")), {}};
  colour.f0.assign(colour.n.size(), 0.0f);
  colour.k.assign(colour.n.size(), 0.0f);
  return colour;
}
GaussFacets facets_of(const ModelSpec& spec) {
  const double each = std::sqrt(2.0) * spec.numbers.at("sigma");
  return {each, each};
}

class Coated final : public ScatterModel {
 public:
  Coated(const ModelSpec& spec, const SpectralState& state)
      : mirror_(skin_of(spec, state), facets_of(spec)),
        index_(state.sample(spec.curves.at("index"))),
        reflect_(state.sample(spec.curves.at("reflectance"))),
        transmit_(state.sample(spec.curves.at("transmittance"))),
        knots_(state.knots) {
    require_sum_below_one({&reflect_, &transmit_}, "reflectance + transmittance", state);
    const auto constant = [](const std::vector<float>& v) {
      return std::all_of(v.begin(), v.end(), [&](float x) { return x == v[0]; });
    };
    uniform_ = mirror_.spectrally_uniform_shape() && constant(reflect_) && constant(transmit_);
    opaque_ = std::all_of(transmit_.begin(), transmit_.end(), [](float x) { return x == 0; });
    find_entering();
    double body = 0;
    for (size_t i = 0; i < index_.size(); ++i) body = std::max(body, double{reflect_[i] + transmit_[i]} * entering_[i]);
    share_ = body > 0 ? std::clamp(body / (body + kMirror), 0.05, 0.95) : 0;
  }

  void eval(Dir out, Dir in, std::span<float> w) const override {
    if (out.z * in.z == 0) return zero(w);
    const bool reflects = same_side(out, in);
    if (reflects)
      mirror_.eval(out, in, w);
    else
      zero(w);
    add_body(out, in, reflects ? reflect_ : transmit_, w);
  }
  void total(Dir out, std::span<float> W) const override {
    if (out.z == 0) return zero(W);
    mirror_.total(out, W);
    for (size_t i = 0; i < W.size(); ++i) W[i] += (reflect_[i] + transmit_[i]) * passed(W[i]);
  }
  std::optional<Sample> sample(Dir out, Vec2 u, double lobe_u, int knot) const override {
    if (lobe_u >= share_) return mirror_.sample(out, u, (lobe_u - share_) / (1 - share_), knot);
    Dir in = cosine_hemisphere(u);
    if (out.z == 0 || !(in.z > 0)) return std::nullopt;
    const bool reflects = lobe_u < share_ * reflect_share(static_cast<size_t>(knot));
    if (reflects != (out.z > 0)) in.z = -in.z;
    return Sample{in, reflects ? 2 : 3, false};
  }
  void pdf(Dir out, Dir in, std::span<float> p) const override {
    if (out.z * in.z == 0) return zero(p);
    mirror_.pdf(out, in, p);  // zeros on the other side
    for (size_t k = 0; k < p.size(); ++k) {
      const double side = same_side(out, in) ? reflect_share(k) : 1 - reflect_share(k);
      p[k] = finite_float((1 - share_) * p[k] + share_ * side * std::fabs(in.z) / kPi);
    }
  }
  Polarised mueller(Dir out, Dir in, std::span<Mueller> m) const override {
    if (out.z * in.z == 0) return depolarised(m);
    thread_local std::vector<float> all, facets;
    all.resize(m.size()), facets.assign(m.size(), 0);
    eval(out, in, all);
    Polarised of{true, 0};
    m[0] = Mueller::depolariser();
    if (same_side(out, in)) {
      mirror_.eval(out, in, facets);
      of = mirror_.mueller(out, in, m);
    }
    double sum = 0, mirrored = 0;
    for (size_t i = m.size(); i-- > 0;) {
      sum += all[i], mirrored += facets[i];
      const double share = all[i] > 0 ? std::min(1.0f, facets[i] / all[i]) : 0;
      const Mueller skin = m[of.grey ? 0 : i];
      m[i] = skin * share + through(out, in, index_[i]) * (1 - share);
      m[i](0, 0) = 1;
    }
    return {m.size() == 1, sum > 0 ? of.unknown * mirrored / sum : 0};
  }
  bool spectrally_uniform_shape() const override { return uniform_; }
  bool opaque() const override { return opaque_; }

 private:
  // What a skin reflects of diffuse light, to weigh lobes by.
  static constexpr double kMirror = 0.1;
  static float passed(float reflected) { return std::max(0.0f, 1 - reflected); }
  double reflect_share(size_t knot) const {
    const double r = reflect_[knots_[knot]], all = r + transmit_[knots_[knot]];
    return opaque_ || !(all > 0) ? 1 : 0.9 * r / all + 0.05;
  }
  // Both planes of refraction hold the normal, as the meridian frames do.
  static Mueller through(Dir out, Dir in, double index) {
    const PlaneBlocks o = fresnel_transmission(std::fabs(out.z), index),
                      i = fresnel_transmission(std::fabs(in.z), index);
    Mueller m = Mueller::depolariser();
    m(1, 0) = o.a > 0 ? o.b / o.a : 0;
    m(0, 1) = i.a > 0 ? i.b / i.a : 0;
    m(1, 1) = m(1, 0) * m(0, 1);
    return m;
  }
  void add_body(Dir out, Dir in, const std::vector<float>& body, std::span<float> w) const {
    thread_local std::vector<float> from, to;
    from.resize(w.size()), to.resize(w.size());
    mirror_.total(out, from);
    mirror_.total(in, to);
    const float cosine = static_cast<float>(std::fabs(in.z) / kPi);
    for (size_t i = 0; i < w.size(); ++i) w[i] += body[i] * passed(from[i]) * passed(to[i]) / entering_[i] * cosine;
  }
  // Share of diffuse light that enters, per bin: midpoints in the cosine squared.
  void find_entering() {
    constexpr int steps = 512;
    std::vector<float> W(index_.size());
    std::vector<double> sum(index_.size());
    for (int s = 0; s < steps; ++s) {
      mirror_.total(dir_from_angles(std::acos(std::sqrt((s + 0.5) / steps)), 0), W);
      for (size_t i = 0; i < W.size(); ++i) sum[i] += passed(W[i]) / steps;
    }
    entering_.assign(sum.begin(), sum.end());
  }

  FacetMirror<GaussFacets> mirror_;
  std::vector<float> index_, reflect_, transmit_, entering_;
  std::vector<size_t> knots_;
  double share_ = 0;  // of samples drawn by the cosine
  bool uniform_ = false, opaque_ = true;
};

std::vector<ModelSpec> coated_examples() {
  const Curve green({0.4, 0.55, 0.65, 0.8, 2.0}, {0.05, 0.12, 0.05, 0.48, 0.2}, Outside::hold);
  const Curve through({0.4, 0.55, 0.65, 0.8, 2.0}, {0.01, 0.1, 0.02, 0.46, 0.25}, Outside::hold);
  return {{"coated",
           {{"sigma", 0.3}},
           {{"index", Curve::constant(1.45)}, {"reflectance", green}, {"transmittance", through}},
           {},
           nullptr},
          {"coated", {{"sigma", 0.3}}, {{"reflectance", Curve::constant(1)}}, {}, nullptr}};
}

}  // namespace

ModelRow coated_row() {
  using P = Parameter;
  return {{"coated",
           "diffuse body under a rough transparent skin, polarised by refraction in and out (Wolff 1994, Baek 2018): "
           "plastic, varnish, cuticles of leaves",
           "1/sr", make_model<Coated>},
          {{"index", P::Kind::curve, "1", "refractive index of the skin", 1.01, 5, false, 1.5},
           {"sigma", P::Kind::number, "1", "root mean square slope of the skin along an axis; cuticles 0.2 to 0.4",
            1e-3, 0.7},
           {"reflectance", P::Kind::curve, "1", "share of what has entered that leaves on the same side", 0, 1},
           {"transmittance", P::Kind::curve, "1", "share of what has entered that leaves on the other side", 0, 1,
            false, 0}},
          true,
          coated_examples};
}

}  // namespace suite
