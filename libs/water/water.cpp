#include "water/water.h"

#include <algorithm>
#include <cmath>

#include "optics/phases/sea_particles.h"
#include "water/constituents.h"

namespace suite {

namespace {

void check_number(const Where& where, const char* name, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return;
  throw Error(where, strf("water: %s %g", name, value), strf("%g to %g %s", low, high, unit), "SP601");
}

void check(const WaterSpec& s, const Where& where) {
  check_number(where, "temperature_c", s.temperature_c, -2, 40, "degrees Celsius");
  check_number(where, "salinity", s.salinity_psu, 0, 45, "PSU");
  check_number(where, "chlorophyll", s.chlorophyll, 0, 300, "mg/m3");
  check_number(where, "cdom", s.dissolved_440, 0, 100, "1/m at 440 nm");
  check_number(where, "cdom_slope_per_nm", s.dissolved_slope_per_nm, 0.001, 0.05, "1/nm");
  check_number(where, "mineral", s.mineral, 0, 10000, "g/m3");
  check_number(where, "mineral_backscatter", s.mineral_backscatter, kLeastBackscatter, kMostBackscatter, "");
  if (s.backscatter != 0) check_number(where, "backscatter", s.backscatter, kLeastBackscatter, kMostBackscatter, "");
  check_number(where, "g", s.g, -0.9999, 0.9999, "");
  if (s.particles != "fournier_forand" && s.particles != "petzold" && s.particles != "hg")
    throw Error(where, "water: unknown phase '" + s.particles + "'", "fournier_forand, petzold or hg", "SP601");
  if (s.pure_absorption && s.pure_absorption->min() < 0)
    throw Error(where, strf("water: pure_absorption %g", s.pure_absorption->min()), "1/m, at least 0", "SP601");
  if (s.measured && (s.chlorophyll > 0 || s.dissolved_440 > 0 || s.case_1_dissolved || s.mineral > 0))
    throw Error(where, "water: measured properties hold all that is in the water",
                "leave out chlorophyll, cdom and mineral, or iop", "SP601");
}

void add_rows(const Curve& c, std::vector<double>& um) {
  if (c.is_constant()) return;
  um.insert(um.end(), c.wavelength_um().begin(), c.wavelength_um().end());
}

std::vector<double> wavelengths(const WaterSpec& s) {
  std::vector<double> um = pure_water_wavelengths(s.pure);
  for (int i = 0; i <= 240; ++i) um.push_back(kWaterLowUm + 0.0025 * i);
  um.push_back(kWaterHighUm);
  std::vector<const Curve*> given;
  if (s.pure_absorption) given.push_back(&*s.pure_absorption);
  if (s.measured) given.insert(given.end(), {&s.measured->absorption, &s.measured->scattering});
  for (const Curve* c : given) add_rows(*c, um);
  std::sort(um.begin(), um.end());
  const auto outside = [&](double w) {
    return w < kWaterLowUm || w > kWaterHighUm ||
           std::any_of(given.begin(), given.end(), [&](const Curve* c) { return !c->covers(w, w); });
  };
  um.erase(std::remove_if(um.begin(), um.end(), outside), um.end());
  um.erase(std::unique(um.begin(), um.end(), [](double a, double b) { return b - a < 1e-9; }), um.end());
  return um;
}

struct Properties {
  double water_absorption, absorption = 0, water = 0, particles = 0, minerals = 0;  // 1/m
  double scattering() const { return water + particles + minerals; }
};

Properties properties(const WaterSpec& s, double um, const Where& where) {
  Properties p{};
  p.water = sea_water_scattering(um, s.temperature_c, s.salinity_psu);
  if (!s.measured || !s.measured->with_water)
    p.water_absorption = s.pure_absorption ? s.pure_absorption->at(um) : pure_water_absorption(s.pure, um);
  if (!s.measured) {
    p.absorption = p.water_absorption + phytoplankton_absorption(um, s.chlorophyll) +
                   dissolved_absorption(um, s.case_1_dissolved ? case_1_dissolved(s.chlorophyll) : s.dissolved_440,
                                        s.dissolved_slope_per_nm) +
                   mineral_absorption(um, s.mineral);
    p.particles = phytoplankton_scattering(um, s.chlorophyll);
    p.minerals = mineral_scattering(s.mineral);
    return p;
  }
  const MeasuredWater& m = *s.measured;
  p.absorption = p.water_absorption + m.absorption.at(um);
  p.particles = m.scattering.at(um) - (m.with_water ? p.water : 0);
  if (p.particles < -0.01 * p.water)
    throw Error(where,
                strf("water: the measured scattering at %g um is %g 1/m, less than the %g of sea water itself", um,
                     m.scattering.at(um), p.water),
                "with 'includes_water: false' it is that of particles alone", "SP601");
  p.particles = std::max(0.0, p.particles);
  return p;
}

// Of the first kind of particles; measured: the mean over wavelengths, weighed by what scatters.
double backscatter_of(const WaterSpec& s, const std::vector<double>& um) {
  if (s.backscatter > 0) return s.backscatter;
  if (!s.measured) return phytoplankton_backscatter(s.chlorophyll > 0 ? s.chlorophyll : 1);
  if (!s.measured->backscatter) return 0.0183;  // Petzold's average particle
  double back = 0, all = 0;
  for (const double w : um) {
    if (!s.measured->backscatter->covers(w, w)) continue;
    const double water = s.measured->with_water ? sea_water_scattering(w, s.temperature_c, s.salinity_psu) : 0;
    back += s.measured->backscatter->at(w) - 0.5 * water;
    all += s.measured->scattering.at(w) - water;
  }
  return all > 0 ? std::clamp(back / all, kLeastBackscatter, kMostBackscatter) : 0.0183;
}

}  // namespace

Medium water_medium(const WaterSpec& s, const Where& where) {
  check(s, where);
  const std::vector<double> um = wavelengths(s);
  if (um.size() < 2) throw Error(where, "water: the curves given have no wavelengths in common", "", "SP601");
  std::vector<double> absorption, scattering, index, particles, minerals;
  for (const double w : um) {
    const Properties p = properties(s, w, where);
    absorption.push_back(p.absorption);
    scattering.push_back(p.scattering());
    particles.push_back(p.particles / p.scattering());
    minerals.push_back(p.minerals / p.scattering());
    index.push_back(sea_water_index(w, s.temperature_c, s.salinity_psu));
  }
  const auto curve = [&](std::vector<double> v) { return Curve(um, std::move(v), Outside::error, where); };
  Medium m;
  m.absorption = curve(std::move(absorption));
  m.scattering = curve(std::move(scattering));
  m.index = curve(std::move(index));
  m.phase = {"sea",
             {{"backscatter", backscatter_of(s, um)},
              {"g", s.g},
              {"mineral_backscatter", s.mineral_backscatter},
              {"depolarisation", kWaterDepolarisation}},
             {{"particles", curve(std::move(particles))}, {"minerals", curve(std::move(minerals))}},
             {{"kind", s.particles}},
             nullptr};
  m.temperature_k = s.temperature_c + 273.15;
  return m;
}

namespace {

// Raman light over elastic light of the water's own upwelling radiance, deep water, at wavelength um: both as what is
// scattered back per metre over how far light goes (the light that makes it at the excitation's wavelength).
double raman_share(const Medium& m, double backscatter, double um) {
  const double from = 1 / (1 / um + 0.34);  // a shift of 3400 1/cm
  if (!m.absorption.covers(from, um)) return 0;
  const double elastic = m.scattering.at(um) * backscatter / (2 * m.absorption.at(um));
  return 0.5 * raman_scattering(from) / (m.absorption.at(from) + m.absorption.at(um)) / elastic;
}

}  // namespace

std::vector<std::string> water_notes(const WaterSpec& s, const Medium& m) {
  std::vector<std::string> notes;
  double most = 0, at = 0;
  for (double um = 0.45; um < 0.701; um += 0.01) {
    if (!m.absorption.covers(um, um)) continue;
    const double particles = m.phase.curves.at("particles").at(um), minerals = m.phase.curves.at("minerals").at(um);
    const double back = particles * m.phase.numbers.at("backscatter") +
                        minerals * m.phase.numbers.at("mineral_backscatter") + 0.5 * (1 - particles - minerals);
    if (const double share = raman_share(m, back, um); share > most) most = share, at = um;
  }
  if (most > 0)
    notes.push_back(
        strf("Raman scattering is left out, some %.0f %% of the water's own light at %.2f um; and fluorescence (of "
             "chlorophyll near 0.685 um, of dissolved matter in the blue)",
             100 * most, at));
  if (!s.pure_absorption && !(s.measured && s.measured->with_water) && m.absorption.covers(0.44, 0.44))
    notes.push_back(
        strf("absorption of pure water is %.4f 1/m at 0.44 um after %s; Pope & Fry (1997) measured 0.0064: %.0f %% of "
             "all absorption there may be too much (pure_absorption takes another table)",
             pure_water_absorption(s.pure, 0.44), s.pure == PureWater::segelstein ? "Segelstein" : "Hale & Querry",
             100 * (pure_water_absorption(s.pure, 0.44) - 0.00635) / m.absorption.at(0.44)));
  return notes;
}

}  // namespace suite
