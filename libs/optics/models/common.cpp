#include "optics/models/common.h"

namespace suite {

void require_sum_below_one(std::initializer_list<const std::vector<float>*> curves, const char* what,
                           const SpectralState& state) {
  for (size_t i = 0; i < state.size(); ++i) {
    float sum = 0;
    for (const std::vector<float>* c : curves) sum += (*c)[i];
    if (sum > 1 + 1e-6f)
      throw Error(strf("%s = %g at %g um exceeds 1", what, sum, state.bins[i].center_um()),
                  "a surface cannot return more than it receives");
  }
}

bool proportional(const std::vector<float>& a, const std::vector<float>& b) {
  float share = -1;
  for (size_t i = 0; i < a.size(); ++i) {
    if (a[i] + b[i] <= 0) continue;
    const float here = a[i] / (a[i] + b[i]);
    if (share >= 0 && here != share) return false;
    share = here;
  }
  return true;
}

}  // namespace suite
