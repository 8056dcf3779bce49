// Temperatures that follow from the balance of heat of the whole scene: sun, sky, neighbours, air, conduction. What the
// material brings to it; libs/heat solves it before anything is rendered.
#include <cmath>

#include "thermal/models/rows.h"

namespace suite {

namespace {

// Stands for a temperature that is found elsewhere.
class HeatModel final : public TemperatureModel {
 public:
  void kelvin(std::span<const double>, const Loads&, std::span<double>) const override {
    throw Error("a temperature of model 'heat' is part of the scene's balance, not of one place");
  }
  bool needs_loads() const override { return true; }
};

std::vector<TemperatureSpec> heat_examples() { return {}; }

}  // namespace

TemperatureRow heat_temperature_row() {
  using P = Parameter;
  const auto number = [](const char* name, const char* unit, const char* what, double low, double high) {
    return P{name, P::Kind::number, unit, what, low, high, false, NAN};
  };
  return {
      {"heat", "the balance of heat of the scene under weather (the simulation's `heat:`)", "K",
       [](const TemperatureSpec&) -> std::unique_ptr<const TemperatureModel> { return std::make_unique<HeatModel>(); }},
      {number("thickness_m", "m", "of the one layer, when no layers are given", 1e-9, 1e6),
       number("density_kg_m3", "kg/m3", "of the one layer", 1e-6, 1e5),
       number("specific_heat_j_kg_k", "J/(kg K)", "of the one layer", 1e-6, 1e6),
       number("conductivity_w_m_k", "W/(m K)", "of the one layer", 1e-9, 1e5),
       number("wetness", "1", "share of the evaporation of free water", 0, 1),
       number("source_w_m2", "W/m2", "released at the front, e.g. by an engine", -1e5, 1e5),
       number("back_flux_w_m2", "W/m2", "of back: flux, into the element", -1e5, 1e5),
       number("back_k", "K", "of back: ground (held), air", 1, 10000),
       number("back_film_w_m2_k", "W/(m2 K)", "of back: air", 1e-6, 1e6),
       number("absorptance", "1", "of sunlight, where the optics do not say", 0, 1),
       number("emissivity", "1", "in the thermal infrared, where the optics do not say; else checked against them", 0,
              1),
       number("still_w_m2_k", "W/(m2 K)", "of convection: constant, in still air", 0, 1e6),
       number("wind_j_m3_k", "J/(m3 K)", "of convection: constant, growth per m/s of wind", 0, 1e4),
       number("perimeter_per_area_1_m", "1/m", "of convection: tarp", 1e-3, 1e3),
       number("length_m", "m", "of convection: still_air", 1e-4, 1e3),
       {"convection", P::Kind::text, "", "a law of libs/heat/convection.h, or none; mcadams", 0, 0, false, NAN},
       {"roughness", P::Kind::text, "", "of the law", 0, 0, false, NAN},
       {"back", P::Kind::text, "", "adiabatic, flux, ground, air or open (to sky and surfaces); adiabatic", 0, 0, false,
        NAN}},
      false,
      true,
      heat_examples};
}

}  // namespace suite
