#include "air/spheres.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>

#include "air/phase_grid.h"
#include "base/error.h"
#include "base/parallel.h"

namespace suite {

namespace {

constexpr double kGreenOfSpheres = 0.55;  // um

std::complex<double> index_at(const SphereSpec& spheres, double w) {
  for (const Curve* of : {&spheres.n, &spheres.k})
    if (!of->covers(w, w))
      throw Error(strf("particles '%s': no index at %g um", spheres.name.c_str(), w), of->range_text());
  return {spheres.n.at(w), spheres.k.at(w)};
}

}  // namespace

ParticleOptics sphere_optics(const SphereSpec& spheres, std::span<const double> wavelengths) {
  if (!(spheres.density >= 0 && std::isfinite(spheres.density)))
    throw Error(strf("particles '%s': the density %g is negative", spheres.name.c_str(), spheres.density));
  std::vector<double> all(wavelengths.begin(), wavelengths.end());
  if (spheres.density == 0) all.push_back(kGreenOfSpheres);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::vector<std::complex<double>> index;
  for (const double w : all) index.push_back(index_at(spheres, w));
  std::vector<BulkOptics> made(all.size());
  parallel_for(0, all.size(), 1, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      made[i] = bulk_optics(spheres.sizes, index[i], all[i], stored_cosines(), 1e-3, BulkMatrices::all);
  });
  const auto number = [&](double w) {
    return static_cast<size_t>(std::lower_bound(all.begin(), all.end(), w) - all.begin());
  };
  // In microns squared of a particle, or square metres of a kilogram.
  const auto extinction = [&](const BulkOptics& bulk) {
    return spheres.density > 0 ? bulk.mass_extinction(spheres.density) : bulk.extinction_um2;
  };
  const double unit = spheres.density > 0 ? 1 : made[number(kGreenOfSpheres)].extinction_um2;
  ParticleOptics optics;
  std::vector<size_t> entries;
  for (const double w : wavelengths) {
    const BulkOptics& bulk = made[entries.emplace_back(number(w))];
    std::vector<double> logs(bulk.phase.size());
    std::transform(bulk.phase.begin(), bulk.phase.end(), logs.begin(), [](double p) { return std::log(p); });
    optics.add(extinction(bulk) / unit, bulk.albedo(), refined_phase(logs));
  }
  auto stored = std::make_shared<std::vector<std::vector<PlaneBlocks>>>();
  for (BulkOptics& bulk : made) stored->push_back(std::move(bulk.matrices));
  optics.know_matrices([stored, entries](size_t w) { return refined_matrices((*stored)[entries[w]]); });
  return optics;
}

}  // namespace suite
