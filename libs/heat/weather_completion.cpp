#include "heat/weather_completion.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {

using Q = WeatherQuantity;

constexpr double kSunAtOneUnit = 1361.1;  // W/m2; C. Gueymard, Solar Energy 168, 2018
constexpr double kLowestSine = 0.065;     // 3.7 degrees: below, what a level plane gets says nothing of the beam
constexpr double kLit = 10;               // W/m2, more than any instrument's noise at night
constexpr double kDeepNight = -6 * kDegree;

// Rows of which something is true.
struct Tally {
  size_t count = 0;
  int first_line = 0;
  void add(const WeatherRow& row) {
    if (count++ == 0) first_line = row.line;
  }
  std::string text(size_t rows) const { return strf("%zu of %zu rows, first in line %d", count, rows, first_line); }
};

void say(WeatherTable& table, const Tally& tally, const std::string& what) {
  if (tally.count) table.notes.push_back(what + ": " + tally.text(table.rows.size()));
}

bool any(const WeatherTable& table, Q q) {
  return std::any_of(table.rows.begin(), table.rows.end(),
                     [q](const WeatherRow& r) { return std::isfinite(r.value(q)); });
}

std::string name(Q q) { return std::string(weather_info(q).name); }

void check_ranges(const WeatherTable& table) {
  const bool airless = table.airless();
  for (size_t i = 0; i < table.rows.size(); ++i)
    for (size_t k = 0; k < kWeatherQuantities; ++k) {
      const WeatherQuantityInfo& info = weather_info(weather_quantity(k));
      const double v = table.rows[i].values[k];
      const Q q = weather_quantity(k);
      if (airless && v == 0 && (q == Q::pressure || q == Q::longwave_down)) continue;
      if (!std::isnan(v) && !(v >= info.low && v <= info.high))
        throw Error(
            table.where(i),
            strf("%s = %g %s is out of range", std::string(info.name).c_str(), v, std::string(info.unit).c_str()),
            strf("%g to %g", info.low, info.high));
    }
}

void count_missing(WeatherTable& table) {
  std::string nowhere;
  for (size_t k = 0; k < kWeatherQuantities; ++k) {
    const Q q = weather_quantity(k);
    Tally missing;
    for (const WeatherRow& row : table.rows)
      if (std::isnan(row.value(q))) missing.add(row);
    if (missing.count == table.rows.size())
      nowhere += (nowhere.empty() ? "" : ", ") + name(q);
    else
      say(table, missing, name(q) + " is missing");
  }
  if (!nowhere.empty()) table.notes.push_back("not in the file: " + nowhere);
  size_t gaps = 0;
  for (size_t i = 1; i < table.rows.size(); ++i) gaps += table.begin(i) != table.rows[i - 1].end;
  if (gaps) table.notes.push_back(strf("rows are missing in %zu places", gaps));
}

void settle(WeatherTable& table) {
  Tally negative, humid;
  for (WeatherRow& row : table.rows) {
    bool below = false;
    for (const Q q : {Q::global, Q::direct_normal, Q::diffuse, Q::shortwave_up})
      if (row.value(q) < 0) row.value(q) = 0, below = true;
    if (below) negative.add(row);
    if (row.value(Q::relative_humidity) > 1) row.value(Q::relative_humidity) = 1, humid.add(row);
    if (row.value(Q::wind_speed) == 0) row.value(Q::wind_from) = kMissing;
  }
  say(table, negative, "shortwave below 0 is taken as 0");
  say(table, humid, "relative humidity above 1 is taken as 1");
}

