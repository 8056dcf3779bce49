// Layers and faces of slabs, for tests.
#pragma once
#include <cmath>
#include <utility>
#include <vector>

#include "math/vec.h"
#include "thermal/slab.h"

namespace suite::test {

// Thickness, m; density, kg/m3; specific heat, J/(kg K); conductivity, W/(m K).
inline SlabLayer uniform(double thickness, double density, double specific_heat, double conductivity,
                         int intervals = 0) {
  SlabLayer l;
  l.thickness = thickness;
  l.density = density;
  l.specific_heat = {specific_heat};
  l.conductivity = {conductivity};
  l.intervals = intervals;
  return l;
}
inline SlabFace flux(double w_m2) {
  SlabFace f;
  f.value = [w_m2](double) { return w_m2; };
  return f;
}
inline SlabFace held(TimeFunction kelvin) {
  SlabFace f;
  f.kind = SlabFace::Kind::temperature;
  f.value = std::move(kelvin);
  return f;
}
inline SlabFace surface(double emissivity, Loads loads, double convection = 0) {
  SlabFace f;
  f.kind = SlabFace::Kind::surface;
  f.emissivity = emissivity;
  f.convection_still = convection;
  f.loads = std::move(loads);
  return f;
}

// Two metres of lunar regolith at the equator after P. O. Hayne et al., JGR Planets 122, 2017, table A1 and equations
// A2-A8: density and conductivity grow with depth, conductivity and specific heat depend on temperature.
inline std::vector<SlabLayer> lunar_regolith() {
  std::vector<SlabLayer> layers;
  const double H = 0.07, chi = 2.7 / std::pow(350.0, 3);
  double z = 0;
  for (double h = 0.001; z < 2; h *= 1.06) {
    const double fade = std::exp(-(z + h / 2) / H), k = 3.4e-3 - (3.4e-3 - 7.4e-4) * fade;
    SlabLayer l;
    l.thickness = h;
    l.density = 1800 - (1800 - 1100) * fade;
    l.specific_heat = {-3.6125, 2.7431, 2.3616e-3, -1.2340e-5, 8.9093e-9};
    l.conductivity = {k, 0, 0, k * chi};
    l.intervals = 1;
    layers.push_back(l);
    z += h;
  }
  return layers;
}

// W/m2 the regolith of the equator absorbs, t seconds after noon of a lunar day of `period`; the albedo grows with the
// incidence angle (S. J. Keihm, Icarus 60, 1984).
inline double lunar_sun(double t, double period) {
  const double cosine = std::cos(2 * kPi * t / period);
  if (cosine <= 0) return 0;
  const double angle = std::acos(cosine);
  return 1361 * (1 - 0.12 - 0.06 * std::pow(angle / (kPi / 4), 3) - 0.25 * std::pow(angle / (kPi / 2), 8)) * cosine;
}

}  // namespace suite::test
