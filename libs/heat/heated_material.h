// What a material says of its heat: the balance of its faces, what conducts behind them, what lies at the back. Made
// from the temperature that scenes describe as `model: heat` (thermal/models/heat.cpp lists the keys).
#pragma once
#include <optional>

#include "heat/balance.h"
#include "thermal/slab_grid.h"
#include "thermal/temperature.h"

namespace suite {

struct HeatedMaterial {
  std::vector<SlabLayer> layers;  // from the front down; empty: no heat capacity, as leaves
  FaceTraits front, back;         // emissivities are the optics' own
  bool back_open = false;         // the back sees sky and surfaces
  BackCondition behind;
  double source = 0;  // W/m2 released at the front
  // Where the optics do not reach: of sunlight, and in the thermal infrared.
  std::optional<double> absorptance, emissivity;
};

// Error located at `where`: unknown laws and conditions, layers that slabs refuse, keys that exclude or ask for each
// other.
HeatedMaterial heated_material(const TemperatureSpec& spec, const Where& where = {});

}  // namespace suite
