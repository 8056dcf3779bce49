// The wind-roughened surface of deep water seen from far: glitter of normally distributed slopes, whitecaps, and the
// light that comes back from below as a diffuse reflectance. Opaque, the same on both sides.
// What meets one facet is exact for Smith's surface (masking and shadowing by a normal distribution of uncorrelated
// slopes), what meets more is facet_mirror.h's second lobe. What enters comes back by `below`, as the product of what
// the surface lets through from both directions: reciprocal, at `below` = 1 nothing is lost.
#include "optics/models/sea.h"

#include <algorithm>
#include <cmath>

#include "math/warps.h"
#include "optics/models/facet_mirror.h"
#include "optics/models/rows.h"

namespace suite {

GaussFacets SeaSlopes::facets() const { return {std::sqrt(2 * along), std::sqrt(2 * across)}; }

SeaSlopes sea_slopes(double wind, bool directed) {
  if (directed) return {std::max(1e-4, 0.00316 * wind), 0.003 + 0.00192 * wind};
  const double each = 0.5 * (0.003 + 0.00512 * wind);
  return {each, each};
}

std::vector<std::string> sea_notes(double wind, bool directed) {
  const SeaSlopes s = sea_slopes(wind, directed);
  const double slope = std::sqrt(s.along + s.across);
  if (wind > 14)
    return {strf(
        "slopes at %g m/s (%.2g root mean square) and whitecaps (%.2g of the surface) go on beyond the 14 m/s that "
        "were measured",
        wind, slope, whitecap_share(wind))};
  if (wind < 1)
    return {
        strf("at %g m/s the sea is not flat: slopes of %.2g root mean square are what Cox & Munk's lines leave without "
             "wind; a flat surface is a mirror or a dielectric",
             wind, slope)};
  return {};
}

double whitecap_share(double wind) { return std::min(1.0, 2.95e-6 * std::pow(wind, 3.52)); }

namespace {

FacetColour water_of(const ModelSpec& spec, const SpectralState& state) {
  FacetColour colour{{}, state.sample(spec.curves.at("index")), state.sample(spec.curves.at("k"))};
  colour.f0.assign(colour.n.size(), 0.0f);
  return colour;
}

class Sea final : public ScatterModel {
 public:
  Sea(const ModelSpec& spec, const SpectralState& state)
      : mirror_(water_of(spec, state),
                sea_slopes(spec.numbers.at("wind_m_s"), spec.numbers.at("directed") > 0.5).facets()),
        foam_(state.sample(spec.curves.at("foam"))),
        below_(state.sample(spec.curves.at("below"))) {
    const double given = spec.numbers.at("whitecaps"), wind = spec.numbers.at("wind_m_s");
    white_ = static_cast<float>(given >= 0 ? given : whitecap_share(wind));
    find_entering();
    double diffuse = 0;
    for (size_t i = 0; i < foam_.size(); ++i)
      diffuse = std::max(diffuse, double(white_) * foam_[i] + (1.0 - white_) * below_[i] * entering_[i]);
    share_ = diffuse > 0 ? std::clamp(diffuse / (diffuse + (1 - white_) * kMirror), 0.05, 1.0) : 0;
    const auto constant = [](const std::vector<float>& v) {
      return std::all_of(v.begin(), v.end(), [&](float x) { return x == v[0]; });
    };
    uniform_ = mirror_.spectrally_uniform_shape() && constant(foam_) && constant(below_);
  }

