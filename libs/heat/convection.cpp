#include "heat/convection.h"

#include <algorithm>
#include <cmath>

#include "base/named_numbers.h"

namespace suite {

namespace {

using P = Parameter;

double difference(const Airflow& air) { return air.surface_kelvin - air.air_kelvin; }

class Linear final : public ConvectionLaw {
 public:
  Linear(double still, double per_wind) : still_(still), per_wind_(per_wind) {}
  double coefficient(const Airflow& air) const override { return still_ + per_wind_ * air.wind; }
  bool asks_surface() const override { return false; }

 private:
  double still_, per_wind_;
};

// W. H. McAdams, Heat transmission, 3rd edition, 1954, p. 249, after measurements of W. Juerges, 1924, in air at 294 K
// on a vertical plate of 0.5 m: h = 5.678 (a + b (V / 0.3048)^n). The well-known 5.7 + 3.8 V is its rounded first
// branch.
class McAdams final : public ConvectionLaw {
 public:
  explicit McAdams(bool rough) : rough_(rough) {}
  double coefficient(const Airflow& air) const override {
    constexpr double kBtu = 5.678, kFoot = 0.3048, kFast = 4.88;  // W/(m2 K), m, m/s
    const double v = air.wind / kFoot;
    if (air.wind < kFast) return kBtu * (rough_ ? 1.09 + 0.23 * v : 0.99 + 0.21 * v);
    return kBtu * (rough_ ? 0.53 : 0.50) * std::pow(v, 0.78);
  }
  bool asks_surface() const override { return false; }

 private:
  bool rough_;
};

// G. N. Walton, Thermal analysis research program reference manual, NBSIR 83-2655, 1983, after the ASHRAE Handbook of
// Fundamentals: turbulent natural convection at planes of any tilt.
double tilted_natural(const Airflow& air) {
  const double dt = difference(air), third = std::cbrt(std::fabs(dt)), tilt = std::fabs(air.cosine_up);
  if (tilt < 1e-6 || dt == 0) return 1.31 * third;
  const bool rises = (dt > 0) == (air.cosine_up > 0);  // warm air can leave upwards, or cold air downwards
  return rises ? 9.482 * third / (7.238 - tilt) : 1.810 * third / (1.382 + tilt);
}

// TARP: natural convection as above plus, after E. M. Sparrow, J. W. Ramsey, E. A. Mass, J. Heat Transfer 101, 1979,
// 2.537 W R sqrt(perimeter V / area), half of it in the lee.
class Tarp final : public ConvectionLaw {
 public:
  Tarp(double roughness, double perimeter_per_area) : roughness_(roughness), perimeter_per_area_(perimeter_per_area) {}
  double coefficient(const Airflow& air) const override {
    const double forced = 2.537 * roughness_ * std::sqrt(perimeter_per_area_ * air.wind);
    return tilted_natural(air) + (air.windward ? forced : forced / 2);
  }

 private:
  double roughness_, perimeter_per_area_;
};

// MoWiTT: M. Yazdanian, J. H. Klems, "Measurement of the exterior convective film coefficient for windows in low-rise
// buildings", ASHRAE Transactions 100, 1994: sqrt((0.84 dT^(1/3))^2 + (a V^b)^2).
class Mowitt final : public ConvectionLaw {
 public:
  double coefficient(const Airflow& air) const override {
    const double natural = 0.84 * std::cbrt(std::fabs(difference(air)));
    const double forced = air.windward ? 3.26 * std::pow(air.wind, 0.89) : 3.55 * std::pow(air.wind, 0.617);
    return std::hypot(natural, forced);
  }
};

// Still air at a plate of a given length. Vertical to 45 deg: S. W. Churchill, H. H. S. Chu, Int. J. Heat Mass Transfer
// 18, 1975, equation 9, gravity by its part along the plate. Flatter ones, McAdams 1954 and J. R. Lloyd, W. R. Moran,
// J. Heat Transfer 96, 1974: air that can leave 0.54 Ra^(1/4) below Ra 1e7 and 0.15 Ra^(1/3) above, held air 0.27
// Ra^(1/4).
class StillAir final : public ConvectionLaw {
 public:
  explicit StillAir(double length) : length_(length) {}
  double coefficient(const Airflow& air) const override {
    const double dt = difference(air), tilt = std::fabs(air.cosine_up);
    // Air at the film's temperature: D. Sutherland's law for viscosity and conductivity (constants of F. M. White,
    // Viscous fluid flow, 1974), ideal gas.
    const double T = (air.surface_kelvin + air.air_kelvin) / 2, ratio = std::pow(T / 273.15, 1.5);
    const double viscosity = 1.716e-5 * ratio * (273.15 + 111) / (T + 111);   // Pa s
    const double conductivity = 0.0241 * ratio * (273.15 + 194) / (T + 194);  // W/(m K)
    const double density = air.pressure / (287.05 * T), heat = 1006;          // kg/m3, J/(kg K)
    const double prandtl = viscosity * heat / conductivity;
    const bool flat = tilt > std::sqrt(0.5);
    const double gravity = 9.80665 * (flat ? 1 : std::sqrt(1 - tilt * tilt));
    const double rayleigh =
        gravity * std::fabs(dt) / T * std::pow(length_, 3) * density * density * prandtl / (viscosity * viscosity);
    double nusselt = 0;
    if (!flat) {
      const double shape = std::pow(1 + std::pow(0.492 / prandtl, 9.0 / 16), 8.0 / 27);
      nusselt = std::pow(0.825 + 0.387 * std::pow(rayleigh, 1.0 / 6) / shape, 2);
    } else if ((dt > 0) == (air.cosine_up > 0)) {
      nusselt = rayleigh < 1e7 ? 0.54 * std::pow(rayleigh, 0.25) : 0.15 * std::cbrt(rayleigh);
    } else {
      nusselt = 0.27 * std::pow(rayleigh, 0.25);
    }
    return nusselt * conductivity / length_;
  }

