#include "heat/weather_table.h"

#include <algorithm>

namespace suite {

using Q = WeatherQuantity;

const WeatherQuantityInfo& weather_info(WeatherQuantity quantity) {
  // Wider than the records of the Earth: -89.2 to 56.7 C, 870 to 1085 hPa at sea level and 330 hPa on Everest, 113 m/s,
  // and for radiation the noise of instruments at night and edges of clouds.
  static constexpr WeatherQuantityInfo kInfo[kWeatherQuantities] = {{"air_temperature", "K", 173, 343},
                                                                    {"dew_point", "K", 143, 343},
                                                                    {"relative_humidity", "1", 0, 1.1},
                                                                    {"pressure", "Pa", 30000, 110000},
                                                                    {"wind_speed", "m/s", 0, 120},
                                                                    {"wind_from", "rad", -4 * kPi, 4 * kPi},
                                                                    {"global", "W/m2", -50, 2000},
                                                                    {"direct_normal", "W/m2", -50, 1500},
                                                                    {"diffuse", "W/m2", -50, 1500},
                                                                    {"shortwave_up", "W/m2", -50, 1800},
                                                                    {"longwave_down", "W/m2", 30, 700},
                                                                    {"longwave_up", "W/m2", 30, 1200},
                                                                    {"precipitation", "kg/(m2 s)", 0, 0.2},
                                                                    {"cloud_cover", "1", 0, 1},
                                                                    {"opaque_cover", "1", 0, 1},
                                                                    {"snow_depth", "m", 0, 30}};
  return kInfo[static_cast<size_t>(quantity)];
}

bool WeatherTable::airless() const {
  return !rows.empty() && std::ranges::all_of(rows, [](const WeatherRow& r) { return r.value(Q::pressure) == 0; });
}

double WeatherTable::begin(size_t row) const {
  const double end = rows[row].end;
  if (row > 0 && end - rows[row - 1].end <= step + kStampSlack) return rows[row - 1].end;
  return end - step;
}

void set_stamps(WeatherTable& table, const std::vector<Instant>& ends) {
  SUITE_CHECK_EQ(table.rows.size(), ends.size());
  if (ends.size() < 2)
    throw Error(Where{table.file, 0, 0, {}, -1}, strf("weather of %zu rows", ends.size()), "two at least");
  std::vector<double> steps;
  steps.reserve(ends.size());
  for (size_t i = 1; i < ends.size(); ++i) {
    steps.push_back(ends[i] - ends[i - 1]);
    if (!(steps.back() > 0))
      throw Error(table.where(i), strf("this row is %g s after the one before", steps.back()), "stamps ascend");
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  table.step = *middle;
  if (table.step > kLongestStep)
    throw Error(table.where(1), strf("a row stands for %g s", table.step), "weather is resolved by the day at least");
  // The sun is asked for some days around.
  constexpr double kMargin = 5 * 86400;
  const Instant first = ends.front() + -table.step;
  try {
    utc_from_instant(first + -kMargin);
    utc_from_instant(ends.back() + kMargin);
    table.epoch = utc_from_instant(first);
  } catch (const Error& e) {
    throw Error(table.where(0), e.message(), e.hint());
  }
  const Clock clock(table.epoch);
  for (size_t i = 0; i < ends.size(); ++i) table.rows[i].end = clock.seconds(ends[i]);
}

std::array<WeatherMeaning, kWeatherQuantities> usual_meanings() {
  std::array<WeatherMeaning, kWeatherQuantities> meaning{};
  for (const Q q :
       {Q::global, Q::direct_normal, Q::diffuse, Q::shortwave_up, Q::longwave_down, Q::longwave_up, Q::precipitation})
    meaning[static_cast<size_t>(q)] = WeatherMeaning::mean;
  return meaning;
}

}  // namespace suite
