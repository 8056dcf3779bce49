// Layers and faces of slabs, for tests.
#pragma once
#include <utility>

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

}  // namespace suite::test
