// How paths of the balance of heat go on at a surface.
#pragma once
#include <optional>
#include <vector>

#include "math/warps.h"
#include "optics/scatter_model.h"
#include "spectral/state.h"

namespace suite {

// Blocks of random numbers from here on choose points of elements (heat/elements.h).
inline constexpr uint32_t kPointBlock = 1u << 20;

// A path of one bin of a state of which every bin is a knot, or whose shapes are all alike.
class OneBinWalk {
 public:
  explicit OneBinWalk(const SpectralState& state)
      : knots_(state.knots.size()), w_(state.size()), p_(state.knots.size()) {}

  struct Reflected {
    Dir direction;      // local
    double weight = 0;  // what the surface makes of the bin's throughput, its total included
  };
  // Nothing: the draw was in vain.
  std::optional<Reflected> reflect(const ScatterModel& model, Dir out, Vec2 u, double lobe_u, size_t bin) {
    const size_t knot = knots_ == 1 ? 0 : bin;
    const auto drawn = model.sample(out, u, lobe_u, static_cast<int>(knot));
    if (!drawn) return std::nullopt;
    if (drawn->delta) {
      model.delta_weight(out, drawn->lobe, static_cast<int>(knot), w_);
      model.delta_probability(out, drawn->lobe, static_cast<int>(knot), p_);
    } else {
      model.eval(out, drawn->in, w_);
      model.pdf(out, drawn->in, p_);
    }
    if (!(p_[knot] > 0)) return std::nullopt;
    return Reflected{drawn->in, static_cast<double>(w_[bin]) / static_cast<double>(p_[knot])};
  }

 private:
  size_t knots_;
  std::vector<float> w_, p_;
};

}  // namespace suite
