// The heat balance at the face of an element: what a face is, what acts on it, and the temperature of elements without
// heat capacity.
//
// Assumes: longwave grey in emission and absorption; air as a perfect gas near 101 kPa for evaporation.
#pragma once
#include <memory>
#include <span>

#include "heat/convection.h"

namespace suite {

// What a face is.
struct FaceTraits {
  double emissivity = 0.95;                              // 0..1
  std::shared_ptr<const ConvectionLaw> convection = {};  // none = no air
  double cosine_up = 1;                                  // of the outward normal with the vertical
  double wetness = 0;                                    // 0..1: share of the evaporation of free water
};

// What acts on it at one moment.
struct FaceWeather {
  double absorbed = 0;      // W/m2, shortwave, already multiplied by the absorptance
  double longwave = 0;      // W/m2 arriving; the emissivity absorbs its share
  double air_kelvin = 300;  // K
  double wind = 0;          // m/s
  double gusts = 0;         // m/s, standard deviation of the wind within the time the balance is of
  bool windward = true;
  double vapour_pressure = 0;  // Pa, of the air; asked for where the face is wet
  double pressure = 101325;    // Pa
  double source = 0;           // W/m2 released at the face from inside, e.g. by a machine
  double film = -1;            // W/(m2 K), as film_of() has it, where it was asked before; < 0: is asked
};

// Flux into the element = constant - linear T - quartic T^4, W/m2.
struct FaceBalance {
  double constant = 0, linear = 0, quartic = 0;
  double flux(double T) const { return constant - T * (linear + quartic * T * T * T); }
};

// Saturation vapour pressure over water, Pa, at 170 K and above (below: its value there).
// Source: D. Bolton, "The computation of equivalent potential temperature", Mon. Weather Rev. 108, 1980, equation 10:
// 0.1 % from -30 to 35 degC.
double saturation_pressure(double kelvin);

// The coefficient of the face's law of convection, W/(m2 K), as a mean over gusts; the law must be there. The film of
// the weather is not looked at.
double film_of(const FaceTraits& face, const FaceWeather& weather, double kelvin);

// Heat the face loses to the air at a temperature, W/m2: convection h (T - air) and evaporation
// wetness h / gamma (e_s(T) - e), gamma = c_p p / (0.622 L) by the analogy of heat and vapour transfer
// (J. L. Monteith, M. H. Unsworth, Principles of environmental physics, 3rd edition, 2008, chapters 11 and 13; Lewis
// number 1). Negative when the air warms it or dew falls.
double loss_to_air(const FaceTraits& face, const FaceWeather& weather, double kelvin);

// Net flux into the element, W/m2, exactly.
double net_flux(const FaceTraits& face, const FaceWeather& weather, double kelvin);

// The same as a line and a T^4 term: exact for radiation and for laws that do not depend on the surface, else the
// tangent at `kelvin` (over half a kelvin to both sides, so that the law of still air has one where it does not blow).
FaceBalance balance_at(const FaceTraits& face, const FaceWeather& weather, double kelvin);

// What lies behind an element.
struct BackCondition {
  enum class Kind {
    flux,  // `value` W/m2 into the element; 0 = adiabatic, or the ground's heat flux
    air,   // room of `value` K behind a film of `film` W/(m2 K)
    held,  // `value` K, e.g. deep ground
  } kind = Kind::flux;
  double value = 0, film = 0;
};
// A back open to the sky or to other surfaces is a face of its own: balance_at(). Error: a film or a temperature that
// is not positive, what is not finite.
FaceBalance back_balance(const BackCondition& back);

// The temperature (K) at which the fluxes into all faces of an element without heat capacity sum to 0, to rounding.
// Fluxes fall with temperature, so there is at most one. Error: none between 1 and 10000 K, e.g. without emission and
// air.
struct MasslessFace {
  FaceTraits traits;
  FaceWeather weather;
};
double massless_kelvin(std::span<const MasslessFace> faces);

}  // namespace suite
