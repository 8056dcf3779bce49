// The table of scattering models: one row a model. Construction, error texts, --list-models and the conformance tests
// all come from this table.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/registry.h"
#include "optics/model_spec.h"
#include "optics/scatter_model.h"
#include "spectral/state.h"

namespace suite {

// make bakes for a state; the spec has been checked by check_model. Error when curves do not cover the state.
struct ModelRow : RegistryRow<std::unique_ptr<const ScatterModel>(const ModelSpec& spec, const SpectralState& state)> {
  std::vector<Parameter> parameters;
  bool reciprocal;  // claims f(out, in) = f(in, out)
  // Specs that the conformance tests run, chosen to reach the corners of the parameter space. Data that a text names
  // are the tests' to supply.
  std::vector<ModelSpec> (*examples)();
};

const Registry<ModelRow>& models();
// Every parameter known, present where required, in range; fills defaults. Error located at `where` otherwise.
void check_model(ModelSpec& spec, const Where& where = {});
// The same for any list of parameters; `what` names the kind in messages ("model", "phase function").
void check_parameters(ModelSpec& spec, std::span<const Parameter> parameters, const char* what,
                      const Where& where = {});
std::unique_ptr<const ScatterModel> bake(const ModelSpec& spec, const SpectralState& state);

}  // namespace suite
