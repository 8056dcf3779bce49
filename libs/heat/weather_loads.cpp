// Weather as what acts on faces: air, beam, radiance of the sky, infrared, on the moments of a span.
#include <algorithm>
#include <cmath>

#include "heat/heat_balance.h"
#include "heat/sky_models.h"
#include "light/kinds/clear_sky.h"
#include "light/kinds/solar_spectrum.h"
#include "light/perez_sky.h"

namespace suite {

namespace {

using Q = WeatherQuantity;

constexpr double kBlend = 3600;  // s before the end of a span that repeats, over which its end is led to its begin
constexpr double kLowestSun = 1.5 * kDegree;  // elevation below which spectra and the spread of skies are those of here

// A quantity on ascending times, led back to its first value where the span repeats.
std::vector<double> on_times(const std::vector<double>& times, const HeatSpec& spec,
                             const std::function<double(double)>& value) {
  std::vector<double> out;
  for (const double t : times) out.push_back(value(t));
  if (!spec.periodic) return out;
  const double gap = out.front() - out.back(), begin = std::max(times.front(), times.back() - kBlend);
  for (size_t k = 0; k < times.size(); ++k)
    if (times[k] > begin) out[k] += gap * (times[k] - begin) / (times.back() - begin);
  out.back() = out.front();
  return out;
}

// Shares of the bins in a spectrum.
std::vector<float> shares(const Curve& spectrum, const SpectralState& state) {
  std::vector<float> out;
  double sum = 0;
  for (const Bin& b : state.bins) {
    const double low = std::max(b.low_um, spectrum.low_um()), high = std::min(b.high_um, spectrum.high_um());
    out.push_back(static_cast<float>(high > low ? spectrum.integral(low, high) : 0));
    sum += double{out.back()};
  }
  for (float& v : out) v = static_cast<float>(v / sum);
  return out;
}

ClearSpectra clear_at(Dir sun) {
  const double elevation = std::max(std::asin(std::clamp(sun.z, -1.0, 1.0)), kLowestSun);
  return clear_spectra({}, {std::cos(elevation), 0, std::sin(elevation)}, solar_irradiance());
}

// Where the sun stands, from a table of every minute or less: within 3e-6 rad. Asked outside, its ends.
std::function<Dir(double)> sun_table(const std::function<SkyBody(double)>& sun, TimeSpan span) {
  const auto count = static_cast<size_t>(std::ceil((span.end - span.begin) / 60)) + 1;
  const double step = (span.end - span.begin) / static_cast<double>(count);
  std::vector<Dir> table;
  for (size_t k = 0; k <= count; ++k) table.push_back(sun(span.begin + step * static_cast<double>(k)).direction);
  return [table = std::move(table), begin = span.begin, step](double t) {
    const double x = std::clamp((t - begin) / step, 0.0, static_cast<double>(table.size() - 1));
    const auto k = std::min(static_cast<size_t>(x), table.size() - 2);
    return normalized(table[k] + (table[k + 1] - table[k]) * (x - static_cast<double>(k)));
  };
}

// Spectra of beam and sky: those of a clear sky with the sun at its height; of the sky in the middle of the light of
// clear skies, whatever the clouds: what is found of sunlight then holds for any weather. Without air the sun's own.
void set_spectra(SunCourse& course, bool airless) {
  const SpectralState state = sunlight_state();
  const std::vector<float> above = airless ? shares(solar_irradiance(), state) : std::vector<float>{};
  double weight = 0, height = 0;
  for (size_t k = 0; k < course.moments.size(); ++k) {
    const Dir d = course.towards(course.moments[k]);
    if (d.z > 0) {
      const ClearSpectra clear = clear_at(d);
      course.beam.push_back(airless ? above : shares(clear.direct, state));
      const double diffuse = clear.diffuse.integral(clear.diffuse.low_um(), clear.diffuse.high_um());
      weight += diffuse, height += diffuse * d.z;
    } else {
      course.beam.emplace_back(state.size(), 0.0f);
    }
  }
  const double z = weight > 0 ? height / weight : 0.5;
  course.sky = shares(clear_at({std::sqrt(1 - z * z), 0, z}).diffuse, state);
}

constexpr uint32_t kInside = 4;  // places of a part of the sky in each direction

// Those of all parts, part by part.
std::vector<Dir> places_of_sky() {
  std::vector<Dir> places;
  for (uint32_t r = 0; r < kSkyRings; ++r)
    for (uint32_t c = 0; c < kSkyTurns; ++c)
      for (uint32_t i = 0; i < kInside * kInside; ++i) {
        const double z = (r + (i / kInside + 0.5) / kInside) / kSkyRings;
        const double phi = 2 * kPi * (c + (i % kInside + 0.5) / kInside) / kSkyTurns, s = std::sqrt(1 - z * z);
        places.push_back({s * std::cos(phi), s * std::sin(phi), z});
      }
  return places;
}

// Radiance of the sky's parts with the given irradiance of level ground.
std::vector<float> patches(Dir sun, double direct, double diffuse, double extraterrestrial) {
  std::vector<float> out(kSkyPatches, 0.0f);
  if (!(diffuse > 0)) return out;
  const double zenith = std::min(polar_angle(sun), kPi / 2 - kLowestSun);
  const PerezSky sky(zenith, direct, diffuse, extraterrestrial, air_mass(zenith));
  static const std::vector<Dir> places = places_of_sky();
  double level = 0;
  for (size_t p = 0; p < kSkyPatches; ++p) {
    double sum = 0;
    for (size_t i = 0; i < kInside * kInside; ++i) {
      const Dir d = places[p * kInside * kInside + i];
      const double radiance = sky.at(d.z, angle_between(d, sun));
      sum += radiance, level += radiance * d.z;
    }
    out[p] = static_cast<float>(sum / (kInside * kInside));
  }
  const double scale = diffuse / (level / (kInside * kInside) * kSkyPatch);
  for (float& v : out) v = static_cast<float>(v * scale);
  return out;
}

}  // namespace

WeatherLoads weather_loads(const HeatWeather& w, const HeatSpec& spec) {
  const double length = spec.span.end - spec.span.begin;
  const auto steps = static_cast<size_t>(std::max(1.0, std::round(length / spec.step)));
  const double step = length / static_cast<double>(steps);
  for (const Q q : {Q::air_temperature, Q::wind_speed, Q::longwave_down, Q::direct_normal, Q::diffuse})
    w.weather.require(q, w.clock(spec.span.begin), w.clock(spec.span.end));
  WeatherLoads out;
  for (size_t k = 0; k <= steps; ++k) out.moments.push_back(spec.span.begin + step * static_cast<double>(k));
  out.moments.back() = spec.span.end;

  // Air: as fine as the file has it, so that gusts are averaged and not left out.
  const double fine = std::clamp(w.weather.table().step / 2, length / 200000, step / 2);
  const auto samples = static_cast<size_t>(std::ceil(length / fine));
  for (size_t k = 0; k <= samples; ++k)
    out.air.times.push_back(spec.span.begin + length * static_cast<double>(k) / static_cast<double>(samples));
  const auto at = [&](Q q) { return [&w, q](double t) { return w.weather.at(q, w.clock(t)); }; };
  out.air.kelvin = on_times(out.air.times, spec, at(Q::air_temperature));
  out.air.wind = on_times(out.air.times, spec, at(Q::wind_speed));
  for (double& v : out.air.wind) v = std::max(v, 0.0);
  const bool humid = w.weather.has(Q::dew_point);
  out.air.vapour_pressure = on_times(out.air.times, spec, [&](double t) {
    return humid ? vapour_pressure(w.weather.at(Q::dew_point, w.clock(t))) : 0;
  });
  out.humid = humid;
  out.air.repeat = spec.periodic;
  if (w.weather.has(Q::pressure))
    if (const double mean = w.weather.mean(Q::pressure, w.clock(spec.span.begin), w.clock(spec.span.end)); mean > 0)
      out.air.pressure = mean;

  // Light and infrared: means around the moments, so that none is lost or counted twice.
  const auto around = [&](Q q) {
    return [&, q](double t) {
      const double a = std::max(t - step / 2, spec.span.begin), b = std::min(t + step / 2, spec.span.end);
      return w.weather.mean(q, w.clock(a), w.clock(b));
    };
  };
  out.direct = on_times(out.moments, spec, around(Q::direct_normal));
  out.diffuse = on_times(out.moments, spec, around(Q::diffuse));
  out.longwave = on_times(out.moments, spec, around(Q::longwave_down));
  out.air_kelvin = on_times(out.moments, spec, at(Q::air_temperature));
  out.course.moments = out.moments;
  out.course.towards = sun_table(w.sun, spec.span);
  const SkyBody noon = w.sun((spec.span.begin + spec.span.end) / 2);
  out.course.angular_radius = noon.angular_radius;
  const double astronomical = noon.distance / kAstronomicalUnit;
  const double extraterrestrial = solar_irradiance().integral(0.28, 4) / (astronomical * astronomical);
  set_spectra(out.course, w.weather.table().airless());
  for (size_t k = 0; k < out.moments.size(); ++k) {
    const Dir sun = out.course.towards(out.moments[k]);
    out.diffuse[k] = std::max(out.diffuse[k], 0.0);
    // A beam without a sun over the horizon is what the file's hour has of sunrise.
    out.direct[k] = sun.z > 0 ? std::max(out.direct[k], 0.0) : 0;
    out.sky.push_back(patches(sun, out.direct[k], out.diffuse[k], extraterrestrial));
    out.global.push_back(out.diffuse[k] + out.direct[k] * std::max(sun.z, 0.0));
  }
  return out;
}

}  // namespace suite
