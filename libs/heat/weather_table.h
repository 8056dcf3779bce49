// Weather as files give it: rows over time, one value a quantity, before anything is interpolated.
//
// Assumes: a row's stamp is the end of its interval; what each quantity means there (an instant at the stamp, or the
// mean over the interval) is said once a table. Missing values are NaN, never a number.
#pragma once
#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "motion/scene_frame.h"
#include "motion/time.h"

namespace suite {

enum class WeatherQuantity {
  air_temperature,    // K
  dew_point,          // K, over water
  relative_humidity,  // 0 to 1, over water
  pressure,           // Pa, of the station
  wind_speed,         // m/s
  wind_from,          // rad, azimuth (CONVENTIONS.md) of where the wind comes from; missing in a calm
  global,             // W/m2, shortwave from above on a level plane
  direct_normal,      // W/m2, of the sun on a plane that faces it
  diffuse,            // W/m2, of the sky on a level plane
  shortwave_up,       // W/m2, from below on a level plane
  longwave_down,      // W/m2
  longwave_up,        // W/m2
  precipitation,      // kg/(m2 s), which is mm/s of water
  cloud_cover,        // 0 to 1, of the sky
  opaque_cover,       // 0 to 1, of the sky by clouds that hide it
  snow_depth          // m
};
inline constexpr size_t kWeatherQuantities = 16;
inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

// Name, unit and the range outside of which a value is refused.
struct WeatherQuantityInfo {
  std::string_view name, unit;
  double low = 0, high = 0;
};
const WeatherQuantityInfo& weather_info(WeatherQuantity quantity);
inline WeatherQuantity weather_quantity(size_t i) { return static_cast<WeatherQuantity>(i); }

struct WeatherRow {
  WeatherRow() { values.fill(kMissing); }
  double end = 0;  // s of the table's clock: the stamp
  std::array<double, kWeatherQuantities> values;
  int line = 0;  // of the file
  double& value(WeatherQuantity q) { return values[static_cast<size_t>(q)]; }
  double value(WeatherQuantity q) const { return values[static_cast<size_t>(q)]; }
};

enum class WeatherMeaning { instant, mean };

struct WeatherTable {
  std::string file;
  Utc epoch;        // second 0: where the first row's interval begins
  Geodetic site;    // height: of the station
  double step = 0;  // s, what a row's interval lasts
  std::array<WeatherMeaning, kWeatherQuantities> meaning{};
  std::vector<WeatherRow> rows;    // stamps ascend; where more than a step lies between two, rows are missing
  std::vector<std::string> notes;  // what a user should know, one sentence each

  WeatherMeaning& meaning_of(WeatherQuantity q) { return meaning[static_cast<size_t>(q)]; }
  WeatherMeaning meaning_of(WeatherQuantity q) const { return meaning[static_cast<size_t>(q)]; }
  // Whether the pressure is 0 in every row: a body without air. Its sun is not the Earth's.
  bool airless() const;
  // Where the interval of a row begins; that of the one before ends there when no row is missing between them.
  double begin(size_t row) const;
  Where where(size_t row) const { return {file, rows[row].line, 0, {}, -1}; }
};

// Two rows follow each other without a gap when they are at most this further apart than the step: a leap second.
inline constexpr double kStampSlack = 1.5;     // s
inline constexpr double kLongestStep = 86400;  // s, of a table

// Gives each row its end from instants (one a row), and the table its epoch and step (the median of what lies between
// stamps). Error, located: fewer than two rows, a stamp not after the one before, a median step of more than a day,
// within some days of the ends of 1972 to 2199.
void set_stamps(WeatherTable& table, const std::vector<Instant>& ends);

// Radiation and precipitation are means, the rest are instants: what most files mean.
std::array<WeatherMeaning, kWeatherQuantities> usual_meanings();

}  // namespace suite
