#include "base/files.h"
#include "formats/weather/readers.h"

namespace suite {

namespace {

constexpr size_t kMostBytes = size_t{256} << 20;

bool two_numbers(const TextLines& lines) {
  try {
    lines.integer(0, "count", 0, 1000000000);
    lines.number(1, "step");
  } catch (const Error&) {
    return false;
  }
  return lines.words() == 2;
}

using Parse = WeatherTable (*)(std::string_view, const std::string&, const WeatherOptions&);

// By the first two lines.
Parse kind_of(std::string_view text, const std::string& file) {
  TextLines lines(text, file);
  if (!lines.next_raw()) throw lines.error_at_end("holds no weather", "see formats/weather/FORMAT.md for the kinds");
  if (lines.line().starts_with("LOCATION,")) return parse_epw;
  if (lines.line().starts_with("*C0001") || lines.line().starts_with("*U0001")) return parse_bsrn;
  if (lines.line().starts_with("Source,Location ID,")) return parse_psm3;
  if (two_numbers(lines)) return parse_wth;
  if (lines.next_raw()) {
    if (lines.line().starts_with("Date (MM/DD/YYYY),")) return parse_tmy3;
    if (lines.words() >= 5 && lines.word(3) == "m" && lines.word(4) == "version") return parse_surfrad;
  }
  return parse_csv;
}

}  // namespace

WeatherRow& add_row(WeatherTable& table, const TextLines& lines) {
  if (table.rows.size() == kMostWeatherRows) throw lines.error(0, strf("more than %zu rows", kMostWeatherRows));
  table.rows.emplace_back();
  table.rows.back().line = lines.where().line;
  return table.rows.back();
}

void put_precipitation(WeatherRow& row, double millimetres, double hours) {
  double& rate = row.value(WeatherQuantity::precipitation);
  if (millimetres == 0)
    rate = 0;
  else if (hours > 0 && hours < 99)
    rate = millimetres / (3600 * hours);
}

std::string standard_time_note(double utc_offset) {
  return strf("times are local standard time, UTC%+g h, without daylight saving", utc_offset / 3600);
}

void refuse_options(const WeatherOptions& options, WeatherUses uses, const std::string& file, const char* kind) {
  const auto refuse = [&](bool given, bool used, const char* name) {
    if (given && !used)
      throw Error(Where{file, 0, 0, {}, -1}, strf("%s is given for weather of %s", name, kind),
                  "leave it out: the file says it itself, or has no use for it");
  };
  refuse(options.site.has_value(), uses.site, "a site");
  refuse(options.utc_offset.has_value(), uses.utc_offset, "a UTC offset");
  refuse(options.date.has_value(), uses.date, "a date");
  refuse(options.year.has_value(), uses.year, "a year");
}

void check_date(const LocalStamp& stamp, const TextLines& lines, size_t word) {
  if (!is_date(stamp)) throw lines.error(word, strf("there is no %d-%02d-%02d", stamp.year, stamp.month, stamp.day));
}

WeatherTable table_of_means(const std::string& file, const WeatherOptions& options, const char* kind) {
  refuse_options(options, {}, file, kind);
  WeatherTable table;
  table.file = file;
  table.meaning.fill(WeatherMeaning::mean);
  return table;
}

WeatherTable table_of_hours(const std::string& file, const WeatherOptions& options, const char* kind) {
  refuse_options(options, {.year = true}, file, kind);
  WeatherTable table;
  table.file = file;
  table.meaning = usual_meanings();
  return table;
}

Weather parse_weather(std::string_view text, const std::string& file, const WeatherOptions& options) {
  return Weather(kind_of(text, file)(text, file, options), options.longwave);
}

Weather read_weather(const std::string& path, const WeatherOptions& options) {
  return parse_weather(read_text(path, kMostBytes), path, options);
}

}  // namespace suite
