#include "input.h"

#include <cstring>

#include "base/files.h"
#include "formats/merl/merl.h"
#include "formats/rgl/rgl.h"
#include "optics/model_function.h"

namespace suite {

FitInput load_input(const SqtFitOptions& options) {
  FitInput input;
  input.provenance.command = command_line();
  input.provenance.tool = std::string("sqt-fit ") + kVersion;
  if (!options.model.empty()) {
    input.function = model_function(options.model);
    input.provenance.input = options.model;
  } else {
    const std::vector<std::byte> bytes = read_bytes(options.input);
    const bool tensor = bytes.size() >= 11 && std::memcmp(bytes.data(), "tensor_file", 11) == 0;
    if (tensor)
      input.function = parse_rgl(bytes, options.input);
    else
      input.function = parse_merl(bytes, options.input);
    input.provenance.input = options.input;
    input.provenance.input_sha256 = sha256(bytes);
  }
  input.provenance.conventions = input.function->info().source;
  return input;
}

}  // namespace suite
