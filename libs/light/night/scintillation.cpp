#include "light/night/scintillation.h"

#include <algorithm>
#include <cmath>

#include "math/variates.h"

namespace suite {

double scintillation_index(double aperture, double mass, double height, double exposure) {
  constexpr double kShortest = 0.01;  // s
  return 0.09 * std::pow(100 * aperture, -2.0 / 3) * std::pow(mass, 1.75) * std::exp(-height / 8000) /
         std::sqrt(2 * std::max(kShortest, exposure));
}

double scintillation(double index, uint64_t key) {
  if (!(index > 0)) return 1;
  Pcg32 random(key);
  const double variance = std::log1p(index * index);
  return std::exp(std::sqrt(variance) * normal(random) - 0.5 * variance);
}

}  // namespace suite