void complete_humidity(WeatherTable& table) {
  const bool dew = any(table, Q::dew_point), humidity = any(table, Q::relative_humidity);
  if (!dew) table.meaning_of(Q::dew_point) = table.meaning_of(Q::relative_humidity);
  if (!humidity) table.meaning_of(Q::relative_humidity) = table.meaning_of(Q::dew_point);
  Tally dews, humidities;
  for (WeatherRow& row : table.rows) {
    const double air = row.value(Q::air_temperature);
    double &d = row.value(Q::dew_point), &h = row.value(Q::relative_humidity);
    if (std::isnan(air)) continue;
    // Below 0.1 % the dew point is none that a formula is known for.
    if (std::isnan(d) && h >= 0.001)
      d = dew_point_of(h, air), dews.add(row);
    else if (std::isnan(h) && !std::isnan(d))
      h = std::min(1.0, relative_humidity_of(d, air)), humidities.add(row);
  }
  say(table, dews, "dew_point from relative_humidity (Bolton 1980)");
  say(table, humidities, "relative_humidity from dew_point (Bolton 1980)");
}

// The three kinds of shortwave from above, which must mean the same.
WeatherMeaning meaning_of_light(WeatherTable& table) {
  WeatherMeaning meaning = table.meaning_of(Q::global);
  bool first = true;
  for (const Q q : {Q::global, Q::direct_normal, Q::diffuse}) {
    if (!any(table, q)) continue;
    if (!first && table.meaning_of(q) != meaning)
      throw Error(Where{table.file, 0, 0, {}, -1},
                  name(q) + " is a mean and others are instants, or the other way round",
                  "global, direct_normal and diffuse mean the same");
    meaning = table.meaning_of(q);
    first = false;
  }
  for (const Q q : {Q::global, Q::direct_normal, Q::diffuse}) table.meaning_of(q) = meaning;
  return meaning;
}

double brightest(const WeatherRow& row) {
  double most = 0;
  for (const Q q : {Q::global, Q::direct_normal, Q::diffuse}) most = std::fmax(most, row.value(q));
  return most;
}

void refuse_night_sun(const WeatherTable& table, WeatherMeaning meaning, const SunTable& sun) {
  for (size_t i = 0; i < table.rows.size(); ++i) {
    const WeatherRow& row = table.rows[i];
    if (!(brightest(row) > kLit)) continue;
    double highest = sun.at(row.end).sine;
    if (meaning == WeatherMeaning::mean) {
      const double begin = table.begin(i);
      highest = std::max({highest, sun.at(begin).sine, sun.at((begin + row.end) / 2).sine});
    }
    if (highest >= std::sin(kDeepNight)) continue;
    throw Error(table.where(i),
                strf("the sun shines (%g W/m2) while it is %.0f degrees below the horizon of %g, %g", brightest(row),
                     -std::asin(highest) / kDegree, table.site.latitude_deg, table.site.longitude_deg),
                "wrong time zone, longitude or date? Times of weather files are standard time without daylight saving");
  }
}

// Shortwave of one row: what is given, and the sine of the sun's elevation that belongs to it.
struct Light {
  double &global, &direct, &diffuse;
  double sine = 0, outside = 0;  // W/m2 on a plane that faces the sun, above the air
};

struct Filled {
  Tally global, direct, diffuse, split, contradiction;
};

void fill(Light light, const WeatherRow& row, Filled& filled) {
  const bool g = !std::isnan(light.global), b = !std::isnan(light.direct), d = !std::isnan(light.diffuse);
  if (g && b && d) {
    if (std::abs(light.direct * light.sine + light.diffuse - light.global) > 0.15 * light.global + 25)
      filled.contradiction.add(row);
  } else if (b && d) {
    light.global = light.direct * light.sine + light.diffuse;
    filled.global.add(row);
  } else if (g && b) {
    light.diffuse = std::max(0.0, light.global - light.direct * light.sine);
    filled.diffuse.add(row);
  } else if (g && d) {
    const double level = std::max(0.0, light.global - light.diffuse);
    light.direct = light.sine > kLowestSine ? std::min(level / light.sine, light.outside) : 0;
    filled.direct.add(row);
  } else if (g) {
    const double share = light.sine > kLowestSine ? diffuse_share(light.global / (light.outside * light.sine)) : 1;
    light.direct = share < 1 ? std::min((1 - share) * light.global / light.sine, light.outside) : 0;
    light.diffuse = light.global - light.direct * light.sine;
    filled.split.add(row);
  }
}

