// Sources in simulation texts: what is read, and that faults are told at their place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "air/lowtran.h"
#include "base/files.h"
#include "formats/picture/picture.h"
#include "formats/sim_text/sources.h"
#include "formats/sqt/sqt.h"
#include "formats/sqt/sqt_write.h"
#include "support/message_of.h"
#include "support/radiometry_kit.h"
#include "support/sqt_examples.h"
#include "support/temp_folder.h"

namespace suite::format_sim_text_sources_test {
namespace {

SourceSpecs read(const std::string& text, const std::string& file = "x.yaml") {
  const Params root = Params::parse_text(text, file);
  std::vector<AskedCurve> asked;
  SourceSpecs s = read_sources(root, asked);
  root.reject_unread();
  return s;
}

TEST(Sources, AirIsReadAsItIsWritten) {
  const SourceSpecs s = read(
      "atmosphere: {profile: tropical, water_kg_m2: 20, ozone_du: 250, ppm: {co2: 420}, gases: none, g_points: 8, "
      "shape: "
      "flat, scattering: single, streams: 8, scene_height_m: 1200, ground_albedo: 0.4, aerosol: {model: urban, "
      "optical_depth_550: 0.3}, clouds: [{kind: water, base_m: 3000, top_m: 3500, optical_depth_550: 5, "
      "effective_radius_um: 8}]}");
  ASSERT_TRUE(s.air);
  EXPECT_FALSE(s.atmosphere);
  EXPECT_NEAR(precipitable_water(s.air->profile), 20, 1e-6);
  EXPECT_NEAR(dobson(s.air->profile), 250, 1e-6);
  EXPECT_NEAR(s.air->profile.levels[0].share(Gas::co2), 420e-6, 1e-12);
  EXPECT_FALSE(s.air->gases);
  EXPECT_EQ(s.air->points.most, 8);
  EXPECT_FALSE(s.air->round);
  EXPECT_EQ(s.air->scattering, AirScattering::single);
  EXPECT_EQ(s.air->streams, 8);
  EXPECT_EQ(s.air->height_of_scene(), 1200);
  EXPECT_NEAR(s.air->aerosol->profile.depth(), 0.3, 1e-6);
  // What does nothing once light is scattered once, or without gases.
  std::string notes;
  for (const std::string& n : s.air->notes) notes += n + "\n";
  for (const char* key : {"'streams'", "'ground_albedo'", "'g_points'", "'ppm'"})
    EXPECT_THAT(notes, testing::HasSubstr(key));
  const double middle[] = {0.55};
  EXPECT_NEAR(s.air->clouds[0].content * 500 * particle_optics(s.air->clouds[0].particles, middle).extinction(0), 5,
              1e-6);
}

TEST(Sources, SpheresBySizesAndIndex) {
  const auto air = [](const char* aerosol, const char* cloud) {
    return read(strf("atmosphere: {profile: tropical, aerosol: {spheres: {%s}, optical_depth_550: 0.2, "
                     "scale_height_m: 1000}, clouds: [{spheres: {%s}, base_m: 1000, top_m: 2000, "
                     "optical_depth_550: 3}]}",
                     aerosol, cloud))
        .air;
  };
  const auto spec = air("sizes: log_normal, median_radius_um: 0.1, sigma: 1.6, n: 1.5, k: 0.01",
                        "sizes: gamma, effective_radius_um: 2, effective_variance: 0.1, n: 1.33");
  const double middle[] = {0.55};
  EXPECT_NEAR(particle_optics(spec->aerosol->boundary, middle).extinction(0), 1, 1e-12);
  const ParticleOptics drops = particle_optics(spec->clouds[0].particles, middle);
  EXPECT_NEAR(spec->clouds[0].content * 1000 * drops.extinction(0), 3, 1e-6);
  EXPECT_EQ(drops.albedo(0), 1);
  EXPECT_TRUE(drops.matrices());
  EXPECT_TRUE(air("sizes: junge, exponent: 3, least_radius_um: 0.1, largest_radius_um: 2, n: 1.5",
                  "sizes: modified_gamma, shape: 6, slope: 3, n: 1.33, density_kg_m3: 900"));
}

TEST(Sources, GasesByName) {
  const auto gases = [](const char* name) {
    const SourceSpecs s = read(strf("atmosphere: {profile: tropical, gases: %s}", name));
    return s.air->gases;
  };
  EXPECT_EQ(gases("builtin").get(), &builtin_gases());
  EXPECT_EQ(gases("lowtran").get(), &lowtran_gases());
}

TEST(Sources, ParticlesOfAUser) {
  const TempFolder folder;
  write_file(folder / "p.txt",
             "wavelength_um extinction_m2_g albedo asymmetry\n0.4 3 0.9 0.7\n0.55 2 0.9 0.7\n2 1 0.9 0.7\n");
  write_file(folder / "r.txt", "wavelength_um extinction_relative albedo asymmetry\n8 0.3 0.9 0.7\n12 0.2 0.9 0.7\n");
  const auto air = [&](const std::string& text) {
    return read("atmosphere: {profile: tropical, " + text + "}", folder / "x.yaml").air;
  };
  const auto own =
      air("aerosol: {optics: p.txt, optical_depth_550: 0.3}, clouds: [{optics: p.txt, base_m: 1000, top_m: 2000, "
          "optical_depth_550: 4}, {optics: r.txt, base_m: 1000, top_m: 2000, optical_depth_550: 4}]");
  ASSERT_TRUE(own->aerosol->boundary.data);
  const double red[] = {2};
  EXPECT_NEAR(particle_optics(own->aerosol->boundary, red).extinction(0), 0.5, 1e-9);
  EXPECT_NEAR(own->clouds[0].content * 1000 * 2000, 4, 1e-9);  // kg/m3, m, m2/kg
  EXPECT_NEAR(own->clouds[1].content * 1000, 4, 1e-9);
  const auto message = [&](const std::string& text) { return message_of([&] { air(text); }); };
  EXPECT_THAT(message("aerosol: {optics: p.txt, model: rural}"), testing::HasSubstr("drop one"));
  EXPECT_THAT(message("aerosol: {optics: p.txt, relative_humidity: 0.5}"), testing::HasSubstr("relative_humidity"));
  EXPECT_THAT(message("aerosol: {optics: gone.txt}"), testing::HasSubstr("no file"));
  EXPECT_THAT(message("clouds: [{optics: r.txt, base_m: 1000, top_m: 2000, content_g_m3: 1}]"),
              testing::HasSubstr("give `optical_depth_550`"));
}

// The first of them, for one bin at 0.55 um.
std::shared_ptr<const Light> baked(const SourceSpecs& s) {
  const Tracer tracer(test::scene_of({test::quad(1, 0, 0)}, {test::material("m", test::lambert(0))}));
  return s.lights.at(0)->bake(tracer, make_state(std::vector<Band>{Band::rectangular("b", 0.55, 0.01)}, 1));
}

struct BadCase {
  const char *text, *message;
};
class BadSources : public testing::TestWithParam<BadCase> {};
TEST_P(BadSources, AreToldAtTheirPlace) {
  const std::string message = message_of([] { read(GetParam().text); });
  EXPECT_THAT(message, testing::HasSubstr(GetParam().message));
  EXPECT_THAT(message, testing::StartsWith("x.yaml:"));
}
const BadCase kBad[] = {
    {"atmosphere: {profile: us_standart}", "us_standard"},
    {"atmosphere: {profile: tropical, ppm: {co3: 400}}", "unknown gas 'co3'"},
    {"atmosphere: {profile: tropical, water_kg_m2: -1}", "-1"},
    {"atmosphere: {profile: tropical, aerosol: {model: rurale}}", "rural"},
    {"atmosphere: {profile: tropical, aerosol: {model: rural, optical_depth_550: 0.1, visibility_km: 5}}", "drop one"},
    {"atmosphere: {profile: tropical, aerosol: {model: rural, scale_height_m: 1000}}", "optical_depth_550"},
    {"atmosphere: {profile: tropical, clouds: [{kind: water, base_m: 1000, top_m: 2000}]}", "content_g_m3"},
    {"atmosphere: {profile: tropical, clouds: [{kind: water, base_m: 1000, top_m: 900, optical_depth_550: 1}]}", "900"},
    {"atmosphere: {profile: tropical, aerosol: {model: rural, wind_m_s: 3}}", "wind_m_s"},
    {"atmosphere: {profile: tropical, aerosol: {model: desert, relative_humidity: 0.5}}", "relative_humidity"},
    {"atmosphere: {profile: tropical, aerosol: {model: rural, optical_depth_550: 1, scale_height_m: 900, season: "
     "fall_winter}}",
     "season"},
    {"atmosphere: {profile: tropical, clouds: [{kind: water, base_m: 1000, top_m: 2000, optical_depth_550: 1, "
     "effective_radius_um: 50}]}",
     "50"},
    {"atmosphere: {profile: tropical, streams: 7}", "7 streams are not even"},
    {"atmosphere: {profile: tropical, aerosol: {model: rural, spheres: {sizes: gamma}}}", "drop one of the two"},
    {"atmosphere: {profile: tropical, aerosol: {spheres: {sizes: lognormal, n: 1.5}}}", "log_normal"},
    {"atmosphere: {profile: tropical, aerosol: {spheres: {sizes: log_normal, median_radius_um: 0.1, sigma: 0.5, n: "
     "1.5}}}",
     "the geometric standard deviation 0.5 is outside its range"},
    {"atmosphere: {profile: tropical, aerosol: {spheres: {sizes: log_normal, median_radius_um: 0.1, sigma: 2}}}",
     "'n'"},
    {"atmosphere: {profile: tropical, aerosol: {spheres: {sizes: log_normal, median_radius_um: 0.1, sigma: 2, n: 1.5, "
     "density_kg_m3: 1}}}",
     "density_kg_m3"},
    {"lamps: [{kind: point, position_m: [0, 0, 1], intensity: 1, stokes: [1, 0.9, 0.9, 0]}]",
     "no light of intensity 1"},
    {"lamps: [{kind: point, position_m: [0, 0, 1], intensity: 1, stokes_axis: [1, 0, 0]}]", "not polarised"},
    {"sky: {radiance: 1, stokes: [1, 0.5, 0, 0]}", "stokes"},
    {"sun: {direction: {zenith_deg: 1, azimuth_deg: 0}, stokes: [1, 0, 0, 0.1]}", "stokes"},
    {"atmosphere: {profile: tropical, ground_albedo: 1.2}", "the albedo exceeds 1"},
    {"atmosphere: {profile: tropical, g_points: 99}", "99"},
    {"atmosphere: {profile: tropical, scattering: twice}", "twice"},
    {"atmosphere: {profile: tropical, shape: flat, refraction: true}", "round Earth"},
    {"atmosphere: {profile: tropical, heights_m: [0, 1]}", "heights_m"},
    {"{sky: {radiance: 1}, atmosphere: {profile: tropical}}", "makes its own"},
    {"sun: {irradiance: 3}", "the key 'direction' is missing"},
    {"sun: {direction: {zenith_deg: 190, azimuth_deg: 0}}", "190"},
    {"sun: {direction: {zenith_deg: 10, azimuth_deg: 0}, irradiance: -3}", "the irradiance is negative"},
    {"sun: {direction: {time_utc: 2026-13-01}}", "2026-13-01"},
    {"sun: {direction: {zenith_deg: 1, azimuth_deg: 0}, collimated: true, half_angle_deg: 1}", "collimated"},
    {"moon: {direction: {zenith_deg: 1, azimuth_deg: 0}}", "the moon's light is not given"},
    {"moon: {direction: {zenith_deg: 1, azimuth_deg: 0}, phase_deg: 10, irradiance: 1}", "drop one of the two"},
    {"sky: {kind: clear}", "a clear sky needs a sun"},
    {"sky: {kind: cloudy}", "clear"},
    {"sky: {radiance: 1, table: [[1, 2], [1]]}", "equally long"},
    {"sky: {radiance: 1, table: [[1, 2]]}", "at least two rows"},
    {"sky: {radiance: 1, tables: [{wavelength_um: 0.6, table: [[1], [1]]}, {wavelength_um: 0.5, table: [[1], [1]]}]}",
     "not ascending"},
    {"sky: {radiance: 1, tables: [{wavelength_um: 0.5, table: [[1], [1]]}, {wavelength_um: 0.6, table: [[1, 1], [1, "
     "1]]}]}",
     "differ in size"},
    {"sky: {kind: thermal, layers: [{temperature_k: -3, optical_depth: 1}]}", "-3"},
    {"sky: {kind: thermal, layers: [{temperature_k: 3, optical_depth: -1}]}", "the optical depth is negative"},
    {"night_sky: {}", "a night sky needs a date"},
    {"night_sky: {time_utc: 2026-02-30}", "2026-02-30"},
    {"{epoch: 2026-02-03T20:00:00Z, night_sky: {parts: [moonlight]}}", "moonlight"},
    {"{epoch: 2026-02-03T20:00:00Z, night_sky: {parts: []}}", "no part is named"},
    {"{epoch: 2026-02-03T20:00:00Z, night_sky: {parts: [airglow, airglow]}}", "named twice"},
    {"{epoch: 2026-02-03T20:00:00Z, night_sky: {scale: {airglov: 2}}}", "no part 'airglov'"},
    {"{epoch: 2026-02-03T20:00:00Z, night_sky: {scale: {airglow: -2}}}", "-2"},
    {"{epoch: 2026-02-03T20:00:00Z, night_sky: {place: {latitude_deg: 95, longitude_deg: 0}}}", "95"},
    {"{epoch: 2026-02-03T20:00:00Z, night_sky: {place: {latitude_deg: 5}}}", "longitude_deg"},
    {"{epoch: 2026-02-03T20:00:00Z, night_sky: {catalogue: gaia}}", "builtin"},
    {"{epoch: 2026-02-03T20:00:00Z, night_sky: {city_glow: [{azimuth_deg: 0, spectrum: {lamp: neon}, horizon_cd_m2: "
     "1}]}}",
     "neon"},
    {"{epoch: 2026-02-03T20:00:00Z, night_sky: {city_glow: [{azimuth_deg: 0, spectrum: 1}]}}", "horizon_cd_m2"},
    {"{epoch: 2026-02-03T20:00:00Z, night_sky: {city_glow: [{azimuth_deg: 0, spectrum: 0, horizon_cd_m2: 1}]}}",
     "no light that the eye sees"},
    {"{epoch: 2026-02-03T20:00:00Z, night_sky: {city_glow: [{azimuth_deg: 0, spectrum: 1, population: 1e5, "
     "distance_km: "
     "500}]}}",
     "500"},
    {"{epoch: 2026-02-03T20:00:00Z, night_sky: {solar_flux_sfu: 5000}}", "5000"},
    {"{epoch: 2026-02-03T20:00:00Z, night_sky: {stars_to_mag: bright}}", "bright"},
    {"{epoch: 2026-02-03T20:00:00Z, night_sky: {resolve_stars: all}}", "in_view"},
    {"moon: {direction: {zenith_deg: 1, azimuth_deg: 0}, irradiance: 1, earthshine: true}", "belongs to a moon"},
    {"lamps: [{kind: point, position_m: [0, 0, 1], intensity: {lamp: neon}}]", "sodium"},
    {"lamps: [{kind: point, intensity: 1}]", "either position_m or positions_m"},
    {"lamps: [{kind: spot, position_m: [0, 0, 1], intensity: 1}]", "outer_deg"},
    {"lamps: [{kind: spot, position_m: [0, 0, 1], intensity: 1, outer_deg: 10, inner_deg: 20}]", "narrower"},
    {"lamps: [{kind: point, position_m: [0, 0, 1], intensity: 1, axis: [0, 0, 0]}]", "no length"},
    {"lamps: [{kind: point, position_m: [0, 0, 1], intensity: 1, distribution: {table: [[1]]}}]", "two rows"},
    {"lamps: [{kind: point, position_m: [0, 0, 1], intensity: 1, distribution: {table: [[1], [-1]]}}]", "negative"},
    {"lamps: [{kind: surface, radiance: 1}]", "material"},
    {"lamps: [{kind: surface, material: a, radiance: 1, both_side: true}]", "both_sides"},
    {"atmosphere: {heights_m: [0, 10, 5]}", "not ascending"},
    {"atmosphere: {heights_m: [0]}", "2 to 201"},
    {"atmosphere: {heights_m: [0, 1000], temperature_k: [280, 270]}", "2 temperatures for 1 layers"},
    {"atmosphere: {aerosol: {optical_depth_550: 0.1, phase: {model: hgg}}}", "unknown"},
    {"atmosphere: {aerosol: {optical_depth_550: 0.1, albedo: 1.2}}", "exceeds 1"},
    {"atmosphere: {gases: [{name: a, layer_optical_depths: [1, 2]}]}", "2 optical depths for 17 layers"},
    {"sun: {direction: {zenith_deg: 1, azimuth_deg: 0}}\nsky: {kind: clear}\natmosphere: {}",
     "stands for the atmosphere"},
    {"earth: {height_m: 3}", "material"}};
INSTANTIATE_TEST_SUITE_P(All, BadSources, testing::ValuesIn(kBad));

TEST(SimSources, AMissingPictureIsNamed) {
  EXPECT_THAT(message_of([] { read("sky: {kind: image, file: nowhere.png}"); }),
              testing::HasSubstr("nowhere.png: error: no such file"));
}

TEST(SimSources, PanoramaLooksTheWayThePictureDoes) {
  // A bright pixel column in the middle of a picture whose left edge is north: it stands in the south.
  const TempFolder folder;
  Canvas canvas(8, 4, kBlack);
  canvas.fill(4, 1, 1, 1, kWhite);
  write_png(folder / "sky.png", canvas, "test");
  const SourceSpecs s = read("sky: {kind: image, file: sky.png, wavelength_um: [0.45, 0.55, 0.65]}", folder / "x.yaml");
  const auto sky = baked(s);
  auto at = [&](double zenith_deg, double compass_deg) {
    std::vector<float> L(1, 0.0f);
    sky->add(dir_from_angles(zenith_deg * kDegree, azimuth_from_compass_deg(compass_deg)), 0, 1, L);
    return L[0];
  };
  EXPECT_EQ(at(67, 202), 255);  // row 1 of 4: 45 to 90 degrees; column 4 of 8: 180 to 225 degrees
  EXPECT_EQ(at(67, 178), 0);
  EXPECT_EQ(at(67, 227), 0);
  EXPECT_EQ(at(40, 202), 0);
  EXPECT_EQ(at(95, 202), 0);
  EXPECT_THAT(message_of([&] { read("sky: {kind: image, file: sky.png}", folder / "x.yaml"); }),
              testing::HasSubstr("3 channels and 0 wavelengths"));
}

TEST(SimSources, DistributionFromAnSqt) {
  // A distribution fitted to 1 + cos of the polar angle comes back within the fit's error, as a lamp uses it.
  const TempFolder folder;
  const test::Analytic f([](Dir, Dir in) { return 1 + in.z; }, 1, sqt::Domain::sphere, sqt::Quantity::intensity);
  const std::vector<std::byte> bytes = pack_sqt(test::small_fit(f), {"test", "test", "1 + cos", "", "intensity"}, {});
  write_file(folder / "lamp.sqt", bytes);
  const SourceSpecs s = read(
      "lamps: [{kind: point, position_m: [0, 0, 3], intensity: 2, distribution: {sqt: lamp.sqt}}]", folder / "x.yaml");
  // Places one metre from the lamp, whose axis points down.
  const auto lamp = baked(s);
  for (const double polar : {0.1, 0.8, 1.4, 2.2}) {
    const LightReceiver at{Vec3{0, 0, 3} + dir_from_angles(kPi - polar, 1), {}, true};
    const auto sample = lamp->sample(at, {}, 0);
    ASSERT_TRUE(sample) << polar;
    EXPECT_NEAR(sample->scale, 1 + std::cos(polar), 0.05) << polar;
    EXPECT_EQ(sample->spectrum[0], 2);
  }
  const test::Analytic brdf([](Dir, Dir) { return 0.3; });
  write_file(folder / "brdf.sqt", pack_sqt(test::small_fit(brdf), {"test", "test", "flat", "", "bsdf"}, {}));
  EXPECT_THAT(message_of([&] {
                read("lamps: [{kind: point, position_m: [0, 0, 3], intensity: 2, distribution: {sqt: brdf.sqt}}]",
                     folder / "x.yaml");
              }),
              testing::HasSubstr("holds no distribution of intensity"));
}

}  // namespace
}  // namespace suite::format_sim_text_sources_test
