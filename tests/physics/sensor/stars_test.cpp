// Stars on focal planes: places and energy by closed forms, through perspective, distortion, point spread, motion of
// the sky and air; hidden by what stands in front.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "light/kinds/solar_spectrum.h"
#include "motion/ephemeris.h"
#include "support/stars_kit.h"

namespace suite::stars_test {
namespace {

using namespace test;

TEST(Stars, FrameCameraKeepsTheirEnergyAndPlace) {
  const Dir star = sphere().without_air(kStar.place);
  ASSERT_GT(star.z, 0.5);
  for (const auto& [right, up] : {std::pair{0.0, 0.0}, {30.3 * kStep, -70.2 * kStep}}) {
    PlatformKit kit;
    kit.render(ground(), stars_alone({kStar}), camera(star, right, up));
    std::printf("energy over that of the star - 1: %.1e\n", energy(kit.shots[0], 1e4) / above(kStar) - 1);
    EXPECT_NEAR(energy(kit.shots[0], 1e4) / above(kStar), 1, 1e-4);
    const std::vector<Listed> seen = table_of(kit.shots[0]);
    ASSERT_EQ(seen.size(), 1u);
    EXPECT_NEAR(seen[0].irradiance / above(kStar), 1, 1e-4);
    // In the pixel that holds it (the table has that pixel's middle).
    EXPECT_NEAR(std::hypot(seen[0].column - 100, seen[0].row - 100), std::hypot(std::tan(right), std::tan(up)) / kStep,
                0.8);
  }
}

// Jupiter, high in the west that evening: listed by its name where the theory has it, as bright as a star of its
// magnitude and colour, and dark when the part is not asked for.
TEST(Stars, PlanetsAreOnTheFocalPlaneToo) {
  const Instant t = instant_from_utc(parse_iso8601(kUtc));
  const SeenPlanet jupiter = seen_planets(sphere(), julian_tt(t))[static_cast<size_t>(Planet::jupiter)];
  const Dir place = sphere().without_air(jupiter.place);
  ASSERT_GT(place.z, 0.5);
  NightSkyLightSpec night;
  night.scale = {0, 0, 0, 0, 0, 2};
  night.time.utc = kUtc;
  night.place = kPlace;
  SourceSpecs sources;
  sources.add(night);
  PlatformKit kit;
  kit.render(ground(), sources, camera(place, 0, 0));
  const double expected = 2 * kVegaIrradiance * flux_of(jupiter.v) * planet_shape(Planet::jupiter).mean(0.545, 0.555);
  EXPECT_NEAR(energy(kit.shots[0], 1e4) / expected, 1, 1e-4);
  bool listed = false;
  for (const TextFile& text : kit.shots[0].texts) listed |= text.text.find("\njupiter,-2.") != std::string::npos;
  EXPECT_TRUE(listed);
  kit.render(ground(), stars_alone({}), camera(place, 0, 0));
  EXPECT_EQ(energy(kit.shots[1], 1e4), 0);
}

// The truth `star` says which row of the table lit a pixel most; the second star of two in one pixel is not named, and
// pixels between them hold none.
TEST(Stars, TruthNamesThem) {
  const Dir star = sphere().without_air(kStar.place);
  CatalogueStar faint = kStar, apart = kStar;
  faint.name = "faint", faint.v = 6;
  apart.name = "apart", apart.v = 6, apart.place.declination += 30 * kStep;
  PlatformKit kit;
  kit.render(ground(), stars_alone({faint, kStar, apart}), camera(star, 0, 0, "truth: [star]\n"));
  const CaptureResult& r = kit.shots[0].result;
  ASSERT_EQ(r.truth_names, std::vector<std::string>{"star"});
  std::map<int, int> pixels;
  for (const double row : r.truth) ++pixels[static_cast<int>(row)];
  EXPECT_EQ(pixels, (std::map<int, int>{{0, 40000 - 2}, {2, 1}, {3, 1}}));
  size_t brightest = 0;
  for (size_t i = 0; i < r.problems(); ++i)
    if (r.radiance[i * r.values_per_problem()] > r.radiance[brightest * r.values_per_problem()]) brightest = i;
  EXPECT_EQ(r.truth[brightest], 2);
}

// A satellite in low orbit, in sunlight over a place in darkness: where SGP4 has it, as seen from the camera, and as
// bright as a matte sphere there; it goes on its way during an exposure, and is dark in the Earth's shadow.
TEST(Stars, SatellitesPassInSunlight) {
  OrbitElements elements;
  elements.satellite = "25544";
  elements.epoch = parse_iso8601(kUtc);
  elements.inclination = 0.9, elements.eccentricity = 1e-3;
  elements.mean_motion = 15.5 * 2 * kPi / 1440;
  const auto orbit = std::make_shared<const Sgp4>(elements);
  const SceneFrame frame(kPlace);
  const TrackPtr track = orbit_track(orbit, frame, Clock(parse_iso8601(kUtc)), 0);
  NightSkyLightSpec night;
  night.scale = {};
  night.satellites.push_back({"iss", orbit, 400, 0.3});
  night.time.utc = kUtc;
  night.place = kPlace;
  SourceSpecs sources;
  sources.add(night);
  const Vec3 camera_at{0, 0, 2};
  std::optional<double> lit, dark;
  const auto share = [&](double t) {
    const Dir to_sun = sun_at(frame, {}, instant_from_utc(parse_iso8601(kUtc)) + t).direction;
    return SunlitPoint(track, frame, to_sun, 120).share(t, camera_at);
  };
  for (double t = 0; t < 40 * 86400 && !(lit && dark); t += 30) {
    if (normalized(track->at(t).translation).z < 0.4) continue;
    (share(t) > 0 ? lit : dark) = t;
  }
  ASSERT_TRUE(lit && dark);
  const auto shot = [&](double t, double exposure) {
    PlatformKit kit;
    kit.render(ground(), sources,
               camera(normalized(track->at(t + exposure / 2).translation - camera_at), 0, 0,
                      strf("time_s: %g\nintegration_time_s: %g\n", t, exposure)));
    return kit.shots.at(0);
  };
  const double t = std::round(*lit), expected = share(t) * solar_irradiance().mean(0.545, 0.555);
  const Shot still = shot(t, 0);
  EXPECT_NEAR(energy(still, 1e4) / expected, 1, 1e-4);
  std::string table;
  for (const TextFile& text : still.texts) table += text.text;
  EXPECT_NE(table.find("\niss,"), table.npos);
  // At 7 km/s and 400 to 800 km it crosses the 200 pixels of 1e-4 rad in some 2 s.
  const Shot moving = shot(t, 0.5);
  size_t pixels = 0;
  for (const double L : moving.result.radiance) pixels += L > 0;
  EXPECT_GT(pixels, 20u);
  EXPECT_NEAR(energy(moving, 1e4) / expected, 1, 0.02);
  EXPECT_EQ(energy(shot(std::round(*dark), 0), 1e4), 0);
}

// Starlight is unpolarised: half of it passes a polarizer, as Q and U of the light behind say, and none shows without.
TEST(Stars, PolarizersTakeHalf) {
  const Dir star = sphere().without_air(kStar.place);
  PlatformKit kit;
  kit.render(ground(), stars_alone({kStar}), camera(star, 0, 0, "stokes: linear\nanalyser: {polarizer_deg: 30}\n"));
  kit.render(ground(), stars_alone({kStar}), camera(star, 0, 0, "stokes: linear\n"));
  EXPECT_NEAR(energy(kit.shots[0], 1e4) / above(kStar), 0.5, 1e-4);
  EXPECT_NEAR(energy(kit.shots[1], 1e4) / above(kStar), 1, 1e-4);
  const auto linear = [](const CaptureResult& r) {
    double I = 0, Q = 0, U = 0;
    for (size_t p = 0; p < r.problems(); ++p) {
      const double* const S = &r.radiance[p * r.values_per_problem()];
      I += S[0], Q += S[1], U += S[2];
    }
    return std::hypot(Q, U) / I;
  };
  EXPECT_NEAR(linear(kit.shots[0].result), 1, 1e-6);
  EXPECT_NEAR(linear(kit.shots[1].result), 0, 1e-6);
}

// 20 degrees off the axis a pixel sees 0.83 of the solid angle: radiance is as much higher.
TEST(Stars, WideAngles) {
  const Dir star = sphere().without_air(kStar.place);
  PlatformKit kit;
  std::string wide = camera(star, 0.35, 0);
  wide.replace(wide.find("focal_length_mm: 100"), 20, "focal_length_mm: 2.5");
  kit.render(ground(), stars_alone({kStar}), wide);
  const double cosine = std::cos(0.35);
  EXPECT_NEAR(energy(kit.shots[0], 250) / above(kStar), 1, 0.01);  // by the pixel's middle
  double brightest = 0;
  for (const double r : kit.shots[0].result.radiance) brightest = std::max(brightest, r);
  EXPECT_NEAR(brightest / (above(kStar) * 250 * 250 / std::pow(cosine, 3)), 1, 1e-4);
  EXPECT_GT(std::fabs(brightest / (above(kStar) * 250 * 250) - 1), 0.1) << "the solid angle must be noticed";
}

TEST(Stars, FaintOnesAndHiddenOnesAreNotListed) {
  const Dir star = sphere().without_air(kStar.place);
  CatalogueStar faint = kStar;
  faint.v = 9;  // beyond the limit of 8
  PlatformKit kit;
  kit.render(ground(), stars_alone({faint}), camera(star, 0, 0));
  EXPECT_TRUE(table_of(kit.shots[0]).empty());
  EXPECT_EQ(energy(kit.shots[0], 1e4), 0);
  // A board between camera and star.
  const Frame f = Frame::around(star);
  const Vec3 middle = Vec3{0, 0, 2} + star * 50;
  const Mesh board =
      mesh_of({middle - f.x - f.y, middle + f.x - f.y, middle + f.x + f.y, middle - f.x + f.y}, {0, 1, 2, 0, 2, 3}, 0);
  PlatformKit hidden;
  hidden.render(ground({board}), stars_alone({kStar}), camera(star, 0, 0));
  EXPECT_TRUE(table_of(hidden.shots[0]).empty());
  EXPECT_LT(energy(hidden.shots[0], 1e4), 0.01 * above(kStar));
}

// In 100 s the star goes 15.041 arc seconds a second times cos(declination).
TEST(Stars, TrailsKeepTheirEnergyAndLength) {
  const Dir star = sphere().without_air(kStar.place);
  PlatformKit kit;
  kit.render(ground(), stars_alone({kStar}), camera(star, 0, 0, "time_s: 0\nintegration_time_s: 100\n"));
  const CaptureResult& r = kit.shots[0].result;
  EXPECT_NEAR(energy(kit.shots[0], 1e4) / above(kStar), 1, 1e-4);
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
  for (size_t p = 0; p < r.problems(); ++p) {
    if (!(r.radiance[p] > 0)) continue;
    const auto x = static_cast<double>(p % r.columns), y = static_cast<double>(p / r.columns);
    left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = std::max(bottom, y);
  }
  const double expected = 100 * 7.292115e-5 * std::cos(kStar.place.declination) / kStep;
  EXPECT_GT(expected, 50);
  EXPECT_NEAR(std::hypot(right - left, bottom - top), expected, 2);
}

// Beer's law in layers that dim: a depth of 0.3 at the star's zenith angle.
TEST(Stars, AirDimsThem) {
  const Dir star = sphere().without_air(kStar.place);
  SourceSpecs sources = stars_alone({kStar});
  AtmosphereSpec air;
  air.heights = {0, 1000};
  air.rayleigh = false;
  AtmosphereSpec::Gas gas;
  gas.name = "grey";
  gas.layers = {Curve::constant(0.3)};
  air.gases.push_back(gas);
  air.temperature_k = {280};
  sources.atmosphere = air;
  PlatformKit kit;
  kit.render(ground(), sources, camera(star, 0, 0));
  const std::vector<Listed> seen = table_of(kit.shots[0]);
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_NEAR(seen[0].irradiance / above(kStar), std::exp(-0.3 * 0.998 / star.z), 2e-3);  // 2 m up
}

// From 400 km up, with air below, a star stands where it is without air; on the ground it is lifted.
TEST(Stars, FromOrbitAirLiftsNoneAboveIt) {
  const Dir star = sphere().without_air(kStar.place);
  SourceSpecs sources = stars_alone({kStar});
  AtmosphereSpec air;
  air.heights = {0, 1000};
  air.rayleigh = false;
  air.temperature_k = {280};
  sources.atmosphere = air;
  const auto place = [&](double height) {
    std::string text = camera(star, 0, 0);
    const Vec3 at = Vec3{0, 0, height} + star * 1e3;
    text.replace(text.find("[0, 0, 2]"), 9, strf("[0, 0, %g]", height));
    const size_t look = text.find("look_at_m: ");
    text.replace(look, text.find("\n", look) - look, strf("look_at_m: [%.17g, %.17g, %.17g]", at.x, at.y, at.z));
    PlatformKit kit;
    kit.render(ground(), sources, text);
    const std::vector<Listed> seen = table_of(kit.shots.at(0));
    return seen.size() == 1 ? std::hypot(seen[0].column - 100, seen[0].row - 100) : INFINITY;
  };
  // Pixels of 20.6 arc seconds; R = 58 arc seconds times the tangent of the zenith distance on the ground.
  EXPECT_LT(place(400e3), 1);
  EXPECT_NEAR(place(2), 58.2 * std::tan(std::acos(star.z)) / 20.63, 1);
}

// A lens with distortion and a Gaussian spot: energy by the pixels' solid angles, centre by the lens.
// A platform that stands and looks past the star by degrees.
double energy_by_platform(double past, const std::string& readout) {
  const Dir star = sphere().without_air(kStar.place);
  const double azimuth = std::atan2(star.x, star.y) / kDegree, height = std::asin(star.z) / kDegree;
  PlatformKit kit;
  kit.frame = SceneFrame(kPlace);
  kit.render(ground(), stars_alone({kStar}),
             strf("kind: platform\nmotion: {kind: straight, position_m: [0, 0, 2], heading_deg: %.12g, speed_m_s: 0}\n"
                  "tasks: [{start: 0, stop: 0}]\ninstruments:\n  - name: i\n    rotate_deg: [%.12g, 0, 0]\n",
                  azimuth, 90 + height - past) +
                 "    focal_length_mm: 100\n    distortion: {k1: -0.5}\n    psf: {kind: gaussian, sigma_um: 12}\n"
                 "    arrays:\n      - {name: a, columns: 200, rows: 200, pitch_um: 10, paths: 4, " +
                 readout + "bands: [{name: v, center_um: 0.55, fwhm_um: 0.01, shape: rectangular}]}\n");
  EXPECT_EQ(kit.shots.size(), 1u);
  return energy(kit.shots[0], 1e4) / above(kStar);
}

// Electrons of a star in a lens of 50 mm, a throughput of 0.8, a quantum efficiency of 0.6, 0.5 to 0.9 um: for V = 0
// and an even spectrum 3.631e-8 W/(m2 um) times 0.28 um2 / (h c) times the aperture are 4.82e7 a second, and 764 for V
// = 12. A star of 6000 K by its own spectrum; G# = (1 + 4 N^2) / (pi tau), by which the camera counts, gathers 0.4 %
// less than the aperture at f/8.
TEST(Stars, ElectronsOfAnAperture) {
  constexpr double kHc = 1.98644586e-25;  // J m
  const double gathers = kPi / 4 * 0.05 * 0.05 * 0.8 * 0.6 * 1e-6 / kHc;
  EXPECT_NEAR(kVegaIrradiance * (0.81 - 0.25) / 2 * gathers, 4.82e7, 0.01e7);
  EXPECT_NEAR(kVegaIrradiance * flux_of(12) * (0.81 - 0.25) / 2 * gathers, 764, 1);
  const Dir star = sphere().without_air(kStar.place);
  PlatformKit kit;
  kit.frame = SceneFrame(kPlace);
  kit.render(
      ground(), stars_alone({kStar}),
      strf("kind: platform\nmotion: {kind: straight, position_m: [0, 0, 2], heading_deg: %.12g, speed_m_s: 0}\n"
           "tasks: [{start: 0, stop: 0}]\ninstruments:\n  - name: i\n    rotate_deg: [%.12g, 0, 0]\n",
           std::atan2(star.x, star.y) / kDegree, 90 + std::asin(star.z) / kDegree) +
          "    focal_length_mm: 400\n    f_number: 8\n    throughput: 0.8\n"
          "    arrays:\n      - {name: a, columns: 20, rows: 20, pitch_um: 10, paths: 4, integration_time_s: 0.5, "
          "bands: [{name: v, center_um: 0.7, fwhm_um: 0.4, shape: rectangular}], detector: {quantum_efficiency: "
          "0.6, gain_e_per_dn: 1000}}\n");
  double electrons = 0, expected = 0;
  for (const double n : kit.shots.at(0).products.at(0).values) electrons += n;
  const Curve shape = star_shape(kStar.kelvin);
  for (int i = 0; i < 4000; ++i) {
    const double w = 0.5 + (i + 0.5) * 1e-4;
    expected += shape.at(w) * w * 1e-4;
  }
  expected *= kVegaIrradiance * flux_of(kStar.v) * gathers * 0.5 * 256 / 257;
  EXPECT_NEAR(electrons / expected, 1, 2e-3);
}

TEST(Stars, PlatformsSpreadThem) { EXPECT_NEAR(energy_by_platform(0.2, ""), 1, 1e-4); }

// Rows are exposed one after the other, and each sees a star that stands still as long as the others: 50 um a row, 2 ms
// of light, of a read-out of 12 ms.
TEST(Stars, RowsOfARollingShutterSeeThemAlike) {
  const std::string rolling = "readout: {kind: rolling, row_time_s: 50.0e-6}, integration_time_s: 2.0e-3, ";
  for (const double past : {-0.5, 0.0, 0.5}) EXPECT_NEAR(energy_by_platform(past, rolling), 1, 0.02) << past << " deg";
}

}  // namespace
}  // namespace suite::stars_test
