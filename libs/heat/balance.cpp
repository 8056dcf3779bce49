#include "heat/balance.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "heat/slab_batch.h"
#include "spectral/planck.h"

namespace suite {

namespace {

constexpr double kColdest = 1, kHottest = 1e4;  // K

// A root of a falling function: false position by the Illinois variant (M. Dowell, P. Jarratt, BIT 11, 1971), with a
// bisection now and then so that the bracket always shrinks.
template <class Function>
double falling_root(const Function& f, double low, double f_low, double high, double f_high, double tolerance) {
  int side = 0;
  for (int k = 1; high - low > tolerance; ++k) {
    const double secant = low + (high - low) * f_low / (f_low - f_high);
    const double x = k % 8 == 0 ? (low + high) / 2 : std::clamp(secant, low + tolerance / 4, high - tolerance / 4);
    const double y = f(x);
    if (y == 0) return x;
    if (y > 0) {
      low = x, f_low = y;
      if (side == 1) f_high /= 2;
      side = 1;
    } else {
      high = x, f_high = y;
      if (side == -1) f_low /= 2;
      side = -1;
    }
  }
  return (low + high) / 2;
}

}  // namespace

double saturation_pressure(double kelvin) {
  const double celsius = std::fmax(kelvin, 170.0) - 273.15;
  return 611.2 * std::exp(17.67 * celsius / (celsius + 243.5));
}

double film_of(const FaceTraits& face, const FaceWeather& weather, double kelvin) {
  const auto coefficient = [&](double wind) {
    return face.convection->coefficient(
        {kelvin, weather.air_kelvin, wind, face.cosine_up, weather.windward, weather.pressure});
  };
  // Laws bend in the wind: two winds with its mean and deviation stand for all, none below 0; weak gusts do not matter.
  const double gusts = std::fmin(weather.gusts, weather.wind);
  return gusts > 0.05 * weather.wind ? (coefficient(weather.wind - gusts) + coefficient(weather.wind + gusts)) / 2
                                     : coefficient(weather.wind);
}

double loss_to_air(const FaceTraits& face, const FaceWeather& weather, double kelvin) {
  if (!face.convection) return 0;
  const double h = weather.film >= 0 ? weather.film : film_of(face, weather, kelvin);
  double loss = h * (kelvin - weather.air_kelvin);
  if (face.wetness > 0) {
    constexpr double kHeat = 1006, kRatio = 0.622, kVapour = 2.45e6;     // J/(kg K), 1, J/kg at 20 degC
    const double gamma = kHeat * weather.pressure / (kRatio * kVapour);  // Pa/K
    loss += face.wetness * h / gamma * (saturation_pressure(kelvin) - weather.vapour_pressure);
  }
  return loss;
}

double net_flux(const FaceTraits& face, const FaceWeather& weather, double kelvin) {
  const double square = kelvin * kelvin;
  return weather.absorbed + weather.source + face.emissivity * (weather.longwave - kStefanBoltzmann * square * square) -
         loss_to_air(face, weather, kelvin);
}

FaceBalance balance_at(const FaceTraits& face, const FaceWeather& weather, double kelvin) {
  constexpr double kAside = 0.5;  // K
  FaceBalance b;
  b.quartic = face.emissivity * kStefanBoltzmann;
  b.constant = weather.absorbed + weather.source + face.emissivity * weather.longwave;
  if (!face.convection) return b;
  const double above = loss_to_air(face, weather, kelvin + kAside), below = loss_to_air(face, weather, kelvin - kAside);
  b.linear = std::fmax(0.0, (above - below) / (2 * kAside));
  b.constant += b.linear * kelvin - loss_to_air(face, weather, kelvin);
  return b;
}

FaceBalance back_balance(const BackCondition& back) {
  if (!std::isfinite(back.value)) throw Error("what lies behind an element is not finite");
  FaceBalance b;
  if (back.kind == BackCondition::Kind::flux) {
    b.constant = back.value;
    return b;
  }
  if (!(back.value > 0)) throw Error(strf("%g K behind an element", back.value), "more than 0");
  if (back.kind == BackCondition::Kind::air && !(back.film > 0 && std::isfinite(back.film)))
    throw Error(strf("a film of %g W/(m2 K) behind an element", back.film), "more than 0, or adiabatic");
  b.linear = back.kind == BackCondition::Kind::held ? kHeldFilm : back.film;
  b.constant = b.linear * back.value;
  return b;
}

double massless_kelvin(std::span<const MasslessFace> faces) {
  const auto gain = [faces](double kelvin) {
    double sum = 0;
    for (const MasslessFace& f : faces) sum += net_flux(f.traits, f.weather, kelvin);
    return sum;
  };
  const auto refuse = [](const char* why) {
    throw Error(std::string("a leaf or sheet without heat capacity finds no temperature: ") + why,
                "it must emit or touch air, and its loads must be finite");
  };
  // Grow a bracket from the air's temperature, where most end up.
  double low = 300, step = 8;
  if (!faces.empty()) low = std::clamp(faces[0].weather.air_kelvin, kColdest, kHottest);
  double f_low = gain(low), high = low, f_high = f_low;
  if (!std::isfinite(f_low)) refuse("its loads are not finite");
  if (f_low == 0 && gain(low + step) == 0) refuse("nothing acts on it");
  while (f_high > 0 && high < kHottest) {
    low = high, f_low = f_high;
    high = std::fmin(kHottest, high + step), f_high = gain(high), step *= 2;
  }
  while (f_low < 0 && low > kColdest) {
    high = low, f_high = f_low;
    low = std::fmax(kColdest, low - step), f_low = gain(low), step *= 2;
  }
  if (!(f_low >= 0 && f_high <= 0)) refuse("gains and losses do not meet between 1 and 10000 K");
  if (f_low == 0) return low;
  if (f_high == 0) return high;
  return falling_root(gain, low, f_low, high, f_high, 4e-14 * high);
}

}  // namespace suite
