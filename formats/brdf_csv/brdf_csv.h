// Scattering data as plain CSV, one value a row. See FORMAT.md.
#pragma once
#include <string>
#include <string_view>

#include "sqt_fit/samples.h"

namespace suite {

// Error with line and column: unknown columns, angles out of range, wavelengths that differ between direction pairs.
sqt::Samples read_brdf_csv(const std::string& path);
sqt::Samples parse_brdf_csv(std::string_view text, const std::string& file_name);

}  // namespace suite
