// Natural ground: isotropic, volumetric (RossThick) and geometric (LiSparse, reciprocal) kernels, as in satellite
// products. Assumes: crowns with h/b = 2 and b/r = 1; negative sums count as 0; beyond 85 deg evaluated at 85 deg (see
// ground.h). Based on: W. Lucht, C. Schaaf, A. Strahler, "An algorithm for the retrieval of albedo from space using
// semiempirical BRDF models", IEEE TGRS 38(2), 2000, equations 37-44.
#include <cmath>

#include "optics/models/ground.h"
#include "optics/models/rows.h"

namespace suite {

namespace {

struct Kernels {
  double volume, geometry;
  Kernels(Dir o, Dir i) {
    o = not_grazing(o), i = not_grazing(i);
    const double phase = angle_between(o, i), cos_phase = std::cos(phase);
    volume = ((kPi / 2 - phase) * cos_phase + std::sin(phase)) / (o.z + i.z) - kPi / 4;
    // Overlap of the shadows of spheres whose centres stand two radii high.
    const double sec = 1 / o.z + 1 / i.z, dx = o.x / o.z - i.x / i.z, dy = o.y / o.z - i.y / i.z;
    const double sine = (o.x * i.y - o.y * i.x) / (o.z * i.z);  // tan tan sin(delta phi)
    const double cos_t = std::min(1.0, 2 * std::sqrt(dx * dx + dy * dy + sine * sine) / sec), t = std::acos(cos_t);
    const double overlap = (t - std::sin(t) * cos_t) * sec / kPi;
    geometry = overlap - sec + 0.5 * (1 + cos_phase) / (o.z * i.z);
  }
};

class RossLi final : public GroundModel {
 public:
  RossLi(const ModelSpec& spec, const SpectralState& state)
      : isotropic_(state.sample(spec.curves.at("isotropic"))),
        volume_(state.sample(spec.curves.at("volume"))),
        geometry_(state.sample(spec.curves.at("geometry"))) {
    uniform_ = same_shares();
    fill_totals("ross_li", "lower the kernel weights", state, [&](Dir out, std::span<float> W) {
      std::vector<double> sum(W.size());
      for (const GroundNode& n : ground_nodes(out)) {
        const Kernels k(out, n.in);
        for (size_t i = 0; i < W.size(); ++i) sum[i] += n.weight * f(k, i);
      }
      for (size_t i = 0; i < W.size(); ++i) W[i] = static_cast<float>(sum[i]);
    });
  }

  void eval(Dir out, Dir in, std::span<float> w) const override {
    if (!same_side(out, in)) return zero(w);
    const Kernels k(up(out), up(in));
    for (size_t i = 0; i < w.size(); ++i) w[i] = static_cast<float>(f(k, i) * std::fabs(in.z));
  }

 private:
  double f(const Kernels& k, size_t i) const {
    return std::max(0.0, isotropic_[i] + volume_[i] * k.volume + geometry_[i] * k.geometry) / kPi;
  }
  bool same_shares() const {
    for (size_t i = 1; i < isotropic_.size(); ++i)
      if (volume_[i] * isotropic_[0] != volume_[0] * isotropic_[i] ||
          geometry_[i] * isotropic_[0] != geometry_[0] * isotropic_[i])
        return false;
    return true;
  }
  std::vector<float> isotropic_, volume_, geometry_;
};

}  // namespace

ModelRow ross_li_row() {
  using P = Parameter;
  return {{"ross_li", "natural ground, RossThick and LiSparse kernels as in satellite products (Lucht 2000)", "1/sr",
           make_model<RossLi>},
          {{"isotropic", P::Kind::curve, "1", "weight of the constant", 0, 1},
           {"volume", P::Kind::curve, "1", "weight of the RossThick kernel", -1, 1},
           {"geometry", P::Kind::curve, "1", "weight of the LiSparse kernel", -1, 1}},
          true,
          []() -> std::vector<ModelSpec> {
            const Curve level({0.4, 0.65, 0.85, 2.0}, {0.04, 0.06, 0.3, 0.25}, Outside::hold);
            const Curve volume({0.4, 0.65, 0.85, 2.0}, {0.02, 0.03, 0.2, 0.1}, Outside::hold);
            const Curve geometry({0.4, 0.65, 0.85, 2.0}, {0.01, 0.012, 0.03, 0.03}, Outside::hold);
            return {{"ross_li", {}, {{"isotropic", level}, {"volume", volume}, {"geometry", geometry}}, {}, nullptr},
                    {"ross_li",
                     {},
                     {{"isotropic", Curve::constant(0.2)},
                      {"volume", Curve::constant(0.1)},
                      {"geometry", Curve::constant(0.1)}},
                     {},
                     nullptr}};
          }};
}

}  // namespace suite
