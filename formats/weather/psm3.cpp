// Years of the National Solar Radiation Database, Physical Solar Model version 3, as its download service writes them.
// Based on: M. Sengupta and others, "The National Solar Radiation Data Base (NSRDB)", Renewable and Sustainable Energy
// Reviews 89, 2018; the names of columns and their units stand in the file's own first two lines.
#include "formats/weather/readers.h"

namespace suite {

namespace {

using Q = WeatherQuantity;

struct Psm3Column {
  Q quantity;
  const char* name;
  double scale, offset, low, high;  // what may stand there
};
constexpr Psm3Column kPsm3Columns[] = {{Q::global, "GHI", 1, 0, 0, 2000},
                                       {Q::direct_normal, "DNI", 1, 0, 0, 2000},
                                       {Q::diffuse, "DHI", 1, 0, 0, 2000},
                                       {Q::air_temperature, "Temperature", 1, kFreezing, -100, 100},
                                       {Q::dew_point, "Dew Point", 1, kFreezing, -150, 100},
                                       {Q::relative_humidity, "Relative Humidity", 0.01, 0, 0, 110},
                                       {Q::pressure, "Pressure", 100, 0, 200, 1200},
                                       {Q::wind_speed, "Wind Speed", 1, 0, 0, 150}};

size_t psm3_find(const TextLines& head, std::string_view name) {
  for (size_t i = 0; i < head.words(); ++i)
    if (head.word(i) == name) return i;
  return head.words();
}

size_t need(const TextLines& head, std::string_view name) {
  const size_t at = psm3_find(head, name);
  if (at == head.words()) throw head.error(0, "no column '" + std::string(name) + "'", "files of NSRDB PSM3 have it");
  return at;
}

}  // namespace

WeatherTable parse_psm3(std::string_view text, const std::string& file, const WeatherOptions& options) {
  WeatherTable table = table_of_hours(file, options, "NSRDB PSM3");
  table.meaning.fill(WeatherMeaning::instant);
  TextLines lines(text, file);
  lines.next_raw();
  split_at_commas(lines);
  const size_t latitude = need(lines, "Latitude"), longitude = need(lines, "Longitude"),
               zone = need(lines, "Time Zone"), height = need(lines, "Elevation");
  if (!lines.next_raw()) throw lines.error_at_end("ends before its second line");
  split_at_commas(lines);
  table.site = {lines.number_in(latitude, "latitude", -90, 90), lines.number_in(longitude, "longitude", -180, 180),
                lines.number_in(height, "elevation", -1000, 9999)};
  const double utc_offset = 3600 * lines.number_in(zone, "time zone", -12, 14);
  if (!lines.next_raw()) throw lines.error_at_end("ends before the names of its columns");
  split_at_commas(lines);
  const size_t stamp[] = {need(lines, "Year"), need(lines, "Month"), need(lines, "Day"), need(lines, "Hour"),
                          need(lines, "Minute")};
  std::vector<std::pair<const Psm3Column*, size_t>> columns;
  for (const Psm3Column& c : kPsm3Columns)
    if (const size_t at = psm3_find(lines, c.name); at < lines.words()) columns.push_back({&c, at});
  const size_t direction = psm3_find(lines, "Wind Direction"), names = lines.words();
  table.notes.push_back(strf("times are UTC%+g h; values are those of the stamp", utc_offset / 3600));
  std::vector<LocalStamp> stamps;
  while (lines.next_raw()) {
    split_at_commas(lines);
    if (no_fields(lines)) continue;
    if (lines.words() > names) throw lines.error(names, strf("%zu values in %zu columns", lines.words(), names));
    WeatherRow& row = add_row(table, lines);
    LocalStamp& s = stamps.emplace_back();
    s.year = static_cast<int>(lines.integer(stamp[0], "year", 1973, 2198));
    s.month = static_cast<int>(lines.integer(stamp[1], "month", 1, 12));
    s.day = static_cast<int>(lines.integer(stamp[2], "day", 1, 31));
    if (!is_date(s, true)) throw lines.error(stamp[2], strf("there is no day %d of month %d", s.day, s.month));
    s.seconds = 3600.0 * static_cast<double>(lines.integer(stamp[3], "hour", 0, 23)) +
                60.0 * static_cast<double>(lines.integer(stamp[4], "minute", 0, 59));
    for (const auto& [c, at] : columns)
      if (const std::string_view f = field(lines, at); !f.empty() && !f.starts_with("-99"))
        row.value(c->quantity) = c->scale * lines.number_in(at, c->name, c->low, c->high) + c->offset;
    if (const std::string_view f = field(lines, direction); direction < names && !f.empty() && !f.starts_with("-99"))
      row.value(Q::wind_from) = azimuth_from_compass_deg(lines.number_in(direction, "wind direction", 0, 360));
  }
  place_rows(table, std::move(stamps), utc_offset, options.year);
  return table;
}

}  // namespace suite
