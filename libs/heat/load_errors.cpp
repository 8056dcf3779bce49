// What paths of sunlight and points of elements are off by, as loads.
#include <algorithm>
#include <cmath>

#include "base/memory.h"
#include "base/parallel.h"
#include "heat/part_means.h"
#include "heat/path_errors.h"
#include "math/sampling.h"

namespace suite {

namespace {

// By part, W/m2 or W/(m2 sr): the beam, an even sky, the ground beyond the scene.
struct WeatherParts {
  std::vector<double> direct, diffuse, below;
  WeatherParts(const WeatherLoads& w, double ground_albedo) {
    const PartMeans parts(w.moments.size());
    direct = parts.means([&](size_t k) { return w.direct[k]; });
    diffuse = parts.means([&](size_t k) { return w.diffuse[k] / kPi; });
    below = parts.means([&](size_t k) { return ground_albedo * w.global[k] / kPi; });
  }
};

void for_faces(size_t faces, const std::function<void(size_t)>& body) {
  parallel_for(0, faces, 64, [&](size_t begin, size_t end) {
    for (size_t f = begin; f < end; ++f) body(f);
  });
}

}  // namespace

// Blocks are kept for an even sky; where it is brighter or darker than that, paths count by where they met it. Each
// of n paths brings y = pi a (L - even) with the probability w / (pi a) of the patch, w its weight: the variance of
// their mean is (sum w y - (sum w (L - even))^2) / n, as if paths were independent, which they are less than that.
std::vector<float> uneven_sky(const Sunlight& sun, const WeatherLoads& weather, uint32_t paths) {
  const PartMeans parts(weather.moments.size());
  const std::vector<double> even = WeatherParts(weather, 0).diffuse;
  std::vector<double> uneven(kSkyPatches * kHeatParts);  // W/(m2 sr), [patch][part]
  for (size_t patch = 0; patch < kSkyPatches; ++patch) {
    const std::vector<double> L = parts.means([&](size_t k) { return double{weather.sky[k][patch]}; });
    for (size_t p = 0; p < kHeatParts; ++p) uneven[patch * kHeatParts + p] = L[p] - even[p];
  }
  std::vector<float> out(sun.faces() * kHeatParts);
  for_faces(sun.faces(), [&](size_t f) {
    const double most = kPi * double{sun.absorptance[f]};
    const float* w = &sun.sky[f * kSkyPatches];
    std::array<double, kHeatParts> square{}, mean{};
    for (size_t k = 0; k < kSkyPatches; ++k) {
      if (w[k] == 0) continue;
      const double weight = double{w[k]};
      for (size_t p = 0; p < kHeatParts; ++p) {
        const double y = uneven[k * kHeatParts + p];
        square[p] += most * weight * y * y, mean[p] += weight * y;
      }
    }
    for (size_t p = 0; p < kHeatParts; ++p)
      out[f * kHeatParts + p] = static_cast<float>(std::sqrt(std::max(0.0, square[p] - mean[p] * mean[p]) / paths));
  });
  return out;
}

// Every block gets the deviation by an uneven sky with a random sign, the same through the day.
LoadErrors load_errors(Sunlight& sun, const std::vector<float>& uneven, const WeatherLoads& weather,
                       double ground_albedo) {
  constexpr uint64_t kPurpose = 0x736b79;
  const WeatherParts by(weather, ground_albedo);
  const double per_part = static_cast<double>(weather.moments.size() - 1) / kHeatParts;
  const size_t faces = sun.faces(), blocks = sun.blocks;
  LoadErrors out;
  out.of_block = CompactRows(faces * blocks, kHeatParts);
  for_faces(faces, [&](size_t f) {
    std::vector<float> rows(blocks * kHeatParts);
    std::array<double, kHeatParts> mean{};
    for (size_t b = 0; b < blocks; ++b)
      for (size_t p = 0; p < kHeatParts; ++p) {
        const size_t block = f * blocks + b;
        const double off = double{uneven[f * kHeatParts + p]};
        const double brings = double{sun.beam_of_block[block * kHeatParts + p]} / per_part * by.direct[p] +
                              double{sun.diffuse_of_block[block]} * by.diffuse[p] +
                              double{sun.below_of_block[block]} * by.below[p] +
                              (hash_of(kPurpose, f, b) & 1 ? off : -off);
        rows[b * kHeatParts + p] = static_cast<float>(brings);
        mean[p] += brings / static_cast<double>(blocks);
      }
    for (size_t b = 0; b < blocks; ++b) {
      float* row = &rows[b * kHeatParts];
      for (size_t p = 0; p < kHeatParts; ++p) row[p] = static_cast<float>(double{row[p]} - mean[p]);
      out.of_block.set(f * blocks + b, {row, kHeatParts});
    }
  });
  give_up(sun.beam_of_block), give_up(sun.diffuse_of_block), give_up(sun.below_of_block);
  out.spread = CompactRows(faces * Sunlight::kContrasts, kHeatParts);
  for_faces(faces, [&](size_t f) {
    std::array<float, kHeatParts> row{};
    for (size_t c = f * Sunlight::kContrasts; c < (f + 1) * Sunlight::kContrasts; ++c) {
      for (size_t p = 0; p < kHeatParts; ++p)
        row[p] = static_cast<float>(double{sun.beam_spread[c * kHeatParts + p]} / per_part * by.direct[p]);
      out.spread.set(c, row);
    }
  });
  give_up(sun.beam_spread);
  return out;
}

}  // namespace suite
