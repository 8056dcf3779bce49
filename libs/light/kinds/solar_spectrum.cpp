#include "light/kinds/solar_spectrum.h"

#include <cmath>

#include "spectral/planck.h"

namespace suite {

namespace {

constexpr double kTable[] = {
#include "light/kinds/solar_table.inc"
};
constexpr size_t kFine = 399, kCount = sizeof(kTable) / sizeof(kTable[0]);
static_assert(kCount == 744);
// Lower edge of bin i, um.
double edge(size_t i) {
  return i <= kFine ? 0.202 + 0.002 * static_cast<double>(i) : 1 + 0.005 * static_cast<double>(i - kFine);
}

Curve make() {
  // Values stand at the centres of their bins; the outer halves of the first and last bin are held.
  std::vector<double> x{edge(0)}, y{kTable[0]};
  for (size_t i = 0; i < kCount; ++i) {
    x.push_back(0.5 * (edge(i) + edge(i + 1)));
    y.push_back(kTable[i]);
  }
  // Chords over steps of 1 % follow the tail to 3e-4. The join takes the mean of the last 25 bins, which spans lines.
  double mean = 0, blackbody = 0;
  for (size_t i = kCount - 25; i < kCount; ++i) {
    mean += kTable[i];
    blackbody += planck_radiance(0.5 * (edge(i) + edge(i + 1)), 5772);
  }
  for (double w = edge(kCount); w < 1000 * 1.01; w *= 1.01) {
    x.push_back(std::min(w, 1000.0));
    y.push_back(mean / blackbody * planck_radiance(x.back(), 5772));
    if (x.back() == 1000) break;
  }
  return Curve(std::move(x), std::move(y), Outside::error);
}

}  // namespace

const Curve& solar_irradiance() {
  static const Curve curve = make();
  return curve;
}

}  // namespace suite
