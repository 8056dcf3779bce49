// DIRSIG raw sample text (RAWBH10A, RAWBS10A): values of a BRDF or BSDF for listed view zeniths. See FORMAT.md.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "sqt_fit/samples.h"

namespace suite {

// Error with line and column: wrong magic, counts that do not fit the lines, directions that are not unit vectors.
sqt::Samples read_samples(const std::string& path);
sqt::Samples parse_samples(std::string_view text, const std::string& file_name);

// The text of `function` at outgoing zeniths (rad, ascending, below pi/2; azimuth 0) and incident unit vectors;
// RAWBS10A when its domain is the sphere. Values are those at the directions that a reader has. Error: not isotropic,
// or no BSDF.
std::string samples_text(const sqt::Function& function, std::span<const double> zenith, std::span<const Dir> in);

}  // namespace suite
