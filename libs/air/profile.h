// Profiles of the air: pressure, temperature and gases over height.
//
// Assumes: layers of level surfaces; between levels temperature and ln p run linearly in height, the share of a gas
// exponentially (linearly where one end has none of it). Above the highest level there is nothing; below the lowest the
// lowest holds.
// Based on: G. P. Anderson et al., "AFGL Atmospheric Constituent Profiles (0-120 km)", AFGL-TR-86-0110, 1986.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace suite {

enum class Gas { h2o, co2, o3, n2o, co, ch4, o2, n2, no, so2, no2, nh3, hno3 };
inline constexpr int kGases = 13;
std::string_view gas_name(Gas gas);
std::optional<Gas> gas_of(std::string_view name);  // by its formula in small letters
double molar_mass(Gas gas);                        // kg/mol

struct AirLevel {
  double height = 0;                      // m above sea level
  double pressure = 0;                    // Pa
  double temperature = 0;                 // K
  std::array<double, kGases> fraction{};  // mol of the gas in a mol of all air

  double share(Gas gas) const { return fraction[static_cast<size_t>(gas)]; }
  double& share(Gas gas) { return fraction[static_cast<size_t>(gas)]; }
  double density() const;  // molecules of all air, 1/m3
};

struct AirProfile {
  std::string name;
  std::vector<AirLevel> levels;  // ascending

  AirLevel at(double height) const;
};

// Heights ascend, temperatures are 50 to 3000 K, pressures positive and falling, shares within 0 and 1 and together at
// most 1, of two levels at least. Error: the level and what is wrong with it, at `where`.
void check_profile(const AirProfile& profile, const Where& where = {});
// The same of one level and the one below it, if any; `whose` begins the message.
void check_level(const AirLevel& level, const AirLevel* below, const Where& where, const std::string& whose = {});

// The six AFGL atmospheres, 0 to 120 km; Error on another name. Their nitrogen is 78.084 % of what is not water.
std::span<const std::string_view> standard_profiles();
AirProfile standard_profile(std::string_view name);

// What of a profile is set by the user; what is not given stays, but that nitrogen makes room for water vapour.
struct ProfileScaling {
  std::optional<double> water;                          // precipitable water over the lowest level, kg/m2
  std::optional<double> ozone;                          // Dobson units over the lowest level
  std::array<std::optional<double>, kGases> at_ground;  // share at the lowest level, mol/mol; the profile scales alike
  std::optional<double> surface_pressure;  // Pa, 0.6 to 1.4 times the profile's; the change fades upward as p does
};
// Error: a negative amount, one of a gas that the profile has nothing of, both an amount and a share of one gas, or a
// profile that is none any more (check_profile).
AirProfile scaled(const AirProfile& profile, const ProfileScaling& scaling);

// Molecules over 1 m2, from the lowest level up.
double column(const AirProfile& profile, Gas gas);
double precipitable_water(const AirProfile& profile);  // kg/m2
double dobson(const AirProfile& profile);              // ozone; a unit is 2.6868e20 molecules/m2

// Share of water whose vapour pressure is `relative_humidity` (0 to 1) times the saturation pressure over water:
// D. Bolton, Mon. Weather Rev. 108, 1980, equation 10.
double water_share(double relative_humidity, double pressure, double temperature);

}  // namespace suite
