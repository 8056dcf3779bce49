// Weather from files: EnergyPlus (.epw), TMY3 (CSV), NSRDB PSM3, days of SURFRAD, months of BSRN, DIRSIG's .wth, plain
// CSV with units. See FORMAT.md for the grammars and for what each means by its times and values.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "heat/weather.h"

namespace suite {

// What a file may leave open. Error when a value is given that the file says itself, or that its kind has no use for.
struct WeatherOptions {
  std::optional<Geodetic> site = {};      // .wth and CSV without one
  std::optional<double> utc_offset = {};  // s, local standard time minus UTC; .wth and CSV with time_local without one
  std::optional<Utc> date = {};           // .wth: local day of its first row; its time of day is not used
  std::optional<int> year = {};  // EPW and TMY3: the calendar year in which the rows are placed, whatever theirs
  LongwaveModel longwave = LongwaveModel::dilley_obrien;  // where the file has none
};

// The kind is told by the content, not by the name. Error, located: no known kind, no such number, date or time, times
// out of order, what libs/heat/weather_completion.h refuses, files above 256 MB and 600000 rows.
Weather read_weather(const std::string& path, const WeatherOptions& options = {});
Weather parse_weather(std::string_view text, const std::string& file_name, const WeatherOptions& options = {});

}  // namespace suite
