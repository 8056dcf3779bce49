#include "water/sea_water.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "math/vec.h"

namespace suite {

namespace {

struct Row {
  double um, n, k;
};
constexpr Row kSegelstein[] = {
#include "water/tables/segelstein.inc"
};
constexpr Row kHaleQuerry[] = {
#include "water/tables/hale_querry.inc"
};

std::pair<const Row*, const Row*> rows(PureWater table) {
  if (table == PureWater::segelstein) return {std::begin(kSegelstein), std::end(kSegelstein)};
  return {std::begin(kHaleQuerry), std::end(kHaleQuerry)};
}

// `of` at the rows, linear in between.
template <class F>
double between(PureWater table, double um, const F& of) {
  const auto [first, last] = rows(table);
  const Row* above = std::upper_bound(first, last, um, [](double w, const Row& r) { return w < r.um; });
  above = std::clamp(above, first + 1, last - 1);
  const Row& a = above[-1];
  return of(a) + (of(*above) - of(a)) * (um - a.um) / (above->um - a.um);
}

constexpr double kJointUm = 1.1;

// Quan & Fry 1995, equation 3: over air; wavelength in nm.
struct Index {
  double value, by_salinity;  // n, dn/dS
};
Index quan_fry(double um, double t, double s) {
  const double nm = 1000 * um;
  const double by_salinity = 1.779e-4 - 1.05e-6 * t + 1.6e-8 * t * t + 0.01155 / nm;
  const double fresh =
      1.31405 - 2.02e-6 * t * t + (15.868 - 0.00423 * t) / nm - 4382 / (nm * nm) + 1.1455e6 / (nm * nm * nm);
  return {fresh + by_salinity * s, by_salinity};
}
// Dry air of 15 degrees at 1 atm (P. Ciddor, Appl. Opt. 35, 1996).
double index_of_air(double um) {
  const double s = 1 / (um * um);
  return 1 + (5792105 / (238.0185 - s) + 167917 / (57.362 - s)) * 1e-8;
}

// 1/Pa (F. Millero et al., Deep-Sea Res. 27, 1980).
double compressibility(double t, double s) {
  const double pure = 19652.21 + t * (148.4206 + t * (-2.327105 + t * (1.360477e-2 - 5.155288e-5 * t)));
  const double a = 54.6746 + t * (-0.603459 + t * (1.09987e-2 - 6.167e-5 * t));
  const double b = 7.944e-2 + t * (1.6483e-2 - 5.3009e-4 * t);
  return 1e-5 / (pure + s * (a + b * std::sqrt(s)));
}
// kg/m3 (UNESCO, Technical papers in marine science 36, 1981).
double density(double t, double s) {
  const double pure =
      999.842594 + t * (6.793952e-2 + t * (-9.09529e-3 + t * (1.001685e-4 + t * (-1.120083e-6 + 6.536332e-9 * t))));
  const double a = 8.24493e-1 + t * (-4.0899e-3 + t * (7.6438e-5 + t * (-8.2467e-7 + 5.3875e-9 * t)));
  const double b = -5.72466e-3 + t * (1.0227e-4 - 1.6546e-6 * t);
  return pure + s * (a + b * std::sqrt(s) + 4.8314e-4 * s);
}
// d ln(activity of water) / dS (Zhang et al. 2009, from F. Millero & W. Leung, Am. J. Sci. 276, 1976).
double activity_slope(double t, double s) {
  return (-5.58651e-4 + t * (2.40452e-7 + t * (-3.12165e-9 + 2.40808e-11 * t))) +
         1.5 * (1.79613e-5 + t * (-9.9422e-8 + t * (2.08919e-9 - 1.39872e-11 * t))) * std::sqrt(s) +
         2 * (-2.31065e-6 + t * (-1.37674e-9 - 1.93316e-11 * t)) * s;
}

void check(double um, double t, double s) {
  SUITE_CHECK(um >= kWaterLowUm && um <= kWaterHighUm && t >= -2 && t <= 40 && s >= 0 && s <= 45);
}

}  // namespace

double pure_water_absorption(PureWater table, double um) {
  check(um, 0, 0);
  return between(table, um, [](const Row& r) { return 4 * kPi * r.k / (r.um * 1e-6); });
}

const std::vector<double>& pure_water_wavelengths(PureWater table) {
  const auto list = [](PureWater t) {
    std::vector<double> all;
    for (auto [r, end] = rows(t); r != end; ++r) all.push_back(r->um);
    return all;
  };
  static const std::vector<double> of[] = {list(PureWater::segelstein), list(PureWater::hale_querry)};
  return of[static_cast<size_t>(table)];
}

double sea_water_index(double um, double t, double s) {
  check(um, t, s);
  if (um <= kJointUm) return quan_fry(um, t, s).value;
  const auto pure = [](double w) { return between(PureWater::segelstein, w, [](const Row& r) { return r.n; }); };
  return pure(um) + quan_fry(kJointUm, t, s).value - pure(kJointUm);
}

double sea_water_scattering(double um, double t, double s) {
  check(um, t, s);
  if (um > kJointUm) return sea_water_scattering(kJointUm, t, s) * std::pow(kJointUm / um, 4);
  constexpr double avogadro = 6.02214179e23, boltzmann = 1.3806503e-23, molar_kg = 18e-3;
  const double d = kWaterDepolarisation, cabannes = (6 + 6 * d) / (6 - 7 * d);
  const Index over_air = quan_fry(um, t, s);
  const double n = over_air.value * index_of_air(um), dn = over_air.by_salinity * index_of_air(um), n2 = n * n;
  // Change of n^2 with density at constant temperature (Proutiere et al. 1992).
  const double rise = (n2 - 1) * (1 + 2.0 / 3 * (n2 + 2) * std::pow(n / 3 - 1 / (3 * n), 2));
  const double per_wave = kPi * kPi * std::pow(um * 1e-6, -4) * cabannes;
  // At 90 degrees, 1/(m sr).
  const double of_density = 0.5 * per_wave * boltzmann * (t + 273.15) * compressibility(t, s) * rise * rise;
  const double of_salt =
      2 * per_wave * n2 * s * molar_kg * dn * dn / (density(t, s) * -activity_slope(t, s) * avogadro);
  return 8 * kPi / 3 * (of_density + of_salt) * (2 + d) / (1 + d);
}

}  // namespace suite
