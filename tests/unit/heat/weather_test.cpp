// Weather from tables: what is completed, refused and said.
#include "heat/weather.h"

#include "heat/sun_table.h"
#include "spectral/planck.h"
#include "support/weather_kit.h"

namespace suite::weather_test {
namespace {

// Hours of UTC from midnight on, 40 N 105 W, each with 10 C, half humid, 2 m/s of west wind.
WeatherTable hours(size_t n, const char* begin = "2003-06-10T00:00:00Z") {
  WeatherTable t;
  t.file = "w";
  t.site = {40, -105, 1600};
  t.meaning = usual_meanings();
  std::vector<Instant> ends;
  for (size_t i = 0; i < n; ++i) {
    WeatherRow row;
    row.line = static_cast<int>(i) + 10;
    row.value(Q::air_temperature) = 283.15;
    row.value(Q::relative_humidity) = 0.5;
    row.value(Q::wind_speed) = 2;
    row.value(Q::wind_from) = kPi;
    t.rows.push_back(row);
    ends.push_back(instant_from_utc(parse_iso8601(begin)) + 3600.0 * static_cast<double>(i + 1));
  }
  set_stamps(t, ends);
  return t;
}

// A beam of 800 W/m2 where the sun is not low, and a sky of 200 W/m2 times its sine; `late` by some seconds.
void shine(WeatherTable& t, double late = 0) {
  std::vector<double> ends;
  for (const WeatherRow& r : t.rows) ends.push_back(r.end);
  const SunTable sun(t.site, Clock(t.epoch), ends, 86400);
  for (size_t i = 0; i < t.rows.size(); ++i) {
    const double sine = sun.mean_sine(t.begin(i) - late, t.rows[i].end - late);
    const double beam = sine > 0.05 ? 800 : 0;
    t.rows[i].value(Q::direct_normal) = beam;
    t.rows[i].value(Q::diffuse) = 200 * sine;
    t.rows[i].value(Q::global) = (beam + 200) * sine;
  }
}

TEST(Weather, ClockAndSpan) {
  const Weather w(hours(24));
  EXPECT_EQ(to_iso8601(w.clock().utc(0), 0), "2003-06-10T00:00:00Z");
  EXPECT_NEAR(w.span().begin, 0, 1e-6);
  EXPECT_NEAR(w.span().end, 86400, 1e-6);
  EXPECT_EQ(w.at(Q::wind_speed, 1800), 2) << "an instant holds back over the first interval";
  EXPECT_TRUE(std::isnan(w.at(Q::wind_speed, -1)) && std::isnan(w.at(Q::wind_speed, 86401)));
  EXPECT_TRUE(w.has(Q::wind_speed));
  EXPECT_FALSE(w.has(Q::snow_depth));
  EXPECT_TRUE(std::isnan(w.at(Q::snow_depth, 1800)));
  // 19:00 UTC at 105 W is noon: the sun stands 90 - 40 + 23 degrees high.
  EXPECT_NEAR(w.sun(19 * 3600).elevation / kDegree, 73, 0.2);
}

TEST(Weather, AzimuthsGoTheShorterWay) {
  WeatherTable t = hours(6);
  const double from[] = {3.0, -3.0, -3.1, 3.1, 0.2, -0.2};
  for (size_t i = 0; i < 6; ++i) t.rows[i].value(Q::wind_from) = from[i];
  t.rows[4].value(Q::wind_speed) = 0;
  const Weather w(t);
  for (double s = 0; s <= 1; s += 0.1) EXPECT_GE(std::abs(w.at(Q::wind_from, 3600 * (1 + s))), 3 - 1e-12) << s;
  EXPECT_NEAR(std::abs(w.mean(Q::wind_from, 3600, 7200)), kPi, 0.1);
  EXPECT_TRUE(std::isnan(w.at(Q::wind_from, 3600 * 4.5))) << "a calm comes from nowhere";
}

TEST(Weather, HumidityIsCompletedBothWays) {
  WeatherTable t = hours(3);
  t.rows[1].value(Q::relative_humidity) = kMissing;
  t.rows[1].value(Q::dew_point) = 283.15;
  const Weather w(t);
  EXPECT_NEAR(w.at(Q::dew_point, 3600), dew_point_of(0.5, 283.15), 1e-9);
  EXPECT_NEAR(w.at(Q::relative_humidity, 7200), 1, 1e-9);
  EXPECT_THAT(w.notes(), Contains("dew_point from relative_humidity (Bolton 1980): 2 of 3 rows, first in line 10"));
  EXPECT_THAT(w.notes(), Contains("relative_humidity from dew_point (Bolton 1980): 1 of 3 rows, first in line 11"));
}

TEST(Weather, LongwaveIsModelledAndSaid) {
  WeatherTable t = hours(3);
  t.rows[0].value(Q::longwave_down) = 300;
  t.rows[1].value(Q::cloud_cover) = 0.9;
  t.rows[1].value(Q::opaque_cover) = 0.4;
  for (const LongwaveModel model :
       {LongwaveModel::dilley_obrien, LongwaveModel::clark_allen, LongwaveModel::brutsaert}) {
    const Weather w(t, model);
    const double dew = dew_point_of(0.5, 283.15);
    EXPECT_NEAR(w.table().rows[1].value(Q::longwave_down), modelled_longwave(model, 283.15, dew, 0.4), 1e-9);
    EXPECT_NEAR(w.mean(Q::longwave_down, 7200, 10800), modelled_longwave(model, 283.15, dew, 0), 1e-9);
    EXPECT_EQ(w.table().rows[0].value(Q::longwave_down), 300);
    EXPECT_THAT(w.notes(), Contains("longwave_down is modelled (" + std::string(longwave_model_name(model)) +
                                    "): 2 of 3 rows, first in line 11"));
    EXPECT_THAT(w.notes(), Contains(HasSubstr("a sky without clouds, for no cover is given: 1 of 3 rows")));
  }
  EXPECT_NEAR(std::pow(Weather(t).sky_temperature(1800), 4) * kStefanBoltzmann, Weather(t).at(Q::longwave_down, 1800),
              1e-9);
}

TEST(Weather, TheThirdKindOfLightFollowsFromTwo) {
  WeatherTable whole = hours(24);
  shine(whole);
  const Weather expected(whole);
  for (const Q gone : {Q::global, Q::direct_normal, Q::diffuse}) {
    WeatherTable t = whole;
    for (WeatherRow& r : t.rows) r.value(gone) = kMissing;
    const Weather w(t);
    for (size_t i = 0; i < t.rows.size(); ++i) {
      // In the hours of sunrise and sunset the beam is not known from what a level plane gets of it.
      if (gone == Q::direct_normal && whole.rows[i].value(Q::global) < 200) continue;
      EXPECT_NEAR(w.table().rows[i].value(gone), whole.rows[i].value(gone), 1e-6) << i;
    }
    EXPECT_THAT(w.notes(), Contains(HasSubstr(std::string(weather_info(gone).name) + " from ")));
  }
  EXPECT_THAT(expected.notes(), Not(Contains(HasSubstr("differ from global"))));
}

TEST(Weather, GlobalAloneIsSplit) {
  WeatherTable t = hours(24);
  shine(t);
  for (WeatherRow& r : t.rows) r.value(Q::direct_normal) = r.value(Q::diffuse) = kMissing;
  const Weather w(t);
  const SunTable sun(t);
  for (size_t i = 0; i < t.rows.size(); ++i) {
    const WeatherRow& r = w.table().rows[i];
    const double sine = sun.mean_sine(t.begin(i), r.end), distance = sun.at(r.end).distance;
    EXPECT_NEAR(r.value(Q::direct_normal) * sine + r.value(Q::diffuse), r.value(Q::global), 1e-9);
    if (sine < 0.3) continue;
    const double clearness = r.value(Q::global) * distance * distance / (1361.1 * sine);
    EXPECT_NEAR(r.value(Q::diffuse) / r.value(Q::global), diffuse_share(clearness), 1e-9);
  }
  EXPECT_THAT(w.notes(),
              Contains(HasSubstr("direct_normal and diffuse from global alone (Erbs et al. 1982): 24 of 24")));
}

// A sky and a beam that are simple functions of the sun, seen through means of hours.
TEST(Weather, LightRisesAndSetsWithTheSun) {
  WeatherTable t = hours(48);
  const SunTable sun(t);
  const auto level = [&](double time) { return 1000 * std::max(0.0, sun.at(time).sine); };
  const auto beam = [&](double time) { return sun.at(time).sine > -0.0145 ? 800.0 : 0.0; };
  const auto mean = [&](const auto& light, double begin, double end) {
    double sum = 0;
    for (int k = 0; k < 720; ++k) sum += light(begin + (end - begin) * (k + 0.5) / 720);
    return sum / 720;
  };
  std::vector<double> begins, ends, levels;
  for (size_t i = 0; i < t.rows.size(); ++i) {
    begins.push_back(t.begin(i)), ends.push_back(t.rows[i].end);
    levels.push_back(mean(level, begins[i], ends[i]));
    t.rows[i].value(Q::global) = levels[i];
    t.rows[i].value(Q::direct_normal) = mean(beam, begins[i], ends[i]);
  }
  const Weather w(t);
  const WeatherSeries without = WeatherSeries::of_means(begins, ends, levels);
  double worst = 0, worst_without = 0, worst_night = 0;
  for (double time = 0; time < 48 * 3600; time += 60) {
    const double sine = sun.at(time).sine;
    worst = std::max(worst, std::abs(w.at(Q::global, time) - level(time)));
    worst_without = std::max(worst_without, std::abs(without.at(time) - level(time)));
    if (sine < -0.08) worst_night = std::max({worst_night, w.at(Q::global, time), w.at(Q::direct_normal, time)});
    if (sine > 0.03) {
      EXPECT_NEAR(w.at(Q::direct_normal, time), 800, 40) << time;
    }
  }
  EXPECT_LT(worst, 20);
  EXPECT_GT(worst_without, 2 * worst) << "the negative control";
  EXPECT_LT(worst_night, 1);
  for (size_t i = 0; i < t.rows.size(); ++i) EXPECT_NEAR(w.mean(Q::global, begins[i], ends[i]), levels[i], 1e-9);
}

TEST(Weather, LightThatContradictsItselfIsSaid) {
  WeatherTable t = hours(24);
  shine(t);
  t.rows[18].value(Q::global) *= 0.7;
  t.rows[19].value(Q::global) *= 0.7;
  EXPECT_THAT(
      Weather(t).notes(),
      Contains(
          "direct_normal and diffuse differ from global by more than 15 % + 25 W/m2: 2 of 24 rows, first in line 28"));
  WeatherTable mixed = hours(24);
  shine(mixed);
  mixed.meaning_of(Q::diffuse) = WeatherMeaning::instant;
  EXPECT_THAT(message_of([&] { Weather w(mixed); }), HasSubstr("diffuse is a mean and others are instants"));
}

TEST(Weather, ASunAtNightIsRefused) {
  WeatherTable t = hours(24);
  t.rows[6].value(Q::global) = 11;  // 06:00 to 07:00 UTC, 23:00 to 24:00 there
  EXPECT_THAT(message_of([&] { Weather w(t); }), HasSubstr("w:16: error: the sun shines (11 W/m2) while it is 2"));
  EXPECT_THAT(message_of([&] { Weather w(t); }), HasSubstr("wrong time zone"));
  // The noise of an instrument is none.
  t.rows[6].value(Q::global) = 9;
  EXPECT_NO_THROW(Weather w(t));
  // Seven hours beside its zone.
  WeatherTable shifted = hours(24);
  shine(shifted, 7 * 3600);
  EXPECT_THAT(message_of([&] { Weather w(shifted); }), HasSubstr("wrong time zone"));
}

TEST(Weather, AnHourOfDaylightSavingIsSaid) {
  for (const double late : {0.0, 3600.0, -3600.0}) {
    WeatherTable t = hours(24 * 20);
    shine(t, late);
    const auto notes = Weather(t).notes();
    if (late == 0) {
      EXPECT_THAT(notes, Not(Contains(HasSubstr("centred"))));
    } else {
      EXPECT_THAT(notes, Contains(HasSubstr(late > 0 ? "centred 1.0 h after noon" : "centred 1.0 h before noon")));
    }
  }
}

TEST(Weather, WhatIsMissingIsCounted) {
  WeatherTable t = hours(4);
  t.rows[2].value(Q::wind_speed) = t.rows[3].value(Q::wind_speed) = kMissing;
  const Weather w(t);
  EXPECT_THAT(w.notes(), Contains("wind_speed is missing: 2 of 4 rows, first in line 12"));
  EXPECT_THAT(w.notes(), Contains(HasSubstr("not in the file: dew_point, pressure, global")));
  EXPECT_TRUE(std::isnan(w.at(Q::wind_speed, 3600 * 2.5)));
  EXPECT_EQ(w.at(Q::wind_speed, 3600 * 1.5), 2);
  WeatherTable gap = hours(6);
  gap.rows.erase(gap.rows.begin() + 3);
  EXPECT_THAT(Weather(gap).notes(), Contains("rows are missing in 1 places"));
  EXPECT_TRUE(std::isnan(Weather(gap).at(Q::air_temperature, 3600 * 3.5)));
}

TEST(Weather, WhatIsNeededIsThereOrSaid) {
  WeatherTable t = hours(6);
  t.rows[4].value(Q::air_temperature) = kMissing;
  const Weather w(t);
  const auto needed = [&](Q q, double begin, double end) {
    return message_of([&] { w.require(q, 3600 * begin, 3600 * end); });
  };
  EXPECT_EQ(needed(Q::air_temperature, 0, 4), "no error");
  EXPECT_THAT(
      needed(Q::air_temperature, 2, 4.5),
      HasSubstr("w:14: error: air_temperature is missing in this row; it is needed from 2003-06-10T02:00:00Z to"));
  EXPECT_THAT(needed(Q::air_temperature, 5.2, 5.5), HasSubstr("w:14: error"));
  EXPECT_THAT(needed(Q::pressure, 0, 1), HasSubstr("w: error: the weather has no pressure"));
  EXPECT_THAT(needed(Q::wind_speed, 5, 7),
              HasSubstr("the weather does not cover 2003-06-10T05:00:00Z to 2003-06-10T07:00:00Z; "
                        "it goes from 2003-06-10T00:00:00Z to 2003-06-10T06:00:00Z"));
  WeatherTable gap = hours(6);
  gap.rows.erase(gap.rows.begin() + 3);
  EXPECT_THAT(message_of([&] { Weather(gap).require(Q::wind_speed, 0, 6 * 3600); }),
              HasSubstr("w:14: error: rows are missing before this one"));
}

TEST(Weather, ValuesOutOfRangeAreRefusedWithTheirLine) {
  for (size_t k = 0; k < kWeatherQuantities; ++k) {
    const WeatherQuantityInfo& info = weather_info(weather_quantity(k));
    for (const double v : {info.low - 0.01, info.high + 0.01, 1e300}) {
      WeatherTable t = hours(24);
      t.rows[19].values[k] = v;
      EXPECT_THAT(message_of([&] { Weather w(t); }), HasSubstr("w:29: error: " + std::string(info.name) + " = ")) << v;
    }
  }
}

TEST(Weather, NoiseIsSettledAndSaid) {
  WeatherTable t = hours(3);
  t.rows[1].value(Q::global) = -3;
  t.rows[2].value(Q::relative_humidity) = 1.02;
  const Weather w(t);
  EXPECT_EQ(w.table().rows[1].value(Q::global), 0);
  EXPECT_EQ(w.at(Q::relative_humidity, 10800), 1);
  EXPECT_THAT(w.notes(), Contains("shortwave below 0 is taken as 0: 1 of 3 rows, first in line 11"));
  EXPECT_THAT(w.notes(), Contains("relative humidity above 1 is taken as 1: 1 of 3 rows, first in line 12"));
}

TEST(Weather, StampsOutOfOrderAreRefused) {
  WeatherTable t = hours(3);
  const Instant zero = instant_from_utc(t.epoch);
  EXPECT_THAT(message_of([&] {
                set_stamps(t, {zero, zero + 3600, zero + 3600});
              }),
              HasSubstr("w:12: error: this row is 0 s after the one before"));
  EXPECT_THAT(message_of([&] {
                set_stamps(t, {zero, zero + 86401.0, zero + 172802.0});
              }),
              HasSubstr("a row stands for 86401 s"));
  t.rows.resize(1);
  EXPECT_THAT(message_of([&] { set_stamps(t, {zero}); }), HasSubstr("weather of 1 rows"));
}

// The leap second at the end of 2005 lies between two stamps; it tears nothing apart.
TEST(Weather, RunsThroughALeapSecond) {
  WeatherTable t = hours(4, "2005-12-31T22:00:00Z");
  std::vector<Instant> ends;
  for (const char* stamp :
       {"2005-12-31T23:00:00Z", "2006-01-01T00:00:00Z", "2006-01-01T01:00:00Z", "2006-01-01T02:00:00Z"})
    ends.push_back(instant_from_utc(parse_iso8601(stamp)));
  EXPECT_EQ(ends[1] - ends[0], 3601);
  set_stamps(t, ends);
  for (WeatherRow& r : t.rows) r.value(Q::longwave_down) = 300;
  const Weather w(t);
  EXPECT_NEAR(w.mean(Q::longwave_down, 1, 4 * 3600), 300, 1e-9);
  EXPECT_EQ(w.at(Q::air_temperature, 3600 + 1800), 283.15);
}

}  // namespace
}  // namespace suite::weather_test
