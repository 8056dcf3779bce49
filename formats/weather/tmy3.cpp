// Typical meteorological years of NREL. Based on: S. Wilcox & W. Marion, "Users manual for TMY3 data sets",
// NREL/TP-581-43156, 2008, tables 1-1 to 1-3.
#include <chrono>

#include "formats/weather/readers.h"

namespace suite {

namespace {

using Q = WeatherQuantity;

struct Column {
  Q quantity;
  const char* name;
  double scale, offset;
  size_t index = 0;
};
constexpr double kNone = -9900;
constexpr Column kColumns[] = {{Q::global, "GHI (W/m^2)", 1, 0},
                               {Q::direct_normal, "DNI (W/m^2)", 1, 0},
                               {Q::diffuse, "DHI (W/m^2)", 1, 0},
                               {Q::cloud_cover, "TotCld (tenths)", 0.1, 0},
                               {Q::opaque_cover, "OpqCld (tenths)", 0.1, 0},
                               {Q::air_temperature, "Dry-bulb (C)", 1, kFreezing},
                               {Q::dew_point, "Dew-point (C)", 1, kFreezing},
                               {Q::relative_humidity, "RHum (%)", 0.01, 0},
                               {Q::pressure, "Pressure (mbar)", 100, 0},
                               {Q::wind_speed, "Wspd (m/s)", 1, 0}};

size_t find(const TextLines& head, std::string_view name) {
  for (size_t i = 0; i < head.words(); ++i)
    if (head.word(i) == name) return i;
  throw head.error(0, "no column '" + std::string(name) + "'", "TMY3 files have it");
}

LocalStamp read_stamp(const TextLines& lines) {
  const auto part = [&](size_t word, size_t at, size_t length) {
    const std::string_view text = field(lines, word);
    int value = 0;
    for (size_t i = at; i < at + length; ++i) {
      if (i >= text.size() || text[i] < '0' || text[i] > '9')
        throw lines.error(word, "'" + std::string(text.substr(0, 20)) + "' is not a date and time",
                          "MM/DD/YYYY,HH:MM with hours 1 to 24");
      value = 10 * value + (text[i] - '0');
    }
    return value;
  };
  LocalStamp s;
  s.month = part(0, 0, 2), s.day = part(0, 3, 2), s.year = part(0, 6, 4);
  const int hour = part(1, 0, 2), minute = part(1, 3, 2);
  if (!is_date(s, true)) throw lines.error(0, strf("there is no day %d of month %d", s.day, s.month));
  s.seconds = 3600.0 * hour + 60.0 * minute;
  if (minute > 59 || s.seconds > 86400)
    throw lines.error(1, strf("there is no %02d:%02d", hour, minute), "up to 24:00");
  return s;
}

// Vendors write the end of a day as 00:00 of the next one (TMY3: 24:00). Rows that begin with a midnight are those of
// files that count hours from their beginning, and stay.
bool end_the_day_before(LocalStamp& s) {
  if (s.seconds != 0) return false;
  using namespace std::chrono;
  const year_month_day before{sys_days{year{s.year} / s.month / s.day} - days{1}};
  s.year = static_cast<int>(before.year());
  s.month = static_cast<int>(static_cast<unsigned>(before.month()));
  s.day = static_cast<int>(static_cast<unsigned>(before.day()));
  s.seconds = 86400;
  return true;
}

}  // namespace

WeatherTable parse_tmy3(std::string_view text, const std::string& file, const WeatherOptions& options) {
  WeatherTable table = table_of_hours(file, options, "TMY3");
  TextLines lines(text, file);
  lines.next_raw();
  split_at_commas(lines);
  const double utc_offset = 3600 * lines.number_in(3, "time zone", -12, 14);
  table.site = {lines.number_in(4, "latitude", -90, 90), lines.number_in(5, "longitude", -180, 180),
                lines.number_in(6, "elevation", -1000, 9999)};
  lines.next_raw();
  split_at_commas(lines);
  std::vector<Column> columns(std::begin(kColumns), std::end(kColumns));
  for (Column& column : columns) column.index = find(lines, column.name);
  const size_t direction = find(lines, "Wdir (degrees)"), rain = find(lines, "Lprecip depth (mm)"),
               rain_hours = find(lines, "Lprecip quantity (hr)");
  bool begins_at_midnight = false;
  size_t moved = 0;
  read_local_hours(table, lines, utc_offset, options.year, [&](WeatherRow& row) {
    LocalStamp stamp = read_stamp(lines);
    if (table.rows.size() == 1) begins_at_midnight = stamp.seconds == 0;
    if (!begins_at_midnight) moved += end_the_day_before(stamp);
    for (const Column& c : columns)
      if (const double v = lines.number(c.index, c.name); v > kNone) row.value(c.quantity) = c.scale * v + c.offset;
    if (lines.number(direction, "wind direction") > kNone)
      row.value(Q::wind_from) = azimuth_from_compass_deg(lines.number_in(direction, "wind direction", 0, 360));
    const double depth = lines.number(rain, "precipitation"), hours = lines.number(rain_hours, "its hours");
    if (depth > kNone) put_precipitation(row, depth, hours);
    return stamp;
  });
  if (moved) table.notes.push_back(strf("%zu rows at 00:00 are the ends of the days before (24:00 in TMY3)", moved));
  return table;
}

}  // namespace suite
