#include "air/band_fits.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/error.h"

namespace suite {

namespace {

struct ContinuumNode {
  double wavenumber_cm, self_296, self_260, foreign;
};

#include "air/bands_table.inc"

}  // namespace

const BandFit* band_fit(Gas gas, int wavenumber_cm) {
  const auto* found = std::find_if(std::begin(kBandFits), std::end(kBandFits), [&](const BandFit& fit) {
    return fit.gas == gas && wavenumber_cm >= fit.low && wavenumber_cm < fit.high;
  });
  return found == std::end(kBandFits) ? nullptr : found;
}

std::span<const double> band_law(size_t law) {
  constexpr size_t size = 2 * kBandLawPoints;
  SUITE_CHECK((law + 1) * size <= std::size(kBandLaws));
  return {kBandLaws + law * size, size};
}

ContinuumFactors continuum_factors(double v) {
  const auto* high = std::upper_bound(std::begin(kContinuumNodes), std::end(kContinuumNodes), v,
                                      [](double x, const ContinuumNode& node) { return x < node.wavenumber_cm; });
  const auto* last = std::end(kContinuumNodes) - 1;
  if (high == std::begin(kContinuumNodes)) return {high->self_296, high->self_260, high->foreign};
  if (high > last) return {last->self_296, last->self_260, last->foreign};
  const ContinuumNode &a = high[-1], &b = *high;
  const double s = (v - a.wavenumber_cm) / (b.wavenumber_cm - a.wavenumber_cm);
  const auto between = [&](double x, double y) { return x * std::pow(y / x, s); };
  return {between(a.self_296, b.self_296), between(a.self_260, b.self_260), between(a.foreign, b.foreign)};
}

}  // namespace suite
