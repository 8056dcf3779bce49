// Natural ground as a sum of a constant and two kernels of geometry, each with a weight that depends on the wavelength
// (reflectance, of which f is the pi-th part). Negative sums count as 0; beyond 85 deg evaluated at 85 deg (ground.h).
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "optics/models/ground.h"

namespace suite {

// Kernels: made from two upper directions, not grazing; its numbers `volume` and `geometry`, without unit.
template <class Kernels>
class KernelGround : public GroundModel {
 public:
  KernelGround(const char* model, const ModelSpec& spec, const SpectralState& state)
      : GroundModel(spec),
        isotropic_(state.sample(spec.curves.at("isotropic"))),
        volume_(state.sample(spec.curves.at("volume"))),
        geometry_(state.sample(spec.curves.at("geometry"))) {
    uniform_ = same_shares();
    fill_totals(model, "lower the kernel weights", state, [&](Dir out, std::span<float> W) {
      std::vector<double> sum(W.size());
      for (const GroundNode& n : ground_nodes(out)) {
        const Kernels k(not_grazing(out), not_grazing(n.in));
        for (size_t i = 0; i < W.size(); ++i) sum[i] += n.weight * f(k, i);
      }
      for (size_t i = 0; i < W.size(); ++i) W[i] = static_cast<float>(sum[i]);
    });
  }

  void eval(Dir out, Dir in, std::span<float> w) const override {
    if (!same_side(out, in)) return zero(w);
    const Kernels k(not_grazing(up(out)), not_grazing(up(in)));
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

}  // namespace suite
