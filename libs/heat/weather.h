// The weather over a place and a time: what heats and cools a scene from above, at any moment and as means.
//
// Times are seconds of the weather's own clock (SI seconds after its epoch); clock().seconds(utc) makes them.
// Quantities, units and what is missing: weather_table.h. Interpolation: weather_series.h. Instants are met and not
// overshot (one holds back to the start of the first row's interval); means are kept over each interval. Means of light
// follow the sun in theirs: that on a level plane the sine of its elevation (w ln(1 + e^(sine/w)), w = 0.02, which
// leaves some twilight), the beam the part when its upper edge is up, so that no light of an hour of sunrise falls into
// its night.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "heat/sky_models.h"
#include "heat/weather_series.h"
#include "heat/weather_table.h"
#include "motion/ephemeris.h"
#include "motion/time_span.h"

namespace suite {

class Weather {
 public:
  // Completes and checks the table (weather_completion.h). Error, located: as there.
  explicit Weather(WeatherTable table, LongwaveModel longwave = LongwaveModel::dilley_obrien);

  // In the quantity's unit; NaN where it is missing and outside span(). Azimuths are -pi to pi.
  double at(WeatherQuantity quantity, double t) const;
  // Mean over begin..end; NaN unless all of it is known. Error: end before begin. Azimuths go the shorter way round.
  double mean(WeatherQuantity quantity, double begin, double end) const;
  // Error unless the quantity is known throughout begin..end: not in the file at all, outside of what the file covers,
  // or missing in between (with the line).
  void require(WeatherQuantity quantity, double begin, double end) const;
  // Whether it is known anywhere.
  bool has(WeatherQuantity quantity) const { return !series_[static_cast<size_t>(quantity)].empty(); }
  // The temperature of a black sky of the same downwelling longwave, K.
  double sky_temperature(double t) const;

  // The sun over the site, without refraction; ENU of the site.
  SkyBody sun(double t) const { return sun_at(frame_, {}, clock_.at(t)); }

  TimeSpan span() const { return {table_.begin(0), table_.rows.back().end}; }
  const Clock& clock() const { return clock_; }
  const Geodetic& site() const { return table_.site; }
  const WeatherTable& table() const { return table_; }  // completed
  const std::vector<std::string>& notes() const { return table_.notes; }

 private:
  WeatherTable table_;
  Clock clock_;
  SceneFrame frame_;
  std::array<WeatherSeries, kWeatherQuantities> series_;
};

}  // namespace suite
