#include "extreme/numerics.h"

#include <cmath>

#include "math/warps.h"
#include "spectral/planck.h"
#include "transport/pipeline.h"

namespace suite::extreme {

namespace {

double gather(double value, uint64_t n) {
  Accumulators sums({1, 1, 4});
  double* sum = sums.sums(0, 0);
  for (uint64_t i = 0; i < n; ++i) *sum += value;
  return *sum / static_cast<double>(n);
}
double gather_in_float(double value, uint64_t n) {
  float sum = 0;
  for (uint64_t i = 0; i < n; ++i) sum += static_cast<float>(value);
  return static_cast<double>(sum) / static_cast<double>(n);
}
double naive_one_minus_cos(double angle) { return 1 - std::cos(angle); }
double planck_by_exp_minus_one(double wavelength_um, double kelvin) {
  const double m = wavelength_um * 1e-6;
  const double x = kPlanckConstant * kSpeedOfLight / (m * kBoltzmann * kelvin);
  return 2 * kPlanckConstant * kSpeedOfLight * kSpeedOfLight / (m * m * m * m * m) / (std::exp(x) - 1) * 1e-6;
}
double unclamped_acos(Dir a, Dir b) { return std::acos(dot(a, b)); }
Vec3 rebuilt(const Ray&, const Hit& hit) { return hit.position; }
// As a ray tracer in float hands it over: the distance is a float.
Vec3 along_the_ray(const Ray& ray, const Hit& hit) {
  return ray.origin + ray.direction * static_cast<double>(static_cast<float>(hit.distance));
}

std::vector<double> implicit_slab(const SlabSpec& spec, std::span<const double> kelvin, double dt, double report,
                                  double t_end) {
  Slab slab(spec, {0.01, 1800, 1e-9, 60});
  slab.start(0, kelvin);
  std::vector<double> surface;
  for (double t = report; t <= t_end * (1 + 1e-12); t += report) {
    for (long k = std::lround(report / dt); k > 0; --k)
      if (!slab.step(dt)) {
        surface.push_back(std::nan(""));
        return surface;
      }
    surface.push_back(slab.surface());
  }
  return surface;
}

// Forward Euler on the production solver's own nodes; constant properties only. Its limit is the film's time constant.
std::vector<double> explicit_slab(const SlabSpec& spec, std::span<const double> kelvin, double dt, double report,
                                  double t_end) {
  Slab grid(spec, {0.01, 1800, 1e-9, 60});
  grid.start(0, kelvin);
  std::vector<double> T(kelvin.begin(), kelvin.end()), gain(T.size());
  const std::vector<double> z(grid.depths().begin(), grid.depths().end());
  const std::vector<double> capacity(grid.heat_capacities().begin(), grid.heat_capacities().end());
  auto conductivity_at = [&](double depth) {
    double bottom = 0;
    for (const SlabLayer& l : spec.layers)
      if (depth < (bottom += l.thickness)) return l.conductivity[0];
    return spec.layers.back().conductivity[0];
  };
  std::vector<double> surface;
  double t = 0;
  for (double until = report; until <= t_end * (1 + 1e-12); until += report) {
    for (long k = std::lround(report / dt); k > 0; --k, t += dt) {
      const SurfaceLoad load = spec.top.loads(t);
      const double air = spec.top.convection_still + spec.top.convection_wind * load.wind;
      gain.assign(T.size(), 0.0);
      gain[0] = load.sun_absorbed + spec.top.emissivity * (load.sky_irradiance - kStefanBoltzmann * std::pow(T[0], 4)) +
                air * (load.air_temperature - T[0]);
      for (size_t i = 0; i + 1 < T.size(); ++i) {
        const double flux = conductivity_at(0.5 * (z[i] + z[i + 1])) * (T[i] - T[i + 1]) / (z[i + 1] - z[i]);
        gain[i] -= flux, gain[i + 1] += flux;
      }
      for (size_t i = 0; i < T.size(); ++i) T[i] += dt * gain[i] / capacity[i];
      if (!(std::fabs(T[0]) < 1e6)) {
        surface.push_back(std::nan(""));
        return surface;
      }
    }
    surface.push_back(T[0]);
  }
  return surface;
}

}  // namespace

Numerics production() {
  return {gather,          [](double a) { return one_minus_cos(a); },
          planck_radiance, [](Dir a, Dir b) { return angle_between(a, b); },
          rebuilt,         implicit_slab};
}

std::vector<Fault> faults() {
  std::vector<Fault> all;
  auto add = [&](const char* name) -> Numerics& {
    all.push_back({name, production()});
    return all.back().numerics;
  };
  add("float accumulator").mean_of_equal = gather_in_float;
  add("naive 1 - cos").one_minus_cos = naive_one_minus_cos;
  add("exp(x) - 1").planck = planck_by_exp_minus_one;
  add("unclamped acos").angle = unclamped_acos;
  add("hit point by o + t d").hit_point = along_the_ray;
  add("explicit steps beyond their limit").slab = explicit_slab;
  return all;
}

}  // namespace suite::extreme
