// Cornell University measured spectral BRDFs (.brdf text). See FORMAT.md.
#pragma once
#include <string>
#include <string_view>

#include "sqt_fit/samples.h"

namespace suite {

// Error with line and column: missing head, wavelengths or values, angles out of range.
sqt::Samples read_cornell(const std::string& path);
sqt::Samples parse_cornell(std::string_view text, const std::string& file_name);

}  // namespace suite
