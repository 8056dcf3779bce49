// The readers of the kinds, one a file; weather.h chooses among them.
#pragma once
#include <string>
#include <string_view>

#include "base/text_lines.h"
#include "formats/weather/calendar.h"
#include "formats/weather/fields.h"
#include "formats/weather/weather.h"

namespace suite {

inline constexpr size_t kMostWeatherRows = 600000;
inline constexpr double kFreezing = 273.15;

// Rows as the file has them, in SI, with notes on what its kind means by times and values.
WeatherTable parse_epw(std::string_view text, const std::string& file, const WeatherOptions& options);
WeatherTable parse_tmy3(std::string_view text, const std::string& file, const WeatherOptions& options);
WeatherTable parse_psm3(std::string_view text, const std::string& file, const WeatherOptions& options);
WeatherTable parse_surfrad(std::string_view text, const std::string& file, const WeatherOptions& options);
WeatherTable parse_bsrn(std::string_view text, const std::string& file, const WeatherOptions& options);
WeatherTable parse_wth(std::string_view text, const std::string& file, const WeatherOptions& options);
WeatherTable parse_csv(std::string_view text, const std::string& file, const WeatherOptions& options);

// A new row at the line where `lines` stands. Error when there are too many.
WeatherRow& add_row(WeatherTable& table, const TextLines& lines);

// Millimetres of water in so many hours; 99 hours are unknown ones, and nothing in unknown hours is nothing.
void put_precipitation(WeatherRow& row, double millimetres, double hours);

// "UTC-7 h" and so on, as times of files in local standard time are explained.
std::string standard_time_note(double utc_offset);
inline constexpr const char* kHourNote =
    "radiation and precipitation are means of the hour (or part of it) that ends at the stamp, the rest is of the "
    "stamp";

// Options that a kind has a use for; the others are refused. Error naming the first of those that is given.
struct WeatherUses {
  bool site = false, utc_offset = false, date = false, year = false;
};
void refuse_options(const WeatherOptions& options, WeatherUses uses, const std::string& file, const char* kind);

// A date and time of UTC; error at the word of the day where there is no such date.
void check_date(const LocalStamp& stamp, const TextLines& lines, size_t word);

// A table without rows yet, of a kind whose values are means over even steps of UTC, or that has usual_meanings() and
// takes a year. Error as refuse_options.
WeatherTable table_of_means(const std::string& file, const WeatherOptions& options, const char* kind);
WeatherTable table_of_hours(const std::string& file, const WeatherOptions& options, const char* kind);
// Of a file whose rows stand in local standard time, for hours that end at the stamp: rows as read_row(row) takes them
// from each line, split at commas, and read_row returns the stamp of.
template <class ReadRow>
void read_local_hours(WeatherTable& table, TextLines& lines, double utc_offset, std::optional<int> year,
                      ReadRow&& read_row) {
  table.notes.push_back(standard_time_note(utc_offset));
  table.notes.push_back(kHourNote);
  std::vector<LocalStamp> stamps;
  while (lines.next_raw()) {
    split_at_commas(lines);
    if (!no_fields(lines)) stamps.push_back(read_row(add_row(table, lines)));
  }
  place_rows(table, std::move(stamps), utc_offset, year);
}

}  // namespace suite
