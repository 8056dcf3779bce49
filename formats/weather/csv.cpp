// Weather as plain text with units: the grammar is ours, in FORMAT.md.
#include <cmath>
#include <optional>

#include "formats/weather/calendar.h"
#include "formats/weather/fields.h"
#include "formats/weather/readers.h"

namespace suite {

namespace {

using Q = WeatherQuantity;

struct Unit {
  std::string_view of;  // the unit of the quantity, as weather_info has it
  std::string_view name;
  double scale, offset;
};
constexpr Unit kUnits[] = {{"K", "K", 1, 0},
                           {"K", "C", 1, kFreezing},
                           {"1", "1", 1, 0},
                           {"1", "%", 0.01, 0},
                           {"1", "tenths", 0.1, 0},
                           {"1", "oktas", 0.125, 0},
                           {"Pa", "Pa", 1, 0},
                           {"Pa", "hPa", 100, 0},
                           {"Pa", "mbar", 100, 0},
                           {"Pa", "kPa", 1000, 0},
                           {"m/s", "m/s", 1, 0},
                           {"m/s", "km/h", 1 / 3.6, 0},
                           {"m/s", "knot", 1852.0 / 3600, 0},
                           {"rad", "deg", -kDegree, kPi / 2},  // azimuth_from_compass_deg
                           {"W/m2", "W/m2", 1, 0},
                           {"kg/(m2 s)", "kg/(m2 s)", 1, 0},
                           {"kg/(m2 s)", "mm/h", 1.0 / 3600, 0},
                           {"m", "m", 1, 0},
                           {"m", "cm", 0.01, 0},
                           {"m", "mm", 0.001, 0}};

struct CsvColumn {
  Q quantity = Q::air_temperature;
  double scale = 1, offset = 0;
};

// What stands above the rows.
struct Head {
  bool local = false;
  bool stamps_begin = false;
  std::optional<Geodetic> site;
  std::optional<double> utc_offset;
  std::vector<CsvColumn> columns;
};

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && (s.front() == ' ' || s.front() == '\t')) s.remove_prefix(1);
  while (!s.empty() && (s.back() == ' ' || s.back() == '\t')) s.remove_suffix(1);
  return s;
}

CsvColumn read_column(const TextLines& lines, size_t i, WeatherTable& table) {
  const std::string_view text = lines.word(i);
  const size_t open = text.find('['), close = text.rfind(']');
  if (open == std::string_view::npos || close != text.size() - 1)
    throw lines.error(i, "a column without a unit", "as in 'air_temperature [K]'");
  std::string_view name = trimmed(text.substr(0, open));
  const std::string_view unit = trimmed(text.substr(open + 1, close - open - 1));
  std::optional<WeatherMeaning> meaning;
  if (name.ends_with(" mean")) meaning = WeatherMeaning::mean, name = trimmed(name.substr(0, name.size() - 5));
  if (name.ends_with(" instant")) meaning = WeatherMeaning::instant, name = trimmed(name.substr(0, name.size() - 8));
  std::vector<std::string> known;
  for (size_t k = 0; k < kWeatherQuantities; ++k) {
    const WeatherQuantityInfo& info = weather_info(weather_quantity(k));
    known.emplace_back(info.name);
    if (info.name != name) continue;
    std::string units;
    for (const Unit& u : kUnits) {
      if (u.of != info.unit) continue;
      if (meaning) table.meaning[k] = *meaning;
      if (u.name == unit) return {weather_quantity(k), u.scale, u.offset};
      units += (units.empty() ? "" : ", ") + std::string(u.name);
    }
    throw lines.error(i, "unknown unit '" + std::string(unit) + "' of " + std::string(name), "known: " + units);
  }
  throw lines.error(i, "unknown column '" + std::string(name) + "'", name_hint(name, known));
}

void read_columns(Head& head, const TextLines& lines, WeatherTable& table) {
  head.local = lines.word(0) == "time_local";
  if (!head.local && lines.word(0) != "time_utc")
    throw lines.error(0, "unknown column '" + std::string(lines.word(0)) + "'", "time_utc or time_local");
  for (size_t i = 1; i < lines.words(); ++i) {
    head.columns.push_back(read_column(lines, i, table));
    for (size_t k = 0; k + 1 < head.columns.size(); ++k)
      if (head.columns[k].quantity == head.columns.back().quantity)
        throw lines.error(i, "a second column of one quantity", "give each once");
  }
  if (head.columns.empty()) throw lines.error(0, "a table of times alone", "columns as 'air_temperature [K]' follow");
}

