// Water: light through its surface from a film to the deep sea, matter that hardly scatters back, waves in no depth.
#include <cmath>

#include "extreme/case.h"
#include "support/flat_water_kit.h"
#include "water/water.h"
#include "water/waves.h"

namespace suite::extreme {

namespace {

using namespace test;

// Radiance of the bed under a collimated sun, 0.35 from the zenith, off its closed form.
double off_bed(const FlatWater& w, double zenith, uint32_t paths = 4096) {
  const Seen r = see_bed(w, 0, zenith, paths);
  const double exact = bed_radiance(w, 0, zenith);
  return std::fabs(r.radiance[0] / exact - 1);
}

// The share of all directions that particles scatter into, by quadrature even in the logarithm of the angle's sine.
double off_one(double backscatter) {
  WaterSpec spec;
  spec.chlorophyll = 1;
  spec.backscatter = backscatter;
  const SpectralState state = make_state(std::vector<Band>{Band::rectangular("b", 0.55, 0.002)}, 1);
  const auto phase = bake_phase(water_medium(spec).phase, state);
  std::vector<float> density(state.size());
  double sum = 0;
  constexpr int n = 40000;
  const double low = std::log(1e-9), high = std::log(kPi);
  for (int i = 0; i < n; ++i) {
    const double a = std::exp(low + (high - low) * (i + 0.5) / n);
    phase->eval(std::cos(a), density);
    sum += 2 * kPi * std::sin(a) * a * density[0] * (high - low) / n;
  }
  return std::fabs(sum - 1);
}

// Long waves in little water: their speed is that of the depth alone.
double off_shallow(double depth) {
  SeaState sea;
  sea.depth_m = depth;
  const double k = 1e-4;  // rad/m
  return std::fabs(wave_frequency(sea, k) / (k * std::sqrt(9.80665 * depth)) - 1);
}

}  // namespace

std::vector<Case> water_cases() {
  using N = const Numerics&;
  return {
      {"water",
       "bed under flat water, the sun 30 deg from the zenith",
       "closed form",
       "1",
       0.005,
       [](N, double x) { return off_bed({.depth = x}, 30 * kDegree); },
       {"depth", "m", 1e-3, 1e5, 10},
       {}},
      {"water",
       "bed under what hardly refracts",
       "closed form",
       "1",
       0.005,
       [](N, double x) { return off_bed({.index = 1 + x}, 30 * kDegree); },
       {"index - 1", "1", 0.1, 1e-10, 10},
       {}},
      {"water",
       "bed under water that absorbs",
       "closed form",
       "1",
       0.005,
       [](N, double x) { return off_bed({.absorption = x}, 30 * kDegree); },
       {"absorption", "1/m", 0.1, 30, 2},
       {}},
      {"water",
       "bed under a low sun",
       "closed form",
       "1",
       0.005,
       [](N, double x) { return off_bed({}, (90 - x) * kDegree, 1 << 16); },
       {"elevation", "deg", 30, 1e-3, 10},
       {}},
      {"water",
       "particles that scatter back next to nothing",
       "closed form 1",
       "1",
       2e-3,
       [](N, double x) { return off_one(x); },
       {"share scattered back", "1", 0.02, 1e-3, 2},
       {}},
      {"water",
       "long waves in shallow water",
       "closed form, the root of g times depth",
       "1",
       1e-6,
       [](N, double x) { return off_shallow(x); },
       {"depth", "m", 10, 1e-6, 10},
       {}},
  };
}

}  // namespace suite::extreme
