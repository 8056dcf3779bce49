// Henyey-Greenstein phase functions: one lobe, or a forward and a backward one.
// Based on: henyey_greenstein.h; two terms after G. Kattawar, "A three-parameter analytic phase function for multiple
// scattering calculations", JQSRT 15, 1975.
#include "optics/models/common.h"
#include "optics/phases/henyey_greenstein.h"
#include "optics/phases/rows.h"

namespace suite {

namespace {

class DoubleHg final : public PhaseFunction {
 public:
  // hg has g; double_hg has g1, g2, share.
  DoubleHg(const ModelSpec& spec, const SpectralState& state) : knots_(state.knots) {
    const bool two = spec.curves.count("share") != 0;
    g1_ = state.sample(spec.curves.at(two ? "g1" : "g"));
    g2_ = two ? state.sample(spec.curves.at("g2")) : g1_;
    share_ = two ? state.sample(spec.curves.at("share")) : std::vector<float>(state.size(), 1.0f);
  }
  void eval(double c, std::span<float> p) const override {
    for (size_t i = 0; i < p.size(); ++i) p[i] = value(c, i);
  }
  void pdf(double c, std::span<float> p) const override {
    for (size_t k = 0; k < p.size(); ++k) p[k] = value(c, knots_[k]);
  }
  double sample(double u, int knot) const override {
    const size_t i = knots_[static_cast<size_t>(knot)];
    const double share = share_[i];
    return u < share ? hg_sample(g1_[i], u / share) : hg_sample(g2_[i], (u - share) / (1 - share));
  }
  void asymmetry(std::span<float> g) const override {
    for (size_t i = 0; i < g.size(); ++i) g[i] = share_[i] * g1_[i] + (1 - share_[i]) * g2_[i];
  }
  bool spectrally_uniform() const override {
    const auto same = [](const std::vector<float>& v) {
      return std::all_of(v.begin(), v.end(), [&](float x) { return x == v.front(); });
    };
    return same(g1_) && same(g2_) && same(share_);
  }

 private:
  float value(double c, size_t i) const {
    const double second = share_[i] < 1 ? (1 - share_[i]) * hg_value(g2_[i], c) : 0;
    return finite_float(share_[i] * hg_value(g1_[i], c) + second);
  }
  std::vector<float> g1_, g2_, share_;
  std::vector<size_t> knots_;
};

constexpr double kMost = 0.9999;

}  // namespace

PhaseRow hg_row() {
  using P = Parameter;
  return {{"hg", "one-parameter phase function (Henyey & Greenstein 1941)", "1/sr", make_phase<DoubleHg>},
          {{"g", P::Kind::curve, "1", "mean cosine of the scattering angle", -kMost, kMost}},
          []() -> std::vector<ModelSpec> {
            const Curve haze({0.4, 0.8, 2.0}, {0.8, 0.6, 0.3}, Outside::hold);
            return {{"hg", {}, {{"g", haze}}, {}, nullptr},
                    {"hg", {}, {{"g", Curve::constant(-0.9999)}}, {}, nullptr},
                    {"hg", {}, {{"g", Curve::constant(0)}}, {}, nullptr}};
          }};
}

PhaseRow double_hg_row() {
  using P = Parameter;
  return {{"double_hg", "forward and backward lobe (Kattawar 1975)", "1/sr", make_phase<DoubleHg>},
          {{"g1", P::Kind::curve, "1", "mean cosine of the first lobe", -kMost, kMost},
           {"g2", P::Kind::curve, "1", "mean cosine of the second lobe", -kMost, kMost},
           {"share", P::Kind::curve, "1", "share of the first lobe", 0, 1}},
          []() -> std::vector<ModelSpec> {
            return {{"double_hg",
                     {},
                     {{"g1", Curve::constant(0.9)}, {"g2", Curve::constant(-0.4)}, {"share", Curve::constant(0.85)}},
                     {},
                     nullptr}};
          }};
}

}  // namespace suite
