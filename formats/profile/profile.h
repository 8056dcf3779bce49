// Profiles of the air that people bring: tables of named columns, and radiosonde ascents as the University of Wyoming
// prints them. See FORMAT.md.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "air/profile.h"

namespace suite {

struct ReadProfile {
  AirProfile profile;
  std::vector<std::string> notes;  // what was not in the file and where it comes from, one sentence each
};

// What the file does not give, and what lies above its highest level, is taken from `standard`. Error, located: no such
// columns or units, a row with too few or wrong numbers, heights out of order, a profile that is none (check_profile).
ReadProfile read_profile(const std::string& path, std::string_view standard = "us_standard");
ReadProfile parse_profile(std::string_view text, const std::string& file_name,
                          std::string_view standard = "us_standard");

}  // namespace suite
