#include "heat/sky_models.h"

#include <algorithm>
#include <cmath>

#include "spectral/planck.h"

namespace suite {

namespace {
constexpr double kFreezing = 273.15;

double clear_emissivity(LongwaveModel model, double air_temperature, double dew_point) {
  switch (model) {
    case LongwaveModel::dilley_obrien: {
      const double water = 4.65 * vapour_pressure(dew_point) / air_temperature;
      const double down = 59.38 + 113.7 * std::pow(air_temperature / 273.16, 6) + 96.96 * std::sqrt(water / 25);
      return down / (kStefanBoltzmann * std::pow(air_temperature, 4));
    }
    case LongwaveModel::clark_allen:
      return 0.787 + 0.764 * std::log(dew_point / 273);
    case LongwaveModel::brutsaert:
      return 1.24 * std::pow(vapour_pressure(dew_point) / 100 / air_temperature, 1.0 / 7);
  }
  return 0;
}
}  // namespace

double vapour_pressure(double dew_point) {
  const double celsius = dew_point - kFreezing;
  return 611.2 * std::exp(17.67 * celsius / (celsius + 243.5));
}

double dew_point_of(double relative_humidity, double air_temperature) {
  const double x = std::log(relative_humidity * vapour_pressure(air_temperature) / 611.2);
  return kFreezing + 243.5 * x / (17.67 - x);
}

double relative_humidity_of(double dew_point, double air_temperature) {
  return vapour_pressure(dew_point) / vapour_pressure(air_temperature);
}

std::string_view longwave_model_name(LongwaveModel model) {
  switch (model) {
    case LongwaveModel::dilley_obrien:
      return "Dilley & O'Brien 1998, clouds after Unsworth & Monteith 1975";
    case LongwaveModel::clark_allen:
      return "Clark & Allen 1978, clouds after Walton 1983";
    case LongwaveModel::brutsaert:
      return "Brutsaert 1975, clouds after Walton 1983";
  }
  return "";
}

double modelled_longwave(LongwaveModel model, double air_temperature, double dew_point, double opaque_cover) {
  const double clear = clear_emissivity(model, air_temperature, dew_point);
  const double n = 10 * opaque_cover, walton = clear * (1 + n * (0.0224 + n * (-0.0035 + n * 0.00028)));
  const double unsworth = clear + 0.84 * opaque_cover * (1 - clear);
  const double emissivity = model == LongwaveModel::dilley_obrien ? unsworth : walton;
  return std::clamp(emissivity, 0.0, 1.0) * kStefanBoltzmann * std::pow(air_temperature, 4);
}

double diffuse_share(double clearness) {
  const double k = clearness;
  if (k <= 0.22) return 1 - 0.09 * k;
  if (k > 0.8) return 0.165;
  return 0.9511 + k * (-0.1604 + k * (4.388 + k * (-16.638 + k * 12.336)));
}

}  // namespace suite
