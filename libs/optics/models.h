// The table of scattering models: one row a model. Construction, error texts, --list-models and the conformance tests
// all come from this table.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "optics/model_spec.h"
#include "optics/scatter_model.h"
#include "spectral/state.h"

namespace suite {

struct ModelParameter {
  enum class Kind { number, curve, text };
  std::string name;  // "roughness"
  Kind kind;
  std::string unit;  // "1", "rad", "um"
  std::string summary;
  double low, high;  // valid range of numbers and of curve values
  bool required = true;
  double otherwise = 0;  // value when not required and not given
};

struct ModelRow {
  std::string name;     // "lambert"
  std::string summary;  // one line for --list-models, with author and year
  std::vector<ModelParameter> parameters;
  bool reciprocal;  // claims f(out, in) = f(in, out)
  // Bakes for a state. The spec has been checked by check_model. Error when curves do not cover the state.
  std::unique_ptr<const ScatterModel> (*make)(const ModelSpec& spec, const SpectralState& state);
  // Specs that the conformance tests run, chosen to reach the corners of the parameter space.
  std::vector<ModelSpec> (*examples)();
};

std::span<const ModelRow> models();
// Error with the nearest name when unknown.
const ModelRow& find_model(const std::string& name, const Where& where = {});
// Every parameter known, present where required, in range; fills defaults. Error located at `where` otherwise.
void check_model(ModelSpec& spec, const Where& where = {});
// The same for any list of parameters; `what` names the kind in messages ("model", "phase function").
void check_parameters(ModelSpec& spec, std::span<const ModelParameter> parameters, const char* what,
                      const Where& where = {});
std::unique_ptr<const ScatterModel> bake(const ModelSpec& spec, const SpectralState& state);

}  // namespace suite
