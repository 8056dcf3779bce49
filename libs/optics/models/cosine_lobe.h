// What models share that scatter widely, on either side alike, with nothing transmitted: draws by the cosine, whatever
// the wavelength.
#pragma once
#include <algorithm>
#include <cmath>

#include "math/warps.h"
#include "optics/models/common.h"

namespace suite {

class CosineLobe : public ScatterModel {
 public:
  std::optional<Sample> sample(Dir out, Vec2 u, double, int) const final {
    const Dir in = cosine_hemisphere(u);
    if (out.z == 0 || !(in.z > 0)) return std::nullopt;
    return Sample{out.z > 0 ? in : Dir{in.x, in.y, -in.z}, 0, false};
  }
  void pdf(Dir out, Dir in, std::span<float> p) const final {
    std::fill(p.begin(), p.end(), same_side(out, in) ? static_cast<float>(std::fabs(in.z) / kPi) : 0.0f);
  }
  bool spectrally_uniform_shape() const final { return uniform_; }
  bool single_lobe() const final { return true; }

 protected:
  bool uniform_ = true;  // the shape is the same at all wavelengths; the constructor's to clear
};

}  // namespace suite
