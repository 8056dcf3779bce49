#include "light/night/planets.h"

#include <algorithm>
#include <cmath>

#include "light/night/glow.h"
#include "light/night/stars.h"

namespace suite {

namespace {

// a0 + a1 x + a2 x^2 + ...
template <size_t N>
double polynomial(const double (&a)[N], double x) {
  double sum = 0;
  for (size_t i = N; i-- > 0;) sum = sum * x + a[i];
  return sum;
}

// Degrees; north positive. Negative towards the pole, as a planet's own place is looked at from it.
double latitude_under(Dir from, Dir pole) { return std::asin(std::clamp(-dot(from, pole), -1.0, 1.0)) / kDegree; }

double venus(double phase) {
  return phase < 163.7 ? polynomial({-4.384, -1.044e-3, 3.687e-4, -2.814e-6, 8.938e-9}, phase)
                       : polynomial({236.05828, -2.81914, 8.39034e-3}, phase);
}

double mars(double phase) {
  return phase <= 50 ? polynomial({-1.601, 0.02267, -1.302e-4}, phase)
                     : polynomial({-0.367, -0.02573, 3.445e-4}, phase);
}

double jupiter(double phase) {
  if (phase <= 12) return polynomial({-9.395, -3.7e-4, 6.16e-4}, phase);
  return -9.428 - 2.5 * std::log10(polynomial({1, -1.507, -0.363, -0.062, 2.809, -1.876}, phase / 180));
}

double saturn(const PlanetView& v) {
  const double both = v.sun_latitude * v.observer_latitude, phase = std::min(v.phase_angle, 6.5),
               sine = std::sin(std::min(std::sqrt(std::max(0.0, both)), 27.0) * kDegree);
  return -8.914 - 1.825 * sine + 0.026 * phase - 0.378 * sine * std::exp(-2.25 * phase);
}

double uranus(const PlanetView& v) {
  // The formula asks for planetographic latitudes.
  constexpr double kFlattening = 0.0229;
  const auto graphic = [](double latitude) {
    return std::fabs(std::atan(std::tan(latitude * kDegree) / ((1 - kFlattening) * (1 - kFlattening)))) / kDegree;
  };
  const double tilted = -7.110 - 0.00084 * 0.5 * (graphic(v.sun_latitude) + graphic(v.observer_latitude));
  return v.phase_angle > 3.1 ? tilted + polynomial({0, 6.587e-3, 1.045e-4}, v.phase_angle) : tilted;
}

double neptune(const PlanetView& v) {
  const double full = std::clamp(-6.89 - 0.0054 * (v.year - 1980), -7.0, -6.89);
  return v.phase_angle > 1.9 ? full + polynomial({0, 7.944e-3, 9.617e-5}, v.phase_angle) : full;
}

}  // namespace

PlanetView view_of(Planet planet, const PlanetPlace& place, double year) {
  PlanetView v;
  v.from_sun = length(place.from_sun), v.from_observer = length(place.from_observer);
  v.phase_angle = place.phase_angle() / kDegree;
  v.year = year;
  // North poles of Saturn and Uranus, ICRS (IAU working group on cartographic coordinates, 2009).
  const Dir pole = planet == Planet::saturn ? dir_from_angles((90 - 83.537) * kDegree, 40.589 * kDegree)
                                            : dir_from_angles((90 + 15.175) * kDegree, 257.311 * kDegree);
  v.sun_latitude = latitude_under(normalized(place.from_sun), pole);
  v.observer_latitude = latitude_under(normalized(place.from_observer), pole);
  return v;
}

double planet_magnitude(Planet planet, const PlanetView& v) {
  const double far = 5 * std::log10(v.from_sun * v.from_observer);
  switch (planet) {
    case Planet::mercury:
      return far +
             polynomial({-0.613, 6.3280e-2, -1.6336e-3, 3.3644e-5, -3.4265e-7, 1.6893e-9, -3.0334e-12}, v.phase_angle);
    case Planet::venus:
      return far + venus(v.phase_angle);
    case Planet::mars:
      return far + mars(v.phase_angle);
    case Planet::jupiter:
      return far + jupiter(v.phase_angle);
    case Planet::saturn:
      return far + saturn(v);
    case Planet::uranus:
      return far + uranus(v);
    case Planet::neptune:
      return far + neptune(v);
  }
  throw Bug("no such planet");
}

Curve planet_shape(Planet planet) {
  constexpr double kColour[kPlanets] = {0.93, 0.82, 1.36, 0.83, 1.04, 0.56, 0.41};  // B-V
  constexpr double kSunColour = 0.653, kSunKelvin = 5772, kBlue = 0.44, kVisual = 0.55;
  const double steepness = (kColour[static_cast<size_t>(planet)] - kSunColour) / (kVisual - kBlue);  // mag/um
  const Curve sun = star_shape(kSunKelvin);
  std::vector<double> x, y;
  for (double w = kNightLow; w < kNightHigh; w += 0.01) x.push_back(w);
  x.push_back(kNightHigh);
  for (const double w : x)
    y.push_back(sun.at(w) * std::pow(10, 0.4 * steepness * (std::clamp(w, 0.35, 0.65) - kVisual)));
  return Curve(std::move(x), std::move(y), Outside::zero);
}

}  // namespace suite
