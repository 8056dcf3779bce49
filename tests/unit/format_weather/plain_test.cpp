// Plain CSV with units, and DIRSIG's .wth.
#include "base/files.h"
#include "formats/weather/weather.h"
#include "support/temp_folder.h"
#include "support/weather_kit.h"

namespace suite::format_weather_plain_test {
namespace {

constexpr const char* kTable =
    "# a night in Denver\nsite: 39.83 -104.65 1650\n"
    "time_utc, air_temperature [C], relative_humidity [%], wind_speed [km/h], wind_from [deg], precipitation [mm/h], "
    "cloud_cover [oktas], snow_depth [cm], longwave_down instant [W/m2], global [W/m2]\n"
    "2020-01-01T08:00Z, -5, 80, 7.2, 0, 3.6, 4, 12, 250, 0\n"
    "2020-01-01T09:00Z, -6, , 3.6, 90, 0, 8, 12, 260, 0\n"
    "# in between\n"
    "2020-01-01T10:00Z, -7, nan, 3.6, 90, 0, 8, 12, 270, 0\n";

TEST(WeatherCsv, UnitsMeaningsAndGaps) {
  const Weather w = parse_weather(kTable, "w.csv");
  EXPECT_EQ(to_iso8601(w.clock().utc(0), 0), "2020-01-01T07:00:00Z");
  EXPECT_NEAR(w.at(Q::air_temperature, 3600), 268.15, 1e-9);
  EXPECT_NEAR(w.at(Q::relative_humidity, 3600), 0.8, 1e-12);
  EXPECT_NEAR(w.at(Q::wind_speed, 3600), 2, 1e-12);
  EXPECT_NEAR(w.at(Q::wind_from, 3600), kPi / 2, 1e-12);
  EXPECT_NEAR(w.mean(Q::precipitation, 0, 3600), 0.001, 1e-15);
  EXPECT_NEAR(w.at(Q::cloud_cover, 3600), 0.5, 1e-12);
  EXPECT_NEAR(w.at(Q::snow_depth, 3600), 0.12, 1e-12);
  EXPECT_NEAR(w.at(Q::longwave_down, 2 * 3600), 260, 1e-12) << "an instant, as the column says";
  EXPECT_TRUE(std::isnan(w.at(Q::relative_humidity, 5400)));
  EXPECT_THAT(w.notes(), Contains("relative_humidity is missing: 2 of 3 rows, first in line 5"));
  EXPECT_THAT(w.notes(), Not(Contains(HasSubstr("standard time"))));
}

// A day of minutes from 00:00 to 23:59 is a day.
TEST(WeatherCsv, DaysOfMinutesThatEndAMinuteEarly) {
  std::string rows = "site: 39.83 -104.65 1650\ntime_utc, wind_speed [m/s]\n";
  for (int k = 0; k < 1440; ++k) rows += strf("2020-01-01T%02d:%02dZ, %g\n", k / 60, k % 60, k < 1439 ? 1.0 : 3.0);
  const Weather w = parse_weather(rows, "w.csv");
  const double begin = w.clock().seconds(parse_iso8601("2020-01-01T00:00Z"));
  EXPECT_EQ(message_of([&] { w.require(Q::wind_speed, begin, begin + 86400); }), "no error");
  EXPECT_NEAR(w.at(Q::wind_speed, begin + 86390), 3, 1e-9);
  EXPECT_THAT(w.notes(), Contains("the last row is held for 60 s more, to the end of its day"));
  // A minute more is not there.
  EXPECT_THAT(message_of([&] { w.require(Q::wind_speed, begin, begin + 86460); }), HasSubstr("does not cover"));
}

TEST(WeatherCsv, LocalTimesAndStampsThatBegin) {
  const std::string rows =
      "time_local, wind_speed [m/s]\n2020-01-01T01:00, 1\n2020-01-01T02:00, 2\n2020-01-01T03:00, 2\n";
  const Weather w = parse_weather("site: 39.83 -104.65 1650\nutc_offset: -7\nstamps: begin\n" + rows, "w.csv");
  EXPECT_EQ(to_iso8601(w.clock().utc(0), 0), "2020-01-01T08:00:00Z");
  EXPECT_NEAR(w.at(Q::wind_speed, 3600), 1, 1e-12);
  EXPECT_THAT(w.notes(), Contains("times are local standard time, UTC-7 h, without daylight saving"));
  // From the options, where the file is silent.
  const Weather given =
      parse_weather(rows, "w.csv", {.site = Geodetic{39.83, -104.65, 1650}, .utc_offset = 3600.0 * -7});
  EXPECT_EQ(to_iso8601(given.clock().utc(0), 0), "2020-01-01T07:00:00Z");
  EXPECT_THAT(message_of([&] { parse_weather(rows, "w.csv"); }), HasSubstr("the site is not known"));
  EXPECT_THAT(message_of([&] { parse_weather("site: 1 1 0\n" + rows, "w.csv"); }),
              HasSubstr("the UTC offset is not known"));
  EXPECT_THAT(message_of([&] { parse_weather("site: 1 1 0\n" + rows, "w.csv", {.site = Geodetic{}}); }),
              HasSubstr("the site stands in the file and is given"));
  EXPECT_THAT(message_of([&] {
                parse_weather("site: 1 1 0\nutc_offset: 0\ntime_local, wind_speed [m/s]\n2020-01-01T01:00Z, 1\n",
                              "w.csv");
              }),
              HasSubstr("w.csv:4:1: error: a local time with a zone of its own"));
}

TEST(WeatherCsv, RefusesWithThePlace) {
  const auto message = [](const std::string& text) {
    return message_of([&] { parse_weather("site: 40 -105 1600\n" + text, "w.csv"); });
  };
  const std::string head = "time_utc, wind_speed [m/s]\n";
  EXPECT_THAT(message("time_utc, windspeed [m/s]\n"),
              HasSubstr("w.csv:2:11: error: unknown column 'windspeed'; did you mean 'wind_speed'?"));
  EXPECT_THAT(message("time_utc, wind_speed [mph]\n"),
              HasSubstr("unknown unit 'mph' of wind_speed; known: m/s, km/h, knot"));
  EXPECT_THAT(message("time_utc, wind_speed\n"), HasSubstr("a column without a unit"));
  EXPECT_THAT(message("time_utc, wind_speed [m/s], wind_speed [km/h]\n"), HasSubstr("a second column of one quantity"));
  EXPECT_THAT(message("time_utc\n"), HasSubstr("a table of times alone"));
  EXPECT_THAT(message("sight: 1 2 3\n" + head),
              HasSubstr("w.csv:2:1: error: unknown kind of weather, or line 'sight:'"));
  EXPECT_THAT(message("site: 1 2\n" + head), HasSubstr("height is missing"));
  EXPECT_THAT(message("stamps: middle\n" + head), HasSubstr("neither end nor begin"));
  EXPECT_THAT(message("utc_offset: 1\n" + head + "2020-01-01, 1\n"), HasSubstr("utc_offset with a column of time_utc"));
  EXPECT_THAT(message(head + "2020-01-01T01:00, 1, 2\n"), HasSubstr("w.csv:3:1: error: a row of 3 fields"));
  EXPECT_THAT(message(head + "2020-13-01T01:00, 1\n"), HasSubstr("w.csv:3:1: error: month 13 does not exist"));
  EXPECT_THAT(message(head + "2020-01-01T01:00, 1\n"), HasSubstr("weather of 1 rows"));
  EXPECT_THAT(message(head + "2020-01-01T01:00, 1\n2020-01-01T02:00, -9999\n"),
              HasSubstr("w.csv:4: error: wind_speed = -9999 m/s is out of range"));
  EXPECT_THAT(message_of([] { parse_weather("", "w.csv"); }), HasSubstr("holds no weather"));
  EXPECT_THAT(message_of([] { parse_weather("a\nb\n", "w.csv"); }), HasSubstr("unknown kind of weather"));
  EXPECT_THAT(message_of([] { parse_weather(kTable, "w.csv", {.year = 2001}); }),
              HasSubstr("a year is given for weather of this CSV"));
}

TEST(WeatherCsv, FromAFile) {
  TempFolder folder;
  write_file(folder / "w.csv", std::string_view(kTable));
  EXPECT_EQ(read_weather(folder / "w.csv").table().rows.size(), 3u);
  EXPECT_THROW(read_weather(folder / "none.csv"), Error);
}

// 48 hours by the quarter, columns of fixed width that touch where a value is negative.
std::string wth(size_t rows = 193, const char* head = "193   0.25\n") {
  std::string text = head;
  for (size_t i = 0; i < rows; ++i) {
    const double hour = 0.25 * static_cast<double>(i), day = std::fmod(hour, 24);
    const double beam = day > 6 && day < 18 ? 60 : 0;
    text += strf("%6.2f%6.2f%8.2f%6.2f%6.2f%6.2f%6.2f%6.2f%6.2f%3d%3d%6.2f%6.2f\n", hour, -15.0, 1012.5, 0.68, -20.0,
                 2.0, beam, beam / 6, 0.9, 2, 0, 0.0, 0.0);
  }
  return text;
}
const WeatherOptions kRochester{
    .site = Geodetic{43.1, -77.6, 150}, .utc_offset = -5 * 3600.0, .date = Utc{1992, 6, 22, 0, 0, 0}};

TEST(Wth, ColumnsThatTouchAndLangleys) {
  ASSERT_THAT(wth(), HasSubstr("  0.00-15.00 1012.50  0.68-20.00"));
  const Weather w = parse_weather(wth(), "jun.wth", kRochester);
  EXPECT_EQ(w.table().rows.size(), 193u);
  const double noon = w.clock().seconds(parse_iso8601("1992-06-22T17:00:00Z"));
  EXPECT_NEAR(w.at(Q::air_temperature, noon), 258.15, 1e-9);
  EXPECT_NEAR(w.at(Q::dew_point, noon), 253.15, 1e-9);
  EXPECT_NEAR(w.at(Q::pressure, noon), 101250, 1e-6);
  EXPECT_NEAR(w.at(Q::relative_humidity, noon), 0.68, 1e-9);
  EXPECT_NEAR(w.at(Q::wind_speed, noon), 2, 1e-9);
  // 10 and 60 Langley an hour, 41840 J/m2 each.
  EXPECT_NEAR(w.at(Q::diffuse, noon), 116.222, 1e-3);
  EXPECT_NEAR(w.at(Q::global, noon), 813.556, 1e-3);
  EXPECT_NEAR(w.at(Q::direct_normal, noon) * std::sin(w.sun(noon).elevation), 697.333, 0.1);
  EXPECT_THAT(w.notes(), Contains(HasSubstr("direct insolation is taken as that on a level plane")));
  EXPECT_THAT(w.notes(), Contains(HasSubstr("precipitation are not read")));
  EXPECT_THAT(w.notes(),
              Contains("times are local standard time, UTC-5 h, without daylight saving, values of the stamp"));
}

TEST(Wth, NeedsWhatItDoesNotName) {
  EXPECT_THAT(message_of([] { parse_weather(wth(), "a.wth"); }),
              HasSubstr("a.wth:1: error: a .wth file names neither place, nor time zone, nor date"));
  WeatherOptions elsewhere = kRochester;
  elsewhere.utc_offset = 5 * 3600.0;
  EXPECT_THAT(message_of([&] { parse_weather(wth(), "a.wth", elsewhere); }), HasSubstr("wrong time zone"));
}

TEST(Wth, RefusesWithThePlace) {
  const auto message = [](const std::string& text) {
    return message_of([&] { parse_weather(text, "a.wth", kRochester); });
  };
  EXPECT_THAT(message(wth(192)), HasSubstr("has 192 rows, its first line says 193"));
  EXPECT_THAT(message(wth(3, "3 0.5\n")), HasSubstr("a.wth:3:3: error: hour 0.25 where 0.5 is due"));
  EXPECT_THAT(message("2 0.25\n0.0 1 2\n"), HasSubstr("a.wth:2:1: error: a row of 3 values"));
  EXPECT_THAT(message("9999999999 0.25\n"), HasSubstr("unknown kind of weather"));
}

}  // namespace
}  // namespace suite::format_weather_plain_test
