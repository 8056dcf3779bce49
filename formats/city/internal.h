// What the two readers share.
#pragma once
#include "formats/city/city.h"

namespace suite::city {

CityModel parse_json(std::string_view text, const std::string& file, const std::optional<std::string>& lod,
                     Report& report);
CityModel parse_gml(std::string_view text, const std::string& file, const std::optional<std::string>& lod,
                    Report& report);

// Of several levels of detail the one that is taken: by the rule of read_city; nothing where none fits.
std::optional<double> chosen(const std::vector<double>& levels, const std::optional<std::string>& wanted);
// "2.2" as 2.2. Nothing where that is no level (0 to 9.9).
std::optional<double> level_of(std::string_view text);

}  // namespace suite::city
