// DIRSIG raw sample text (RAWBH10A, RAWBS10A): values of a BRDF or BSDF for listed view zeniths. See FORMAT.md.
#pragma once
#include <string>
#include <string_view>

#include "sqt_fit/samples.h"

namespace suite {

// Error with line and column: wrong magic, counts that do not fit the lines, directions that are not unit vectors.
sqt::Samples read_samples(const std::string& path);
sqt::Samples parse_samples(std::string_view text, const std::string& file_name);

}  // namespace suite
