#include "heat/heat_fluxes.h"

#include <algorithm>
#include <cmath>

#include "spectral/planck.h"
#include "surface/quick_look.h"

namespace suite {

namespace {

// Of the air's table, straight between its times.
double air_at(const AirSeries& air, const std::vector<double>& values, double t) {
  const auto after = std::upper_bound(air.times.begin(), air.times.end(), t);
  if (after == air.times.begin()) return values.front();
  if (after == air.times.end()) return values.back();
  const auto k = static_cast<size_t>(after - air.times.begin());
  return values[k - 1] + (values[k] - values[k - 1]) * (t - air.times[k - 1]) / (air.times[k] - air.times[k - 1]);
}

}  // namespace

std::vector<HeatFluxes> fluxes_of(const HeatResult& result, const Elements& elements, const HeatOptics& optics,
                                  const WeatherLoads& weather, uint32_t element) {
  const HeatedMaterial& material = optics.heated[elements[element].material];
  FaceTraits face = material.front;
  face.emissivity = double{result.emissivity[element]};
  face.cosine_up = std::clamp(elements[element].normal.z, -1.0, 1.0);
  std::vector<HeatFluxes> out;
  for (size_t k = 0; k < result.moments; ++k) {
    const double t = weather.moments[k];
    HeatFluxes f;
    f.kelvin = double{result.kelvin[element * result.moments + k]};
    f.errors = result.errors_at(element, t);
    f.sunlight = double{result.absorbed[element * result.moments + k]};
    f.infrared = face.emissivity * double{result.received[element * result.moments + k]};
    f.emitted = face.emissivity * kStefanBoltzmann * std::pow(f.kelvin, 4);
    FaceWeather w;
    w.air_kelvin = air_at(weather.air, weather.air.kelvin, t), w.wind = air_at(weather.air, weather.air.wind, t);
    w.vapour_pressure = air_at(weather.air, weather.air.vapour_pressure, t), w.pressure = weather.air.pressure;
    f.to_air = loss_to_air(face, w, f.kelvin);
    f.source = material.source;
    out.push_back(f);
  }
  return out;
}

uint32_t element_of(const Tracer& tracer, const Elements& elements, Vec3 place, double time) {
  constexpr double kNear = 0.05;
  std::vector<Ray> rays;
  for (const Dir d : {Dir{1, 0, 0}, Dir{0, 1, 0}, Dir{0, 0, 1}})
    for (const Dir along : {-d, d}) rays.push_back({place - along * kNear, along, time});
  std::vector<Hit> hits(rays.size());
  TraceStatistics statistics;
  tracer.nearest(rays, hits, false, statistics);
  std::optional<uint32_t> found;
  double least = kNear;
  for (const Hit& hit : hits) {
    if (!hit.hit()) continue;
    const double off = std::fabs(hit.distance - kNear);
    const uint32_t material = material_of(tracer, hit);
    if (off >= least || material == kNone) continue;
    if (const auto element = elements.at(hit, material)) found = element, least = off;
  }
  if (found) return *found;
  uint32_t best = 0;
  least = INFINITY;
  for (uint32_t e = 0; e < elements.size(); ++e)
    if (const double off = length(elements[e].centre - place); off < least) least = off, best = e;
  return best;
}

}  // namespace suite
