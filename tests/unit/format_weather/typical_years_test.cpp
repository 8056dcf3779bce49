// EnergyPlus and TMY3 files: each trap of theirs.
#include "base/files.h"
#include "formats/weather/weather.h"
#include "support/weather_kit.h"

namespace suite::format_weather_typical_years_test {
namespace {

constexpr const char* kDenver = SUITE_TEST_DATA "/weather/denver_four_days.epw";
constexpr const char* kSandPoint = SUITE_TEST_DATA "/weather/sand_point_four_days.csv";

double at_utc(const Weather& w, Q q, const char* time) { return w.at(q, w.clock().seconds(parse_iso8601(time))); }

// One EPW row of Denver at night: date, hour and what differs.
struct Row {
  int year = 2003, month = 6, day = 10, hour = 1, minute = 0;
  std::string dry = "10", dew = "5", humidity = "70", pressure = "83000", infrared = "300", global = "0", direct = "0",
              diffuse = "0", from = "90", wind = "3", total = "2", opaque = "1", snow = "0", rain = "0.0,1.0";
};
std::string text(const Row& r) {
  return strf("%d,%d,%d,%d,%d,?9,", r.year, r.month, r.day, r.hour, r.minute) + r.dry + "," + r.dew + "," + r.humidity +
         "," + r.pressure + ",0,0," + r.infrared + "," + r.global + "," + r.direct + "," + r.diffuse + ",0,0,0,0," +
         r.from + "," + r.wind + "," + r.total + "," + r.opaque + ",20,5000,9,999999999,20,0.04," + r.snow +
         ",88,0.2," + r.rain + "\n";
}
std::string epw(const std::vector<Row>& rows, const char* zone = "-7.0", int an_hour = 1,
                const char* saving = "0,0,0") {
  std::string all = std::string("LOCATION,Denver,CO,USA,TMY3,725650,39.83,-104.65,") + zone +
                    ",1650.0\nHOLIDAYS/DAYLIGHT SAVINGS,No," + saving + "\n" +
                    strf("DATA PERIODS,1,%d,Data,Sunday, 1/ 1,12/31\n", an_hour);
  for (const Row& r : rows) all += text(r);
  return all;
}
std::vector<Row> night(size_t n = 4) {
  std::vector<Row> rows(n);
  for (size_t i = 0; i < n; ++i) rows[i].hour = static_cast<int>(i) + 1;
  return rows;
}
Weather read(const std::vector<Row>& rows) { return parse_weather(epw(rows), "d.epw"); }
std::string refused(const std::vector<Row>& rows) {
  return message_of([&] { read(rows); });
}

// The same hours, with midnights as TMY3 has them and as vendors do: 00:00 of the next day, at a seam of two years,
// too.
TEST(Tmy3, MidnightOfTheNextDay) {
  const auto file = [](bool vendor) {
    std::string text =
        "1,x,CO,-7.0,40.0,-105.0,1600\nDate (MM/DD/YYYY),Time (HH:MM),GHI (W/m^2),DNI (W/m^2),DHI "
        "(W/m^2),TotCld (tenths),OpqCld (tenths),Dry-bulb (C),Dew-point (C),RHum (%),Pressure (mbar),Wdir "
        "(degrees),Wspd (m/s),Lprecip depth (mm),Lprecip quantity (hr)\n";
    const struct {
      const char *date, *next;
    } days[] = {{"11/30/2006", "12/01/2006"}, {"12/01/2003", "12/02/2003"}, {"12/31/2003", "01/01/2004"}};
    for (int d = 0; d < 3; ++d)
      for (int h = 1; h <= 24; ++h) {
        const bool midnight = vendor && h == 24;
        text += strf("%s,%02d:00,0,0,0,5,5,%g,-5,60,860,180,2.0,0,1\n", midnight ? days[d].next : days[d].date,
                     midnight ? 0 : h, d + 0.01 * h);
        if (d == 1 && h == 24)  // the days between, an hour each step needs no gap
          for (int day = 2; day <= 30; ++day)
            for (int k = 1; k <= 24; ++k) {
              const bool end = vendor && k == 24;
              text +=
                  strf("12/%02d/2003,%02d:00,0,0,0,5,5,9,-5,60,860,180,2.0,0,1\n", end ? day + 1 : day, end ? 0 : k);
            }
      }
    return text;
  };
  const Weather nrel = parse_weather(file(false), "n.csv", {.year = 2021}),
                vendor = parse_weather(file(true), "v.csv", {.year = 2021});
  ASSERT_EQ(nrel.table().rows.size(), vendor.table().rows.size());
  EXPECT_EQ(nrel.clock().utc(0).year, vendor.clock().utc(0).year);
  EXPECT_EQ(to_iso8601(nrel.clock().utc(0), 0), to_iso8601(vendor.clock().utc(0), 0));
  for (size_t i = 0; i < nrel.table().rows.size(); ++i)
    ASSERT_EQ(nrel.table().rows[i].value(Q::air_temperature), vendor.table().rows[i].value(Q::air_temperature)) << i;
  EXPECT_NEAR(at_utc(vendor, Q::air_temperature, "2022-01-01T07:00:00Z"), 273.15 + 2.24, 1e-9);
}

TEST(Psm3, ColumnsByNameAndStampsOfTheirZone) {
  const std::string head =
      "Source,Location ID,City,State,Country,Latitude,Longitude,Time Zone,Elevation,Local Time Zone\n"
      "NSRDB,145809,-,-,-,39.73,-104.98,-7,1600,-7\n"
      "Year,Month,Day,Hour,Minute,GHI,DHI,DNI,Dew Point,Temperature,Pressure,Relative Humidity,Wind Direction,Wind "
      "Speed,Surface Albedo\n";
  const Weather w = parse_weather(head +
                                      "2019,6,1,11,30,900,100,880,4,20,840,35,90,3,0.2\n"
                                      "2019,6,1,12,30,950,110,900,4,22,840,31,90,4,0.2\n"
                                      "2019,6,1,13,30,920,110,890,4,23,840,30,90,5,0.2\n",
                                  "p.csv");
  EXPECT_NEAR(at_utc(w, Q::air_temperature, "2019-06-01T19:30:00Z"), 273.15 + 22, 1e-9);
  EXPECT_NEAR(at_utc(w, Q::global, "2019-06-01T19:30:00Z"), 950, 1e-9);
  EXPECT_NEAR(at_utc(w, Q::pressure, "2019-06-01T19:30:00Z"), 84000, 1e-6);
  EXPECT_NEAR(w.site().longitude_deg, -104.98, 1e-12);
  EXPECT_THAT(message_of([&] { parse_weather(head + "2019,6,31,11,30,900,100,880,4,20,840,35,90,3,0.2\n", "p.csv"); }),
              testing::HasSubstr("p.csv:4:"));
}

// The cut begins on 1994-02-27 at 0:00 local standard time, which is 7:00 UTC.
TEST(Epw, StandardTimeAndHoursThatEndAtTheStamp) {
  const Weather w = read_weather(kDenver);
  EXPECT_EQ(to_iso8601(w.clock().utc(0), 0), "1994-02-27T07:00:00Z");
  EXPECT_EQ(w.table().rows.size(), 96u);
  // The row of hour 12: 13.3 C at 12:00 there; 603 W/m2 from 11:00 to 12:00.
  EXPECT_NEAR(at_utc(w, Q::air_temperature, "1994-02-27T19:00:00Z"), 273.15 + 13.3, 1e-9);
  const double noon = w.clock().seconds(parse_iso8601("1994-02-27T19:00:00Z"));
  EXPECT_NEAR(w.mean(Q::global, noon - 3600, noon), 603, 1e-9);
  EXPECT_NEAR(w.mean(Q::direct_normal, noon - 3600, noon), 583, 1e-9);
  EXPECT_NEAR(w.mean(Q::longwave_down, noon - 3600, noon), 314, 1e-9);
  EXPECT_NEAR(at_utc(w, Q::dew_point, "1994-02-27T19:00:00Z"), 273.15 - 6.1, 1e-9);
  EXPECT_NEAR(at_utc(w, Q::relative_humidity, "1994-02-27T19:00:00Z"), 0.24, 1e-9);
  EXPECT_NEAR(at_utc(w, Q::pressure, "1994-02-27T19:00:00Z"), 83000, 1e-6);
  EXPECT_NEAR(at_utc(w, Q::wind_speed, "1994-02-27T19:00:00Z"), 2.6, 1e-9);
  EXPECT_NEAR(at_utc(w, Q::wind_from, "1994-02-27T19:00:00Z"), (90 - 130) * kDegree, 1e-9);
  EXPECT_NEAR(at_utc(w, Q::cloud_cover, "1994-02-27T19:00:00Z"), 0.9, 1e-9);
  EXPECT_NEAR(at_utc(w, Q::opaque_cover, "1994-02-27T19:00:00Z"), 0.6, 1e-9);
  EXPECT_THAT(w.notes(), Contains("times are local standard time, UTC-7 h, without daylight saving"));
  EXPECT_THAT(w.notes(), Contains(HasSubstr("means of the hour (or part of it) that ends at the stamp")));
  EXPECT_THAT(w.notes(), Not(Contains(HasSubstr("longwave_down is modelled"))));
  EXPECT_THAT(w.notes(), Not(Contains(HasSubstr("differ from global"))));
}

// 27 and 28 February are of 1994, 1 and 2 March of 1991.
TEST(Epw, MonthsOfDifferentYearsAreOneYear) {
  const Weather w = read_weather(kDenver);
  EXPECT_THAT(w.notes(), Contains("a typical year of months of 1994, 1991: all are placed in 1994"));
  EXPECT_NEAR(w.span().end - w.span().begin, 96 * 3600, 1e-6);
  const Weather placed = read_weather(kDenver, {.year = 2021});
  EXPECT_EQ(to_iso8601(placed.clock().utc(0), 0), "2021-02-27T07:00:00Z");
  EXPECT_EQ(placed.at(Q::pressure, 50 * 3600), w.at(Q::pressure, 50 * 3600));
}

TEST(Epw, LeapDays) {
  // A leap year asked for: 29 February repeats 28 February, hour by hour.
  const Weather w = read_weather(kDenver, {.year = 2020});
  EXPECT_EQ(w.table().rows.size(), 120u);
  EXPECT_NEAR(w.span().end - w.span().begin, 120 * 3600, 1e-6);
  EXPECT_THAT(w.notes(), Contains("29 February 2020 is that of 28 February: the rows have none"));
  for (int hour = 1; hour <= 24; ++hour)
    EXPECT_EQ(w.table().rows[static_cast<size_t>(47 + hour)].values[0],
              w.table().rows[static_cast<size_t>(23 + hour)].values[0]);
  // One in the file, and a year without.
  std::vector<Row> rows;
  for (const auto& [month, day] : {std::pair{2, 28}, {2, 29}, {3, 1}})
    for (Row r : night(24)) r.year = 2004, r.month = month, r.day = day, rows.push_back(r);
  EXPECT_EQ(read(rows).table().rows.size(), 72u);
  const Weather without = parse_weather(epw(rows), "d.epw", {.year = 2003});
  EXPECT_EQ(without.table().rows.size(), 48u);
  EXPECT_THAT(without.notes(), Contains("29 February is left out: 2003 is no leap year"));
  EXPECT_THAT(without.notes(), Contains("the year 2004 is replaced by 2003"));
  for (Row& r : rows) r.year = 2003;
  EXPECT_THAT(refused(rows), HasSubstr("there is no 2003-02-29"));
}

TEST(Epw, Hour24IsTheNextMidnight) {
  std::vector<Row> rows = night(2);
  rows[0].hour = 24, rows[0].dry = "11";
  rows[1].day = 11, rows[1].hour = 1;
  const Weather w = read(rows);
  EXPECT_NEAR(at_utc(w, Q::air_temperature, "2003-06-11T07:00:00Z"), 284.15, 1e-9);
  rows[0].hour = 25;
  EXPECT_THAT(refused(rows), HasSubstr("d.epw:4:11: error: hour = 25 is out of range"));
}

TEST(Epw, NumbersThatMeanMissing) {
  std::vector<Row> rows = night(5);
  Row& r = rows[2];
  r.dry = "99.9", r.dew = "99.9", r.humidity = "999", r.pressure = "999999", r.infrared = "9999", r.global = "9999",
  r.direct = "9999", r.diffuse = "9999", r.from = "999", r.wind = "999", r.total = "99", r.opaque = "99",
  r.snow = "999", r.rain = "999.0,99.0";
  const Weather w = read(rows);
  for (const Q q : {Q::air_temperature, Q::dew_point, Q::relative_humidity, Q::pressure, Q::longwave_down, Q::global,
                    Q::direct_normal, Q::diffuse, Q::wind_from, Q::wind_speed, Q::cloud_cover, Q::opaque_cover,
                    Q::snow_depth, Q::precipitation}) {
    EXPECT_TRUE(std::isnan(w.at(q, 2.5 * 3600))) << weather_info(q).name;
    EXPECT_FALSE(std::isnan(w.at(q, 0.5 * 3600))) << weather_info(q).name;
    EXPECT_THAT(w.notes(), Contains(std::string(weather_info(q).name) + " is missing: 1 of 5 rows, first in line 6"));
  }
}

TEST(Epw, InfraredThatIsMissingIsModelled) {
  std::vector<Row> rows = night();
  for (Row& r : rows) r.infrared = "9999";
  rows[1].infrared = "0";
  const Weather w = read(rows);
  EXPECT_NEAR(w.at(Q::longwave_down, 1800), modelled_longwave(LongwaveModel::dilley_obrien, 283.15, 278.15, 0.1), 1e-9);
  EXPECT_THAT(w.notes(), Contains("horizontal infrared of 0 is taken as missing in 1 rows"));
  EXPECT_THAT(w.notes(),
              Contains(HasSubstr(
                  "longwave_down is modelled (Dilley & O'Brien 1998, clouds after Unsworth & Monteith 1975): 4 of 4")));
}

TEST(Epw, DaylightSavingInTheHeadIsNotApplied) {
  const Weather w = parse_weather(epw(night(), "-7.0", 1, "4/ 6,10/26,0"), "d.epw");
  EXPECT_THAT(w.notes(), Contains(HasSubstr("daylight saving is named")));
  EXPECT_EQ(to_iso8601(w.clock().utc(0), 0), "2003-06-10T07:00:00Z");
}

TEST(Epw, PartsOfHours) {
  std::vector<Row> rows = night(4);
  for (int i = 0; i < 4; ++i) rows[static_cast<size_t>(i)].hour = 1, rows[static_cast<size_t>(i)].minute = 15 * (i + 1);
  const Weather w = parse_weather(epw(rows, "-7.0", 4), "d.epw");
  EXPECT_EQ(w.table().step, 900);
  EXPECT_EQ(to_iso8601(w.clock().utc(3600), 0), "2003-06-10T08:00:00Z");
  rows[0].minute = 0;
  EXPECT_THAT(message_of([&] { parse_weather(epw(rows, "-7.0", 4), "d.epw"); }), HasSubstr("minute 0"));
}

TEST(Epw, AWrongZoneShowsAsSunAtNight) {
  std::string text = read_text(kDenver);
  text.replace(text.find("-7.0,1650"), 4, " 7.0");
  EXPECT_THAT(message_of([&] { parse_weather(text, "d.epw"); }), HasSubstr("wrong time zone"));
}

TEST(Epw, RefusesWithThePlace) {
  std::vector<Row> rows = night();
  rows[1].dry = "80";
  EXPECT_THAT(refused(rows), HasSubstr("d.epw:5: error: air_temperature = 353.15 K is out of range; 173 to 343"));
  rows[1].dry = "x";
  EXPECT_THAT(refused(rows), HasSubstr("d.epw:5:18: error: 'x' is not a number"));
  rows = night();
  rows[2].hour = 2;
  EXPECT_THAT(refused(rows), HasSubstr("d.epw:6: error: this row is 0 s after the one before"));
  // The same under a year that is asked for: it was taken for a second year.
  EXPECT_THAT(message_of([&] { parse_weather(epw(rows), "d.epw", {.year = 2001}); }),
              HasSubstr("d.epw:6: error: the row is not later than the one before"));
  rows[2].hour = 3, rows[3].year = 2004, rows[3].hour = 1;
  EXPECT_THAT(message_of([&] { parse_weather(epw(rows), "d.epw", {.year = 2001}); }), HasSubstr("more than a year"));
  rows = night();
  rows[0].month = 4, rows[0].day = 31;
  EXPECT_THAT(refused(rows), HasSubstr("month 4 has no day 31"));
  rows = night();
  for (Row& r : rows) r.year = 1961;
  EXPECT_THAT(refused(rows), HasSubstr("the year 1961 is outside of 1973 to 2198"));
  EXPECT_NO_THROW(parse_weather(epw(rows), "d.epw", {.year = 2001}));
  EXPECT_THAT(message_of([&] { parse_weather(epw(night(), "-20"), "d.epw"); }), HasSubstr("time zone = -20"));
  EXPECT_THAT(message_of([&] { parse_weather("LOCATION,a,b,c,d,e,1,1,1,1\n", "d.epw"); }),
              HasSubstr("no line of DATA PERIODS"));
  EXPECT_THAT(message_of([&] { parse_weather(epw(night()), "d.epw", {.utc_offset = 0.0}); }),
              HasSubstr("a UTC offset is given for weather of EPW"));
}

// Checked by hand against the rows of the file: 02/27/1995 14:00, 03/02/2005.
TEST(Tmy3, RowsAndTraps) {
  const Weather w = read_weather(kSandPoint);
  EXPECT_EQ(to_iso8601(w.clock().utc(0), 0), "1995-02-27T09:00:00Z");
  EXPECT_EQ(w.table().rows.size(), 96u);
  EXPECT_THAT(w.notes(), Contains("a typical year of months of 1995, 2005: all are placed in 1995"));
  EXPECT_THAT(w.notes(), Contains("times are local standard time, UTC-9 h, without daylight saving"));
  const double t = w.clock().seconds(parse_iso8601("1995-02-27T23:00:00Z"));
  EXPECT_NEAR(w.mean(Q::global, t - 3600, t), 317, 1e-9);
  EXPECT_NEAR(w.mean(Q::direct_normal, t - 3600, t), 238, 1e-9);
  EXPECT_NEAR(w.mean(Q::diffuse, t - 3600, t), 211, 1e-9);
  EXPECT_NEAR(w.at(Q::air_temperature, t), 273.15 + 5.5, 1e-9);
  EXPECT_NEAR(w.at(Q::pressure, t), 101200, 1e-6);
  EXPECT_NEAR(w.at(Q::cloud_cover, t), 0.9, 1e-9);
  EXPECT_NEAR(w.site().longitude_deg, -160.517, 1e-12);
  // TMY3 has no infrared.
  EXPECT_THAT(
      w.notes(),
      Contains(HasSubstr(
          "longwave_down is modelled (Dilley & O'Brien 1998, clouds after Unsworth & Monteith 1975): 96 of 96")));
  EXPECT_TRUE(w.table().meaning_of(Q::longwave_down) == WeatherMeaning::instant);
  EXPECT_EQ(w.table().rows[0].value(Q::precipitation), 0) << "nothing in 99 hours, which are unknown ones";
}

TEST(Tmy3, MissingAndRefused) {
  const std::string whole = read_text(kSandPoint);
  const auto with = [&](const char* from, const char* to) {
    std::string text = whole;
    text.replace(text.find(from), std::string(from).size(), to);
    return text;
  };
  const Weather w = parse_weather(with("A,7,6.1,A,7", "A,7,-9900,A,7"), "t.csv");
  EXPECT_THAT(w.notes(), Contains("wind_speed is missing: 1 of 96 rows, first in line 3"));
  EXPECT_THAT(message_of([&] { parse_weather(with("DNI (W/m^2)", "DNI (kW/m^2)"), "t.csv"); }),
              HasSubstr("t.csv:2:1: error: no column 'DNI (W/m^2)'"));
  EXPECT_THAT(message_of([&] { parse_weather(with("02/27/1995,02:00", "02/30/1995,02:00"), "t.csv"); }),
              HasSubstr("t.csv:4:1: error: there is no day 30 of month 2"));
  EXPECT_THAT(message_of([&] { parse_weather(with("02/27/1995,02:00", "02/27/1995,2:00"), "t.csv"); }),
              HasSubstr("t.csv:4:12: error: '2:00' is not a date and time"));
}

}  // namespace
}  // namespace suite::format_weather_typical_years_test
