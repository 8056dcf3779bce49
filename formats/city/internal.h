// What the two readers share.
#pragma once
#include "formats/city/city.h"

namespace suite::city {

CityModel parse_json(std::string_view text, const std::string& file, const std::optional<std::string>& lod,
                     Report& report);
CityModel parse_gml(std::string_view text, const std::string& file, const std::optional<std::string>& lod,
                    Report& report);

// Puts a copy of a prototype's surface in place. corners: of all copies so far. False when these are more than the 2e7
// that a file may ask for: a few bytes each place as many as the prototype has.
bool place_copy(CityModel::Surface& surface, const Affine3& turn, Vec3 at, size_t& corners);

// Of several levels of detail the one that is taken: by the rule of read_city; nothing where none fits.
std::optional<double> chosen(const std::vector<double>& levels, const std::optional<std::string>& wanted);
// "2.2" as 2.2. Nothing where that is no level (0 to 9.9).
std::optional<double> level_of(std::string_view text);

}  // namespace suite::city
