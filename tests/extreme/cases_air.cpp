// Air: clouds that light hardly leaves, air that hardly is, cores of lines, ranges from a millimetre to beyond the
// Moon, a Sun below the horizon.
#include <cmath>
#include <limits>

#include "air/discrete_ordinates.h"
#include "extreme/case.h"
#include "light/stratified_air.h"
#include "spectral/planck.h"
#include "tests/support/bent_rays.h"
#include "tests/support/phase_moments.h"

namespace suite::extreme {

namespace {

using namespace suite::test;

DiscreteOrdinates solve(const DiffuseLayer& layer, double sun, int streams) {
  DiffuseProblem problem;
  problem.layers = std::span(&layer, 1);
  problem.beam.irradiance = 1;
  problem.beam.cosine = sun;
  DiscreteOrdinates solver(streams);
  solver.solve(problem);
  return solver;
}

// Light through a cloud of water drops (g = 0.85, albedo 1 - 1e-6), beside a lossless one: the diffusion limit
// k L / sinh(k L), L = depth + 2 q / (1 - g), k^2 = 3 (1 - albedo) (1 - g).
double through_cloud(double depth) {
  constexpr double g = 0.85, loss = 1e-6;
  const std::vector<double> chi = henyey_greenstein(g, 129);
  const auto through = [&](double albedo) {
    return solve({.depth = depth, .albedo = albedo, .moments = chi}, 1, 16).black_irradiance();
  };
  const double k = std::sqrt(3 * loss * (1 - g)), whole = k * (depth + 2 * 0.7104 / (1 - g));
  return std::fabs(through(1 - loss) / through(1) / (whole / std::sinh(whole)) - 1);
}
// What it sends back, by 16 streams beside 64.
double from_cloud(double depth) {
  const std::vector<double> chi = henyey_greenstein(0.85, 129);
  const DiffuseLayer layer{.depth = depth, .albedo = 1 - 1e-6, .moments = chi};
  return std::fabs(solve(layer, 0.3, 16).fluxes({0, 0}).up / solve(layer, 0.3, 64).fluxes({0, 0}).up - 1);
}
// Half of what air of little depth scatters goes up.
double from_thin_air(double depth) {
  const std::vector<double> chi = rayleigh_moments();
  const DiffuseLayer layer{.depth = depth, .albedo = 0.8, .moments = chi};
  return std::fabs(solve(layer, 0.5, 16).fluxes({0, 0}).up / (0.4 * depth) - 1);
}

SpectralState bin_at(double um, double width_um) {
  return make_state(std::vector<Band>{Band::rectangular("b", um, width_um)}, 1);
}
AirSpec standard_air(AirScattering scattering) {
  AirSpec air;
  air.profile = standard_profile("us_standard");
  air.scattering = scattering;
  return air;
}

// Molecules at 0.55 um, a Sun at 40 degrees. What a level way of so many metres near the ground sends back, beside what
// a metre does at its beginning (Atmosphere::beam), to first order.
double short_way(double metres) {
  const SpectralState state = bin_at(0.55, 0.01);
  const std::vector<float> sun(state.size(), 1000.0f);
  const auto air =
      make_stratified_air(standard_air(AirScattering::single), state, {{dir_from_angles(40 * kDegree, 0), sun.data()}});
  std::vector<float> T(state.size()), S(state.size()), scattered(state.size()), depth(state.size()),
      slope(state.size());
  const Vec3 from{0, 0, 100};
  const Dir d{0, 1, 0};
  air->path(from, d, metres, T, S);
  air->beam(0, air->shells().layer_of(100), from, d, {scattered, depth, slope});
  return std::fabs(S[0] / (scattered[0] * std::exp(-double{depth[0]}) * metres) - 1);
}
// The same air from so far, 85 degrees from the vertical, beside what is seen from 2000 km; light once and more often
// scattered.
double far_away(double metres) {
  const SpectralState state = bin_at(0.55, 0.01);
  const std::vector<float> sun(state.size(), 1000.0f);
  const auto air = make_stratified_air(standard_air(AirScattering::diffuse), state,
                                       {{dir_from_angles(40 * kDegree, 0), sun.data()}});
  const Dir d = -dir_from_angles(85 * kDegree, 1);
  std::vector<float> T(state.size()), S(state.size()), near_T(state.size()), near_S(state.size());
  air->path(d * -2e6, d, 2e6, near_T, near_S);
  air->path(d * -metres, d, metres, T, S);
  return std::max(std::fabs(S[0] / near_S[0] - 1), std::fabs(T[0] / near_T[0] - 1));
}

// The most opaque part of an interval in a band of carbon dioxide, straight up: kelvin off the air's around.
double core(double wavenumber) {
  AirSpec spec = standard_air(AirScattering::single);
  spec.gases = shared_builtin_gases();
  const double um = 1e4 / wavenumber;
  const SpectralState state = with_gas_points(spec, bin_at(um, 15e-4 * um * um));
  const auto air = make_stratified_air(spec, state, {});
  std::vector<float> T(state.size()), S(state.size());
  air->path({0, 0, 0}, {0, 0, 1}, std::numeric_limits<double>::infinity(), T, S);
  const Bin& b = state.bins.back();
  const double kelvin = spec.profile.at(0).temperature,
               planck = planck_band_radiance(b.low_um, b.high_um, kelvin) / (b.high_um - b.low_um);
  return std::fabs(brightness_temperature(um, S.back() / planck * planck_radiance(um, kelvin)) - kelvin);
}

// How deep a place 20 km high lies for the bent beam of a Sun at so many degrees from the zenith (0.55 um, molecules).
double low_sun(double zenith_deg) {
  AirSpec air = standard_air(AirScattering::single);
  air.refraction = true;
  const SpectralState state = bin_at(0.55, 0.01);
  const Bent rays = bent_of(air, state);
  const double lowest = rays.lowest(20e3, zenith_deg * kDegree);
  if (lowest < 0) return std::nan("");
  std::vector<float> depth(state.size());
  if (!bake_beam_table(air, bake_column(air, state)).depth(20e3, std::cos(zenith_deg * kDegree), depth))
    return std::nan("");
  return std::fabs(depth[0] / rays.along(lowest, 20e3, state.size()).depth[0] - 1);
}

}  // namespace

std::vector<Case> air_cases() {
  const auto row = [](const char* name, const char* reference, const char* unit, double bound, double (*error)(double),
                      Sweep sweep) {
    return Case{
        "air", name, reference, unit, bound, [error](const Numerics&, double x) { return error(x); }, std::move(sweep),
        {}};
  };
  return {
      row("light through a cloud, albedo 1 - 1e-6", "diffusion limit (van de Hulst 1980)", "1", 0.005, through_cloud,
          {"optical depth", "1", 1000, 4000, 2}),
      row("light back from a cloud, albedo 1 - 1e-6", "64 streams", "1", 0.005, from_cloud,
          {"optical depth", "1", 1000, 1e6, 10}),
      row("air that hardly scatters", "first order", "1", 1e-6, from_thin_air,
          {"optical depth", "1", 1e-9, 1e-30, 1e3}),
      row("a short way in air", "first order", "1", 1e-6, short_way, {"range", "m", 1e-3, 1e-6, 10}),
      row("slant air from far away", "from 2000 km", "1", 1e-6, far_away, {"range", "m", 1e9, 1e12, 10}),
      row("core of the band at 15 um", "temperature of the air around", "K", 0.1, core,
          {"wavenumber", "cm-1", 667.5, 667.5, 2}),
      row("core of the band at 4.3 um", "temperature of the air around", "K", 0.1, core,
          {"wavenumber", "cm-1", 2350, 2350, 2}),
      row("bent beam of a Sun below the horizon", "quadrature of n r sin(theta)", "1", 0.005, low_sun,
          {"zenith angle", "degrees", 92, 94, 1.005}),
  };
}

}  // namespace suite::extreme
