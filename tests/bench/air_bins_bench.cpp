// Bins in real air against steps of 0.5 nm (0.5 cm-1 beyond 2.5 um): worst error of a band, number of bins and CPU
// seconds, of chosen bins and of the even intervals of 10 nm (15 cm-1) before. Bands of instruments are Gaussians or
// boxes of the published centres and widths. Radiance straight down over an even Lambert ground, without noise
// (support/even_air.h): air_bins_bench [name of a row]
#include <cstdio>
#include <cstring>

#include "light/kinds/solar_spectrum.h"
#include "scheduler/air_bins.h"
#include "scheduler/bins.h"
#include "spectral/planck.h"
#include "support/bins_kit.h"
#include "support/cpu_clock.h"
#include "support/even_air.h"

namespace {

using namespace suite;

struct Instrument {
  const char* name;
  std::vector<Band> bands;
};

std::vector<Instrument> instruments() {
  Instrument sixty{"60 bands of 34 nm", {}}, oli{"Landsat 8 OLI", {}}, tirs{"Landsat 8 TIRS", {}},
      msi{"Sentinel-2A MSI", {}}, emit{"EMIT", {}}, thermal{"8-14 um in 12", {}};
  for (int i = 0; i < 60; ++i) sixty.bands.push_back(Band::gaussian(strf("b%02d", i), 0.42 + 0.0336 * i, 0.0336));
  const auto boxes = [](Instrument& to, std::initializer_list<std::pair<double, double>> edges) {
    for (const auto& [low, high] : edges)
      to.bands.push_back(Band::rectangular(strf("%.4g um", 0.5 * (low + high)), 0.5 * (low + high), high - low));
  };
  boxes(oli, {{0.435, 0.451},
              {0.452, 0.512},
              {0.533, 0.590},
              {0.636, 0.673},
              {0.851, 0.879},
              {1.566, 1.651},
              {2.107, 2.294},
              {0.503, 0.676},
              {1.363, 1.384}});
  boxes(tirs, {{10.60, 11.19}, {11.50, 12.51}});
  for (const auto& [center, width] : {std::pair{442.7, 21.0},
                                      {492.4, 66.0},
                                      {559.8, 36.0},
                                      {664.6, 31.0},
                                      {704.1, 15.0},
                                      {740.5, 15.0},
                                      {782.8, 20.0},
                                      {832.8, 106.0},
                                      {864.7, 21.0},
                                      {945.1, 20.0},
                                      {1373.5, 31.0},
                                      {1613.7, 91.0},
                                      {2202.4, 175.0}})
    msi.bands.push_back(Band::rectangular(strf("%.1f nm", center), 1e-3 * center, 1e-3 * width));
  for (int i = 0; i < 285; ++i) emit.bands.push_back(Band::gaussian(strf("e%03d", i), 0.3815 + 0.0074 * i, 0.0085));
  for (int i = 0; i < 12; ++i) thermal.bands.push_back(Band::rectangular(strf("t%02d", i), 8.25 + 0.5 * i, 0.5));
  return {sixty, oli, msi, emit, tirs, thermal};
}

// Green grass and the sea as smooth curves: chlorophyll, red edge, leaf water.
Curve grass() {
  return Curve({0.3, 0.4,  0.5,  0.55, 0.6, 0.67, 0.69, 0.72, 0.76, 0.9, 0.97, 1.07,
                1.2, 1.28, 1.45, 1.65, 1.8, 1.94, 2.2,  2.5,  4,    8,   14.5},
               {0.02, 0.03, 0.04, 0.09, 0.06, 0.035, 0.05, 0.25, 0.42, 0.46, 0.42, 0.46,
                0.39, 0.42, 0.16, 0.28, 0.22, 0.07,  0.15, 0.05, 0.03, 0.02, 0.02},
               Outside::hold);
}
Curve sea() {
  return Curve({0.3, 0.42, 0.5, 0.6, 0.7, 0.9, 2.5, 14.5}, {0.05, 0.045, 0.035, 0.022, 0.02, 0.02, 0.02, 0.02},
               Outside::hold);
}

// Steps of 0.5 nm, or 0.5 cm-1.
SpectralState reference(const AirSpec& air, double low, double high) {
  const std::vector<Band> all{Band::rectangular("all", 0.5 * (low + high), high - low)};
  SpectralState state = make_state(all, 1e3, 0, 1);
  state.bins.clear();
  while (low < high) {
    const double next = std::min(high, low + std::max(0.0005, 0.5e-4 * low * low * (low > 2.5)));
    state.bins.push_back({low, next});
    low = next;
  }
  return with_gas_points(air, state);
}

struct Place {
  const char *profile, *surface;
  Curve reflectance;
  double height;
};

struct Judged {
  double percent = 0, kelvin = 0;
  std::string band;
};
Judged judge(const Instrument& of, const std::vector<double>& right, const std::vector<double>& without,
             const std::vector<double>& got) {
  Judged j;
  for (size_t b = 0; b < of.bands.size(); ++b) {
    const double um = of.bands[b].center_um;
    double off = std::fabs(got[b] - right[b]) / std::max(right[b], 0.01 * without[b]);
    if (off > j.percent) j.percent = off, j.band = of.bands[b].name;
    if (um > 3)
      j.kelvin =
          std::max(j.kelvin, std::fabs(brightness_temperature(um, got[b]) - brightness_temperature(um, right[b])));
  }
  j.percent *= 100;
  return j;
}

void run(const Instrument& of, const AirSpec& air, const Place& place, const SpectralState& fine,
         const std::vector<double>& fine_with, const std::vector<double>& fine_without, bool verbose) {
  test::EvenGround ground{place.reflectance, solar_irradiance(), 0.8, place.height};
  const std::vector<double> right = test::bands_of(fine, of.bands, fine_with),
                            without = test::bands_of(fine, of.bands, fine_without);
  // Before: even intervals.
  SpectralState wanted = make_state(of.bands, 0.01);
  wanted.choice = {1e-3, 0, 4};
  const SpectralState even = bins_in_air(air, wanted, of.bands).state;
  double begun = test::cpu_seconds();
  const Judged before =
      judge(of, right, without, test::bands_of(even, of.bands, test::even_radiance(air, even, ground)));
  const double even_seconds = test::cpu_seconds() - begun;

  ModelSpec model;
  model.model = "lambert";
  model.curves["reflectance"] = place.reflectance;
  const auto scene =
      test::scene_of({test::mesh_of({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, {0, 1, 2, 0, 2, 3}, 0)},
                     {test::material("ground", model)});
  SourceSpecs sources;
  sources.add(SunSpec{{{0.6, 0, 0.8}, 0.00465, solar_irradiance()}});
  sources.air = std::make_shared<AirSpec>(air);
  test::BinSensor sensor({{{1, 1, std::min(place.height, 6e5)}, {0, 0, -1}, 0}}, of.bands, 16, 1e-3);
  begun = test::cpu_seconds();
  const BinReport report = choose_bins(*scene, {&sources, 1}, sensor).at(0);
  const double choosing = test::cpu_seconds() - begun;
  begun = test::cpu_seconds();
  const std::vector<double> got =
      test::bands_of(sensor.state(), of.bands, test::even_radiance(air, sensor.state(), ground));
  const double chosen_seconds = test::cpu_seconds() - begun;
  const Judged after = judge(of, right, without, got);
  std::printf(
      "%-18s %-19s %-5s %5.0f km | %5zu bins %8.3f %% %7.3f K %-9s %6.2f s | %5zu bins %8.4f %% %7.4f K %-9s %6.2f s, "
      "chosen in %5.2f s, told %.3f %%\n",
      of.name, place.profile, place.surface, place.height / 1000, even.size(), before.percent, before.kelvin,
      before.band.c_str(), even_seconds, sensor.state().size(), after.percent, after.kelvin, after.band.c_str(),
      chosen_seconds, choosing, 100 * report.reached);
  std::fflush(stdout);
  if (!verbose) return;
  std::printf("%s\n", report.text().c_str());
  for (const BinReport::Missed& m : report.missed)
    std::printf("missed: %s %.4f um %.3f %% (%s)\n", m.band.c_str(), m.center_um, 100 * m.error, m.under.c_str());
  for (size_t b = 0; b < of.bands.size(); ++b)
    std::printf("  %-10s %8.4f um %12.5g  off %+8.4f %%  told %.4f %%\n", of.bands[b].name.c_str(),
                of.bands[b].center_um, right[b], 100 * (got[b] / right[b] - 1), 100 * report.bias[b].relative);
}

}  // namespace

int main(int argc, char** argv) {
  const char* only = argc > 1 ? argv[1] : "";
  const bool verbose = argc > 2;
  const std::vector<Instrument> all = instruments();
  for (const char* profile : {"midlatitude_summer", "subarctic_winter"}) {
    AirSpec air, clear;
    air.profile = standard_profile(profile);
    air.gases = shared_builtin_gases();
    air.aerosol = AirSpec::Aerosol{};
    clear = air, clear.gases = nullptr;
    for (const auto& [first, last] : {std::pair{0u, 4u}, {4u, 6u}}) {
      const bool solar = first == 0;
      bool any = false;
      for (size_t i = first; i < last; ++i) any = any || std::strstr(all[i].name, only);
      if (!any) continue;
      const SpectralState fine = solar ? reference(air, 0.36, 2.52) : reference(air, 7.9, 14.1);
      SpectralState plain = fine;
      for (Bin& b : plain.bins) b.g = 0;
      for (const Place& place : {Place{profile, "grass", grass(), 3e3}, Place{profile, "grass", grass(), 6e5},
                                 Place{profile, "sea", sea(), 3e3}, Place{profile, "sea", sea(), 6e5}}) {
        const test::EvenGround ground{place.reflectance, solar_irradiance(), 0.8, place.height};
        const double begun = test::cpu_seconds();
        const std::vector<double> with = test::even_radiance(air, fine, ground),
                                  without = test::even_radiance(clear, plain, ground);
        std::printf("reference: %zu bins, %.1f s\n", fine.size(), test::cpu_seconds() - begun);
        if (place.height < 1e5 && std::strcmp(place.surface, "grass") == 0) {
          const SpectralState moved = solar ? reference(air, 0.3602, 2.5202) : reference(air, 7.903, 14.103);
          const std::vector<double> other = test::even_radiance(air, moved, ground);
          for (size_t i = first; i < last; ++i) {
            const Judged j =
                judge(all[i], test::bands_of(fine, all[i].bands, with), test::bands_of(fine, all[i].bands, without),
                      test::bands_of(moved, all[i].bands, other));
            std::printf("the reference with its steps moved, %s: %.4f %%, %.4f K (%s)\n", all[i].name, j.percent,
                        j.kelvin, j.band.c_str());
          }
        }
        for (size_t i = first; i < last; ++i)
          if (std::strstr(all[i].name, only)) run(all[i], air, place, fine, with, without, verbose);
        if (verbose) return 0;
      }
    }
  }
  return 0;
}
