#include "heat/air_through.h"

#include <algorithm>

namespace suite {

AirThrough::AirThrough(const SurfaceLoads& loads) : loads_(loads) {
  kelvin_ = lines_of(loads.air.kelvin), wind_ = lines_of(loads.air.wind), vapour_ = lines_of(loads.air.vapour_pressure);
  const AveragedTable wind(loads.air.times, loads.air.wind, AveragedTable::Between::linear, loads.air.repeat);
  double t = loads.begin;
  for (const double dt : loads.steps) {
    gusts_.push_back(wind.deviation(t, t + dt));
    t += dt;
  }
}

std::vector<StepLine> AirThrough::lines_of(const std::vector<double>& values) const {
  const AveragedTable table(loads_.air.times, values, AveragedTable::Between::linear, loads_.air.repeat);
  std::vector<StepLine> lines;
  double t = loads_.begin;
  for (const double dt : loads_.steps) {
    lines.push_back(table.over(t, t + dt));
    t += dt;
  }
  return lines;
}

AirThrough::Air AirThrough::at(size_t step, double fraction) const {
  return {kelvin_[step].at(fraction), wind_[step].at(fraction), gusts_[step], vapour_[step].at(fraction)};
}

AirThrough::Air AirThrough::around(size_t moment) const {
  const size_t last = gusts_.size() - 1;
  const Air before = at(moment > 0 ? moment - 1 : 0, moment > 0 ? 1 : 0);
  const Air after = at(std::min(moment, last), moment > last ? 1 : 0);
  return {(before.kelvin + after.kelvin) / 2, (before.wind + after.wind) / 2, (before.gusts + after.gusts) / 2,
          (before.vapour + after.vapour) / 2};
}

FaceWeather AirThrough::weather(const Air& air) const {
  FaceWeather w;
  w.pressure = loads_.air.pressure;
  w.air_kelvin = air.kelvin, w.wind = air.wind, w.gusts = air.gusts, w.vapour_pressure = air.vapour;
  return w;
}

FixedLaw AirThrough::law_of(const FaceTraits& face) const {
  FixedLaw law;
  if (!face.convection || face.convection->asks_surface()) return law;
  if (face.wetness == 0) {
    std::vector<double> coefficient, times_air;
    for (size_t i = 0; i < loads_.air.times.size(); ++i) {
      const double air = loads_.air.kelvin[i];
      coefficient.push_back(face.convection->coefficient({air, air, loads_.air.wind[i], 1, true, loads_.air.pressure}));
      times_air.push_back(coefficient.back() * air);
    }
    law.coefficient = lines_of(coefficient), law.times_air = lines_of(times_air);
  }
  const auto film = [&](const Air& air) { return film_of(face, weather(air), air.kelvin); };
  for (size_t step = 0; step < gusts_.size(); ++step)
    law.film_begin.push_back(film(at(step, 0))), law.film_end.push_back(film(at(step, 1)));
  for (size_t moment = 0; moment <= gusts_.size(); ++moment) law.film_at.push_back(film(around(moment)));
  return law;
}

}  // namespace suite
