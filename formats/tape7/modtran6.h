// The JSON that MODTRAN 6 writes, read into the same runs; the grammar is in FORMAT.md. The
// keys are those of public readers; untested on real output.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "formats/tape7/tape7.h"

namespace suite {

// All cases of a file or text, in its order. Error, located: malformed JSON, a case without output, several lines of
// sight in one, no wavenumbers, columns of different lengths, what is no number.
std::vector<Tape7Block> read_modtran6(const std::string& path);
std::vector<Tape7Block> parse_modtran6(std::string_view json, const std::string& file_name);

}  // namespace suite
