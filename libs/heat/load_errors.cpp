// What paths of sunlight and points of elements are off by, as loads.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/memory.h"
#include "base/parallel.h"
#include "heat/part_means.h"
#include "heat/path_errors.h"
#include "math/sampling.h"

namespace suite {

namespace {

// By part, W/m2 or W/(m2 sr): the beam, the ground beyond the scene.
struct WeatherParts {
  std::vector<double> direct, below;
  WeatherParts(const WeatherLoads& w, double ground_albedo) {
    const PartMeans parts(w.moments.size());
    direct = parts.means([&](size_t k) { return w.direct[k]; });
    below = parts.means([&](size_t k) { return ground_albedo * w.global[k] / kPi; });
  }
};

// The sky of each part as shapes (sky_shapes) by least squares, and what is left, W/(m2 sr).
struct SkyParts {
  std::vector<double> shapes;  // [shape][part]
  std::vector<double> left;    // [patch][part]
  explicit SkyParts(const WeatherLoads& weather) : shapes(kSkyShapes * kHeatParts), left(kSkyPatches * kHeatParts) {
    const PartMeans parts(weather.moments.size());
    for (size_t patch = 0; patch < kSkyPatches; ++patch) {
      const std::vector<double> L = parts.means([&](size_t k) { return double{weather.sky[k][patch]}; });
      std::ranges::copy(L, &left[patch * kHeatParts]);
    }
    // One direction after the other, each made orthogonal to those before, as sums of the shapes.
    std::array<std::array<double, kSkyPatches>, kSkyShapes> q;
    std::array<std::array<double, kSkyShapes>, kSkyShapes> made{};
    for (size_t s = 0; s < kSkyShapes; ++s) {
      for (uint32_t patch = 0; patch < kSkyPatches; ++patch) q[s][patch] = double{sky_shapes(patch)[s]};
      made[s][s] = 1;
      for (size_t before = 0; before < s; ++before) take_off(q[s], made[s], q[before], made[before]);
      const double size = std::sqrt(std::inner_product(q[s].begin(), q[s].end(), q[s].begin(), 0.0));
      for (double& v : q[s]) v /= size;
      for (double& v : made[s]) v /= size;
      for (size_t p = 0; p < kHeatParts; ++p) {
        double along = 0;
        for (size_t patch = 0; patch < kSkyPatches; ++patch) along += q[s][patch] * left[patch * kHeatParts + p];
        for (size_t patch = 0; patch < kSkyPatches; ++patch) left[patch * kHeatParts + p] -= q[s][patch] * along;
        for (size_t k = 0; k < kSkyShapes; ++k) shapes[k * kHeatParts + p] += made[s][k] * along;
      }
    }
  }

 private:
  template <class Values, class Made>
  static void take_off(Values& from, Made& made, const Values& direction, const Made& made_direction) {
    const double along = std::inner_product(from.begin(), from.end(), direction.begin(), 0.0);
    for (size_t k = 0; k < from.size(); ++k) from[k] -= along * direction[k];
    for (size_t k = 0; k < made.size(); ++k) made[k] -= along * made_direction[k];
  }
};

// How much of each part of the span a row tells, of those that a face has.
class PartShares {
 public:
  PartShares(const PathRows& rows, const std::vector<std::vector<float>>& shares) : rows_(rows), all_(kHeatParts, 1.0) {
    if (rows.intervals == 1) return;
    const PartMeans parts(shares.front().size());
    for (const std::vector<float>& share : shares)
      of_interval_.push_back(parts.means([&](size_t k) { return double{share[k]}; }));
  }
  // put(row, share by part)
  template <class Put>
  void each(size_t face, const Put& put) const {
    if (!rows_.has_more(face)) return put(face, all_.data());
    for (size_t k = 0; k < rows_.intervals; ++k) put(rows_.row(face, k), of_interval_[k].data());
  }

