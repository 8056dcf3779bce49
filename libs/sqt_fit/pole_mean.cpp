#include "sqt_fit/pole_mean.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace suite::sqt {

namespace {

constexpr int kPoleAzimuths = 8;
constexpr double kPoleMeanSame = 1e-9;  // relative: rounding, no dependence

Dir turned(Dir d, int k) {
  const double angle = 2 * kPi * k / kPoleAzimuths, c = std::cos(angle), s = std::sin(angle);
  return {c * d.x - s * d.y, s * d.x + c * d.y, d.z};
}

}  // namespace

PoleMean::PoleMean(const Function& function) : function_(function) {
  const Info& i = info();
  if (i.quantity != Quantity::bsdf || !i.isotropic) return;
  std::vector<double> f(i.wavelength_um.size()), g(f.size());
  for (int step = 1; step < 17 && !needed_; ++step) {
    const Dir in = dir_from_angles(5 * kDegree * step, 0.3);
    function.value({0, 0, 1}, in, f);
    for (int k = 1; k < kPoleAzimuths && !needed_; ++k) {
      function.value({0, 0, 1}, turned(in, k), g);
      for (size_t c = 0; c < f.size(); ++c) needed_ |= std::fabs(f[c] - g[c]) > kPoleMeanSame * std::fabs(f[c]);
    }
  }
}

void PoleMean::value(Dir out, Dir in, std::span<double> f) const {
  if (out.x != 0 || out.y != 0) return function_.value(out, in, f);
  std::vector<double> one(f.size()), sum(f.size(), 0.0);
  std::vector<int> known(f.size(), 0);
  for (int k = 0; k < kPoleAzimuths; ++k) {
    function_.value(out, turned(in, k), one);
    for (size_t c = 0; c < f.size(); ++c)
      if (std::isfinite(one[c])) sum[c] += std::max(0.0, one[c]), ++known[c];  // negative values are taken as 0
  }
  for (size_t c = 0; c < f.size(); ++c) f[c] = known[c] ? sum[c] / known[c] : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace suite::sqt
