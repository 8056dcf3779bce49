// Perfectly specular reflection: a Dirac lobe in the mirror direction.
// Based on: Goodenough & Brown, equations 10-11.
#include <algorithm>

#include "optics/models/rows.h"

namespace suite {

namespace {

class Mirror final : public ScatterModel {
 public:
  Mirror(const ModelSpec& spec, const SpectralState& state) : rho_(state.sample(spec.curves.at("reflectance"))) {}
  void eval(Dir, Dir, std::span<float> w) const override { std::fill(w.begin(), w.end(), 0.0f); }
  void total(Dir out, std::span<float> W) const override {
    for (size_t i = 0; i < W.size(); ++i) W[i] = out.z == 0 ? 0.0f : rho_[i];
  }
  std::optional<Sample> sample(Dir out, Vec2, double, int) const override {
    if (out.z == 0) return std::nullopt;
    return Sample{{-out.x, -out.y, out.z}, 0, true};
  }
  void pdf(Dir, Dir, std::span<float> p) const override { std::fill(p.begin(), p.end(), 0.0f); }
  void delta_weight(Dir, int, int, std::span<float> weight) const override {
    std::copy_n(rho_.begin(), weight.size(), weight.begin());
  }
  void delta_probability(Dir, int, int, std::span<float> p) const override { std::fill(p.begin(), p.end(), 1.0f); }
  // Of a perfect conductor: p and s reflect alike, in opposite phase.
  Polarised delta_mueller(Dir out, int, int, std::span<Mueller> m) const override {
    m[0] = ScatteringPlane(out, {-out.x, -out.y, out.z}).matrix(PlaneBlocks::of(1, 0, -1, 0));
    return {true, 0};
  }
  bool has_delta() const override { return true; }
  bool single_lobe() const override { return true; }
  bool spectrally_uniform_shape() const override { return true; }

 private:
  std::vector<float> rho_;
};

}  // namespace

ModelRow mirror_row() {
  using P = Parameter;
  return {{"mirror", "perfectly specular reflection (Dirac lobe)", "1/sr",
           [](const ModelSpec& spec, const SpectralState& state) -> std::unique_ptr<const ScatterModel> {
             return std::make_unique<Mirror>(spec, state);
           }},
          {{"reflectance", P::Kind::curve, "1", "specular reflectance of both sides", 0, 1}},
          true,
          []() -> std::vector<ModelSpec> {
            return {{"mirror", {}, {{"reflectance", Curve::constant(0.8)}}, {}, nullptr}};
          }};
}

}  // namespace suite
