// .sqt: a fitted scattering function in one file (FORMAT.md). JSON header and payload compressed, checksum over both.
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/json.h"
#include "sqt/aligned.h"
#include "sqt/bundle.h"
#include "sqt/errors.h"
#include "sqt/paper.h"

namespace suite {

// Versions read. A file is written as the oldest that can say what it holds.
inline constexpr int kSqtOldest = 3, kSqtVersion = 4;

// Where a fit came from; all of it goes into the header.
struct SqtProvenance {
  std::string command;       // canonical command line
  std::string tool;          // "sqt-fit 0.1.0"
  std::string input;         // file name or model specification
  std::string input_sha256;  // of the input file, empty for models
  std::string conventions;   // of the input, one line
};

// A file image. errors: per channel and overall as Reference::measure returns them, or empty.
std::vector<std::byte> pack_sqt(const sqt::AlignedFit& fit, const SqtProvenance& provenance,
                                const std::vector<sqt::ErrorFigures>& errors);
std::vector<std::byte> pack_sqt(const sqt::PaperData& data, const SqtProvenance& provenance,
                                const std::vector<sqt::ErrorFigures>& errors);

// The error figures under their published keys, to six digits.
Json error_json(const sqt::ErrorFigures& e);

struct SqtFile {
  std::shared_ptr<const sqt::Bundle> bundle;
  std::string header;  // JSON text
  int version = 0;
  size_t bytes = 0;
};
// Errors: missing, not an SQT, a newer version, checksum mismatch, truncated, implausible sizes, inconsistent data.
SqtFile parse_sqt(std::span<const std::byte> bytes, const std::string& file_name);
SqtFile read_sqt(const std::string& path);

}  // namespace suite
