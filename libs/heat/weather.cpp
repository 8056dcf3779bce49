#include "heat/weather.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "heat/sun_table.h"
#include "heat/weather_completion.h"
#include "spectral/planck.h"

namespace suite {

namespace {

using Q = WeatherQuantity;

// Light on a level plane by the sine of the sun's elevation, smooth through the horizon.
double level_pace(double sine) {
  constexpr double kTwilight = 0.02;
  return kTwilight * std::log1p(std::exp(sine / kTwilight));
}
// The beam: there from when the upper edge is seen (34' of refraction, 16' of radius: 0.83 degrees below), within a
// degree.
double beam_pace(double sine) {
  constexpr double kUpperEdge = 0.0145, kSoftness = 0.005;
  return 1 / (1 + std::exp(-(sine + kUpperEdge) / kSoftness));
}

WeatherSeries::Pace pace_of(Q quantity, std::shared_ptr<const SunTable> sun) {
  switch (quantity) {
    case Q::global:
    case Q::diffuse:
    case Q::shortwave_up:
      return [sun = std::move(sun)](double t) { return level_pace(sun->at(t).sine); };
    case Q::direct_normal:
      return [sun = std::move(sun)](double t) { return beam_pace(sun->at(t).sine); };
    default:
      return {};
  }
}

// Azimuths without jumps: each the shorter way round from the one before, none below 0 (as means must not be).
void unwrap(std::vector<double>& azimuths) {
  double last = kMissing, lowest = 0;
  for (double& a : azimuths) {
    if (std::isnan(a)) continue;
    if (!std::isnan(last)) a = last + std::remainder(a - last, 2 * kPi);
    last = a;
    lowest = std::min(lowest, a);
  }
  const double turns = std::ceil(-lowest / (2 * kPi));
  for (double& a : azimuths) a += 2 * kPi * turns;
}

WeatherSeries series_of(const WeatherTable& table, Q quantity, const std::shared_ptr<const SunTable>& sun) {
  std::vector<double> begins, ends, values;
  for (size_t i = 0; i < table.rows.size(); ++i) {
    begins.push_back(table.begin(i));
    ends.push_back(table.rows[i].end);
    values.push_back(table.rows[i].value(quantity));
  }
  if (quantity == Q::wind_from) unwrap(values);
  if (table.meaning_of(quantity) == WeatherMeaning::mean)
    return WeatherSeries::of_means(begins, ends, values,
                                   table.airless() ? WeatherSeries::Pace{} : pace_of(quantity, sun));
  ends.insert(ends.begin(), begins.front());
  values.insert(values.begin(), values.front());
  return WeatherSeries::of_instants(ends, values, table.step + kStampSlack);
}

// Polynomials of what is never below 0 miss 0 by rounding.
double settled(Q quantity, double value) {
  if (quantity == Q::wind_from) return std::remainder(value, 2 * kPi);
  return value < 0 ? 0 : value;
}

// A day of rows of minutes that ends at 23:59 lacks the step to midnight: the last row holds that long.
void close_last_day(WeatherTable& table) {
  constexpr double kLongest = 600, kDay = 86400;
  if (table.rows.empty() || !(table.step > 0) || table.step > kLongest) return;
  const double covered = table.rows.back().end - table.rows.front().end + table.step;
  if (std::fabs(std::remainder(covered, kDay)) > kStampSlack) return;
  WeatherRow more = table.rows.back();
  more.end += table.step;
  table.rows.push_back(more);
  table.notes.push_back(strf("the last row is held for %g s more, to the end of its day", table.step));
}

}  // namespace

Weather::Weather(WeatherTable table, LongwaveModel longwave)
    : table_(std::move(table)), clock_(table_.epoch), frame_(table_.site) {
  close_last_day(table_);
  const auto sun = std::make_shared<const SunTable>(table_);
  complete_weather(table_, longwave, *sun);
  for (size_t i = 0; i < kWeatherQuantities; ++i) series_[i] = series_of(table_, weather_quantity(i), sun);
}

double Weather::at(Q quantity, double t) const {
  return settled(quantity, series_[static_cast<size_t>(quantity)].at(t));
}

double Weather::mean(Q quantity, double begin, double end) const {
  return settled(quantity, series_[static_cast<size_t>(quantity)].mean(begin, end));
}

void Weather::require(Q quantity, double begin, double end) const {
  if (!std::isnan(mean(quantity, begin, end))) return;
  const std::string name(weather_info(quantity).name);
  const Where whole{table_.file, 0, 0, {}, -1};
  const auto time = [&](double t) { return to_iso8601(clock_.utc(t), 0); };
  if (!has(quantity)) throw Error(whole, "the weather has no " + name);
  if (begin < span().begin || end > span().end)
    throw Error(whole, "the weather does not cover " + time(begin) + " to " + time(end),
                "it goes from " + time(span().begin) + " to " + time(span().end));
  for (size_t i = 0; i < table_.rows.size(); ++i) {
    const WeatherRow& row = table_.rows[i];
    // An instant counts until the next one.
    const bool instant = table_.meaning_of(quantity) == WeatherMeaning::instant && i + 1 < table_.rows.size();
    if (table_.rows[i + (instant ? 1 : 0)].end <= begin) continue;
    const bool gap = i > 0 && table_.begin(i) != table_.rows[i - 1].end;
    if (gap || std::isnan(row.value(quantity)))
      throw Error(table_.where(i), gap ? "rows are missing before this one" : name + " is missing in this row",
                  "it is needed from " + time(begin) + " to " + time(end));
  }
  throw Error(whole, name + " is not known from " + time(begin) + " to " + time(end));
}

double Weather::sky_temperature(double t) const { return std::pow(at(Q::longwave_down, t) / kStefanBoltzmann, 0.25); }

}  // namespace suite
