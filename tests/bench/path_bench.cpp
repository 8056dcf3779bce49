// Transmittance and radiance of builtin air along paths, to be held against other programs (tests/bench/air_paths).
//
// path_bench [CONTINUUM] reads lines "altitude range visibility" from standard input (km: of the sensor above sea
// level, along the ground to the target at sea level, of the rural aerosol) and prints, after a line with the path's
// number, a line "wavelength transmittance radiance" (um, 1, W/(m2 sr um)) every 0.01 um from 0.3 to 14 um: means over
// 0.01 um in midlatitude summer, without the sun. CONTINUUM: of water, a file of MT_CKD in place of the builtin one.
// path_bench --sun prints "wavelength radiance all_round" from 0.4 to 0.7 um in place of that: of the sun at 50 degrees
// from the zenith on August 23rd, 90 degrees beside the line of sight, over a mixed forest; all_round with the light
// that is scattered more than once as it is in the mean over azimuths. path_bench --limits [CONTINUUM] prints the
// limits that the gases report, one a line: low, high (um); rms and largest error of transmittance, of brightness
// straight down and slanted (K); 0 = none.
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>

#include "air/column.h"
#include "formats/hitran/hitran.h"
#include "light/kinds/solar_spectrum.h"
#include "light/stratified_air.h"

namespace {

using namespace suite;

constexpr double kStep = 0.01;

SpectralState intervals(double low, double high) {
  const std::vector<Band> all = {Band::rectangular("all", 0.5 * (low + high), high - low + kStep)};
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

struct Sight {
  Vec3 from, way;
};
Sight sight(double radius, double altitude, double range) {
  const double angle = 1e3 * range / radius;
  const Vec3 from{0, 0, 1e3 * altitude}, target{radius * std::sin(angle), 0, radius * std::cos(angle) - radius};
  return {from, target - from};
}

using Columns = std::vector<std::vector<double>>;

// Prints what `along` gives for each line; `begin` is called where another visibility begins.
void each_path(double low, const std::function<void(double)>& begin,
               const std::function<Columns(double, double)>& along) {
  double altitude = 0, range = 0, visibility = 0, made_for = 0;
  for (int number = 0; std::scanf("%lf %lf %lf", &altitude, &range, &visibility) == 3; ++number) {
    if (visibility != made_for) begin(made_for = visibility);
    const Columns columns = along(altitude, range);
    std::printf("path %d\n", number);
    for (size_t i = 0; i < columns[0].size(); ++i) {
      std::printf("%.3f", low + kStep * double(i));
      for (const auto& column : columns) std::printf(" %.6g", column[i]);
      std::printf("\n");
    }
  }
}

void without_sun(const std::shared_ptr<const GasProvider>& gases) {
  SpectralState state;
  std::unique_ptr<const Atmosphere> air;
  double radius = 0;
  const auto begin = [&](double visibility) {
    const AirSpec spec = air_of(visibility, gases);
    state = with_gas_points(spec, intervals(0.3, 14));
    air = make_stratified_air(spec, state, {});
    radius = spec.radius;
  };
  each_path(0.3, begin, [&](double altitude, double range) {
    const Sight s = sight(radius, altitude, range);
    std::vector<float> T(state.size()), S(state.size());
    air->path(s.from, normalized(s.way), length(s.way), T, S);
    return Columns{means(state, T), means(state, S)};
  });
}

// One atmosphere for each azimuth of the sun, about the line of sight.
void with_sun(const std::shared_ptr<const GasProvider>& gases) {
  constexpr int kAzimuths = 12;
  constexpr double kZenith = 50 * kDegree, kDistance = 1.0110;  // AU, on August 23rd
  SpectralState state;
  std::vector<float> irradiance;
  std::unique_ptr<const Atmosphere> air;
  double radius = 0;
  const auto begin = [&](double visibility) {
    AirSpec spec = air_of(visibility, gases);
    spec.scattering = AirScattering::diffuse, spec.adjacency = false;
    // Mixed forest, as pybsm's atmosphere_README.txt lists it.
    spec.ground_albedo = Curve({0.2, 0.5, 0.7, 0.725}, {0.025, 0.036, 0.032, 0.097}, Outside::hold);
    spec.aerosol->boundary.relative_humidity = 0.76;  // of the profile at the ground
    state = with_gas_points(spec, intervals(0.4, 0.7));
    irradiance = state.sample(solar_irradiance());
    for (float& e : irradiance) e /= static_cast<float>(kDistance * kDistance);
    air = make_stratified_air(spec, state, {{dir_from_angles(kZenith, 0), irradiance.data()}});
    radius = spec.radius;
  };
  each_path(0.4, begin, [&](double altitude, double range) {
    const Sight s = sight(radius, altitude, range);
    std::vector<float> T(state.size()), thermal(state.size()), once(state.size()), more(state.size());
    const auto look = [&](double azimuth) {
      const Vec3 way{s.way.x * std::cos(azimuth), s.way.x * std::sin(azimuth), s.way.z};
      air->parts(s.from, normalized(way), length(way), {T, thermal, once, more});
    };
    std::vector<double> round(means(state, more).size());
    for (int k = 0; k < kAzimuths; ++k) {
      look(kPi * (k + 0.5) / kAzimuths);
      const std::vector<double> m = means(state, more);
      for (size_t i = 0; i < m.size(); ++i) round[i] += m[i] / kAzimuths;
    }
    look(0.5 * kPi);
    const std::vector<double> first = means(state, once), beside = means(state, more);
    Columns columns(2);
    for (size_t i = 0; i < first.size(); ++i)
      columns[0].push_back(first[i] + beside[i]), columns[1].push_back(first[i] + round[i]);
    return columns;
  });
}

void limits(const GasProvider& gases) {
  for (const GasLimit& l : gases.limits())
    std::printf("%g %g %g %g %g %g %g %g\n", l.low_um, l.high_um, l.transmittance.rms, l.transmittance.most,
                l.kelvin_down.rms, l.kelvin_down.most, l.kelvin_slanted.rms, l.kelvin_slanted.most);
}

}  // namespace

int main(int count, char** words) {
  std::vector<std::string> given(words + 1, words + count);
  const bool sun = !given.empty() && given[0] == "--sun", only_limits = !given.empty() && given[0] == "--limits";
  if (sun || only_limits) given.erase(given.begin());
  std::shared_ptr<const GasProvider> gases = shared_builtin_gases();
  if (!given.empty()) gases = builtin_gases(read_water_continuum(given[0]));
  if (only_limits)
    limits(*gases);
  else if (sun)
    with_sun(gases);
  else
    without_sun(gases);
}
