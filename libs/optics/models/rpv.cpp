// Natural ground: the Rahman-Pinty-Verstraete model with bowl, forward or backward lobe, and hot spot.
// Assumes: the same on both sides, nothing transmitted; beyond 85 deg evaluated at 85 deg (see ground.h).
// Based on: H. Rahman, B. Pinty, M. Verstraete, "Coupled surface-atmosphere reflectance (CSAR) model 2", JGR 98(D11),
// 1993, equations 2-5.
#include <cmath>

#include "optics/models/ground.h"
#include "optics/models/rows.h"

namespace suite {

namespace {

class Rpv final : public GroundModel {
 public:
  Rpv(const ModelSpec& spec, const SpectralState& state)
      : GroundModel(spec),
        rho0_(state.sample(spec.curves.at("rho0"))),
        k_(state.sample(spec.curves.at("k"))),
        asymmetry_(state.sample(spec.curves.at("asymmetry"))),
        rho_c_(state.sample(spec.curves.at("rho_c"))) {
    for (size_t i = 1; i < rho0_.size(); ++i) uniform_ = uniform_ && same_shape(i, 0);
    // The shape is integrated once for every set of shape parameters.
    fill_totals("rpv", "lower rho0 or raise k", state, [&](Dir out, std::span<float> W) {
      const std::vector<GroundNode> nodes = ground_nodes(out);
      for (size_t i = 0; i < W.size(); ++i) {
        if (i > 0 && same_shape(i, i - 1)) {
          W[i] = rho0_[i - 1] > 0 ? W[i - 1] * rho0_[i] / rho0_[i - 1] : static_cast<float>(integral(out, nodes, i));
          continue;
        }
        W[i] = static_cast<float>(integral(out, nodes, i));
      }
    });
  }

  void eval(Dir out, Dir in, std::span<float> w) const override {
    if (!same_side(out, in)) return zero(w);
    const Geometry g(up(out), up(in));
    for (size_t i = 0; i < w.size(); ++i) w[i] = static_cast<float>(f(g, i) * std::fabs(in.z));
  }

 private:
  struct Geometry {
    double bowl, cos_phase, distance;  // mu_i mu_o (mu_i + mu_o); cosine of the phase angle; G
    Geometry(Dir o, Dir i) {
      o = not_grazing(o), i = not_grazing(i);
      bowl = o.z * i.z * (o.z + i.z);
      cos_phase = std::min(1.0, dot(o, i));
      distance = std::hypot(o.x / o.z - i.x / i.z, o.y / o.z - i.y / i.z);
    }
  };
  double f(const Geometry& g, size_t i) const {
    const double t = asymmetry_[i], d = 1 + 2 * t * g.cos_phase + t * t;
    return rho0_[i] / kPi * std::pow(g.bowl, k_[i] - 1) * (1 - t * t) / (d * std::sqrt(d)) *
           (1 + (1 - rho_c_[i]) / (1 + g.distance));
  }
  double integral(Dir out, const std::vector<GroundNode>& nodes, size_t i) const {
    double sum = 0;
    for (const GroundNode& n : nodes) sum += n.weight * f(Geometry(out, n.in), i);
    return sum;
  }
  bool same_shape(size_t a, size_t b) const {
    return k_[a] == k_[b] && asymmetry_[a] == asymmetry_[b] && rho_c_[a] == rho_c_[b];
  }

  std::vector<float> rho0_, k_, asymmetry_, rho_c_;
};

}  // namespace

ModelRow rpv_row() {
  using P = Parameter;
  return {
      {"rpv", "natural ground with bowl, lobe and hot spot (Rahman, Pinty & Verstraete 1993)", "1/sr", make_model<Rpv>},
      {{"rho0", P::Kind::curve, "1", "overall reflectance level", 0, 1},
       {"k", P::Kind::curve, "1", "below 1 a bowl, above 1 a bell", 0.2, 2},
       {"asymmetry", P::Kind::curve, "1", "negative scatters back to the light, positive forward", -0.9, 0.9},
       {"rho_c", P::Kind::curve, "1", "hot spot: 1 - rho_c is its height; 1 = none", 0, 1, false, 1},
       bpdf_parameter()},
      true,
      []() -> std::vector<ModelSpec> {
        const Curve level({0.4, 0.65, 0.85, 2.0}, {0.02, 0.04, 0.2, 0.15}, Outside::hold);
        const Curve bowl({0.4, 0.65, 0.85, 2.0}, {0.7, 0.75, 0.85, 0.8}, Outside::hold);
        const Curve back({0.4, 0.85, 2.0}, {-0.2, -0.1, -0.15}, Outside::hold);
        return {{"rpv", {}, {{"rho0", level}, {"k", bowl}, {"asymmetry", back}, {"rho_c", level}}, {}, nullptr},
                {"rpv",
                 {},
                 {{"rho0", Curve::constant(0.1)}, {"k", Curve::constant(1.2)}, {"asymmetry", Curve::constant(0.3)}},
                 {{"bpdf", "nadal_breon rho 0.0145 beta 120"}},
                 nullptr}};
      }};
}

}  // namespace suite