 private:
  const PathRows& rows_;
  std::vector<double> all_;
  std::vector<std::vector<double>> of_interval_;
};

void for_faces(size_t faces, const std::function<void(size_t)>& body) {
  parallel_for(0, faces, 64, [&](size_t begin, size_t end) {
    for (size_t f = begin; f < end; ++f) body(f);
  });
}

}  // namespace

// Blocks are kept for skies of a few shapes; where the sky is brighter or darker than these, paths count by where they
// met it. Each of n paths brings y = pi a (L - shapes) with the probability w / (pi a) of the patch, w its weight: the
// variance of their mean is (sum w y - (sum w (L - shapes))^2) / n, as if paths were independent, which they are less
// than that.
std::vector<float> uneven_sky(const Sunlight& sun, const WeatherLoads& weather,
                              const std::vector<std::vector<float>>& shares, uint32_t paths) {
  const std::vector<double> uneven = SkyParts(weather).left;
  const PartShares of_parts(sun.rows, shares);
  std::vector<float> out(sun.faces() * kHeatParts);
  for_faces(sun.faces(), [&](size_t f) {
    const double most = kPi * double{sun.absorptance[f]};
    std::array<float, kSkyPatches> w;
    std::array<double, kHeatParts> square{}, mean{};
    of_parts.each(f, [&](size_t row, const double* share) {
      sun.sky.get(row, w);
      for (size_t k = 0; k < kSkyPatches; ++k) {
        if (w[k] == 0) continue;
        const double weight = double{w[k]};
        for (size_t p = 0; p < kHeatParts; ++p) {
          const double y = uneven[k * kHeatParts + p] * share[p];
          square[p] += most * weight * y * y, mean[p] += weight * y;
        }
      }
    });
    for (size_t p = 0; p < kHeatParts; ++p)
      out[f * kHeatParts + p] = static_cast<float>(std::sqrt(std::max(0.0, square[p] - mean[p] * mean[p]) / paths));
  });
  return out;
}

// Every block gets the deviation by an uneven sky with a random sign, the same through the day.
LoadErrors load_errors(Sunlight& sun, const std::vector<float>& uneven, const WeatherLoads& weather,
                       const std::vector<std::vector<float>>& shares, double ground_albedo) {
  const PartShares of_parts(sun.rows, shares);
  constexpr uint64_t kPurpose = 0x736b79;
  const WeatherParts by(weather, ground_albedo);
  const std::vector<double> shapes = SkyParts(weather).shapes;
  const double per_part = static_cast<double>(weather.moments.size() - 1) / kHeatParts;
  const size_t faces = sun.faces(), blocks = sun.blocks;
  LoadErrors out;
  out.of_block = CompactRows(faces * blocks, kHeatParts);
  for_faces(faces, [&](size_t f) {
    std::array<float, kHeatParts> row{};
    std::array<double, kHeatParts> brings{};
    for (size_t b = 0; b < blocks; ++b) {
      const size_t block = f * blocks + b;
      const bool plus = hash_of(kPurpose, f, b) & 1;
      brings.fill(0);
      of_parts.each(f, [&](size_t of_row, const double* share) {
        const size_t found = of_row * blocks + b;
        for (size_t p = 0; p < kHeatParts; ++p) {
          double sum = sun.beam_of_block.at(found, p) / per_part * by.direct[p] +
                       share[p] * double{sun.below_of_block[found]} * by.below[p];
          if (const double off = double{uneven[f * kHeatParts + p]}; of_row == f) sum += plus ? off : -off;
          for (size_t s = 0; s < kSkyShapes; ++s)
            sum += share[p] * sun.sky_of_block.at(found, s) * shapes[s * kHeatParts + p];
          brings[p] += sum;
        }
      });
      for (size_t p = 0; p < kHeatParts; ++p) row[p] = static_cast<float>(brings[p]);
      out.of_block.set(block, row);
    }
  });
  sun.beam_of_block = {}, sun.sky_of_block = {};
  give_up(sun.below_of_block);
  out.spread = CompactRows(faces * Sunlight::kContrasts, kHeatParts);
  for_faces(faces, [&](size_t f) {
    std::array<float, kHeatParts> row{};
    for (size_t c = f * Sunlight::kContrasts; c < (f + 1) * Sunlight::kContrasts; ++c) {
      for (size_t p = 0; p < kHeatParts; ++p)
        row[p] = static_cast<float>(sun.beam_spread.at(c, p) / per_part * by.direct[p]);
      out.spread.set(c, row);
    }
  });
  sun.beam_spread = {};
  return out;
}

}  // namespace suite
