#include "math/warps.h"

#include <immintrin.h>

#include <cstring>

namespace suite {

void cosine_hemispheres(size_t count, double* x, double* y, double* z) {
  using Four = double __attribute__((vector_size(32)));
  for (size_t i = 0; i < count; i += 4) {
    Four a, b;
    std::memcpy(&a, x + i, sizeof a), std::memcpy(&b, y + i, sizeof b);
    a = 2 * a - 1, b = 2 * b - 1;
    const auto wide = a * a > b * b;
    const Four r = wide ? a : b, other = wide ? b : a;
    const SineCosine<Four> angle = sine_cosine_near_zero((kPi / 4) * (r == 0 ? Four{} : other / r));
    const Four along = r * angle.cosine, across = r * angle.sine;
    a = wide ? along : across, b = wide ? across : along;
    const Four left = 1 - a * a - b * b;
    const Four height = _mm256_sqrt_pd(left > 0 ? left : Four{});
    std::memcpy(x + i, &a, sizeof a), std::memcpy(y + i, &b, sizeof b), std::memcpy(z + i, &height, sizeof height);
  }
}

}  // namespace suite
