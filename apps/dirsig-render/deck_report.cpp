#include "deck_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "formats/tape5/tape5.h"
#include "formats/tape7/modtran6.h"
#include "formats/tape7/tape7.h"
#include "light/kinds/solar_spectrum.h"
#include "light/stratified_air.h"
#include "motion/ephemeris.h"
#include "scheduler/air_bins.h"

namespace suite {

namespace {

constexpr size_t kMostIntervals = 50;
constexpr double kLevel = 2e3;     // m, of a horizontal path; a straight line rises by 0.3 m
constexpr double kNarrowest = 20;  // 1/cm: below it our bands of gases have no structure

// What a run is told of: one value an interval, empty where its mode has none.
struct Spectra {
  std::vector<double> transmittance, radiance, two_way, irradiance;
};
using Column = std::vector<double> Spectra::*;
struct Shown {
  Column column;
  const char *name, *unit;
};
constexpr Shown kShown[] = {{&Spectra::transmittance, "transmittance", ""},
                            {&Spectra::radiance, "path radiance", "W/(m2 sr um)"},
                            {&Spectra::two_way, "two-way transmittance", ""},
                            {&Spectra::irradiance, "the Sun's irradiance", "W/(m2 um)"}};

constexpr const char* kProfiles[] = {"tropical",         "midlatitude_summer", "midlatitude_winter",
                                     "subarctic_summer", "subarctic_winter",   "us_standard"};

// The hazes of card 2 (LOWTRAN 7, table of IHAZE): kind below 2 km and visibility, m.
struct Haze {
  int number;
  const char* kind;
  double visibility;
};
constexpr Haze kHazes[] = {
    {1, "rural", 23e3}, {2, "rural", 5e3}, {4, "maritime", 23e3}, {5, "urban", 5e3}, {6, "free_troposphere", 50e3}};

void add_haze(const Tape5Run& run, AirSpec& air) {
  if (run.haze == 0) return;
  const auto* haze = std::find_if(std::begin(kHazes), std::end(kHazes), [&](auto& h) { return h.number == run.haze; });
  if (haze == std::end(kHazes))
    throw Error(run.where, strf("haze %d of card 2 is none that our air has", run.haze),
                "0 none, 1 and 2 rural, 4 maritime, 5 urban, 6 tropospheric");
  AirSpec::Aerosol aerosol;
  aerosol.boundary.name = haze->kind;
  aerosol.profile = AerosolProfile(run.visibility.value_or(haze->visibility));
  air.aerosol = aerosol;
}

AirSpec air_of(const Tape5Run& run) {
  AirSpec air;
  air.where = run.where;
  ProfileScaling scaling;
  if (run.co2_ppm) scaling.at_ground[static_cast<size_t>(Gas::co2)] = 1e-6 * *run.co2_ppm;
  air.profile = scaled(standard_profile(kProfiles[run.model - 1]), scaling);
  air.gases = shared_builtin_gases();
  add_haze(run, air);
  air.scene_height = 0;
  air.ground_height = run.ground_height;
  air.ground_albedo = Curve::constant(run.surface_albedo);
  air.ground_temperature = run.surface_temperature.value_or(0);
  air.scattering = run.many_scatterings ? AirScattering::diffuse : AirScattering::single;
  check_air(air);
  return air;
}

// Ascending in wavelength, evenly wide in wavenumber, all within the deck's band.
std::vector<Band> intervals_of(const Tape5Run& run) {
  const double all = run.last - run.first,
               width = std::max({kNarrowest, run.width, all / static_cast<double>(kMostIntervals)});
  const auto n = static_cast<size_t>(std::max(1.0, std::floor(all / width + 1e-9)));
  if (!(all > 0)) throw Error(run.where, "the deck's band is one wavenumber", "a band of card 4");
  std::vector<Band> bands;
  for (size_t i = n; i-- > 0;) {
    const auto edge = [&](size_t k) { return run.first + all * static_cast<double>(k) / static_cast<double>(n); };
    const double low = 1e4 / edge(i + 1) * (1 + 1e-12), high = 1e4 / edge(i) * (1 - 1e-12);
    bands.push_back(Band::rectangular(strf("%.1f to %.1f", edge(i), edge(i + 1)), 0.5 * (low + high), high - low));
  }
  return bands;
}

// A segment: it begins at the observer over the origin and looks north. distance: m, infinite into space.
struct Line {
  Vec3 from;
  Dir direction;
  double distance = INFINITY;
};

// Where a straight line from a height at a zenith angle first comes to another height, m; infinite: never.
double way_to(double from, double zenith, double to, double radius) {
  const double r = radius + from, rise = r * std::cos(zenith), side = r * std::sin(zenith),
               under = (radius + to) * (radius + to) - side * side;
  if (under < 0) return INFINITY;
  const double way = to < from ? -rise - std::sqrt(under) : -rise + std::sqrt(under);
  return way > 0 ? way : INFINITY;
}

Line line_of(const Tape5Run& run, double radius) {
  double zenith = run.zenith.value_or(0), distance = INFINITY;
  const double h1 = run.observer_height, h2 = run.end_height;
  if (run.path_type == 1) {
    if (!run.range) throw Error(run.where, "a horizontal path without a range", "columns 31 to 40 of card 3");
    // A part of it, which is nearly level: see along_level.
    distance = std::min(*run.range, kLevel);
    zenith = kPi / 2;
  } else if (run.path_type == 2 && run.range) {
    distance = *run.range;
    // Angles of zero are blanks where the two heights and the range say the angle.
    if (const double rise = h2 - h1; zenith == 0 && rise != 0 && std::fabs(rise) <= distance) {
      const double r1 = radius + h1, r2 = radius + h2;
      zenith = std::acos(std::clamp((r2 * r2 - r1 * r1 - distance * distance) / (2 * r1 * distance), -1.0, 1.0));
    }
  } else {
    const double end = run.path_type == 2 ? h2 : run.ground_height;
    if (run.path_type == 2 || zenith > kPi / 2) distance = way_to(h1, zenith, end, radius);
    if (run.path_type == 2 && !std::isfinite(distance))
      throw Error(run.where, strf("the path of card 3 never comes to H2, %g m", h2));
  }
  return {{0, 0, h1}, {0, std::sin(zenith), std::cos(zenith)}, distance};
}

// The Sun over the observer: by its angles, or by the date in a year like any other.
struct SunOfDeck {
  Dir direction;
  double nearer = 1;  // square of an astronomical unit over its distance
};
std::optional<SunOfDeck> sun_of(const Tape5Run& run) {
  if (run.mode < 2) return std::nullopt;
  SunOfDeck sun;
  // J. Duffie & W. Beckman, "Solar engineering of thermal processes", 1980, equation 1.4.1.
  if (run.day && *run.day > 0) sun.nearer = 1 + 0.033 * std::cos(2 * kPi * *run.day / 365);
  if (run.mode == 3) {
    sun.direction = {0, std::sin(run.zenith.value_or(0)), std::cos(run.zenith.value_or(0))};
  } else if (run.solar_zenith) {
    // Azimuths count clockwise from the line of sight, which looks north.
    sun.direction = dir_from_angles(*run.solar_zenith, kPi / 2 - run.relative_azimuth.value_or(0));
  } else if (run.latitude && run.hour && run.day) {
    const SceneFrame frame({*run.latitude / kDegree, *run.longitude / kDegree, 0});
    const Instant instant =
        instant_from_utc(parse_iso8601("2001-01-01T00:00:00Z")) + 86400.0 * (*run.day - 1) + 3600 * *run.hour;
    sun.direction = sun_at(frame, {}, instant).direction;
  } else {
    throw Error(run.where, "the deck does not say where the Sun stands", "cards 3A1 and 3A2");
  }
  return sun;
}

std::vector<double> means(const BandProjection& projection, std::span<const float> bins) {
  std::vector<double> sums(projection.bands(), 0.0);
  projection.add(bins, sums);
  return sums;
}

// A path at one pressure is as any part of it: transmittances multiply, and each part's radiance passes those before
// it.
void along_level(double parts, std::vector<float>& T, std::vector<float>& S) {
  for (size_t i = 0; i < T.size(); ++i) {
    const double one = double{T[i]}, all = std::pow(one, parts), lost = 1 - one;
    S[i] = static_cast<float>(double{S[i]} * (lost > 1e-6 ? (1 - all) / lost : parts));
    T[i] = static_cast<float>(all);
  }
}

Spectra ours(const Tape5Run& run, std::span<const Band> bands) {
  const AirSpec air = air_of(run);
  const SpectralState state = bins_in_air(air, make_state(bands, 0.01), bands).state;
  const BandProjection projection(state, bands);
  std::vector<float> light, T(state.size()), S(state.size());
  std::vector<Beam> beams;
  const std::optional<SunOfDeck> sun = sun_of(run);
  if (sun) {
    light = state.sample(solar_irradiance().scaled(sun->nearer));
    beams.push_back({sun->direction, light.data()});
  }
  const auto atmosphere = make_stratified_air(air, state, beams);
  const Line line = line_of(run, air.radius);
  Spectra s;
  if (run.mode == 3) {
    atmosphere->transmittance(line.from, sun->direction, INFINITY, T);
    s.transmittance = means(projection, T);
    for (size_t i = 0; i < T.size(); ++i) T[i] *= light[i];
    s.irradiance = means(projection, T);
    return s;
  }
  atmosphere->path(line.from, line.direction, line.distance, T, S);
  if (run.path_type == 1) along_level(*run.range / line.distance, T, S);
  s.transmittance = means(projection, T);
  if (run.mode > 0) s.radiance = means(projection, S);
  if (run.mode < 2 || !std::isfinite(line.distance)) return s;
  atmosphere->transmittance(line.from + line.direction * line.distance, sun->direction, INFINITY, S);
  for (size_t i = 0; i < T.size(); ++i) T[i] *= S[i];
  s.two_way = means(projection, T);
  return s;
}

Spectra theirs(const Tape7Block& run, std::span<const Band> bands) {
  std::vector<double> wavelength_um;
  for (const double nu : run.wavenumber) wavelength_um.push_back(1e4 / nu);
  const auto over = [&](const std::vector<double>& values) {
    const Curve curve(wavelength_um, values, Outside::error, run.header);
    std::vector<double> all;
    for (const Band& b : bands) all.push_back(curve.mean(b.low_um(), b.high_um()));
    return all;
  };
  const auto written = [&](const char* name) {
    const Tape7Column* c = run.find(name);
    return c && std::all_of(c->values.begin(), c->values.end(), [](double v) { return std::isfinite(v); });
  };
  Spectra s;
  s.transmittance = over(run.transmittance().values);
  if (run.mode == Tape7Mode::irradiance)
    s.irradiance = over(run.column("SOL_TR").values);
  else if (run.mode != Tape7Mode::transmittance)
    s.radiance = over(run.path_radiance());
  if (written("REF_SOL") && written("TOA_SUN")) s.two_way = over(run.two_way_transmittance());
  return s;
}

std::string compared(const Shown& shown, std::span<const Band> bands, const std::vector<double>& a,
                     const std::vector<double>& b) {
  const std::string unit = *shown.unit ? std::string(", ") + shown.unit : "";
  std::string text = strf("  %s%s\n  %-20s %12s", shown.name, unit.c_str(), "1/cm", "here");
  text += b.empty() ? "\n" : strf(" %12s %12s\n", "theirs", "difference");
  double squares = 0, most = 0, level = 0;
  size_t at = 0;
  for (size_t i = 0; i < bands.size(); ++i) {
    text += strf("  %-20s %12.5g", bands[i].name.c_str(), a[i]);
    text += b.empty() ? "\n" : strf(" %12.5g %12.4g\n", b[i], a[i] - b[i]);
    if (b.empty()) continue;
    squares += (a[i] - b[i]) * (a[i] - b[i]);
    level += b[i];
    if (std::fabs(a[i] - b[i]) > most) most = std::fabs(a[i] - b[i]), at = i;
  }
  if (b.empty()) return text;
  const auto n = static_cast<double>(bands.size());
  return text + strf("  difference: rms %.3g, largest %.3g (%s 1/cm); their mean %.4g\n", std::sqrt(squares / n), most,
                     bands[at].name.c_str(), level / n);
}

std::string head_of(const Tape5Run& run, size_t number) {
  const Line line = line_of(run, AirSpec{}.radius);
  const bool level = run.path_type == 1 && run.mode != 3;
  std::string text = strf("run %zu: %s, %s, from %g m ", number, kProfiles[run.model - 1],
                          run.haze ? strf("haze %d", run.haze).c_str() : "no haze", run.observer_height);
  text +=
      level ? "along its level (ITYPE 1)" : strf("at %.4g degrees from the zenith", run.zenith.value_or(0) / kDegree);
  const double distance = level ? *run.range : line.distance;
  if (run.mode != 3) text += std::isfinite(distance) ? strf(" over %.6g m", distance) : " into space";
  if (const auto sun = sun_of(run); sun && run.mode == 2)
    text += strf(", the Sun at %.4g degrees", polar_angle(sun->direction) / kDegree);
  text += run.many_scatterings ? "; scattered often\n" : "; scattered once\n";
  if (run.unread.empty()) return text;
  text += "  not followed here:";
  for (size_t i = 0; i < run.unread.size(); ++i) text += (i ? ", " : " ") + run.unread[i];
  return text + "\n";
}

void check_same(const Tape5Run& run, const Tape7Block& other) {
  const int mode = static_cast<int>(other.mode);
  // A run with the Sun below the horizon has no columns of it.
  if (mode != run.mode && !(run.mode == 2 && other.mode == Tape7Mode::thermal_radiance))
    throw Error(other.header, strf("this run is of mode %d, that of the deck of mode %d", mode, run.mode),
                "the output of the deck");
  // The last row may be one step short of the end that card 4 gives.
  if (other.wavenumber.front() > run.first * (1 + 1e-6) || other.wavenumber.back() < (run.last - run.step) * (1 - 1e-6))
    throw Error(other.header,
                strf("this run reaches from %g to %g 1/cm, the deck's from %g to %g", other.wavenumber.front(),
                     other.wavenumber.back(), run.first, run.last),
                "the output of the deck");
}

}  // namespace

bool is_deck(const std::string& path) {
  const std::filesystem::path p(path);
  const std::string ending = p.extension().string();
  return ending == ".tp5" || ending == ".ltn" || ending == ".tape5" || p.filename().string().starts_with("tape5");
}

std::string deck_text(const std::string& deck, const std::string& against) {
  std::vector<Tape5Run> runs = read_tape5(deck);
  std::vector<Tape7Block> others;
  if (!against.empty()) others = against.ends_with(".json") ? read_modtran6(against) : read_tape7(against);
  if (!others.empty() && others.size() != runs.size())
    throw Error(Where{against, 0, 0, {}, -1},
                strf("%zu runs stand beside the %zu of the deck", others.size(), runs.size()),
                "the output of the deck");
  for (size_t i = 0; i < others.size(); ++i) {
    check_same(runs[i], others[i]);
    runs[i].last = std::min(runs[i].last, others[i].wavenumber.back());
  }
  std::string text;
  for (size_t i = 0; i < runs.size(); ++i) {
    std::vector<Band> bands = intervals_of(runs[i]);
    text += head_of(runs[i], i + 1);
    const Spectra here = ours(runs[i], bands);
    const Spectra there = others.empty() ? Spectra{} : theirs(others[i], bands);
    for (const Shown& shown : kShown)
      if (!(here.*shown.column).empty()) text += compared(shown, bands, here.*shown.column, there.*shown.column);
  }
  return text;
}

}  // namespace suite
