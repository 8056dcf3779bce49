// Flat faces and light that is even over directions.
#pragma once
#include "optics/fresnel.h"

namespace suite::test {

// How much of even light from within matter of an index a smooth face sends back: 2 times the integral of its
// reflectance times the cosine, by midpoints.
inline double reflected_within(double index) {
  constexpr int n = 20000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double c = (i + 0.5) / n;
    sum += 2 * c * fresnel_dielectric(c, 1 / index).reflectance / n;
  }
  return sum;
}

}  // namespace suite::test
