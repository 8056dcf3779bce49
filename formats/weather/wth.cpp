// Weather of THERM and DIRSIG (.wth). Based on: the page "Weather history files" of DIRSIG's documentation, which
// leaves some columns and units open; FORMAT.md says what is assumed.
#include <cmath>

#include "formats/weather/readers.h"

namespace suite {

namespace {

using Q = WeatherQuantity;

constexpr double kLangleyAnHour = 41840.0 / 3600;  // W/m2
constexpr size_t kWthColumns = 13;

void read_row(WeatherRow& row, const TextLines& lines) {
  if (lines.words() != kWthColumns)
    throw lines.error(0, strf("a row of %zu values", lines.words()), strf("%zu stand in one", kWthColumns));
  row.value(Q::air_temperature) = lines.number(1, "air temperature") + kFreezing;
  row.value(Q::pressure) = 100 * lines.number(2, "pressure");
  row.value(Q::relative_humidity) = lines.number(3, "relative humidity");
  row.value(Q::dew_point) = lines.number(4, "dew point") + kFreezing;
  row.value(Q::wind_speed) = lines.number(5, "wind speed");
  const double direct = kLangleyAnHour * lines.number(6, "direct insolation");
  row.value(Q::diffuse) = kLangleyAnHour * lines.number(7, "diffuse insolation");
  row.value(Q::global) = direct + row.value(Q::diffuse);
  for (size_t i = 8; i < kWthColumns; ++i) lines.number(i, "value");
}

}  // namespace

WeatherTable parse_wth(std::string_view text, const std::string& file, const WeatherOptions& options) {
  refuse_options(options, {.site = true, .utc_offset = true, .date = true}, file, "a .wth file");
  if (!options.site || !options.utc_offset || !options.date)
    throw Error(Where{file, 1, 0, {}, -1}, "a .wth file names neither place, nor time zone, nor date",
                "give site, UTC offset and the day of the first row");
  const LocalStamp first{options.date->year, options.date->month, options.date->day, 0};
  if (!is_date(first))
    throw Error(Where{file, 1, 0, {}, -1}, strf("there is no %d-%02d-%02d", first.year, first.month, first.day));
  WeatherTable table;
  table.file = file;
  table.site = *options.site;
  TextLines lines(text, file);
  lines.next_raw();
  const long long rows = lines.integer(0, "number of rows", 2, kMostWeatherRows);
  const double step = 3600 * lines.number_in(1, "hours between rows", 1.0 / 3600, 24);
  std::vector<Instant> ends;
  const Instant midnight = instant_of(first, *options.utc_offset);
  while (lines.next_raw()) {
    split_at_blanks_and_signs(lines);
    if (lines.words() == 0) continue;
    WeatherRow& row = add_row(table, lines);
    read_row(row, lines);
    // Hours have two digits, so that a third of an hour is not exact.
    const double seconds = step * static_cast<double>(ends.size());
    if (std::abs(lines.number(0, "hour") * 3600 - seconds) > 36)
      throw lines.error(0, strf("hour %g where %g is due", lines.number(0, "hour"), seconds / 3600),
                        "rows are evenly spaced");
    ends.push_back(midnight + seconds);
  }
  if (static_cast<long long>(table.rows.size()) != rows)
    throw lines.error_at_end(strf("has %zu rows, its first line says %lld", table.rows.size(), rows));
  set_stamps(table, ends);
  table.notes.push_back(standard_time_note(*options.utc_offset) + ", values of the stamp");
  table.notes.push_back(
      "direct insolation is taken as that on a level plane, in Langley an hour (11.62 W/m2), as diffuse is");
  table.notes.push_back("sky exposure, cloud type and precipitation are not read: their meaning is not documented");
  return table;
}

}  // namespace suite
