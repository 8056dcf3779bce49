#include "sqt/reciprocity.h"

#include <algorithm>
#include <cmath>

#include "math/sampling.h"
#include "math/warps.h"
#include "sqt/mirror_pairs.h"

namespace suite::sqt {

std::vector<double> reciprocity_error(size_t channels,
                                      const std::function<void(Dir out, Dir in, std::span<double> f)>& value) {
  constexpr uint32_t kPairs = 25000;
  const double limit = std::cos(80 * kDegree);
  const SampleStream stream(1, 78, 0);
  std::vector<double> there(channels), back(channels), difference(channels + 1), sum(channels + 1), error(channels + 1);
  for (uint32_t n = 0; n < kPairs; ++n) {
    const auto u = stream.draw(n, 0);
    const Dir out = uniform_sphere({u[0] / 2, u[1]}), h = near_half(u[2], u[3]);
    const Dir in = n % 2 ? h * (2 * dot(h, out)) - out : uniform_sphere({u[2] / 2, u[3]});
    if (!(out.z > limit) || !(in.z > limit)) continue;
    const Dir half = normalized(in + out);
    const double near = near_pdf(1 - half.z) / (4 * std::max(1e-9, dot(half, out))), uniform = 1 / (2 * kPi);
    const double weight = 2 * uniform / (uniform + near);
    value(out, in, there);
    value(in, out, back);
    for (size_t c = 0; c < channels; ++c) {
      if (!std::isfinite(there[c]) || !std::isfinite(back[c])) continue;
      for (const size_t k : {c, channels}) {
        difference[k] += weight * std::fabs(there[c] - back[c]);
        sum[k] += weight * (std::fabs(there[c]) + std::fabs(back[c]));
      }
    }
  }
  for (size_t k = 0; k <= channels; ++k) error[k] = sum[k] > 0 ? difference[k] / sum[k] : 0;
  return error;
}

std::vector<double> reciprocity_error(const Bundle& bundle) {
  if (!bundle.cosine_weighted()) return std::vector<double>(bundle.channels() + 1, 0.0);
  return reciprocity_error(bundle.channels(), [&](Dir out, Dir in, std::span<double> f) { bundle.value(out, in, f); });
}

}  // namespace suite::sqt
