// A lunar day at the equator through weather, elements, paths and the balance, against the night that Diviner measured
// (tests/data/thermal/diviner_regtemp_lat00.csv; NOTICE).
//
// Weather is a file without air: pressure, longwave and wind 0, a beam of 1361 W/m2. The sun is the test's own, for
// weather's is that of a place on the Earth.
//
// Parameters, as they were set before the first run, are those of P. O. Hayne et al., JGR Planets 122, 2017 (the layers
// of support/slab_kit.h, emissivity 0.95, 0.018 W/m2 from below), on level ground. Their albedo grows with the angle of
// incidence; the ground here is Lambert's, with the one albedo that absorbs as much in a day.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "base/files.h"
#include "formats/weather/weather.h"
#include "spectral/planck.h"
#include "support/heated_scene.h"
#include "support/message_of.h"
#include "support/slab_kit.h"

namespace suite::lunar_day_test {
namespace {

using namespace test;

constexpr double kPeriod = 2.55024e6, kSun = 1361;  // s, W/m2

std::string without_air(double pressure = 0) {
  std::string text =
      "site: 0 0 0\ntime_utc, air_temperature [K], pressure [Pa], wind_speed [m/s], direct_normal instant [W/m2], "
      "diffuse instant [W/m2], longwave_down [W/m2]\n";
  for (int day = 1; day <= 31; ++day) text += strf("2020-01-%02dT00:00Z,200,%g,0,%g,0,0\n", day, pressure, kSun);
  return text;
}

double even_albedo() {
  double absorbed = 0, arriving = 0;
  constexpr int kSteps = 100000;
  for (int i = 0; i < kSteps; ++i) {
    const double t = kPeriod * (i + 0.5) / kSteps;
    absorbed += lunar_sun(t, kPeriod);
    arriving += kSun * std::fmax(0.0, std::cos(2 * kPi * t / kPeriod));
  }
  return 1 - absorbed / arriving;
}

// Noon at 0 s, then westwards.
HeatWeather moon_under(const Weather& weather) {
  HeatWeather moon = as_it_is(weather);
  moon.sun = [](double t) {
    const double a = 2 * kPi * t / kPeriod;
    return SkyBody{{-std::sin(a), 0, std::cos(a)}, kAstronomicalUnit, kSunRadius / kAstronomicalUnit, kPi / 2 - a};
  };
  return moon;
}

BalancedScene ground(const HeatSpec& spec, double albedo) {
  return BalancedScene(
      {quad(50, 0, 0)}, {warmed("regolith", albedo, 0.95)},
      {heat_of(lunar_regolith(), {{"back_flux_w_m2", 0.018}}, {{"convection", "none"}, {"back", "flux"}})}, spec);
}

TEST(LunarDay, NightAsMeasured) {
  const Weather weather = parse_weather(without_air(), "moon.csv");
  for (const std::string& note : weather.notes()) std::printf("%s\n", note.c_str());
  HeatSpec spec;
  spec.span = {0, kPeriod};
  spec.step = kPeriod / 720, spec.elements = 1, spec.paths = 512;
  const double albedo = even_albedo();
  const BalancedScene scene = ground(spec, albedo);
  const HeatResult result = scene.solve(weather_loads(moon_under(weather), spec), spec);
  for (const std::string& note : result.notes) std::printf("%s\n", note.c_str());
  ASSERT_EQ(scene.elements->size(), 1u);

  std::istringstream in(read_text(SUITE_TEST_DATA "/thermal/diviner_regtemp_lat00.csv"));
  std::string line;
  std::getline(in, line);
  double square = 0, worst = 0;
  int rows = 0;
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    double hour = 0, measured = 0;
    char comma = 0;
    cells >> hour >> comma >> measured;  // hours of 1/24 lunar day after noon
    const double kelvin = result.kelvin_at(0, kPeriod * hour / 24);
    std::printf("  %5.2f h: %.2f K, measured %.2f K\n", hour, kelvin, measured);
    square += (kelvin - measured) * (kelvin - measured), ++rows;
    worst = std::fmax(worst, std::fabs(kelvin - measured));
  }
  const double noon = result.kelvin_at(0, 0);
  const double still = std::pow((1 - albedo) * kSun / (0.95 * kStefanBoltzmann), 0.25);  // keeps no heat at noon
  std::printf(
      "lunar day: albedo %.4f, noon %.1f K (%.1f K without conduction), night rms %.2f K, at worst %.2f K; "
      "largest step %.2g K, past %.2g K, balance %.3g W/m2 of %.0f\n",
      albedo, noon, still, std::sqrt(square / rows), worst, double{result.step_error[0]}, result.past_error,
      result.balance.residual() / scene.elements->total_area(), result.balance.sunlight / scene.elements->total_area());
  EXPECT_EQ(rows, 9);
  EXPECT_LT(std::sqrt(square / rows), 1);
  EXPECT_LT(noon, still);
  EXPECT_GT(noon, still - 4);
  EXPECT_LT(std::fabs(result.balance.residual()), 1e-3 * result.balance.sunlight);
}

// What layers whose heat capacity depends on temperature take up of an afternoon and evening that do not repeat.
TEST(LunarDay, StoresWhatItTakesUp) {
  const Weather weather = parse_weather(without_air(), "moon.csv");
  HeatSpec spec;
  spec.span = {0, 10 * 86400};
  spec.step = 1800, spec.elements = 1, spec.paths = 64, spec.periodic = false;
  const BalancedScene scene = ground(spec, 0.18);
  const HeatResult result = scene.solve(weather_loads(moon_under(weather), spec), spec);
  const double area = scene.elements->total_area();
  std::printf("ten days from noon: stored %.3f W/m2, residual %.4f W/m2\n", result.balance.stored / area,
              result.balance.residual() / area);
  EXPECT_LT(result.balance.stored, 0);
  EXPECT_LT(std::fabs(result.balance.residual()), 1e-3 * result.balance.sunlight);
}

// With air a sky without infrared, and a sun at night, are faults of the file.
TEST(LunarDay, AirIsChecked) {
  EXPECT_NE(message_of([] { parse_weather(without_air(1e5), "earth.csv"); }).find("longwave_down = 0 W/m2"),
            std::string::npos);
}

}  // namespace
}  // namespace suite::lunar_day_test
