// The layered slab: waves in depth, stiff starts, a thin film on concrete, conservation, and what cannot run yet.
#include <cmath>
#include <fstream>
#include <sstream>

#include "extreme/case.h"
#include "spectral/planck.h"
#include "support/slab_kit.h"

namespace suite::extreme {

namespace {

using namespace test;

// Carslaw & Jaeger, Conduction of heat in solids, 2.6, thermal inertia 120.
double periodic_wave(double depths) {
  const double period = 59479413.48, inertia = 120, heat = 960000;
  const double conductivity = inertia * inertia / heat, depth = std::sqrt(conductivity / heat * period / kPi),
               rate = 2 * kPi / period;
  SlabSpec spec;
  spec.layers = {uniform(14 * depth, heat / 1000, 1000, conductivity, 1400)};
  spec.top = held([rate](double t) { return 190 + 30 * std::sin(rate * t); });
  spec.bottom = flux(0);
  Slab slab(spec, {1e-4, period / 200, 1e-9, 60});
  slab.start(0, 190);
  spin_up(slab, 0, period, {1e-7, 200});
  double worst = 0;
  for (int i = 1; i <= 24; ++i) {
    slab.advance(period * (1 + i / 24.0));
    worst = std::fmax(worst, std::fabs(slab.at_depth(depths * depth) - 190 -
                                       30 * std::exp(-depths) * std::sin(rate * period * i / 24.0 - depths)));
  }
  return worst;
}

// A half space at 200 K in balance whose light is cut off, thermal inertia 500, default grid and steps.
double cut_off(double inertia) {
  const double heat = 1e6, conductivity = inertia * inertia / heat;
  const double F = kStefanBoltzmann * std::pow(200.0, 4), h = 4 * F / 200, x = h * std::sqrt(50) / inertia;
  SlabSpec spec;
  spec.layers = {uniform(0.5, 1000, 1000, conductivity)};
  spec.top = surface(1, [](double) { return SurfaceLoad{}; });
  spec.bottom = flux(0);
  Slab slab(spec, {});
  slab.start(0, 200);
  slab.advance(50);
  // Carslaw & Jaeger 2.7 with the loss linearised; 198.586 K at inertia 500.
  return std::fabs(slab.surface() - (200 - F / h * (1 - std::exp(x * x) * std::erfc(x))));
}

double mean_flux(double q) {
  const double period = 88775;
  SlabSpec spec;
  spec.layers = {uniform(0.1, 1200, 700, 0.05), uniform(0.4, 1800, 800, 0.5)};
  spec.layers[0].contact_resistance = 0.02;
  spec.top = surface(0.95, [period](double t) {
    return SurfaceLoad{600 * std::fmax(0.0, -std::cos(2 * kPi * t / period)), 0, 0, 0};
  });
  spec.bottom = flux(q);
  Slab slab(spec, {0.02, period / 24, 1e-9, 60});
  slab.start(0, 220);
  spin_up(slab, 0, period, {2e-11, 500});
  double worst = 0;
  for (const double f : slab.mean_fluxes()) worst = std::fmax(worst, std::fabs(f + q));
  return worst;
}

// A film of `microns` um on a metre of concrete through a sunny day at full hours, against steps of 1 s or a quarter.
SlabSpec film(double microns) {
  SlabSpec spec;
  spec.layers = {uniform(microns * 1e-6, 2700, 900, 0.2), uniform(1, 2300, 880, 1.4)};
  spec.top = surface(0.9, [](double t) {
    const double phase = 2 * kPi * t / 86400, sun = std::fmax(0.0, -std::cos(phase));
    return SurfaceLoad{700 * sun * sun, 320, 288 - 5 * std::cos(phase), 2};
  });
  spec.top.convection_still = 5.7;
  spec.top.convection_wind = 3.8;
  spec.bottom = flux(0);
  return spec;
}
double film_error(const Numerics& numerics, double dt, double microns) {
  const SlabSpec spec = film(microns);
  Slab start(spec, {0.01, 1800, 1e-9, 60});
  start.start(0, 288);
  start.advance(86400);
  const std::vector<double> dawn(start.kelvin().begin(), start.kelvin().end());
  const double report = std::fmax(3600, dt);
  const std::vector<double> reference = production().slab(spec, dawn, std::fmin(1, dt / 4), report, 43200);
  const std::vector<double> got = numerics.slab(spec, dawn, dt, report, 43200);
  double worst = 0;
  for (size_t i = 0; i < got.size(); ++i) {
    if (std::isnan(got[i])) return got[i];
    worst = std::fmax(worst, std::fabs(got[i] - reference[i]));
  }
  return got.size() == reference.size() ? worst : std::nan("");
}

double huge_step(double dt) {
  SlabSpec spec;
  spec.layers = {uniform(1e-5, 2700, 900, 200), uniform(0.001, 2700, 900, 0.2)};
  spec.top = surface(1, [](double) { return SurfaceLoad{0, 400, 0, 0}; });
  spec.bottom = flux(0);
  Slab slab(spec, {0.01, 1e9, 1e-9, 60});
  const double balance = std::pow(400 / kStefanBoltzmann, 0.25);
  slab.start(0, balance + 5);
  for (int i = 0; i < 2; ++i)
    if (!slab.step(dt)) return INFINITY;
  return std::fabs(slab.surface() - balance);
}

double steady_wall(double contrast) {
  SlabSpec wall;
  wall.layers = {uniform(0.1, 1000, 1000, 0.5), uniform(0.2, 2000, 800, 0.5 * contrast)};
  wall.layers[0].contact_resistance = 0.3;
  wall.top = held([](double) { return 300.0; });
  wall.bottom = held([](double) { return 290.0; });
  Slab a(wall, {1e-3, 1e7, 1e-9, 600});
  a.start(0, 295);
  a.advance(1e9);
  a.reset_means();
  a.advance(1.1e9);
  const double q = 10 / (0.1 / 0.5 + 0.3 + 0.2 / (0.5 * contrast));
  double worst = 0;
  for (const double f : a.mean_fluxes()) worst = std::fmax(worst, std::fabs(f / q - 1));
  return worst;
}

// The equatorial night of the Moon after P. O. Hayne et al., JGR Planets 122, 2017, against the Diviner radiometer.
double lunar_night() {
  const double period = 2.55024e6;
  SlabSpec spec;
  spec.layers = lunar_regolith();
  spec.top = surface(0.95, [period](double t) { return SurfaceLoad{lunar_sun(t, period), 0, 0, 0}; });
  spec.bottom = flux(0.018);
  Slab slab(spec, {0.02, period / 48, 1e-9, 60});
  slab.start(0, 250);
  spin_up(slab, 0, period, {1e-6, 500});
  std::ifstream in(SUITE_TEST_DATA "/thermal/diviner_regtemp_lat00.csv");
  std::string line;
  std::getline(in, line);
  double worst = 0;
  int rows = 0;
  for (; std::getline(in, line); ++rows) {
    std::istringstream cells(line);
    double hour = 0, kelvin = 0;
    char comma = 0;
    cells >> hour >> comma >> kelvin;
    slab.advance(period * (1 + hour / 24));
    worst = std::fmax(worst, std::fabs(slab.surface() - kelvin));
  }
  return rows == 9 ? worst : INFINITY;
}

}  // namespace

static void add_steps(std::vector<Case>& c) {
  for (const double dt : {1.0, 10.0, 60.0, 600.0})
    c.push_back({"slab",
                 "10 um film on concrete, steps of " + std::to_string(static_cast<int>(dt)) + " s",
                 dt == 1 ? "steps of 0.25 s" : "steps of 1 s",
                 "K",
                 dt == 1 ? 1e-6 : 0.01,
                 [dt](const Numerics& n, double microns) { return film_error(n, dt, microns); },
                 {"film", "um", 10, dt == 600 ? 1e-4 : 10, 10},
                 {}});
  c.push_back({"slab",
               "periodic wave at one skin depth",
               "closed form (Carslaw & Jaeger 2.6)",
               "K",
               1e-3,
               [](const Numerics&, double z) { return periodic_wave(z); },
               {"depth", "skin depths", 1, 10, 2},
               {}});
  c.push_back({"slab",
               "light cut off, thermal inertia 500, 50 s",
               "closed form (Carslaw & Jaeger 2.7), 198.586 K",
               "K",
               0.05,
               [](const Numerics&, double x) { return cut_off(x); },
               {"thermal inertia", "SI", 500, 50, 2},
               {}});
  c.push_back({"slab",
               "mean flux of a periodic state is the one from below",
               "closed form -q",
               "W/m2",
               1e-9,
               [](const Numerics&, double q) { return mean_flux(q); },
               {"flux from below", "W/m2", 0.2, 20, 10},
               {}});
}

static void add_slabs(std::vector<Case>& c) {
  c.push_back({"slab",
               "10 um film on concrete, steps of an hour",
               "steps of 1 s",
               "K",
               0.2,
               [](const Numerics& n, double dt) { return film_error(n, dt, 10); },
               {"step", "s", 3600, 14400, 2},
               {}});
  c.push_back({"slab",
               "steps of a year, 1e9 film time constants",
               "closed form: radiative balance",
               "K",
               1e-3,
               [](const Numerics&, double dt) { return huge_step(dt); },
               {"step", "s", 3.15e7, 1e15, 10},
               {}});
  c.push_back({"slab",
               "conductivities 4 : 1 with contact resistance, steady",
               "closed form",
               "1",
               1e-9,
               [](const Numerics&, double x) { return steady_wall(x); },
               {"ratio of conductivities", "1", 4, 4e8, 10},
               {}});
  c.push_back({"slab",
               "lunar night at the equator",
               "published: Diviner regolith temperatures",
               "K",
               2.5,
               [](const Numerics&, double) { return lunar_night(); },
               {},
               {}});
}

std::vector<Case> thermal_cases() {
  std::vector<Case> c;
  add_steps(c);
  add_slabs(c);
  return c;
}

}  // namespace suite::extreme
