// The slab against closed forms and published temperatures.
#include "thermal/slab.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "math/vec.h"
#include "spectral/planck.h"

namespace suite {
namespace {

SlabLayer uniform(double thickness, double density, double specific_heat, double conductivity, int intervals = 0) {
  SlabLayer l;
  l.thickness = thickness;
  l.density = density;
  l.specific_heat = {specific_heat};
  l.conductivity = {conductivity};
  l.intervals = intervals;
  return l;
}
SlabFace flux(double w_m2) {
  SlabFace f;
  f.value = [w_m2](double) { return w_m2; };
  return f;
}
SlabFace held(TimeFunction kelvin) {
  SlabFace f;
  f.kind = SlabFace::Kind::temperature;
  f.value = std::move(kelvin);
  return f;
}
SlabFace surface(double emissivity, Loads loads, double convection = 0) {
  SlabFace f;
  f.kind = SlabFace::Kind::surface;
  f.emissivity = emissivity;
  f.convection_still = convection;
  f.loads = std::move(loads);
  return f;
}

// Carslaw & Jaeger, Conduction of heat in solids, 2.6: the wave that a harmonic surface temperature sends down.
TEST(Slab, PeriodicWaveInDepth) {
  const double period = 59479413.48, inertia = 120, heat = 960000;
  const double conductivity = inertia * inertia / heat, depth = std::sqrt(conductivity / heat * period / kPi);
  EXPECT_NEAR(depth, 0.5438992, 5e-8);
  const double rate = 2 * kPi / period;
  SlabSpec spec;
  spec.layers = {uniform(14 * depth, heat / 1000, 1000, conductivity, 1400)};
  spec.top = held([rate](double t) { return 190 + 30 * std::sin(rate * t); });
  spec.bottom = flux(0);
  Slab slab(spec, {1e-4, period / 200, 1e-9, 60});
  slab.start(0, 190);
  spin_up(slab, 0, period, {1e-7, 200});
  double worst = 0;
  for (int i = 1; i <= 24; ++i) {
    const double t = period * (1 + i / 24.0);
    slab.advance(t);
    for (const double z : {0.0, 0.25, 0.5, 1.0, 2.0, 4.0}) {
      const double exact = 190 + 30 * std::exp(-z) * std::sin(rate * t - z);
      worst = std::fmax(worst, std::fabs(slab.at_depth(z * depth) - exact));
    }
  }
  std::printf("periodic wave: largest error %.2e K\n", worst);
  EXPECT_LT(worst, 1e-3);
}

// A half space at 200 K in balance loses its light: a surface flux of sigma T^4 sets in at once. Short-time law
// T = 200 - 2 F sqrt(t/pi)/inertia.
TEST(Slab, StiffStartOfACoolingHalfSpace) {
  const double inertia = 500, heat = 1e6, conductivity = inertia * inertia / heat;
  const double F = kStefanBoltzmann * std::pow(200.0, 4);
  EXPECT_NEAR(2 * F / (inertia * std::sqrt(kPi)), 0.204749, 1e-6);
  SlabSpec spec;
  spec.layers = {uniform(0.5, 1000, 1000, conductivity)};
  spec.top = surface(1, [](double) { return SurfaceLoad{}; });
  spec.bottom = flux(0);
  Slab slab(spec, {1e-4, 3600, 1e-9, 0.01});
  slab.start(0, 200);
  for (const double t : {0.1, 0.5, 1.0, 2.0}) {
    slab.advance(t);
    // The next term of the expansion is of order t: 4 F/T times the lost temperature's own flux, below 3e-4 K here.
    EXPECT_NEAR(slab.surface(), 200 - 0.204749 * std::sqrt(t), 2e-3) << t;
  }
  slab.advance(50);
  std::printf("stiff start: %.5f K at 50 s (198.586), %lld steps\n", slab.surface(), slab.counters().steps);
  EXPECT_NEAR(slab.surface(), 198.586, 1e-3);
  // Coarse settings stay within the bound of 0.05 K.
  Slab coarse(spec, {0.05, 3600, 1e-9, 60});
  coarse.start(0, 200);
  coarse.advance(50);
  EXPECT_NEAR(coarse.surface(), 198.586, 0.05);
}

Loads day(double noon_w_m2, double period) {
  return [=](double t) { return SurfaceLoad{noon_w_m2 * std::fmax(0.0, -std::cos(2 * kPi * t / period)), 0, 0, 0}; };
}

// In a periodic state the mean flux is the one from below at every depth, whatever the materials do in between.
TEST(Slab, MeanFluxIsTheGeothermalOneAtEveryDepth) {
  const double period = 88775, q = 0.2;
  for (const bool with_temperature : {false, true}) {
    SlabSpec spec;
    spec.layers = {uniform(0.1, 1200, 700, 0.05), uniform(0.4, 1800, 800, 0.5)};
    spec.layers[0].contact_resistance = 0.02;
    if (with_temperature) {
      spec.layers[0].conductivity = {0.01, 0, 0, 1e-9};  // radiation between grains
      spec.layers[1].specific_heat = {100, 2.5, 0, 0, 0};
    }
    spec.top = surface(0.95, day(600, period));
    spec.bottom = flux(q);
    Slab slab(spec, {0.02, period / 24, 1e-9, 60});
    slab.start(0, 220);
    const SpinUpResult r = spin_up(slab, 0, period, {2e-11, 500});
    double worst = 0;
    for (const double f : slab.mean_fluxes()) worst = std::fmax(worst, std::fabs(f + q));
    std::printf("mean flux: largest deviation %.2e W/m2 after %d periods of %zu steps\n", worst, r.periods,
                r.steps.size());
    EXPECT_LT(worst, 1e-9);
  }
}

// Lunar regolith at the equator after P. O. Hayne et al., JGR Planets 122, 2017, table A1 and equations A2-A8: density
// and conductivity grow with depth, both depend on temperature; night temperatures of the Diviner radiometer.
SlabSpec regolith(double period) {
  SlabSpec spec;
  const double H = 0.07, chi = 2.7 / std::pow(350.0, 3);
  double z = 0;
  for (double h = 0.001; z < 2; h *= 1.06) {
    const double fade = std::exp(-(z + h / 2) / H), k = 3.4e-3 - (3.4e-3 - 7.4e-4) * fade;
    SlabLayer l;
    l.thickness = h;
    l.density = 1800 - (1800 - 1100) * fade;
    l.specific_heat = {-3.6125, 2.7431, 2.3616e-3, -1.2340e-5, 8.9093e-9};
    l.conductivity = {k, 0, 0, k * chi};
    l.intervals = 1;
    spec.layers.push_back(l);
    z += h;
  }
  spec.top = surface(0.95, [period](double t) {
    // t counts from noon; the albedo grows with the incidence angle (Keihm 1984).
    const double cosine = std::cos(2 * kPi * t / period);
    if (cosine <= 0) return SurfaceLoad{};
    const double angle = std::acos(cosine);
    const double albedo = 0.12 + 0.06 * std::pow(angle / (kPi / 4), 3) + 0.25 * std::pow(angle / (kPi / 2), 8);
    return SurfaceLoad{1361 * (1 - albedo) * cosine, 0, 0, 0};
  });
  spec.bottom = flux(0.018);
  return spec;
}

TEST(Slab, LunarNight) {
  const double period = 2.55024e6;
  Slab slab(regolith(period), {0.02, period / 48, 1e-9, 60});
  slab.start(0, 250);
  const SpinUpResult r = spin_up(slab, 0, period, {1e-6, 500});
  const double noon = slab.surface();
  std::ifstream in(SUITE_TEST_DATA "/thermal/diviner_regtemp_lat00.csv");
  std::string line;
  std::getline(in, line);
  double worst = 0, square = 0;
  int rows = 0;
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    double hour = 0, kelvin = 0;
    char comma = 0;
    cells >> hour >> comma >> kelvin;  // hours of 1/24 lunar day after noon
    slab.advance(period * (1 + hour / 24));
    std::printf("  %5.2f h: %.2f K, measured %.2f K\n", hour, slab.surface(), kelvin);
    worst = std::fmax(worst, std::fabs(slab.surface() - kelvin));
    square += (slab.surface() - kelvin) * (slab.surface() - kelvin);
    ++rows;
  }
  std::printf("lunar night: noon %.1f K, largest difference %.2f K, rms %.2f K, %d periods\n", noon, worst,
              std::sqrt(square / rows), r.periods);
  EXPECT_EQ(rows, 9);
  EXPECT_LT(worst, 2.5);
  EXPECT_NEAR(noon, 386, 3);  // the published model's equatorial noon
}

}  // namespace
}  // namespace suite
