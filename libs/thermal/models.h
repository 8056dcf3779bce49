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

}  // namespace suite
