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

// The matrix of a model that depolarises by its definition.
inline ScatterModel::Polarised depolarised(std::span<Mueller> m) {
  m[0] = Mueller::depolariser();
  return {true, 0};
}
// Sums w M over the parts of a model, and gives M / m11 and what is unknown of it all.
class MuellerSum {
 public:
  // Light of a matrix, of w times it, and what depolarises: by its nature, or for want of a matrix.
  Mueller over(const Mueller& polarised, double depolarises, double not_known) {
    const double m11 = polarised(0, 0), all = m11 + depolarises + not_known;
    unknown_ += not_known, all_ += all;
    if (!(all > 0) || !std::isfinite(all)) return Mueller::depolariser();
    Mueller m = polarised * (1 / all);
    m(0, 0) = 1;
    return m;
  }
  double unknown() const { return all_ > 0 ? unknown_ / all_ : 0; }

 private:
  double unknown_ = 0, all_ = 0;
};

// Error naming `what` and the wavelength where the curves sum to more than 1.
void require_sum_below_one(std::initializer_list<const std::vector<float>*> curves, const char* what,
                           const SpectralState& state);
// True when a[i] / b[i] is the same for all i (both zero fits anything).
bool proportional(const std::vector<float>& a, const std::vector<float>& b);

}  // namespace suite
