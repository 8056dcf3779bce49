// Transmittance and thermal path radiance of builtin air along paths, to be held against other programs
// (tests/bench/air_paths): path_bench [CONTINUUM] reads lines "altitude range visibility" from standard input (km: of
// the sensor above sea level, along the ground to the target at sea level, of the rural aerosol) and prints, after a
// line with the path's number, a line "wavelength transmittance radiance" (um, 1, W/(m2 sr um)) every 0.01 um from 0.3
// to 14 um: means over 0.01 um in midlatitude summer, without the sun. CONTINUUM: of water, a file of MT_CKD in place
// of the builtin one.
#include <cmath>
#include <cstdio>
#include <memory>

#include "air/column.h"
#include "formats/hitran/hitran.h"
#include "light/stratified_air.h"

namespace {

using namespace suite;

SpectralState intervals() {
  constexpr double kLow = 0.295, kHigh = 14.005, kStep = 0.01;
  const std::vector<Band> all = {Band::rectangular("all", 0.5 * (kLow + kHigh), kHigh - kLow)};
  return make_state(all, kStep * (1 + 1e-9), 0, 1);
}

AirSpec air_of(double visibility_km, const std::shared_ptr<const GasProvider>& gases) {
  AirSpec air;
  air.profile = standard_profile("midlatitude_summer");
  air.gases = gases;
  air.scattering = AirScattering::single;
  air.aerosol = AirSpec::Aerosol{};
  air.aerosol->profile = AerosolProfile(1e3 * visibility_km);
  return air;
}

// Means over the intervals.
std::vector<double> means(const SpectralState& state, std::span<const float> values) {
  std::vector<double> sums;
  for (size_t i = 0; i < state.size(); ++i) {
    if (state.bins[i].g == 0) sums.push_back(0);
    sums.back() += state.bins[i].weight * double{values[i]};
  }
  return sums;
}

}  // namespace

int main(int count, char** words) {
  std::shared_ptr<const GasProvider> gases = shared_builtin_gases();
  if (count > 1) gases = builtin_gases(read_water_continuum(words[1]));
  double altitude = 0, range = 0, visibility = 0, made_for = 0;
  SpectralState state;
  std::unique_ptr<const Atmosphere> air;
  for (int number = 0; std::scanf("%lf %lf %lf", &altitude, &range, &visibility) == 3; ++number) {
    const AirSpec spec = air_of(visibility, gases);
    if (visibility != made_for) {
      state = with_gas_points(spec, intervals());
      air = make_stratified_air(spec, state, {});
      made_for = visibility;
    }
    const double angle = 1e3 * range / spec.radius;
    const Vec3 sensor{0, 0, 1e3 * altitude},
        target{spec.radius * std::sin(angle), 0, spec.radius * std::cos(angle) - spec.radius};
    const Vec3 way = target - sensor;
    std::vector<float> T(state.size()), S(state.size());
    air->path(sensor, normalized(way), length(way), T, S);
    const std::vector<double> t = means(state, T), s = means(state, S);
    std::printf("path %d\n", number);
    for (size_t i = 0; i < t.size(); ++i) std::printf("%.3f %.6g %.6g\n", 0.3 + 0.01 * double(i), t[i], s[i]);
  }
}
