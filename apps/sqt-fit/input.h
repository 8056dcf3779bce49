// Where the function comes from.
#pragma once
#include <memory>

#include "formats/sqt/sqt.h"
#include "formats/sqt/sqt_write.h"
#include "options.h"
#include "sqt/function.h"
#include "sqt_fit/mueller_brdf.h"

namespace suite {

struct FitInput {
  std::shared_ptr<const sqt::Function> function;
  std::shared_ptr<const sqt::MuellerBrdf> mueller;  // where the input has matrices, too
  SqtProvenance provenance;
};
// Error: unknown kind of file (hint lists the known ones), or what the reader says.
FitInput load_input(const SqtFitOptions& options);

}  // namespace suite
