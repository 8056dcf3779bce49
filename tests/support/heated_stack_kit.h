// Exchange of infrared alone, solved to 1e-8 K, and endless plates with shields between them.
#pragma once
#include "math/stats.h"
#include "support/heated_scene_kit.h"

namespace suite::test {

// A history that does not change, solved to 1e-8 K.
inline SurfaceHistory solve_exchange(const HeatKit& kit, const ExchangePaths& paths, const std::vector<double>& outside,
                                     double start) {
  const ExchangeMatrix matrix = paths.matrix(kit.faces->outsides());
  CoupledSurfaces surfaces(surface_groups(*kit.elements, *kit.faces, kit.optics, paths.emissivity), matrix);
  surfaces.start(start);
  SurfaceOptions options;
  options.coupling = {1e-8, 300, 8};
  options.past.tolerance = 1e-9;
  return surfaces.solve(still_exchange(kit, outside, {0, 86400}, 4), options);
}

// Endless plates at 350 and 280 K, shields without heat capacity between them, all of one emissivity: the flux is
// sigma (T1^4 - T2^4) / ((shields + 1) (2 / emissivity - 1)) (e.g. Siegel & Howell, Thermal radiation heat transfer).
struct Stack {
  double flux = 0, error = 0;  // W/m2 out of the hot plate; standard error
  double exact = 0;
};
inline Stack stack(double emissivity, int shields, uint32_t paths, uint64_t seed) {
  HeatedScene s;
  const uint32_t hot = s.heated(emissivity, held_at(350)), cold = s.heated(emissivity, held_at(280)),
                 shield = s.heated(emissivity, heat({}, {{"back", "open"}}));
  s.plane(0, 0, hot);
  for (int k = 1; k <= shields; ++k) s.plane(0, 0, shield, shifted({0, 0, 1.0 * k}));
  s.plane(0, 0, cold, upside_down({0, 0, shields + 1.0}));
  const HeatKit kit(std::move(s), 1);
  size_t plate = 0;
  while ((*kit.elements)[plate].material != hot) ++plate;
  Stack out;
  out.exact = (black(350) - black(280)) / ((shields + 1) * (2 / emissivity - 1));
  // The histories' own flux, through all paths and through an eighth of them eight times.
  const auto flux = [&](const PathOptions& options) {
    const SurfaceHistory h = solve_exchange(kit, kit.exchange(options), outsides_at(kit, 10), 315);
    return emissivity * (black(h.kelvin_at(plate, 0)) - h.received.at(plate, 0));
  };
  out.flux = flux({8, paths / 8, seed});
  RunningStats eighths;
  for (uint64_t k = 0; k < 8; ++k) eighths.add(flux({1, paths / 8, mix64(seed + k)}));
  out.error = eighths.stderr_of_mean();
  return out;
}

// A sheet of aluminium of 1 mm without air, adiabatic behind, whose absorptance and emissivity are one number.
inline HeatKit aluminium_sheet(double emissivity) {
  HeatedScene s;
  s.plane(4, 4,
          s.heated(emissivity, heat({{"thickness_m", 1e-3},
                                     {"density_kg_m3", 2700},
                                     {"specific_heat_j_kg_k", 900},
                                     {"conductivity_w_m_k", 237}})));
  return {std::move(s), 4};
}
// Its temperatures in a beam of 459.3 W/m2 from the zenith under an empty sky, found by so many steps a day.
inline HeatResult in_the_sun(const HeatKit& sheet, size_t steps) {
  StillWeather w;
  w.direct = 459.3;
  HeatSpec run;
  run.span = {0, 86400}, run.tolerance = 1e-4;
  return sheet.solve(still_loads(w, run.span, steps), run);
}

}  // namespace suite::test
