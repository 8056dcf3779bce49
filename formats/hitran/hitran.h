// Line lists as HITRAN gives them (.par, 160 columns), partition sums and the continuum of water as text. See
// FORMAT.md.
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "air/lines.h"

namespace suite {

// The gases of a list, each with its lines by ascending wavenumber; molecules that `Gas` does not have are left out.
// Error, located: a line shorter than 67 columns, a field that is no number or out of range, no line of a known gas.
std::vector<LineGas> read_hitran(const std::string& path);
std::vector<LineGas> parse_hitran(std::string_view text, const std::string& file_name);

// Partition sum over that at 296 K from rows of kelvin and sum; linear between, Error outside when asked for it.
std::function<double(double kelvin)> read_partition_sum(const std::string& path);
std::function<double(double kelvin)> parse_partition_sum(std::string_view text, const std::string& file_name);

// Error, located: other columns, wavenumbers that are not evenly spaced, negative coefficients.
WaterContinuum read_water_continuum(const std::string& path);
WaterContinuum parse_water_continuum(std::string_view text, const std::string& file_name);

}  // namespace suite
