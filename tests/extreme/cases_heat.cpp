// The balance of heat: plates and shields that hardly emit, metal that hardly absorbs, storms and calms.
#include <cmath>

#include "extreme/case.h"
#include "support/heated_stack_kit.h"

namespace suite::extreme {

namespace {

using namespace test;

// NaN where the sweeps over the surfaces do not settle.
double off_stack(double emissivity, int shields) {
  try {
    const Stack s = stack(emissivity, shields, 1 << 12, 1);
    return std::fabs(s.flux / s.exact - 1);
  } catch (const Error&) {
    return NAN;
  }
}

// The temperature of its balance does not know the number.
double off_bare_metal(double emissivity) {
  const HeatResult r = in_the_sun(aluminium_sheet(emissivity), 24);
  double worst = 0;
  for (const float T : r.kelvin)
    worst = std::fmax(worst, std::fabs(double{T} - std::pow(459.3 / kStefanBoltzmann, 0.25)));
  return worst;
}

// A black plate of copper in sun and wind of so many m/s, against the root of its balance.
double off_in_wind(double wind) {
  HeatedScene s;
  TemperatureSpec spec =
      heat({{"thickness_m", 1e-3}, {"density_kg_m3", 8960}, {"specific_heat_j_kg_k", 385}, {"conductivity_w_m_k", 400}},
           {{"convection", "mcadams"}});
  s.plane(4, 4, s.heated(1, spec));
  const HeatKit kit(std::move(s), 4);
  StillWeather w;
  w.direct = 800, w.longwave = 300, w.air_kelvin = 285, w.wind = wind;
  HeatSpec run;
  run.span = {0, 86400}, run.tolerance = 1e-4, run.paths = 4096;  // the sky's infrared is not even
  const HeatResult r = kit.solve(still_loads(w, run.span, 24), run);
  ConvectionSpec named;
  named.law = "mcadams";
  const double h = make_convection(named)->coefficient({.surface_kelvin = 300, .air_kelvin = 285, .wind = wind});
  double low = 100, high = 1000;
  for (int i = 0; i < 200; ++i) {
    const double T = (low + high) / 2;
    (black(T) + h * (T - 285) < 1100 ? low : high) = T;
  }
  double worst = 0;
  for (const float T : r.kelvin) worst = std::fmax(worst, std::fabs(double{T} - low));
  return worst;
}

}  // namespace

std::vector<Case> heat_cases() {
  using N = const Numerics&;
  return {
      {"heat",
       "flux between plates, one shield",
       "closed form",
       "1",
       0.01,
       [](N, double x) { return off_stack(x, 1); },
       {"emissivity", "1", 0.3, 0.01, 3},
       {}},
      {"heat",
       "flux between plates of emissivity 0.3",
       "closed form",
       "1",
       0.01,
       [](N, double x) { return off_stack(0.3, static_cast<int>(x)); },
       {"shields", "1", 1, 64, 2},
       {}},
      {"heat",
       "bare metal in the sun",
       "closed form",
       "K",
       0.3,
       [](N, double x) { return off_bare_metal(x); },
       {"emissivity", "1", 0.02, 1e-6, 10},
       {}},
      {"heat",
       "black copper in sun and wind",
       "root of its balance",
       "K",
       0.05,
       [](N, double x) { return off_in_wind(x); },
       {"wind", "m/s", 0.1, 100, 10},
       {}},
  };
}

}  // namespace suite::extreme
