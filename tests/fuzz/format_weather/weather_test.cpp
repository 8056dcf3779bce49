// Seeded mutations of each kind of weather: a series of finite or missing values, or one Error with a place.
#include <gtest/gtest.h>

#include <cmath>

#include "base/files.h"
#include "formats/weather/weather.h"
#include "support/fuzz.h"

namespace suite::format_weather_weather_test {
namespace {

void check(std::span<const std::byte> b, const WeatherOptions& options) {
  const Weather w = parse_weather({reinterpret_cast<const char*>(b.data()), b.size()}, "f", options);
  const TimeSpan span = w.span();
  ASSERT_TRUE(std::isfinite(span.begin) && span.end > span.begin);
  for (size_t k = 0; k < kWeatherQuantities; ++k) {
    const WeatherQuantity q = weather_quantity(k);
    ASSERT_FALSE(std::isinf(w.at(q, (span.begin + span.end) / 2)) || std::isinf(w.mean(q, span.begin, span.end)));
  }
}

void fuzz(const std::string& text, uint64_t seed, const std::vector<std::string>& words,
          const WeatherOptions& options = {}) {
  test::fuzz(
      test::bytes_of(text), [&](std::span<const std::byte> b) { check(b, options); }, seed, test::kMutations, words);
}

// The first lines and a day of rows.
std::string cut(const std::string& name, size_t lines) {
  const std::string text = read_text(SUITE_TEST_DATA "/weather/" + name);
  size_t end = 0;
  for (size_t i = 0; i < lines; ++i) end = text.find('\n', end) + 1;
  return text.substr(0, end);
}

TEST(WeatherFuzz, Epw) {
  fuzz(cut("denver_four_days.epw", 20), 21,
       {"LOCATION,", "DATA PERIODS,1,4,", "9999", "99.9", ",24,", "2,29", "\"", "1e300", "nan", "-7.0"});
}

TEST(WeatherFuzz, Tmy3) {
  fuzz(cut("sand_point_four_days.csv", 12), 22,
       {"-9900", "02/29/2004", "24:00", "Date (MM/DD/YYYY),", "\"", ",,", "1e300", "nan"});
}

TEST(WeatherFuzz, Surfrad) {
  std::string text = " Alamosa\n   37.70  105.92 2317 m version 1\n";
  for (int i = 0; i < 6; ++i)
    text += strf(
        " 2016 1 1 1 0 %d 0.0 %.2f -1.8 0 -0.8 0 1.8 0 2.3 0 186.3 0 -5.7 0 -6.2 0 276.0 0 -6.3 0 -6.4 0 -9999.9 1"
        " -9999.9 1 -1.0 0 -89.7 0 -90.7 0 -7.6 0 52.7 0 3.1 0 304.7 0 773.5 0\n",
        i, 91.65 + 0.177 * i);
  fuzz(text, 23, {"-9999.9", " m version 1", "2016", "1e300", "nan", "\n", "-105.92", " 2 "});
}

TEST(WeatherFuzz, Bsrn) {
  std::string text =
      "*C0001\n 21  6 2016  1\n*C0004\n 1  1 2010\n  5  7\nhere\n+41\nnone\n 136.815 186.944  491 06610\n*U0100\n";
  for (int i = 720; i < 724; ++i)
    text += strf("  1   %d    -999 -99.9 -999 -999     702   0.1  702  702\n", i) +
            "             95   0.1   95   95     291   0.2  291  291     18.5  61.5   957\n";
  fuzz(text, 24, {"*C0001", "*U0100", "*C0004", "-999", "-99.9", "1439", "1e300", "nan", "\n"});
}

TEST(WeatherFuzz, Wth) {
  std::string text = "5 0.25\n";
  for (int i = 0; i < 5; ++i) text += strf("%5.2f-15.00 1012.5 0.68-20.00 2.0 0.0 0.0 0.9 2 0 0.0 0.0\n", 0.25 * i);
  fuzz(text, 25, {"193 0.25\n", "-", "1e300", "nan", "0.25", "98.0"},
       {.site = Geodetic{43.1, -77.6, 150}, .utc_offset = -5 * 3600.0, .date = Utc{1992, 6, 22, 0, 0, 0}});
}

TEST(WeatherFuzz, Csv) {
  fuzz(
      "site: 39.83 -104.65 1650\nutc_offset: -7\nstamps: begin\n"
      "time_local, air_temperature [C], dew_point mean [K], wind_from [deg], global [W/m2], cloud_cover [%]\n"
      "2020-01-01T01:00, -5, 260, 0, 0, 10\n2020-01-01T02:00, -6, , 90, 0, 20\n2020-01-01T03:00, -7, 262, 350, 0, 30\n",
      26,
      {"time_utc", "[K]", "[%]", "2199-12-31T23:00", "1972-01-01", "site:", "utc_offset: 14", "end", "nan", "1e300",
       ",", "#"});
}

}  // namespace
}  // namespace suite::format_weather_weather_test
