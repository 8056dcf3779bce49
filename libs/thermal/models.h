// The table of temperature models: one row a model. Construction, error texts and the conformance tests come from it.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/registry.h"
#include "thermal/temperature.h"

namespace suite {

// The spec has been checked by make_temperature_model.
struct TemperatureRow : RegistryRow<std::unique_ptr<const TemperatureModel>(const TemperatureSpec& spec)> {
  std::vector<Parameter> parameters;  // numbers
  bool takes_table, takes_layers;
  // Specs the conformance tests run.
  std::vector<TemperatureSpec> (*examples)();
};

const Registry<TemperatureRow>& temperature_models();
// Every parameter known, present where required, in range; fills defaults. Error located at `where`.
void check_temperature(TemperatureSpec& spec, const Where& where = {});
// Checks a copy of the spec and makes the model. Error located at `where`.
std::unique_ptr<const TemperatureModel> make_temperature_model(const TemperatureSpec& spec, const Where& where = {});

// Power that a surface gets from below or of its own, W/m2, >= 0.
double inner_power(const TemperatureSpec& spec);
// Of the surface in the thermal infrared; 0.95 where the spec does not say.
double emissivity_of(const TemperatureSpec& spec);
// The highest temperature that the spec itself holds: numbers in kelvin, its table, and what inner_power() holds a
// surface at that loses it by radiation alone. Loads do not count. K; 0 = none.
double hottest_given(const TemperatureSpec& spec);

}  // namespace suite
