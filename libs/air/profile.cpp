#include "air/profile.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {

#include "air/afgl_table.inc"

constexpr double kBoltzmann = 1.380649e-23, kAvogadro = 6.02214076e23, kDobson = 2.6868e20;
constexpr size_t kHeights = std::size(kAfglHeightKm), kAfglGases = 7, kColumns = 2 + kAfglGases;
constexpr Gas kMain[kAfglGases] = {Gas::h2o, Gas::co2, Gas::o3, Gas::n2o, Gas::co, Gas::ch4, Gas::o2},
              kTraces[] = {Gas::no, Gas::so2, Gas::no2, Gas::nh3, Gas::hno3};
static_assert(std::size(kAfglColumns) == 6 * kColumns * kHeights);
static_assert(std::size(kAfglTracesPpmv) == std::size(kTraces) * kHeights);

constexpr std::string_view kGasNames[] = {"h2o", "co2", "o3",  "n2o", "co",  "ch4", "o2",
                                          "n2",  "no",  "so2", "no2", "nh3", "hno3"};
constexpr double kMolarMass[] = {0.0180153, 0.0440095, 0.0479982, 0.0440128, 0.0280101, 0.0160425, 0.0319988,
                                 0.0280134, 0.0300061, 0.0640638, 0.0460055, 0.0170305, 0.0630128};
static_assert(std::size(kGasNames) == kGases && std::size(kMolarMass) == kGases);

constexpr std::string_view kProfiles[] = {"tropical",         "midlatitude_summer", "midlatitude_winter",
                                          "subarctic_summer", "subarctic_winter",   "us_standard"};

AirLevel between(const AirLevel& a, const AirLevel& b, double height) {
  const double s = (height - a.height) / (b.height - a.height);
  AirLevel level;
  level.height = height;
  level.pressure = a.pressure * std::pow(b.pressure / a.pressure, s);
  level.temperature = a.temperature + s * (b.temperature - a.temperature);
  for (size_t g = 0; g < kGases; ++g) {
    const double fa = a.fraction[g], fb = b.fraction[g];
    level.fraction[g] = fa > 0 && fb > 0 && fa != fb ? fa * std::pow(fb / fa, s) : fa + s * (fb - fa);
  }
  return level;
}

void scale(AirProfile& profile, Gas gas, double factor) {
  for (AirLevel& level : profile.levels) level.share(gas) *= factor;
}

// Factor that makes `now` of a gas the amount asked for.
double factor_to(double wanted, double now, Gas gas) {
  const std::string name(gas_name(gas));
  if (!(wanted >= 0) || wanted > kLargestNumber)
    throw Error(strf("an amount of %s of %g", name.c_str(), wanted), "it is 0 or more");
  if (wanted > 0 && !(now > 0)) throw Error(strf("the profile has no %s to scale", name.c_str()));
  return wanted > 0 ? wanted / now : 0;
}

}  // namespace

std::string_view gas_name(Gas gas) { return kGasNames[static_cast<size_t>(gas)]; }
std::optional<Gas> gas_of(std::string_view name) {
  for (size_t g = 0; g < kGases; ++g)
    if (kGasNames[g] == name) return static_cast<Gas>(g);
  return std::nullopt;
}
double molar_mass(Gas gas) { return kMolarMass[static_cast<size_t>(gas)]; }

double AirLevel::density() const { return pressure / (kBoltzmann * temperature); }

AirLevel AirProfile::at(double height) const {
  SUITE_CHECK(!levels.empty());
  if (height <= levels.front().height) {
    AirLevel level = levels.front();
    level.height = height;
    return level;
  }
  if (height > levels.back().height) {
    AirLevel level;
    level.height = height;
    level.temperature = levels.back().temperature;
    return level;
  }
  const auto above = std::lower_bound(levels.begin(), levels.end(), height,
                                      [](const AirLevel& level, double h) { return level.height < h; });
  if (above->height == height) return *above;
  return between(*(above - 1), *above, height);
}

void check_level(const AirLevel& level, const AirLevel* below, const Where& where, const std::string& whose) {
  const auto wrong = [&](const std::string& what, const char* right) { throw Error(where, whose + what, right); };
  if (!(std::abs(level.height) <= 1e6)) wrong(strf("a height of %g m", level.height), "-1e6 to 1e6 m");
  if (!(level.temperature >= 50 && level.temperature <= 3000))
    wrong(strf("a temperature of %g K", level.temperature), "50 to 3000 K");
  if (!(level.pressure > 0 && level.pressure <= 1e7)) wrong(strf("a pressure of %g Pa", level.pressure), "0 to 1e7 Pa");
  if (below && !(level.height > below->height)) wrong(strf("it follows %g m", below->height), "heights ascend");
  if (below && !(level.pressure < below->pressure))
    wrong(strf("%g Pa follow %g Pa", level.pressure, below->pressure), "pressure falls with height");
  double sum = 0;
  for (size_t g = 0; g < kGases; ++g) {
    if (!(level.fraction[g] >= 0 && level.fraction[g] <= 1))
      wrong(strf("a share of %s of %g", std::string(kGasNames[g]).c_str(), level.fraction[g]), "shares are 0 to 1");
    sum += level.fraction[g];
  }
  if (sum > 1 + 1e-9) wrong(strf("its gases sum to %g", sum), "at most 1");
}

