// Every flux of an element's front through the span, from a result: what a probe tells.
#pragma once
#include "heat/heat_balance.h"

namespace suite {

// W/m2 at one moment; into the element = sunlight + infrared + source - emitted - to_air.
struct HeatFluxes {
  double kelvin = 0;  // K
  HeatErrors errors;
  double sunlight = 0, infrared = 0, emitted = 0, to_air = 0, source = 0;
  double into() const { return sunlight + infrared + source - emitted - to_air; }
};

// By moment.
std::vector<HeatFluxes> fluxes_of(const HeatResult& result, const Elements& elements, const HeatOptics& optics,
                                  const WeatherLoads& weather, uint32_t element);

// The element of the surface at a place (m, ENU): within 5 cm along an axis of ENU, the nearest such; where there is
// none, the element whose middle is nearest. time: s, at which things stand where they do.
uint32_t element_of(const Tracer& tracer, const Elements& elements, Vec3 place, double time);

}  // namespace suite