void read_key(Head& head, const TextLines& lines) {
  const std::string_view key = lines.word(0);
  if (key == "site:") {
    head.site = Geodetic{lines.number_in(1, "latitude", -90, 90), lines.number_in(2, "longitude", -180, 360),
                         lines.number_in(3, "height", -1000, 9000)};
  } else if (key == "utc_offset:") {
    head.utc_offset = 3600 * lines.number_in(1, "hours ahead of UTC", -12, 14);
  } else if (key == "stamps:") {
    if (lines.words() < 2 || (lines.word(1) != "end" && lines.word(1) != "begin"))
      throw lines.error(1, "stamps are neither end nor begin", "'stamps: end' or 'stamps: begin'");
    head.stamps_begin = lines.word(1) == "begin";
  } else {
    const std::vector<std::string> known = {"site:", "utc_offset:", "stamps:", "time_utc", "time_local"};
    throw lines.error(0, "unknown kind of weather, or line '" + std::string(key.substr(0, 40)) + "'",
                      name_hint(key, known));
  }
  const size_t wanted = key == "site:" ? 4 : 2;
  if (lines.words() > wanted) throw lines.error(wanted, "more than one value too many", "a comment follows a '#'");
}

Head read_head(TextLines& lines, WeatherTable& table) {
  Head head;
  while (lines.next()) {
    if (lines.word(0).starts_with("time_")) {
      split_at_commas(lines);
      read_columns(head, lines, table);
      return head;
    }
    read_key(head, lines);
  }
  throw lines.error_at_end("has no line of columns", "one that begins with time_utc or time_local");
}

Instant read_time(const TextLines& lines, const Head& head) {
  const std::string_view text = lines.word(0);
  if (head.local && text.size() > 10 && text.find_first_of("Zz+-", 10) != std::string_view::npos)
    throw lines.error(0, "a local time with a zone of its own", "name the column time_utc");
  try {
    const Utc utc = parse_iso8601(text);
    if (utc.year < 1973 || utc.year > 2198) throw Error(strf("the year %d is outside of 1973 to 2198", utc.year));
    return instant_from_utc(utc) + (head.local ? -*head.utc_offset : 0.0);
  } catch (const Error& e) {
    throw lines.error(0, e.message(), e.hint());
  }
}

// What a file and the options both say, or neither.
template <class T>
void settle(std::optional<T>& of_file, const std::optional<T>& of_options, const std::string& file, const char* what) {
  const Where whole{file, 0, 0, {}, -1};
  if (of_file && of_options) throw Error(whole, strf("%s stands in the file and is given", what), "leave one out");
  if (!of_file) of_file = of_options;
  if (!of_file) throw Error(whole, strf("%s is not known", what), "a line above the columns says it; see FORMAT.md");
}

}  // namespace

WeatherTable parse_csv(std::string_view text, const std::string& file, const WeatherOptions& options) {
  WeatherTable table;
  table.file = file;
  table.meaning = usual_meanings();
  TextLines lines(text, file);
  Head head = read_head(lines, table);
  refuse_options(options, {.site = true, .utc_offset = head.local}, file, "this CSV");
  settle(head.site, options.site, file, "the site");
  if (head.local)
    settle(head.utc_offset, options.utc_offset, file, "the UTC offset");
  else if (head.utc_offset)
    throw Error(Where{file, 0, 0, {}, -1}, "utc_offset with a column of time_utc", "name it time_local");
  table.site = *head.site;
  if (head.local) table.notes.push_back(standard_time_note(*head.utc_offset));
  std::vector<Instant> stamps;
  while (lines.next()) {
    split_at_commas(lines);
    if (lines.words() != head.columns.size() + 1)
      throw lines.error(0, strf("a row of %zu fields", lines.words()),
                        strf("the columns are %zu", head.columns.size() + 1));
    WeatherRow& row = add_row(table, lines);
    stamps.push_back(read_time(lines, head));
    for (size_t i = 0; i < head.columns.size(); ++i) {
      const CsvColumn& c = head.columns[i];
      if (lines.word(i + 1).empty() || lines.word(i + 1) == "nan") continue;
      row.value(c.quantity) = c.scale * lines.number(i + 1, "value") + c.offset;
    }
  }
  set_stamps(table, stamps);
  if (head.stamps_begin) {
    for (Instant& stamp : stamps) stamp = stamp + table.step;
    set_stamps(table, stamps);
  }
  return table;
}

}  // namespace suite
