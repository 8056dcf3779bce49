// Heat that air takes from a surface: a table of named laws for the transfer coefficient, W/(m2 K).
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/registry.h"

namespace suite {

// What a law may ask for.
struct Airflow {
  double surface_kelvin = 300;
  double air_kelvin = 300;
  double wind = 0;       // m/s, >= 0, as the weather gives it (10 m above open ground) unless the law says otherwise
  double cosine_up = 1;  // of the surface's outward normal with the vertical: 1 a roof, 0 a wall, -1 seen from below
  bool windward = true;  // the wind blows against the surface, or along it within 100 deg of its normal
  double pressure = 101325;  // Pa
};

class ConvectionLaw {
 public:
  virtual ~ConvectionLaw() = default;
  // W/(m2 K), >= 0; the surface loses it times (surface - air). May be called from many threads.
  virtual double coefficient(const Airflow& air) const = 0;
  // Whether it depends on anything but the wind and the air.
  virtual bool asks_surface() const { return true; }
};

// A law as a user names it.
struct ConvectionSpec {
  std::string law;                        // a row of convection_laws()
  std::map<std::string, double> numbers;  // the row lists the names
  std::string roughness;                  // a row's texts; empty = the row's default
};

struct ConvectionRow : RegistryRow<std::unique_ptr<const ConvectionLaw>(const ConvectionSpec& spec)> {
  std::vector<Parameter> parameters;     // numbers
  std::vector<std::string> roughnesses;  // names that `roughness` may have, the default first; empty = none
  std::string valid;                     // range for which the source claims it
};

const Registry<ConvectionRow>& convection_laws();
// Error located at `where`: unknown law, number or roughness, a number missing or out of range.
std::unique_ptr<const ConvectionLaw> make_convection(const ConvectionSpec& spec, const Where& where = {});

}  // namespace suite
