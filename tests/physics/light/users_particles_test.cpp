// Particles that a user brings as a file, in all three ways of following light: what the suite knows of its own kinds,
// written to such a file, gives the same radiances.
#include <gtest/gtest.h>

#include <cmath>

#include "air/particle_tables.h"
#include "air/phase_grid.h"
#include "formats/particles/particles.h"
#include "light/kinds/sun.h"
#include "light/stratified_air.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test::users_particles_test {
namespace {

// A named kind as a file has it. scale: of the albedo.
std::string exported(const ParticleSpec& spec, std::span<const double> wavelengths, bool by_gram, double scale = 1) {
  const ParticleOptics optics = particle_optics(spec, wavelengths);
  std::string text =
      std::string("wavelength_um, ") + (by_gram ? "extinction_m2_g" : "extinction_relative") + ", albedo\n";
  for (size_t w = 0; w < wavelengths.size(); ++w)
    text += strf("%.9g, %.9g, %.12g\n", wavelengths[w], optics.extinction(w) / (by_gram ? 1000 : 1),
                 scale * optics.albedo(w));
  text += "wavelength_um, angle_deg, phase_per_sr\n";
  const std::span<const double> cosines = phase_cosines();
  for (size_t w = 0; w < wavelengths.size(); ++w)
    for (size_t i = cosines.size(); i-- > 0;)
      text += strf("%.9g, %.9g, %.9g\n", wavelengths[w], std::acos(cosines[i]) / kDegree,
                   static_cast<double>(optics.phase(w)[i]));
  return text;
}

ParticleSpec brought(const std::string& text) {
  ReadParticles read = parse_particles(text, "p.txt");
  for (const std::string& note : read.notes) ADD_FAILURE() << note;
  ParticleSpec spec;
  spec.data = std::make_shared<const ParticleData>(std::move(read.data));
  return spec;
}

std::vector<double> rural_wavelengths() {
  const std::span<const double> all = aerosol_table("rural").wavelengths_um;
  return {all.begin(), all.end()};
}

AirSpec hazy(const ParticleSpec& particles) {
  AirSpec air;
  air.profile = standard_profile("us_standard");
  air.aerosol = AirSpec::Aerosol{};
  air.aerosol->boundary = particles;
  return air;
}

// Between the wavelengths of the table as well as on them.
const std::vector<double> kCenters{0.45, 0.55, 0.87, 1.62, 10.6};

// Radiance and transmittance down and up, one after the other.
std::vector<double> seen(AirSpec air, AirScattering scattering) {
  std::vector<Band> bands;
  for (const double c : kCenters) bands.push_back(Band::rectangular("b", c, 0.01));
  const SpectralState state = make_state(bands, 1);
  air.scattering = scattering;
  const std::vector<float> sun(state.size(), 1.0f);
  const auto made = make_stratified_air(air, state, {{dir_from_angles(40 * kDegree, 0.3), sun.data()}});
  std::vector<double> all;
  for (const double zenith : {20.0, 44.0, 75.0, 120.0, 170.0}) {
    const Dir d = dir_from_angles(zenith * kDegree, 0.4);
    std::vector<float> T(state.size()), S(state.size());
    if (d.z > 0)
      made->path({0, 0, 0}, d, INFINITY, T, S);
    else
      made->path(-d * (2e5 / -d.z), d, 2e5 / -d.z, T, S);
    all.insert(all.end(), T.begin(), T.end());
    all.insert(all.end(), S.begin(), S.end());
  }
  return all;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::fabs(a[i] - b[i]) / std::fabs(b[i]));
  return largest;
}

TEST(UsersParticles, AnExportedAerosolGivesTheRadianceOfItsModel) {
  const ParticleSpec rural;
  const std::vector<double> wavelengths = rural_wavelengths();
  const AirSpec own = hazy(rural), file = hazy(brought(exported(rural, wavelengths, false))),
                darker = hazy(brought(exported(rural, wavelengths, false, 0.97)));
  for (const AirScattering scattering : {AirScattering::single, AirScattering::diffuse}) {
    const std::vector<double> expected = seen(own, scattering);
    EXPECT_LT(largest_difference(seen(file, scattering), expected), 1e-3);
    EXPECT_GT(largest_difference(seen(darker, scattering), expected), 1e-3);  // control
  }
}

TEST(UsersParticles, AnExportedCloudGivesTheRadianceOfItsModel) {
  const ParticleSpec water{.name = "water", .effective_radius_um = 8};
  std::vector<double> wavelengths{0.3};
  wavelengths.insert(wavelengths.end(), kCenters.begin(), kCenters.end());
  wavelengths.push_back(15);
  AirSpec own;
  own.profile = standard_profile("us_standard");
  own.clouds.push_back({water, 1000, 1500, 2e-5});
  AirSpec file = own;
  file.clouds[0].particles = brought(exported(water, wavelengths, true));
  for (const AirScattering scattering : {AirScattering::single, AirScattering::diffuse})
    EXPECT_LT(largest_difference(seen(file, scattering), seen(own, scattering)), 1e-3);
}

// Paths scattered in the air draw the same directions of both.
std::vector<double> traced(const ParticleSpec& particles) {
  AirSpec air = hazy(particles);
  air.scattering = AirScattering::traced;
  SourceSpecs sources;
  sources.air = std::make_shared<const AirSpec>(air);
  sources.add(SunSpec{{dir_from_angles(50 * kDegree, 0.3), 0, Curve::constant(1)}});
  const Dir d = -dir_from_angles(45 * kDegree, 0.5);
  const auto scene = scene_of({quad(1e6, 0, 0)}, {material("ground", lambert(0.3))});
  const std::vector<Band> bands{Band::rectangular("blue", 0.45, 0.01), Band::rectangular("red", 0.67, 0.01)};
  const std::vector<Ray> rays{{-d * 2e5, d, 0}};
  const CaptureResult result = render(scene, sources, std::make_unique<RaySensor>(rays, bands, 256, 0.02)).result;
  return {result.radiance.begin(), result.radiance.end()};
}
TEST(UsersParticles, PathsAreScatteredByThemAsByTheirModel) {
  const ParticleSpec rural;
  const std::vector<double> wavelengths = rural_wavelengths(), expected = traced(rural);
  EXPECT_LT(largest_difference(traced(brought(exported(rural, wavelengths, false))), expected), 1e-3);
  EXPECT_GT(largest_difference(traced(brought(exported(rural, wavelengths, false, 0.9))), expected), 1e-3);
}

}  // namespace
}  // namespace suite::test::users_particles_test
