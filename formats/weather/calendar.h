// Rows with stamps in local standard time placed in UTC: typical years, leap days, hour 24.
#pragma once
#include <optional>
#include <vector>

#include "heat/weather_table.h"

namespace suite {

struct LocalStamp {
  int year = 0, month = 1, day = 1;
  double seconds = 0;  // of the day, to 86400
};

// Whether there is such a date; in any year where `any_year`.
bool is_date(const LocalStamp& stamp, bool any_year = false);

// The instant of a stamp of local standard time, `utc_offset` s ahead of UTC. The date exists. Error: outside of UTC
// here.
Instant instant_of(const LocalStamp& stamp, double utc_offset);

// Gives the rows their times, one stamp a row. Where the years of the rows are those of a typical year (months of
// different years in the order of one), or `year` is given, one year replaces them: `year`, else that of the first row,
// or the next one where that is a leap year and the rows have no 29 February. In a leap year a 29 February that the
// rows have not is that of 28 February; where a year is replaced by one without, it is left out. All of that is noted.
// Error, located: no such date, stamps out of order.
void place_rows(WeatherTable& table, std::vector<LocalStamp> stamps, double utc_offset, std::optional<int> year);

}  // namespace suite
