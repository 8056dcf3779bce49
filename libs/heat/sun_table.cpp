#include "heat/sun_table.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace suite {

namespace {
constexpr double kDay = 86400;
double whole_day(double t) { return std::floor(t / kDay); }

std::vector<double> ends_of(const WeatherTable& table) {
  std::vector<double> ends;
  ends.reserve(table.rows.size());
  for (const WeatherRow& row : table.rows) ends.push_back(row.end);
  return ends;
}
}  // namespace

SunTable::SunTable(const Geodetic& site, const Clock& clock, std::span<const double> times, double before)
    : latitude_(site.latitude_deg * kDegree), longitude_(site.longitude_deg * kDegree) {
  const SceneFrame frame(site);
  for (const double t : times)
    for (double day = whole_day(t - before); day <= whole_day(t) + 1; ++day) {
      if (!days_.empty() && days_.back().day >= static_cast<int64_t>(day)) continue;
      const SkyBody sun = sun_at(frame, {}, clock.at(kDay * day));
      const Dir d = frame.ecef_direction(sun.direction);
      days_.push_back({static_cast<int64_t>(day), std::asin(d.z), std::atan2(d.y, d.x), sun.distance});
    }
}

SunTable::SunTable(const WeatherTable& table)
    : SunTable(table.site, Clock(table.epoch), ends_of(table), table.step + kStampSlack) {}

SunTable::Place SunTable::at(double t) const {
  const int64_t day = static_cast<int64_t>(whole_day(t));
  const auto found =
      std::lower_bound(days_.begin(), days_.end(), day, [](const Day& d, int64_t wanted) { return d.day < wanted; });
  SUITE_CHECK(found != days_.end() && found + 1 != days_.end() && found->day == day && (found + 1)->day == day + 1);
  const Day &a = *found, &b = *(found + 1);
  const double share = t / kDay - static_cast<double>(day);
  const double declination = a.declination + share * (b.declination - a.declination);
  // The point below the sun runs west once a day, and a little slower or faster.
  const double below = a.longitude + share * (std::remainder(b.longitude - a.longitude, 2 * kPi) - 2 * kPi);
  Place place;
  place.hour_angle = std::remainder(longitude_ - below, 2 * kPi);
  place.sine = std::sin(latitude_) * std::sin(declination) +
               std::cos(latitude_) * std::cos(declination) * std::cos(place.hour_angle);
  place.distance = (a.distance + share * (b.distance - a.distance)) / kAstronomicalUnit;
  return place;
}

double SunTable::mean_sine(double begin, double end) const {
  const int steps = std::clamp(static_cast<int>(std::ceil((end - begin) / 600)), 1, 144);
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += std::max(0.0, at(begin + (end - begin) * (i + 0.5) / steps).sine);
  return sum / steps;
}

}  // namespace suite
