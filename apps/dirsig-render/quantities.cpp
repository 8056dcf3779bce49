#include "quantities.h"

#include <cmath>

#include "scheduler/moments.h"
#include "spectral/planck.h"

namespace suite {

namespace {

// What radiance in W/(m2 sr um) is multiplied by. Photons are counted at the energy of the band's centre.
double unit_factor(OutputSpec::Units units, const Band& band) {
  if (units == OutputSpec::Units::w_cm2) return 1e-4;
  if (units == OutputSpec::Units::photons) return band.center_um * 1e-6 / (kPlanckConstant * kSpeedOfLight);
  return 1;
}

}  // namespace

QuantityText text_of(Quantity quantity, OutputSpec::Units units) {
  static const char* const kUnits[] = {"W/(m2 sr um)", "W/(cm2 sr um)", "photons/(s m2 sr um)"};
  if (quantity == Quantity::toa_reflectance) return {"top-of-atmosphere reflectance", "reflectance"};
  if (quantity == Quantity::brightness_temperature) return {"brightness temperature", "K"};
  if (quantity == Quantity::remote_sensing_reflectance)
    return {"radiance over the downward irradiance above the water", "1/sr"};
  return {"spectral radiance", kUnits[static_cast<size_t>(units)]};
}

Conversion::Conversion(const Delivery& d, Quantity quantity, OutputSpec::Units units, const Facts& facts)
    : per_pixel_(d.result.values_per_problem()), bands_(d.result.bands), columns_(d.result.columns) {
  std::vector<ColumnBands> columns = d.columns;
  if (columns.empty()) columns.push_back({d.result.columns, d.bands});
  std::optional<FarDisk> sun;
  if (quantity == Quantity::toa_reflectance)
    sun = facts.sun(moment_of(d.sensor.tasks()[d.result.task].captures[d.result.capture]));
  for (const ColumnBands& c : columns) {
    Part part{c.columns, {}, {}, {}};
    for (const Band& b : c.bands) {
      part.relative_error.push_back(0);
      if (quantity == Quantity::brightness_temperature) {
        part.thermometers.emplace_back(b);
      } else if (quantity == Quantity::remote_sensing_reflectance) {
        const LightAbove::Irradiance down = facts.light_above().of(d, b);
        part.factor.push_back(1 / down.mean);
        part.relative_error.back() = down.error / down.mean;
      } else {
        part.factor.push_back(sun ? kPi / (band_mean(b, sun->irradiance) * normalized(sun->direction).z)
                                  : unit_factor(units, b));
      }
    }
    parts_.push_back(std::move(part));
  }
}

void Conversion::apply(std::span<double> values, std::span<double> errors) const {
  const size_t rows = values.size() / (columns_ * per_pixel_);
  size_t at = 0;
  for (size_t row = 0; row < rows; ++row)
    for (const Part& part : parts_)
      for (size_t v = 0; v < part.columns * per_pixel_; ++v, ++at) {
        const size_t band = v % per_pixel_ % bands_;
        if (part.thermometers.empty()) {
          values[at] *= part.factor[band];
          errors[at] = std::hypot(errors[at] * part.factor[band], values[at] * part.relative_error[band]);
          continue;
        }
        const BandThermometer::Reading t = part.thermometers[band].read(values[at]);
        values[at] = t.kelvin, errors[at] *= t.slope;
      }
}

}  // namespace suite
