#include "input.h"

#include "base/files.h"
#include "formats/measured/measured.h"
#include "optics/model_function.h"
#include "sqt/scattered.h"

namespace suite {

FitInput load_input(const SqtFitOptions& options) {
  FitInput input;
  input.provenance.command = command_line();
  input.provenance.tool = std::string("sqt-fit ") + kVersion;
  if (!options.model.empty()) {
    input.function = model_function(options.model);
    input.provenance.input = options.model;
  } else {
    Measured measured = read_measured(options.input);
    if (auto* function = std::get_if<0>(&measured))
      input.function = std::move(*function);
    else
      input.function = sqt::interpolate(std::get<1>(measured));
    input.provenance.input = options.input;
    input.provenance.input_sha256 = sha256(read_bytes(options.input));
  }
  input.provenance.conventions = input.function->info().source;
  return input;
}

}  // namespace suite
