#include "air/gases.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "air/parts.h"

namespace suite {

namespace {

// Parts of one band: its absorbers overlapped at random, those that hardly matter as an addition to all parts.
Parts overlapped(const std::vector<GasPoints>& absorbers, const Column& column, double weight) {
  Parts parts(column.levels());
  parts.add(weight, std::vector<float>(column.levels(), 0.0f));
  std::vector<const GasPoints*> rich;
  for (const GasPoints& a : absorbers) {
    if (a.count() == 1) {
      parts.add_to_all(a.absorption);
      continue;
    }
    const Parts of(a, column.levels());
    double through = 0;
    const std::vector<double> depth = of.depths(column);
    for (size_t i = 0; i < of.count(); ++i) through += of.weight(i) * std::exp(-depth[i]);
    if (1 - through < kSlight) {
      parts.add_to_all(of.joined(0, of.count(), depth));
    } else {
      rich.push_back(&a);
    }
  }
  for (const GasPoints* a : rich) {
    parts = parts.times(*a);
    if (parts.count() > kPartsOfBand) parts = parts.gathered(column, kPartsOfBand);
  }
  return parts;
}

}  // namespace

GasPoints gas_points(const GasProvider& provider, std::span<const AirLevel> levels, double low_um, double high_um,
                     const GasReduction& reduction) {
  if (!(low_um > 0 && high_um > low_um))
    throw Error(strf("gas absorption from %g to %g um", low_um, high_um), "an interval of positive wavelengths");
  if (low_um < provider.low_um() * (1 - 1e-9) || high_um > provider.high_um() * (1 + 1e-9))
    throw Error(strf("gas absorption from %g to %g um", low_um, high_um),
                strf("the table reaches from %g to %g um", provider.low_um(), provider.high_um()));
  if (reduction.most < 1 || reduction.most > 16)
    throw Error(strf("%d points of gas absorption", reduction.most), "1 to 16");
  SUITE_CHECK(levels.size() >= 2);
  const Column column(levels);
  const double low_cm = 1e4 / high_um, high_cm = 1e4 / low_um;
  Parts all(levels.size());
  for (const GasProvider::Band& band : provider.bands(low_cm, high_cm))
    all.append(overlapped(provider.absorbers(band, levels), column, (band.high_cm - band.low_cm) / (high_cm - low_cm)));
  return all.reduced(column, reduction);
}

std::vector<double> vertical_depths(const GasPoints& points, std::span<const AirLevel> levels) {
  std::vector<double> depth(points.count(), 0.0);
  for (size_t i = 0; i + 1 < levels.size(); ++i)
    for (size_t g = 0; g < points.count(); ++g) {
      const double a = static_cast<double>(points.absorption[i * points.count() + g]),
                   b = static_cast<double>(points.absorption[(i + 1) * points.count() + g]);
      depth[g] += (levels[i + 1].height - levels[i].height) * mean_between(a, b);
    }
  return depth;
}

}  // namespace suite
