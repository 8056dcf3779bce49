// Writing .sqt files (FORMAT.md): what a fit gave, with where it came from and how well it fits.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "base/json.h"
#include "sqt_fit/aligned_fit.h"
#include "sqt_fit/errors.h"
#include "sqt_fit/mueller_fit.h"
#include "sqt_fit/paper_fit.h"

namespace suite {

// Where a fit came from; all of it goes into the header.
struct SqtProvenance {
  std::string command;              // canonical command line
  std::string tool;                 // "sqt-fit 0.9.0"
  std::string input;                // file name or model specification
  std::string input_sha256;         // of the input file, empty for models
  std::string conventions;          // of the input, one line
  sqt::MuellerErrors mueller = {};  // of its matrices, where the fit has some
};

// A file image. errors: per channel and overall as Reference::measure returns them, or empty.
std::vector<std::byte> pack_sqt(const sqt::AlignedFit& fit, const SqtProvenance& provenance,
                                const std::vector<sqt::ErrorFigures>& errors);
std::vector<std::byte> pack_sqt(const sqt::PaperData& data, const SqtProvenance& provenance,
                                const std::vector<sqt::ErrorFigures>& errors);

// The error figures under their published keys, to six digits.
Json error_json(const sqt::ErrorFigures& e);
Json mueller_error_json(const sqt::MuellerErrors& e);

}  // namespace suite
