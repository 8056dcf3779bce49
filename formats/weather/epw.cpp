// EnergyPlus weather. Based on: "Auxiliary Programs" of the EnergyPlus documentation, chapter "EnergyPlus Weather File
// (EPW) Data Dictionary" (fields, units, values that mean missing).
#include <algorithm>
#include <cmath>

#include "formats/weather/readers.h"

namespace suite {

namespace {

using Q = WeatherQuantity;

struct EpwField {
  Q quantity;
  size_t index;  // from 0
  const char* name;
  double missing;  // this and more
  double scale, offset;
};
constexpr EpwField kFields[] = {{Q::air_temperature, 6, "dry bulb temperature", 99.9, 1, kFreezing},
                                {Q::dew_point, 7, "dew point", 99.9, 1, kFreezing},
                                {Q::relative_humidity, 8, "relative humidity", 999, 0.01, 0},
                                {Q::pressure, 9, "pressure", 999999, 1, 0},
                                {Q::longwave_down, 12, "horizontal infrared", 9999, 1, 0},
                                {Q::global, 13, "global horizontal", 9999, 1, 0},
                                {Q::direct_normal, 14, "direct normal", 9999, 1, 0},
                                {Q::diffuse, 15, "diffuse horizontal", 9999, 1, 0},
                                {Q::wind_speed, 21, "wind speed", 999, 1, 0},
                                {Q::cloud_cover, 22, "total sky cover", 99, 0.1, 0},
                                {Q::opaque_cover, 23, "opaque sky cover", 99, 0.1, 0},
                                {Q::snow_depth, 30, "snow depth", 999, 0.01, 0}};
constexpr size_t kWindDirection = 20, kRain = 33, kRainHours = 34, kFewest = 24;

// What the lines above the data say.
struct EpwHead {
  double utc_offset = 0;  // s
  int rows_an_hour = 1;
};

void read_location(WeatherTable& table, EpwHead& head, const TextLines& lines) {
  table.site.latitude_deg = lines.number_in(6, "latitude", -90, 90);
  table.site.longitude_deg = lines.number_in(7, "longitude", -180, 180);
  head.utc_offset = 3600 * lines.number_in(8, "time zone", -12, 14);
  table.site.height_m = lines.number_in(9, "elevation", -1000, 9999.9);
}

EpwHead read_head(WeatherTable& table, TextLines& lines) {
  EpwHead head;
  while (lines.next_raw()) {
    split_at_commas(lines);
    const std::string_view name = field(lines, 0);
    if (name == "LOCATION") read_location(table, head, lines);
    if (name == "HOLIDAYS/DAYLIGHT SAVINGS" && lines.words() > 3 && (field(lines, 2) != "0" || field(lines, 3) != "0"))
      table.notes.push_back(
          "a period of daylight saving is named, which the file's times do not follow: it is not applied");
    if (name != "DATA PERIODS") continue;
    const long long periods = lines.integer(1, "number of data periods", 1, 100);
    if (periods > 1) table.notes.push_back(strf("%lld periods of data", periods));
    head.rows_an_hour = static_cast<int>(lines.integer(2, "rows an hour", 1, 60));
    return head;
  }
  throw lines.error_at_end("has no line of DATA PERIODS", "the rows of an EPW file follow it");
}

LocalStamp read_stamp(const TextLines& lines, const EpwHead& head) {
  LocalStamp s;
  s.year = static_cast<int>(lines.integer(0, "year", 0, 9999));
  s.month = static_cast<int>(lines.integer(1, "month", 1, 12));
  s.day = static_cast<int>(lines.integer(2, "day", 1, 31));
  if (!is_date(s, true)) throw lines.error(2, strf("month %d has no day %d", s.month, s.day));
  const double hour = static_cast<double>(lines.integer(3, "hour", 1, 24));
  const double minute = static_cast<double>(lines.integer(4, "minute", 0, 60));
  // Of hourly rows the minute says nothing: files have 0, 60 and even 30 there.
  if (head.rows_an_hour == 1) {
    s.seconds = 3600 * hour;
  } else {
    if (minute == 0) throw lines.error(4, "minute 0 in a file of several rows an hour", "rows end at minutes up to 60");
    s.seconds = 3600 * (hour - 1) + 60 * minute;
  }
  return s;
}

void read_values(WeatherRow& row, const TextLines& lines, size_t& without_infrared) {
  for (const EpwField& column : kFields) {
    if (column.index >= lines.words() && column.index >= kFewest) continue;  // files may end after the clouds
    const double v = lines.number(column.index, column.name);
    if (v >= column.missing) continue;
    // A sky of 0 K is how some converters say that they have none.
    if (column.quantity == Q::longwave_down && v == 0) {
      ++without_infrared;
      continue;
    }
    row.value(column.quantity) = column.scale * v + column.offset;
  }
  const double from = lines.number(kWindDirection, "wind direction");
  if (from < 999)
    row.value(Q::wind_from) = azimuth_from_compass_deg(lines.number_in(kWindDirection, "wind direction", 0, 360));
  if (lines.words() <= kRainHours) return;
  const double depth = lines.number(kRain, "liquid precipitation depth"), hours = lines.number(kRainHours, "its hours");
  if (depth < 999) put_precipitation(row, depth, hours);
}

}  // namespace

WeatherTable parse_epw(std::string_view text, const std::string& file, const WeatherOptions& options) {
  WeatherTable table = table_of_hours(file, options, "EPW");
  TextLines lines(text, file);
  const EpwHead head = read_head(table, lines);
  size_t without_infrared = 0;
  read_local_hours(table, lines, head.utc_offset, options.year, [&](WeatherRow& row) {
    const LocalStamp stamp = read_stamp(lines, head);
    read_values(row, lines, without_infrared);
    return stamp;
  });
  if (without_infrared)
    table.notes.push_back(strf("horizontal infrared of 0 is taken as missing in %zu rows", without_infrared));
  return table;
}

}  // namespace suite
