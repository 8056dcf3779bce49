// Small things that the model files share.
#pragma once
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "optics/models.h"

namespace suite {

template <class Model>
std::unique_ptr<const ScatterModel> make_model(const ModelSpec& spec, const SpectralState& state) {
  return std::make_unique<Model>(spec, state);
}

inline void zero(std::span<float> v) { std::fill(v.begin(), v.end(), 0.0f); }
// Narrow lobes at grazing exceed what a float holds; the largest float stands for them.
inline float finite_float(double x) {
  return static_cast<float>(std::min(x, static_cast<double>(std::numeric_limits<float>::max())));
}
// Both strictly on the same side of the surface.
inline bool same_side(Dir a, Dir b) { return a.z * b.z > 0; }
inline Dir up(Dir d) { return {d.x, d.y, std::fabs(d.z)}; }

// Error naming `what` and the wavelength where the curves sum to more than 1.
void require_sum_below_one(std::initializer_list<const std::vector<float>*> curves, const char* what,
                           const SpectralState& state);
// True when a[i] / b[i] is the same for all i (both zero fits anything).
bool proportional(const std::vector<float>& a, const std::vector<float>& b);

}  // namespace suite
