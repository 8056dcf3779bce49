#include "correction/lut.h"

#include <algorithm>
#include <cmath>

#include "light/kinds/solar_spectrum.h"
#include "math/vec.h"
#include "scheduler/air_bins.h"

namespace suite {

namespace {

constexpr double kMicrowatts = 0.1;  // uW/(cm2 nm) in W/(m2 um)
constexpr double kPerGram = 10;      // kg/m2 in g/cm2
constexpr size_t kMostViews = 10000000;

LutAxis& of(LutAxes& axes, LutAxisOf axis) { return axes[static_cast<size_t>(axis)]; }

void check_axis(const LutAxis& axis) {
  const std::string name(axis.name);
  for (size_t i = 0; i < axis.values.size(); ++i) {
    const double v = axis.values[i];
    if (!(v >= axis.low && v <= axis.high))
      throw Error(strf("%s = %g is outside the valid range", name.c_str(), v),
                  strf("give values from %g to %g %s", axis.low, axis.high, axis.unit));
    if (i > 0 && !(v > axis.values[i - 1]))
      throw Error(strf("%s has %g after %g", name.c_str(), v, axis.values[i - 1]), "values ascend");
  }
}

// The profile from a height up.
AirProfile above(const AirProfile& profile, double height) {
  if (!(height > profile.levels.front().height)) return profile;
  AirProfile cut{profile.name, {profile.at(height)}};
  for (const AirLevel& level : profile.levels)
    if (level.height > height + 0.5) cut.levels.push_back(level);
  if (cut.levels.size() < 2) throw Error(strf("a ground at %g m lies above the air's profile", height));
  return cut;
}

// The number along each of the axes from `first` on, of the table's combination k of them.
std::vector<double> values_at(const LutAxes& axes, size_t first, size_t count, size_t k) {
  std::vector<double> at(count);
  for (size_t a = count; a-- > 0;) {
    const std::vector<double>& values = axes[first + a].values;
    at[a] = values[k % values.size()];
    k /= values.size();
  }
  return at;
}

size_t combinations(const LutAxes& axes, size_t first, size_t count) {
  size_t n = 1;
  for (size_t a = first; a < first + count; ++a) n *= std::min(axes[a].values.size(), kMostViews);
  return n;
}

double narrowest(std::span<const Band> bands) {
  double least = INFINITY;
  for (const Band& b : bands) least = std::min(least, b.fwhm_um);
  return least;
}

}  // namespace

LutAxes lut_axes() {
  return {{{"H2OSTR", "g/cm2", 0.001, 20, {}},
           {"AOT550", "1", 0, 5, {}},
           {"O3", "DU", 0, 1000, {}},
           {"surface_elevation_km", "km", -0.5, 9, {}},
           {"observer_altitude_km", "km", -0.5, 1e6, {}},
           {"observer_zenith", "deg", 0, 75, {}},
           {"solar_zenith", "deg", 0, 89, {}},
           {"relative_azimuth", "deg", 0, 180, {}}}};
}

size_t LutTable::states() const { return combinations(axes, 0, kLutStateAxes); }
size_t LutTable::views() const { return combinations(axes, kLutStateAxes, kLutAxes - kLutStateAxes); }

std::string LutTable::name_of(size_t state) const {
  const std::vector<double> at = values_at(axes, 0, kLutStateAxes, state);
  std::string text;
  for (size_t a = 0; a < kLutStateAxes; ++a)
    text += strf("%s%s %g", a ? ", " : "", std::string(axes[a].name).c_str(), at[a]);
  return text;
}

namespace {

// What is no air (more water than a level can hold) is refused here and not after hours, when its turn comes.
void check_states(const AirSpec& air, const LutTable& table) {
  for (size_t k = 0; k < table.states(); ++k) try {
      air_of_state(air, table, k);
    } catch (const Error& e) {
      throw Error(e.where(), "no air has " + table.name_of(k) + ": " + e.message(), e.hint());
    }
}

}  // namespace

LutTable make_lut(const AirSpec& air, std::vector<Band> bands, LutAxes axes) {
  for (const LutAxis& axis : axes) check_axis(axis);
  if (of(axes, LutAxisOf::sun_zenith).values.empty())
    throw Error("a table for atmospheric correction wants values of solar_zenith, degrees");
  if (!of(axes, LutAxisOf::aerosol).values.empty() && !air.aerosol)
    throw Error("AOT550 is given for air without aerosol", "give the atmosphere an `aerosol`, or leave AOT550 out");
  const auto otherwise = [&](LutAxisOf axis, double value) {
    if (of(axes, axis).values.empty()) of(axes, axis).values = {value};
  };
  otherwise(LutAxisOf::elevation, 1e-3 * air.height_of_ground());
  otherwise(LutAxisOf::height, 100);
  otherwise(LutAxisOf::view_zenith, 0);
  otherwise(LutAxisOf::azimuth, 0);
  const double ground = of(axes, LutAxisOf::elevation).values.back();
  const AirProfile profile = above(air.profile, 1e3 * of(axes, LutAxisOf::elevation).values.front());
  otherwise(LutAxisOf::water, precipitable_water(profile) / kPerGram);
  otherwise(LutAxisOf::aerosol, air.aerosol ? air.aerosol->profile.depth() : 0);
  otherwise(LutAxisOf::ozone, dobson(profile));
  if (!(of(axes, LutAxisOf::height).values.front() > ground))
    throw Error(strf("a sensor at observer_altitude_km %g is not above the ground at surface_elevation_km %g",
                     of(axes, LutAxisOf::height).values.front(), ground));
  if (combinations(axes, kLutStateAxes, kLutAxes - kLutStateAxes) > kMostViews ||
      combinations(axes, 0, kLutStateAxes) > kMostViews)
    throw Error("the table has more than 1e7 states or views", "give fewer values");
  std::ranges::sort(bands, {}, &Band::center_um);
  LutTable table{std::move(axes), std::move(bands), {}};
  for (const Band& b : table.bands) table.solar_irradiance.push_back(kMicrowatts * band_mean(b, solar_irradiance()));
  check_states(air, table);
  return table;
}

AirSpec air_of_state(const AirSpec& air, const LutTable& table, size_t state) {
  const std::vector<double> at = values_at(table.axes, 0, kLutStateAxes, state);
  const double ground = 1e3 * at[static_cast<size_t>(LutAxisOf::elevation)];
  AirSpec made = air;
  made.scene_height = ground;
  made.ground_height = ground;
  ProfileScaling scaling;
  scaling.water = kPerGram * at[static_cast<size_t>(LutAxisOf::water)];
  scaling.ozone = at[static_cast<size_t>(LutAxisOf::ozone)];
  made.profile = scaled(above(air.profile, ground), scaling);
  if (made.aerosol)
    made.aerosol->profile = made.aerosol->profile.with_depth(at[static_cast<size_t>(LutAxisOf::aerosol)]);
  return made;
}

double widest_bin(const LutTable& table, const LutFineness& fineness) {
  return fineness.widest_um > 0 ? fineness.widest_um : std::min(0.01, 0.5 * narrowest(table.bands));
}

SpectralState lut_bins(AirSpec& air_of_state, const LutTable& table, const LutFineness& fineness) {
  air_of_state.streams = fineness.streams;
  air_of_state.points.most = fineness.points;
  SpectralState wanted = make_state(table.bands, widest_bin(table, fineness), 0, 1);
  wanted.choice = {1e-3, widest_bin(table, fineness), 1};
  return bins_in_air(air_of_state, wanted, table.bands).state;
}

LutState lut_state(const AirSpec& air, const LutTable& table, size_t state, const LutFineness& fineness) {
  AirSpec here = air_of_state(air, table, state);
  const SpectralState bins = lut_bins(here, table, fineness);
  std::vector<CorrectionView> views;
  for (size_t v = 0; v < table.views(); ++v) {
    const std::vector<double> at = values_at(table.axes, kLutStateAxes, kLutAxes - kLutStateAxes, v);
    views.push_back({at[2], at[1], at[3], 1e3 * at[0]});
  }
  const std::vector<CorrectionBins> all = air_correction(here, bins, views, fineness.thin);
  const std::vector<float> sun = bins.sample(solar_irradiance());
  const BandProjection projection(bins, table.bands);
  LutState out;
  for (size_t v = 0; v < views.size(); ++v)
    out.push_back(lut_values(all[v], sun, std::cos(views[v].sun_zenith * kDegree), projection));
  return out;
}

LutValues lut_difference(const LutState& a, const LutState& b) {
  LutValues most;
  for (size_t k = 0; k < kLutKeys; ++k) {
    most[k].assign(a.at(0)[k].size(), 0.0);
    for (size_t v = 0; v < a.size(); ++v)
      for (size_t i = 0; i < most[k].size(); ++i)
        most[k][i] = std::max(most[k][i], std::fabs(a[v][k][i] - b.at(v)[k][i]));
  }
  return most;
}

}  // namespace suite
