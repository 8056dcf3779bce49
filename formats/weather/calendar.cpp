#include "formats/weather/calendar.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <tuple>

namespace suite {

namespace {

constexpr double kDay = 86400;

bool leap(int year) { return std::chrono::year{year}.is_leap(); }
bool leap_day(const LocalStamp& s) { return s.month == 2 && s.day == 29; }

// The first row that is not later than the one before, of months and days only; 0 = none.
size_t first_not_ascending(const std::vector<LocalStamp>& stamps) {
  const auto key = [](const LocalStamp& s) { return std::tuple(s.month, s.day, s.seconds); };
  for (size_t i = 1; i < stamps.size(); ++i)
    if (!(key(stamps[i - 1]) < key(stamps[i]))) return i;
  return 0;
}

std::string years_of(const std::vector<LocalStamp>& stamps) {
  std::string text = std::to_string(stamps.front().year);
  size_t named = 1;
  for (size_t i = 1; i < stamps.size(); ++i) {
    if (stamps[i].year == stamps[i - 1].year) continue;
    if (++named > 12) return text + ", ...";
    text += ", " + std::to_string(stamps[i].year);
  }
  return text;
}

// One year for all rows, where theirs are not those of a calendar; whether that was done.
bool replace_years(WeatherTable& table, std::vector<LocalStamp>& stamps, std::optional<int> wanted) {
  const bool mixed =
      std::any_of(stamps.begin(), stamps.end(), [&](const LocalStamp& s) { return s.year != stamps.front().year; });
  const size_t back = first_not_ascending(stamps);
  const bool one_year = back == 0;
  if (!wanted && !(mixed && one_year)) return false;
  if (!one_year && stamps[back].year == stamps[back - 1].year)
    throw Error(table.where(back), "the row is not later than the one before", "rows in the order of time, each once");
  if (!one_year)
    throw Error(table.where(0), "the rows run through more than a year, which cannot be placed in one",
                "leave out the year");
  const bool has_leap_day = std::any_of(stamps.begin(), stamps.end(), leap_day);
  int year = wanted.value_or(stamps.front().year);
  if (!wanted && leap(year) && !has_leap_day) ++year;
  if (mixed)
    table.notes.push_back("a typical year of months of " + years_of(stamps) + ": all are placed in " +
                          std::to_string(year));
  else if (year != stamps.front().year)
    table.notes.push_back(strf("the year %d is replaced by %d", stamps.front().year, year));
  for (LocalStamp& s : stamps) s.year = year;
  return true;
}

// The year may have a day more or less than the rows.
void settle_leap_day(WeatherTable& table, std::vector<LocalStamp>& stamps, bool replaced) {
  const int year = stamps.front().year;
  const auto of_day = [&](int month, int day) {
    std::vector<size_t> found;
    for (size_t i = 0; i < stamps.size(); ++i)
      if (stamps[i].year == year && stamps[i].month == month && stamps[i].day == day) found.push_back(i);
    return found;
  };
  const std::vector<size_t> extra = of_day(2, 29);
  if (replaced && !leap(year) && !extra.empty()) {
    const auto from = static_cast<std::ptrdiff_t>(extra.front()), to = static_cast<std::ptrdiff_t>(extra.back()) + 1;
    stamps.erase(stamps.begin() + from, stamps.begin() + to);
    table.rows.erase(table.rows.begin() + from, table.rows.begin() + to);
    table.notes.push_back(strf("29 February is left out: %d is no leap year", year));
  } else if (leap(year) && extra.empty() && !of_day(3, 1).empty()) {
    const std::vector<size_t> before = of_day(2, 28);
    if (before.empty()) return;
    size_t place = before.back() + 1;
    for (const size_t i : before) {
      const WeatherRow row = table.rows[i];
      LocalStamp stamp = stamps[i];
      stamp.day = 29;
      table.rows.insert(table.rows.begin() + static_cast<std::ptrdiff_t>(place), row);
      stamps.insert(stamps.begin() + static_cast<std::ptrdiff_t>(place), stamp);
      ++place;
    }
    table.notes.push_back(strf("29 February %d is that of 28 February: the rows have none", year));
  }
}

}  // namespace

bool is_date(const LocalStamp& s, bool any_year) {
  using namespace std::chrono;
  if (s.month < 1 || s.month > 12 || s.day < 1 || s.day > 31) return false;
  return (year{any_year ? 2000 : s.year} / s.month / s.day).ok();
}

Instant instant_of(const LocalStamp& s, double utc_offset) {
  using namespace std::chrono;
  const double days_here = static_cast<double>(sys_days(year{s.year} / s.month / s.day).time_since_epoch().count());
  const double total = days_here * kDay + s.seconds - utc_offset, day = std::floor(total / kDay);
  const year_month_day date{sys_days{days{static_cast<int>(day)}}};
  const double rest = total - day * kDay;
  Utc utc;
  utc.year = static_cast<int>(date.year());
  utc.month = static_cast<int>(static_cast<unsigned>(date.month()));
  utc.day = static_cast<int>(static_cast<unsigned>(date.day()));
  utc.hour = static_cast<int>(rest / 3600);
  utc.minute = static_cast<int>((rest - 3600 * utc.hour) / 60);
  utc.second = rest - 3600 * utc.hour - 60 * utc.minute;
  return instant_from_utc(utc);
}

void place_rows(WeatherTable& table, std::vector<LocalStamp> stamps, double utc_offset, std::optional<int> year) {
  SUITE_CHECK_EQ(table.rows.size(), stamps.size());
  if (stamps.empty()) throw Error(Where{table.file, 0, 0, {}, -1}, "weather without a row");
  settle_leap_day(table, stamps, replace_years(table, stamps, year));
  std::vector<Instant> ends;
  ends.reserve(stamps.size());
  for (size_t i = 0; i < stamps.size(); ++i) {
    const LocalStamp& s = stamps[i];
    if (!is_date(s)) throw Error(table.where(i), strf("there is no %d-%02d-%02d", s.year, s.month, s.day));
    if (s.year < 1973 || s.year > 2198)
      throw Error(table.where(i), strf("the year %d is outside of 1973 to 2198", s.year),
                  "place the rows in another year");
    ends.push_back(instant_of(s, utc_offset));
  }
  set_stamps(table, ends);
}

}  // namespace suite