void check_profile(const AirProfile& profile, const Where& where) {
  const auto& levels = profile.levels;
  if (levels.size() < 2) throw Error(where, strf("a profile of %zu levels", levels.size()), "two at least");
  for (size_t i = 0; i < levels.size(); ++i)
    check_level(levels[i], i ? &levels[i - 1] : nullptr, where, strf("level %zu (%g m): ", i + 1, levels[i].height));
}

std::span<const std::string_view> standard_profiles() { return kProfiles; }

AirProfile standard_profile(std::string_view name) {
  const auto found = std::find(std::begin(kProfiles), std::end(kProfiles), name);
  if (found == std::end(kProfiles)) {
    const std::vector<std::string> known(std::begin(kProfiles), std::end(kProfiles));
    throw Error("unknown standard profile '" + std::string(name) + "'", name_hint(name, known));
  }
  const double* columns =
      kAfglColumns + (found - std::begin(kProfiles)) * static_cast<std::ptrdiff_t>(kColumns * kHeights);
  AirProfile profile{std::string(name), std::vector<AirLevel>(kHeights)};
  for (size_t i = 0; i < kHeights; ++i) {
    AirLevel& level = profile.levels[i];
    level.height = 1000 * kAfglHeightKm[i];
    level.pressure = 100 * columns[i];
    level.temperature = columns[kHeights + i];
    for (size_t g = 0; g < kAfglGases; ++g) level.share(kMain[g]) = 1e-6 * columns[(2 + g) * kHeights + i];
    for (size_t g = 0; g < std::size(kTraces); ++g) level.share(kTraces[g]) = 1e-6 * kAfglTracesPpmv[g * kHeights + i];
    level.share(Gas::n2) = 0.78084 * (1 - level.share(Gas::h2o));
  }
  return profile;
}

namespace {

// Nitrogen makes room for more water vapour, and fills what less of it leaves.
void make_room(AirProfile& out, const AirProfile& before) {
  for (size_t i = 0; i < out.levels.size(); ++i) {
    const double was = before.levels[i].share(Gas::h2o), is = out.levels[i].share(Gas::h2o);
    if (is != was && was < 1) out.levels[i].share(Gas::n2) *= std::max(0.0, 1 - is) / (1 - was);
  }
}

}  // namespace

AirProfile scaled(const AirProfile& profile, const ProfileScaling& scaling) {
  AirProfile out = profile;
  check_profile(out);
  if (scaling.surface_pressure) {
    const double ground = out.levels.front().pressure, ratio = *scaling.surface_pressure / ground;
    if (!(ratio >= 0.6 && ratio <= 1.4))
      throw Error(strf("a surface pressure of %g Pa on a profile of %g Pa", *scaling.surface_pressure, ground),
                  "0.6 to 1.4 times as much; a higher ground starts higher in the profile");
    for (AirLevel& level : out.levels) level.pressure *= 1 + (ratio - 1) * level.pressure / ground;
  }
  for (size_t g = 0; g < kGases; ++g) {
    if (!scaling.at_ground[g]) continue;
    const Gas gas = static_cast<Gas>(g);
    if ((gas == Gas::h2o && scaling.water) || (gas == Gas::o3 && scaling.ozone))
      throw Error(strf("both a column and a share of %s", std::string(kGasNames[g]).c_str()), "give one of them");
    scale(out, gas, factor_to(*scaling.at_ground[g], out.levels.front().fraction[g], gas));
  }
  if (scaling.water) scale(out, Gas::h2o, factor_to(*scaling.water, precipitable_water(out), Gas::h2o));
  if (scaling.ozone) scale(out, Gas::o3, factor_to(*scaling.ozone, dobson(out), Gas::o3));
  make_room(out, profile);
  check_profile(out);
  return out;
}

double column(const AirProfile& profile, Gas gas) {
  // Gauss points of four in each layer: within one density is nearly an exponential.
  constexpr double at[] = {0.06943184420297371, 0.33000947820757187, 0.6699905217924281, 0.9305681557970263},
                   weight[] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693};
  double sum = 0;
  for (size_t i = 0; i + 1 < profile.levels.size(); ++i) {
    const AirLevel &a = profile.levels[i], &b = profile.levels[i + 1];
    const double thickness = b.height - a.height;
    for (size_t q = 0; q < std::size(at); ++q) {
      const AirLevel level = between(a, b, a.height + at[q] * thickness);
      sum += weight[q] * thickness * level.density() * level.share(gas);
    }
  }
  return sum;
}

double precipitable_water(const AirProfile& profile) {
  return column(profile, Gas::h2o) * molar_mass(Gas::h2o) / kAvogadro;
}
double dobson(const AirProfile& profile) { return column(profile, Gas::o3) / kDobson; }

double water_share(double relative_humidity, double pressure, double temperature) {
  const double celsius = temperature - 273.15;
  return relative_humidity * 611.2 * std::exp(17.67 * celsius / (celsius + 243.5)) / pressure;
}

}  // namespace suite
