// The table of temperature models: one row a model. Construction, error texts and the conformance tests come from it.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "thermal/temperature.h"

namespace suite {

struct TemperatureParameter {
  std::string name;  // with its unit, e.g. "thickness_m"
  std::string summary;
  double low, high;  // valid range, both ends included
  bool required = true;
  double otherwise = 0;  // value when not required and not given; NaN = stays absent
};

struct TemperatureRow {
  std::string name;     // "slab"
  std::string summary;  // one line for listings
  std::vector<TemperatureParameter> parameters;
  bool takes_table, takes_layers;
  // The spec has been checked by make_temperature_model.
  std::unique_ptr<const TemperatureModel> (*make)(const TemperatureSpec& spec);
  // Specs the conformance tests run.
  std::vector<TemperatureSpec> (*examples)();
};

std::span<const TemperatureRow> temperature_models();
// Error with the nearest name when unknown.
const TemperatureRow& find_temperature_model(const std::string& name, const Where& where = {});
// Every parameter known, present where required, in range; fills defaults. Error located at `where`.
void check_temperature(TemperatureSpec& spec, const Where& where = {});
// Checks a copy of the spec and makes the model. Error located at `where`.
std::unique_ptr<const TemperatureModel> make_temperature_model(const TemperatureSpec& spec, const Where& where = {});

}  // namespace suite
