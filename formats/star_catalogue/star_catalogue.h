// Star catalogues of the user, as CSV. See FORMAT.md.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "light/night/stars.h"

namespace suite {

inline constexpr size_t kMostStars = 5'000'000;

// The stars of a table in the order of its rows, moved to the epoch 2000.0. Error with file and line otherwise.
std::vector<CatalogueStar> read_star_catalogue(const std::string& path);
std::vector<CatalogueStar> parse_star_catalogue(std::string_view text, const std::string& file);

// B-V of main-sequence stars of a spectral type ("G2V", "K1.5III", "M"): class O to M and a subclass of 0 to 9.9,
// linear between the nodes of the table, constant beyond; the luminosity class is not read. Nothing when `type` does
// not begin so. Based on: A. N. Cox (ed.), "Allen's Astrophysical Quantities", 4th ed. 2000, table 15.7.
std::optional<double> colour_of_type(std::string_view type);

}  // namespace suite
