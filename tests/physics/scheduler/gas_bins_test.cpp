// Bins that are chosen through the gases of real air, against steps of 0.5 nm (0.5 cm-1 in the thermal infrared): bands
// on the slopes of water's bands over grass from 3 km, a blue band without lines, and bands at 9.4 and 13.6 um.
// Radiance straight down over an even ground, by discrete ordinates without noise (support/even_air.h). Even intervals
// of 10 nm (15 cm-1), split into g-points, are off by 3 to 8 % there: the negative control.
#include <gtest/gtest.h>

#include "light/kinds/night_sky.h"
#include "light/kinds/solar_spectrum.h"
#include "scheduler/air_bins.h"
#include "scheduler/air_paths.h"
#include "scheduler/seen_lights.h"
#include "spectral/planck.h"
#include "support/bins_kit.h"
#include "support/even_air.h"

namespace suite::gas_bins_test {
namespace {

AirSpec summer() {
  AirSpec air;
  air.profile = standard_profile("midlatitude_summer");
  air.gases = shared_builtin_gases();
  air.aerosol = AirSpec::Aerosol{};
  return air;
}

struct Bands {
  double right, without_gases, chosen, even;
};

// Steps between two wavelengths: 0.5 nm, or 0.5 cm-1.
SpectralState steps(const AirSpec& air, std::span<const Band> bands) {
  SpectralState state = make_state(bands, 1e3, 0, 1);
  const std::vector<Bin> stretches = state.bins;
  state.bins.clear();
  for (const Bin& stretch : stretches)
    for (double low = stretch.low_um; low < stretch.high_um;) {
      const double width = low > 2.5 ? 0.5e-4 * low * low : 0.0005;
      const double high = stretch.high_um - low < 1.5 * width ? stretch.high_um : low + width;
      state.bins.push_back({low, high});
      low = high;
    }
  return with_gas_points(air, state);
}

struct Judged {
  std::vector<Bands> bands;
  BinReport report;
};
Judged judge(const std::vector<Band>& bands, const test::EvenGround& ground) {
  const AirSpec air = summer();
  AirSpec clear = air;
  clear.gases = nullptr;
  const SpectralState fine = steps(air, bands);
  SpectralState plain = fine;
  for (Bin& b : plain.bins) b.g = 0;
  const std::vector<double> right = test::bands_of(fine, bands, test::even_radiance(air, fine, ground)),
                            without = test::bands_of(fine, bands, test::even_radiance(clear, plain, ground));
  SpectralState wanted = make_state(bands, 0.01);
  wanted.choice = {1e-3, 0, 4};
  const SpectralState even = bins_in_air(air, wanted, bands).state;
  const std::vector<double> by_even = test::bands_of(even, bands, test::even_radiance(air, even, ground));

  ModelSpec model;
  model.model = "lambert";
  model.curves["reflectance"] = ground.reflectance;
  const auto scene = test::scene_of({test::quad(1, 0, 0)}, {test::material("ground", model)});
  SourceSpecs sources;
  sources.add(SunSpec{{{0.6, 0, 0.8}, 0.00465, ground.sun}});
  sources.air = std::make_shared<AirSpec>(air);
  test::BinSensor sensor({{{0, 0, ground.height}, {0, 0, -1}, 0}}, bands, 16, 1e-3);
  Judged j{{}, choose_bins(*scene, {&sources, 1}, sensor).at(0)};
  std::printf("%s\n", j.report.text().c_str());
  const std::vector<double> chosen =
      test::bands_of(sensor.state(), bands, test::even_radiance(air, sensor.state(), ground));
  for (size_t b = 0; b < bands.size(); ++b) {
    j.bands.push_back({right[b], without[b], chosen[b], by_even[b]});
    std::printf("%s: %.5g, without gases %.5g; chosen bins %+.3f %%, even intervals %+.3f %%\n", bands[b].name.c_str(),
                right[b], without[b], 100 * (chosen[b] / right[b] - 1), 100 * (by_even[b] / right[b] - 1));
  }
  return j;
}

Curve grass() {
  return Curve({0.4, 0.5, 0.55, 0.67, 0.72, 0.76, 0.9, 0.97, 1.07, 1.2, 1.28, 1.45, 1.65, 1.8, 1.94, 2.2, 2.5},
               {0.03, 0.04, 0.09, 0.035, 0.25, 0.42, 0.46, 0.42, 0.46, 0.39, 0.42, 0.16, 0.28, 0.22, 0.07, 0.15, 0.05},
               Outside::hold);
}

TEST(GasBins, SlopesOfWatersBandsOverGrass) {
  std::vector<Band> bands;
  for (const double um : {1.1256, 1.4616, 1.8312}) bands.push_back(Band::gaussian(strf("%.4f um", um), um, 0.0336));
  const Judged j = judge(bands, {grass(), solar_irradiance(), 0.8, 3000});
  double worst_even = 0;
  for (const Bands& b : j.bands) {
    const double scale = std::max(b.right, 0.01 * b.without_gases);
    EXPECT_NEAR(b.chosen, b.right, 0.005 * scale);
    worst_even = std::max(worst_even, std::fabs(b.even - b.right) / scale);
  }
  EXPECT_GT(worst_even, 0.03);
  EXPECT_LT(j.report.bins, 60u);
}

// The shape of Landsat 8's first band: no gas has lines there, but sunlight and scattering change within 10 nm.
TEST(GasBins, BlueBandWithoutLines) {
  const Curve response({0.427, 0.433, 0.436, 0.440, 0.444, 0.448, 0.451, 0.454, 0.459},
                       {0.0001, 0.14, 0.55, 0.90, 0.93, 0.99, 0.85, 0.20, 0.0004}, Outside::zero);
  const Judged j = judge({Band::tabulated("B1", response)}, {Curve::constant(0.3), solar_irradiance(), 0.8, 6e5});
  EXPECT_NEAR(j.bands[0].chosen, j.bands[0].right, 1e-3 * j.bands[0].right);
  EXPECT_GT(std::fabs(j.bands[0].even / j.bands[0].right - 1), 2e-3);
  EXPECT_TRUE(j.report.met()) << j.report.text();
}

TEST(GasBins, ThermalBandsWithin50Millikelvin) {
  const Judged j = judge({Band::gaussian("ozone", 9.4, 0.2), Band::gaussian("foot of 15 um", 13.6, 0.2)},
                         {Curve::constant(0.02), solar_irradiance(), 0.8, 6e5});
  const double um[] = {9.4, 13.6};
  double worst_even = 0;
  for (size_t b = 0; b < 2; ++b) {
    const double kelvin = brightness_temperature(um[b], j.bands[b].right);
    EXPECT_NEAR(brightness_temperature(um[b], j.bands[b].chosen), kelvin, 0.05);
    worst_even = std::max(worst_even, std::fabs(brightness_temperature(um[b], j.bands[b].even) - kelvin));
  }
  EXPECT_GT(worst_even, 0.1);
}

// Beside a light that is a million times brighter no bins are chosen for the ground's emission; what it lacks is known.
TEST(GasBins, LightsThatAreTooDarkToMatterHaveAnError) {
  const std::vector<Band> bands{Band::rectangular("b", 2.2, 0.1)};
  ModelSpec model;
  model.model = "lambert";
  model.curves["reflectance"] = Curve::constant(0.3);
  const auto scene = test::scene_of({test::quad(1, 0, 0)}, {test::material("ground", model)});
  for (const double irradiance : {1e6, 1e-3}) {
    SourceSpecs sources;
    sources.add(SunSpec{{{0.6, 0, 0.8}, 0.00465, Curve::constant(irradiance)}});
    auto air = std::make_shared<AirSpec>(summer());
    air->gases = nullptr, air->molecules = false;
    sources.air = air;
    test::BinSensor sensor({{{0, 0, 3000}, {0, 0, -1}, 0}}, bands, 16, 1e-3);
    const BinReport r = choose_bins(*scene, {&sources, 1}, sensor).at(0);
    const double kelvin = air->profile.levels.front().temperature;
    const std::vector<float> chosen = blackbody_means(sensor.state().bins, kelvin);
    const BandProjection projection(sensor.state(), bands);
    double mean = 0;
    for (size_t i = 0; i < chosen.size(); ++i) mean += projection.weight(0, i) * double{chosen[i]};
    const double right = planck_band_radiance(2.15, 2.25, kelvin) / 0.1, off = std::fabs(mean - right);
    ASSERT_EQ(r.bias.size(), 1u);
    std::printf("%g: %zu bins, %.3g of %.3g off, %.3g known\n", irradiance, r.bins, off, right, r.bias[0].absolute);
    if (irradiance > 1) {
      EXPECT_GT(off, 0.01 * right) << "the case shows nothing";
      EXPECT_NEAR(r.bias[0].absolute, off, 0.2 * off);
    } else {
      EXPECT_LT(off, 2e-3 * right);
      EXPECT_EQ(r.bias[0].absolute, 0);
    }
  }
}

// Lights but for disks come through the gases, too: lines of the airglow through 1.5 air masses, with no sun and no
// moon. Bins that are chosen by them are within 0.5 % of steps of 0.5 nm; even intervals, which lines do not care for,
// are not.
TEST(GasBins, NightSkyThroughTheGases) {
  const std::vector<Band> bands{Band::rectangular("K", 2.2, 0.022), Band::gaussian("O2", 1.27, 0.03),
                                Band::gaussian("H", 1.58, 0.05)};
  const AirSpec air = summer();
  ModelSpec model;
  model.model = "lambert";
  model.curves["reflectance"] = grass();
  const auto scene = test::scene_of({test::quad(1, 0, 0)}, {test::material("ground", model)});
  NightSkyLightSpec night;
  night.time = {"2026-03-20T23:00:00Z", {}};
  night.place = Geodetic{32.6, 102.9, 0};
  night.scale.fill(1e5);
  std::vector<std::string> said;
  SourceSpecs sources;
  sources.lights.push_back(make_light(night)->resolved({*scene, 0, 0, said}));
  sources.air = std::make_shared<AirSpec>(air);
  test::BinSensor sensor({{{0, 0, 3000}, {0, 0, -1}, 0}}, bands, 16, 1e-3);
  const BinReport report = choose_bins(*scene, {&sources, 1}, sensor).at(0);
  std::printf("%s\n", report.text().c_str());
  const AirPaths paths({&sources, 1}, sensor, 0);
  std::vector<LightSpectra> parts;
  sources.lights[0]->add_spectra(parts);
  const auto seen = [&](const SpectralState& state) {
    const std::vector<float> depth = paths.gas_depth(state);
    std::vector<double> sum(state.size(), 0.0);
    for (const std::vector<float>& row : parts.at(0).over(state))
      for (size_t i = 0; i < sum.size(); ++i) sum[i] += double{row[i]} * std::exp(-1.5 * double{depth[i]});
    return test::bands_of(state, bands, sum);
  };
  SpectralState wanted = make_state(bands, 0.01);
  wanted.choice = {1e-3, 0, 4};
  const std::vector<double> right = seen(steps(air, bands)), chosen = seen(sensor.state()),
                            even = seen(bins_in_air(air, wanted, bands).state);
  double worst_even = 0;
  for (size_t b = 0; b < bands.size(); ++b) {
    std::printf("%s: %.5g; chosen bins %+.3f %%, even intervals %+.3f %%\n", bands[b].name.c_str(), right[b],
                100 * (chosen[b] / right[b] - 1), 100 * (even[b] / right[b] - 1));
    EXPECT_NEAR(chosen[b], right[b], 0.005 * right[b]) << bands[b].name;
    worst_even = std::max(worst_even, std::fabs(even[b] / right[b] - 1));
  }
  EXPECT_GT(worst_even, 0.01);
}

// How far the emission of 1500 K is off in the visible, by the bins for a surface of some temperature model; beside a
// light of one colour what is below 400 K is too dark to matter.
double off_at_1500(const TemperatureSpec& spec, FoundHeat heat = {}) {
  const std::vector<Band> bands{Band::rectangular("b", 0.55, 0.1)};
  ModelSpec model;
  model.model = "lambert";
  model.curves["reflectance"] = Curve::constant(0.3);
  Scene scene = *test::scene_of({test::quad(1, 0, 0)}, {test::material("engine", model)});
  scene.temperatures.push_back({0, spec});
  SourceSpecs lit;
  lit.add(SunSpec{{{0.6, 0, 0.8}, 0.00465, Curve::constant(1000)}});
  auto air = std::make_shared<AirSpec>(summer());
  air->gases = nullptr, air->molecules = false, air->aerosol.reset();
  lit.air = air;
  test::BinSensor sensor({{{0, 0, 9}, {0, 0, -1}, 0}}, bands, 16, 1e-3);
  choose_bins(scene, {&lit, 1}, sensor, heat);
  const std::vector<float> chosen = blackbody_means(sensor.state().bins, 1500);
  const BandProjection projection(sensor.state(), bands);
  double mean = 0;
  for (size_t i = 0; i < chosen.size(); ++i) mean += projection.weight(0, i) * double{chosen[i]};
  return std::fabs(mean / (planck_band_radiance(0.5, 0.6, 1500) / 0.1) - 1);
}

TemperatureSpec slab_under(const SurfaceLoad& load, double emissivity = 0.95, double still = 0) {
  TemperatureSpec spec;
  spec.model = "slab";
  spec.numbers = {{"emissivity", emissivity}, {"convection_still_w_m2_k", still}};
  spec.loads = {load};
  return spec;
}

double flux_of(double kelvin) { return kStefanBoltzmann * std::pow(kelvin, 4); }

// Slabs whose loads hold them at 1500 K; the bins of what stays below 400 K are the negative control.
TEST(GasBins, SlabsThatAreHot) {
  const double hot = off_at_1500(slab_under({0, flux_of(1500), 1500, 2})),
               cool = off_at_1500(slab_under({0, flux_of(300), 300, 2}));
  std::printf("%.3g %% off; by bins for 400 K %.3g %%\n", 100 * hot, 100 * cool);
  EXPECT_LT(hot, 1e-3);
  EXPECT_GT(cool, 3e-3);
}

// A surface that emits little becomes as hot by less sunlight, but where air cools it (the negative control).
TEST(GasBins, SlabsThatEmitLittleAreHot) {
  const SurfaceLoad sunlit{0.02 * flux_of(1500), 0, 280, 0};
  const double hot = off_at_1500(slab_under(sunlit, 0.02)), cooled = off_at_1500(slab_under(sunlit, 0.02, 500));
  std::printf("%.3g %% off; by bins for what air cools %.3g %%\n", 100 * hot, 100 * cooled);
  EXPECT_LT(hot, 1e-3);
  EXPECT_GT(cooled, 3e-3);
}

// Walls that neighbours heat: bins follow the temperatures that the balance found.
TEST(GasBins, WallsThatNeighboursHeat) {
  TemperatureSpec wall;
  wall.model = "heat";
  wall.numbers = {{"back_film_w_m2_k", 2000}};  // no temperature
  const double followed = off_at_1500(wall, {1500}), before = off_at_1500(wall);
  std::printf("%.3g %% off; by bins before temperatures are found %.3g %%\n", 100 * followed, 100 * before);
  EXPECT_LT(followed, 1e-3);
  EXPECT_GT(before, 3e-3);
}

// What the report says of each band holds, and bands that are far off are named by wavelength.
TEST(GasBins, ReportsWhatEvenIntervalsMiss) {
  const std::vector<Band> bands{Band::gaussian("slope", 1.8312, 0.0336), Band::gaussian("window", 1.65, 0.0336),
                                Band::gaussian("early", 1.1256, 0.0336)};
  ModelSpec model;
  model.model = "lambert";
  model.curves["reflectance"] = grass();
  const auto scene = test::scene_of({test::quad(1, 0, 0)}, {test::material("ground", model)});
  SourceSpecs sources;
  sources.add(SunSpec{{{0.6, 0, 0.8}, 0.00465, solar_irradiance()}});
  sources.air = std::make_shared<AirSpec>(summer());
  test::BinSensor sensor({{{0, 0, 3000}, {0, 0, -1}, 0}}, bands, 16, 1e-3, 0.01);
  const BinReport r = choose_bins(*scene, {&sources, 1}, sensor).at(0);
  EXPECT_FALSE(r.met());
  EXPECT_FALSE(r.chosen);
  ASSERT_GE(r.missed.size(), 2u);
  EXPECT_EQ(r.missed.front().band, "early");
  EXPECT_EQ(r.missed.back().band, "slope");
  EXPECT_GT(r.missed.back().error, 0.02);
  EXPECT_NE(r.missed_text().find("'slope' (1.831 um)"), std::string::npos) << r.missed_text();
  BandBiases biases;
  add_biases({&r, 1}, biases);
  const std::vector<BandBias> bias = bias_of(biases, r.sensor, 0);
  ASSERT_EQ(bias.size(), 3u);
  EXPECT_FALSE(bias[0].within);
  EXPECT_GT(bias[0].of(0), 0);  // what is too dark is held to the floor
}

}  // namespace
}  // namespace suite::gas_bins_test