 private:
  double length_;
};

const std::vector<std::pair<std::string, double>>& tarp_roughnesses() {
  static const std::vector<std::pair<std::string, double>> table{{"medium_rough", 1.52}, {"very_rough", 2.17},
                                                                 {"rough", 1.67},        {"medium_smooth", 1.13},
                                                                 {"smooth", 1.11},       {"very_smooth", 1.00}};
  return table;
}

std::vector<ConvectionRow> rows() {
  using Made = std::unique_ptr<const ConvectionLaw>;
  const std::string unit = "W/(m2 K)";
  std::vector<std::string> tarp_names;
  for (const auto& [name, factor] : tarp_roughnesses()) tarp_names.push_back(name);
  return {{{"constant", "a number and its growth with the wind, as the user gives them", unit,
            [](const ConvectionSpec& s) -> Made {
              return std::make_unique<Linear>(s.numbers.at("still_w_m2_k"), s.numbers.at("wind_j_m3_k"));
            }},
           {{"still_w_m2_k", P::Kind::number, "W/(m2 K)", "in still air", 0, 1e6},
            {"wind_j_m3_k", P::Kind::number, "J/(m3 K)", "growth per m/s of wind", 0, 1e4, false, 0}},
           {},
           "the user's"},
          {{"mcadams", "wind along plates (McAdams 1954, Juerges 1924)", unit,
            [](const ConvectionSpec& s) -> Made { return std::make_unique<McAdams>(s.roughness == "rough"); }},
           {},
           {"smooth", "rough"},
           "wind near the surface up to 30 m/s, plates of half a metre"},
          {{"tarp", "buildings: natural by tilt, wind by roughness and size (Walton 1983, Sparrow 1979)", unit,
            [](const ConvectionSpec& s) -> Made {
              double factor = 0;
              for (const auto& [name, value] : tarp_roughnesses())
                if (name == s.roughness) factor = value;
              return std::make_unique<Tarp>(factor, s.numbers.at("perimeter_per_area_1_m"));
            }},
           {{"perimeter_per_area_1_m", P::Kind::number, "1/m", "of the surface, 4 / side for a square", 1e-3, 1e3,
             false, 0.4}},
           tarp_names,
           "wind at the surface's height up to 12 m/s, faces of buildings"},
          {{"mowitt", "smooth upright faces of low buildings (Yazdanian & Klems 1994)", unit,
            [](const ConvectionSpec&) -> Made { return std::make_unique<Mowitt>(); }},
           {},
           {},
           "wind up to 12 m/s, very smooth vertical faces such as glass"},
          {{"still_air", "natural convection at a plate (Churchill & Chu 1975, McAdams 1954, Lloyd & Moran 1974)", unit,
            [](const ConvectionSpec& s) -> Made { return std::make_unique<StillAir>(s.numbers.at("length_m")); }},
           {{"length_m", P::Kind::number, "m", "height of an upright plate, area / perimeter of a flat one", 1e-4, 1e3,
             false, 1}},
           {},
           "no wind; Rayleigh numbers to 1e12 upright, 1e4 to 1e11 flat"}};
}

}  // namespace

const Registry<ConvectionRow>& convection_laws() {
  static const Registry<ConvectionRow> table("convection law", "", rows());
  return table;
}

std::unique_ptr<const ConvectionLaw> make_convection(const ConvectionSpec& given, const Where& where) {
  const ConvectionRow& row = convection_laws().find(given.law, where);
  ConvectionSpec spec = given;
  const std::string law = "convection law '" + row.name + "'";
  check_numbers(law, row.parameters, spec.numbers, where);
  if (spec.roughness.empty() && !row.roughnesses.empty()) spec.roughness = row.roughnesses.front();
  const auto& names = row.roughnesses;
  if (!spec.roughness.empty() && std::find(names.begin(), names.end(), spec.roughness) == names.end()) {
    if (names.empty()) throw Error(where, law + " takes no roughness");
    throw Error(where, law + " knows no roughness '" + spec.roughness + "'", name_hint(spec.roughness, names));
  }
  return row.make(spec);
}

}  // namespace suite
