#include "heat/absorbed_sunlight.h"

#include <array>

#include "base/parallel.h"

namespace suite {

namespace {

// Adds what is taken of the sky and from below at a moment, W/m2, by what a row takes and for its share of the moment.
// Light of patches in eights, which go at once.
void add_sky(const WeatherLoads& loads, double ground_albedo, size_t moment, const std::vector<float>& takes,
             float below, double share, double& sum) {
  if (!(share > 0 && loads.global[moment] > 0)) return;
  const float* sky = loads.sky[moment].data();
  std::array<float, 8> diffuse{};
  for (uint32_t p = 0; p < kSkyPatches; p += 8)
    for (uint32_t i = 0; i < 8; ++i) diffuse[i] += takes[p + i] * sky[p + i];
  for (const float v : diffuse) sum += share * double{v};
  sum += share * double{below} * ground_albedo * loads.global[moment] / kPi;
}

}  // namespace

void absorb(Sunlight& sun, const WeatherLoads& loads, double ground_albedo,
            const std::vector<std::vector<float>>& shares) {
  const size_t moments = loads.moments.size();
  parallel_for(0, sun.faces(), 64, [&](size_t begin, size_t end) {
    std::vector<float> row(moments), takes(kSkyPatches), later(moments);
    for (size_t f = begin; f < end; ++f) {
      sun.beam.get(f, row), sun.sky.get(f, takes);
      const bool more = sun.rows.has_more(f);
      std::vector<double> sum(moments);
      for (size_t k = 0; k < moments; ++k) {
        sum[k] = double{row[k]} * loads.direct[k];
        add_sky(loads, ground_albedo, k, takes, sun.below[f], more ? double{shares[0][k]} : 1, sum[k]);
      }
      for (size_t interval = 1; more && interval < sun.rows.intervals; ++interval) {
        const size_t at = sun.rows.row(f, interval);
        sun.beam.get(at, later), sun.sky.get(at, takes);
        for (size_t k = 0; k < moments; ++k) {
          sum[k] += double{later[k]} * loads.direct[k];
          add_sky(loads, ground_albedo, k, takes, sun.below[at], double{shares[interval][k]}, sum[k]);
        }
      }
      for (size_t k = 0; k < moments; ++k) row[k] = static_cast<float>(sum[k]);
      sun.beam.set(f, row);
    }
  });
  sun.beam.resize(sun.faces());
}

}  // namespace suite
