// Measured Mueller matrices of isotropic surfaces as a table of text (FORMAT.md).
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "sqt_fit/mueller_brdf.h"

namespace suite {

// Whether the first line of columns has one called m11.
bool is_mueller_csv(std::string_view text);

// Error: of a line, or of what the table leaves out.
std::shared_ptr<const sqt::MuellerBrdf> parse_mueller_csv(std::string_view text, const std::string& file_name);

}  // namespace suite
