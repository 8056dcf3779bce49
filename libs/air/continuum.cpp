#include "air/continuum.h"

#include <cmath>

#include "base/error.h"

namespace suite {

namespace {

constexpr double kContinuumSecondRadiation = 1.438776877, kContinuumReference = 296,
                 kContinuumAtmosphere = 101325;  // cm K, K, Pa

double interpolated(const WaterContinuum& c, const std::vector<double>& values, double v) {
  const double x = (v - c.first_cm) / c.step_cm;
  if (!(x >= 0) || x >= static_cast<double>(values.size() - 1)) return 0;
  const auto i = static_cast<size_t>(x);
  return values[i] + (x - static_cast<double>(i)) * (values[i + 1] - values[i]);
}

}  // namespace

double WaterContinuum::self_section(double v, double temperature) const {
  const double cold = kContinuumReference / temperature;
  return 1e-4 * interpolated(*this, self, v) * std::pow(cold, interpolated(*this, exponent, v)) *
         radiation_field(v, temperature) * cold / kContinuumAtmosphere;
}

double WaterContinuum::foreign_section(double v, double temperature) const {
  return 1e-4 * interpolated(*this, foreign, v) * radiation_field(v, temperature) * kContinuumReference / temperature /
         kContinuumAtmosphere;
}

double radiation_field(double v, double temperature) {
  return v * std::tanh(0.5 * kContinuumSecondRadiation * v / temperature);
}

void check_continuum(const WaterContinuum& c) {
  if (!(c.step_cm > 0)) throw Error("a water continuum with a step of " + strf("%g cm-1", c.step_cm), "it is positive");
  if (c.self.size() < 2 || c.foreign.size() != c.self.size() || c.exponent.size() != c.self.size())
    throw Error("a water continuum whose columns differ in length", "self, foreign and exponent of equal length");
}

}  // namespace suite