void complete_light(WeatherTable& table, WeatherMeaning meaning, const SunTable& sun) {
  Filled filled;
  for (size_t i = 0; i < table.rows.size(); ++i) {
    WeatherRow& row = table.rows[i];
    Light light{row.value(Q::global), row.value(Q::direct_normal), row.value(Q::diffuse)};
    const SunTable::Place place = sun.at(row.end);
    light.sine = meaning == WeatherMeaning::mean ? sun.mean_sine(table.begin(i), row.end) : std::max(0.0, place.sine);
    light.outside = kSunAtOneUnit / (place.distance * place.distance);
    fill(light, row, filled);
  }
  say(table, filled.contradiction, "direct_normal and diffuse differ from global by more than 15 % + 25 W/m2");
  say(table, filled.global, "global from direct_normal and diffuse");
  say(table, filled.diffuse, "diffuse from global and direct_normal");
  say(table, filled.direct, "direct_normal from global and diffuse");
  say(table, filled.split, "direct_normal and diffuse from global alone (Erbs et al. 1982)");
}

// Light whose middle is not where the sun is highest: an hour of daylight saving, stamps that begin intervals.
void say_late_light(WeatherTable& table, const SunTable& sun) {
  double light = 0, late = 0, expected = 0, expected_late = 0, hours = 0;
  for (size_t i = 0; i < table.rows.size(); ++i) {
    const double g = table.rows[i].value(Q::global), begin = table.begin(i), end = table.rows[i].end;
    if (std::isnan(g)) continue;
    const double sine = sun.mean_sine(begin, end), angle = sun.at((begin + end) / 2).hour_angle;
    light += g, late += g * angle;
    expected += sine, expected_late += sine * angle;
    if (sine > 0) hours += (end - begin) / 3600;
  }
  if (!(hours >= 200 && light > 0 && expected > 0)) return;
  const double shift = (late / light - expected_late / expected) * 12 / kPi;
  if (std::abs(shift) > 0.5)
    table.notes.push_back(
        strf("the light of the days is centred %.1f h %s noon: daylight saving, a wrong time zone, or "
             "stamps that begin their intervals?",
             std::abs(shift), shift > 0 ? "after" : "before"));
}

void complete_longwave(WeatherTable& table, LongwaveModel model) {
  if (!any(table, Q::longwave_down)) table.meaning_of(Q::longwave_down) = table.meaning_of(Q::air_temperature);
  Tally modelled, clear;
  for (WeatherRow& row : table.rows) {
    if (!std::isnan(row.value(Q::longwave_down))) continue;
    const double air = row.value(Q::air_temperature), dew = row.value(Q::dew_point);
    if (std::isnan(air) || std::isnan(dew)) continue;
    double cover = row.value(Q::opaque_cover);
    if (std::isnan(cover)) cover = row.value(Q::cloud_cover);
    if (std::isnan(cover)) cover = 0, clear.add(row);
    row.value(Q::longwave_down) = modelled_longwave(model, air, dew, cover);
    modelled.add(row);
  }
  say(table, modelled, "longwave_down is modelled (" + std::string(longwave_model_name(model)) + ")");
  say(table, clear, "longwave_down is that of a sky without clouds, for no cover is given");
}

}  // namespace

void complete_weather(WeatherTable& table, LongwaveModel model, const SunTable& sun) {
  check_ranges(table);
  if (table.airless()) {
    meaning_of_light(table);
    count_missing(table);
    settle(table);
    table.notes.push_back(
        "the pressure is 0: there is no air, nothing is checked against the Earth's sun or modelled in place of what "
        "is "
        "missing");
    return;
  }
  const WeatherMeaning light = meaning_of_light(table);
  refuse_night_sun(table, light, sun);
  count_missing(table);
  settle(table);
  complete_humidity(table);
  complete_light(table, light, sun);
  if (light == WeatherMeaning::mean) say_late_light(table, sun);
  complete_longwave(table, model);
}

}  // namespace suite
