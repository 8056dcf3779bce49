// The rows of the table in models.cpp, one per file.
#pragma once
#include "thermal/models.h"

namespace suite {

TemperatureRow constant_temperature_row();
TemperatureRow tabulated_temperature_row();
TemperatureRow slab_temperature_row();
TemperatureRow heat_temperature_row();

}  // namespace suite
