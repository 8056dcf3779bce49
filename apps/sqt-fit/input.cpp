#include "input.h"

#include "base/error.h"
#include "base/files.h"
#include "formats/measured/measured.h"
#include "optics/model_function.h"
#include "sqt/narrow_lobe.h"
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
  if (options.method == "aligned") {
    const sqt::NarrowLobe narrow =
        sqt::split_narrow_lobe(input.function, options.order ? static_cast<int>(options.order) : 10);
    if (narrow.rest) {
      input.function = narrow.rest;
      note(
          strf("a lobe narrower than the finest cell in the %s, up to %.3f of the total: stored as a Dirac lobe that "
               "stands for the %.2f deg (half vector) around it",
               narrow.where.c_str(), narrow.largest, narrow.core / kDegree));
    }
  }
  input.provenance.conventions = input.function->info().source;
  return input;
}

}  // namespace suite
