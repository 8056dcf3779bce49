// What a sky does that nobody measured: longwave from humidity and clouds, the direct share of global radiation; and
// what humidity is called.
#pragma once
#include <string_view>

namespace suite {

// Dew point (K) and relative humidity (0 to 1) over water at an air temperature (K).
// D. Bolton, Mon. Weather Rev. 108, 1980, equations 10 and 11; -35 to 35 C within 0.3 %.
double vapour_pressure(double dew_point);                               // Pa
double dew_point_of(double relative_humidity, double air_temperature);  // humidity above 0
double relative_humidity_of(double dew_point, double air_temperature);

enum class LongwaveModel {
  // 59.38 + 113.7 (T / 273.16)^6 + 96.96 sqrt(w / 25) W/m2, w = 4.65 e / T the water above, kg/m2, e in Pa: A. C.
  // Dilley,
  // D. M. O'Brien, "Estimating downward clear sky long-wave irradiance at the surface from screen temperature and
  // precipitable water", Q. J. R. Meteorol. Soc. 124, 1998; w after A. J. Prata, same journal 122, 1996. Clouds that
  // hide a share c of the sky: emissivity (1 - 0.84 c) times the clear one, and 0.84 c (Unsworth & Monteith 1975). The
  // default: made from radiative transfer through soundings of all climates, and among the best three of 13 models at
  // 21
  // sites, with these clouds among the best three of ten (G. N. Flerchinger et al., Water Resources Research 45, 2009:
  // 23 and 24 W/m2 rms by the hour). The other two are fits to a few sites, the first to nights only.
  dilley_obrien,
  // 0.787 + 0.764 ln(dew point / 273 K): G. Clark & C. Allen, "The estimation of atmospheric radiation for clear and
  // cloudy skies", Proc. 2nd National Passive Solar Conference, 1978. With the clouds below what EnergyPlus documents.
  clark_allen,
  // 1.24 (e / T)^(1/7), e in hPa: W. Brutsaert, "On a derivable formula for long-wave radiation from clear skies",
  // Water Resources Research 11, 1975, equation 11.
  brutsaert
};
std::string_view longwave_model_name(LongwaveModel model);  // of clear sky and clouds, with authors and years

// Downwelling longwave, W/m2. Air temperature and dew point in K, clouds that hide the sky 0 to 1. Of the models
// without clouds of their own the clear sky's emissivity is multiplied by 1 + 0.0224 N - 0.0035 N^2 + 0.00028 N^3, N in
// tenths (G. Walton, "Thermal analysis research program reference manual", NBSIR 83-2655, 1983), up to 1.
double modelled_longwave(LongwaveModel model, double air_temperature, double dew_point, double opaque_cover);

// The share of global radiation that is diffuse at a clearness index (global over what arrives outside the air on a
// level plane), 0 or more; hourly. D. Erbs, S. Klein & J. Duffie, Solar Energy 28, 1982, equation 1.
double diffuse_share(double clearness);

}  // namespace suite