  void eval(Dir out, Dir in, std::span<float> w) const override {
    if (!same_side(out, in)) return zero(w);
    mirror_.eval(out, in, w);
    thread_local std::vector<float> from, to;
    from.resize(w.size()), to.resize(w.size());
    mirror_.total(out, from);
    mirror_.total(in, to);
    const float cosine = static_cast<float>(std::fabs(in.z) / kPi);
    for (size_t i = 0; i < w.size(); ++i) {
      const float body = below_[i] * passed(from[i]) * passed(to[i]) / entering_[i];
      w[i] = (1 - white_) * (w[i] + body * cosine) + white_ * foam_[i] * cosine;
    }
  }
  void total(Dir out, std::span<float> W) const override {
    if (out.z == 0) return zero(W);
    mirror_.total(out, W);
    for (size_t i = 0; i < W.size(); ++i) W[i] = (1 - white_) * (W[i] + below_[i] * passed(W[i])) + white_ * foam_[i];
  }
  std::optional<Sample> sample(Dir out, Vec2 u, double lobe_u, int knot) const override {
    if (lobe_u >= share_) return mirror_.sample(out, u, (lobe_u - share_) / (1 - share_), knot);
    const Dir in = cosine_hemisphere(u);
    if (out.z == 0 || !(in.z > 0)) return std::nullopt;
    return Sample{out.z > 0 ? in : Dir{in.x, in.y, -in.z}, 2, false};
  }
  void pdf(Dir out, Dir in, std::span<float> p) const override {
    mirror_.pdf(out, in, p);
    const double diffuse = same_side(out, in) ? share_ * std::fabs(in.z) / kPi : 0;
    for (float& x : p) x = finite_float((1 - share_) * x + diffuse);
  }
  // The glitter as facet_mirror.h has it; whitecaps and what comes from below depolarise.
  Polarised mueller(Dir out, Dir in, std::span<Mueller> m) const override {
    m[0] = Mueller::depolariser();
    if (!same_side(out, in)) return {true, 0};
    thread_local std::vector<float> all, glitter;
    all.resize(m.size()), glitter.resize(m.size());
    eval(out, in, all);
    mirror_.eval(out, in, glitter);
    const Polarised of = mirror_.mueller(out, in, m);
    double sum = 0, mirrored = 0;
    for (size_t i = m.size(); i-- > 0;) {
      const double part = (1 - white_) * double{glitter[i]};
      const Mueller one = m[of.grey ? 0 : i];
      sum += all[i], mirrored += part;
      m[i] = Mueller::depolariser();
      if (all[i] > 0) m[i] = m[i] * (1 - part / all[i]) + one * (part / all[i]);
    }
    return {m.size() == 1, sum > 0 ? of.unknown * mirrored / sum : 0};
  }
  bool spectrally_uniform_shape() const override { return uniform_; }
  bool isotropic() const override { return mirror_.isotropic(); }

 private:
  // What a water surface reflects of diffuse light, to weigh lobes by.
  static constexpr double kMirror = 0.07;
  static float passed(float reflected) { return std::max(0.0f, 1 - reflected); }

  // Share of diffuse light that enters, per bin: midpoints in the cosine squared.
  void find_entering() {
    constexpr int steps = 512;
    const int azimuths = isotropic() ? 1 : 32;
    std::vector<float> W(foam_.size());
    std::vector<double> sum(foam_.size());
    for (int s = 0; s < steps * azimuths; ++s) {
      const double mu = std::sqrt((s / azimuths + 0.5) / steps);
      mirror_.total(dir_from_angles(std::acos(mu), kPi / 2 * (s % azimuths + 0.5) / azimuths), W);
      for (size_t i = 0; i < W.size(); ++i) sum[i] += passed(W[i]) / (steps * azimuths);
    }
    entering_.assign(sum.begin(), sum.end());
  }

  FacetMirror<GaussFacets> mirror_;
  std::vector<float> foam_, below_, entering_;
  float white_ = 0;
  double share_ = 0;  // of samples drawn by the cosine
  bool uniform_ = false;
};

std::vector<ModelSpec> examples() {
  const Curve index({0.4, 0.8, 2.0}, {1.343, 1.333, 1.31}, Outside::hold);
  const Curve below({0.4, 0.6, 0.8}, {0.06, 0.02, 0.001}, Outside::hold);
  return {{"sea", {{"wind_m_s", 5}}, {{"index", index}, {"below", below}}, {}, nullptr},
          {"sea", {{"wind_m_s", 10}, {"directed", 1}}, {}, {}, nullptr},
          {"sea", {{"wind_m_s", 30}, {"whitecaps", 0}}, {}, {}, nullptr},
          {"sea", {{"wind_m_s", 0}}, {}, {}, nullptr}};
}

}  // namespace

ModelRow sea_row() {
  using P = Parameter;
  return {
      {"sea",
       "wind-roughened deep water from far: glitter of Cox & Munk's slopes (1954; measured from 1 to 14 m/s; without "
       "wind the surface is not flat), whitecaps, water below",
       "1/sr", make_model<Sea>},
      {{"wind_m_s", P::Kind::number, "m/s", "speed of the wind at 12.5 m", 0, 40},
       {"directed", P::Kind::number, "1", "1: the wind blows along the surface's x; 0: slopes alike in all directions",
        0, 1, false, 0},
       {"index", P::Kind::curve, "1", "real part of the refractive index", 1.01, 5, false, 1.34},
       {"k", P::Kind::curve, "1", "imaginary part of the refractive index, absorbing positive", 0, 10, false, 0},
       {"whitecaps", P::Kind::number, "1", "share of the surface; -1 = by the wind (Monahan & O'Muircheartaigh 1980)",
        -1, 1, false, -1},
       {"foam", P::Kind::curve, "1", "reflectance of whitecaps (Koepke 1984)", 0, 1, false, kFoamReflectance},
       {"below", P::Kind::curve, "1", "share of the light that enters which comes back, diffuse", 0, 1, false, 0}},
      true,
      examples};
}

}  // namespace suite
