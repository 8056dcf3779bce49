// The natural night sky's parts, against their published tables and closed forms.
#include "light/kinds/night_sky.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "light/night/glow_shells.h"
#include "light/night/zodiacal.h"

namespace suite::test::night_sky_test {
namespace {

// In S10 of a magnitude per square arc second.
double s10_of(double magnitude) { return flux_of(magnitude) * 3600 * 3600 / flux_of(10); }
double magnitude_of(double s10) { return 10 - 2.5 * std::log10(s10 / (3600.0 * 3600)); }

CelestialSphere sphere_at(const char* utc, const Geodetic& place) {
  const Instant t = instant_from_utc(parse_iso8601(utc));
  return CelestialSphere(SceneFrame(place), julian_tt(t), julian_ut1(t, 0));
}
NightSkySpec whole_sky() {
  NightSkySpec spec;
  spec.catalogue = {std::shared_ptr<void>(), &bright_star_catalogue()};
  return spec;
}
constexpr Geodetic kPlace{49.4, 8.7, 120};

// One V = 10 star a square degree; V = 22 mag/arcsec2. 3.631e-8 W/(m2 um) at V = 0 (Bessell 1998).
TEST(NightUnits, S10AndMagnitudes) {
  EXPECT_NEAR(s10_radiance(), 1.19199e-8, 1e-13);
  EXPECT_NEAR(magnitude_of(1), 27.7815, 1e-4);
  EXPECT_NEAR(s10_of(22), 205.40, 0.01);
  EXPECT_NEAR(s10_of(22) * s10_radiance(), 2.44837e-6, 1e-10);
}

// All stars are 434.73 of V = 0 (1092 of V = 1, Seares 1925): 105.38 S10 in the mean, 82.46 of it, 78.2 %, fainter than
// 6.5 (94.5593 are brighter), and a level plane gets a quarter of 2.54e-6 lx each: 2.7606e-4 lx.
TEST(NightUnits, AllStars) {
  const double degrees2 = 4 * kPi / (kDegree * kDegree);
  EXPECT_NEAR(1092 * flux_of(1), kAllStars, 0.01);
  EXPECT_NEAR(kAllStars / flux_of(10) / degrees2, 105.38, 0.005);
  EXPECT_NEAR((kAllStars - 94.5593) / flux_of(10) / degrees2, 82.46, 0.005);
  EXPECT_NEAR(1 - 94.5593 / kAllStars, 0.782, 6e-4);
  EXPECT_NEAR(kAllStars / 4 * 2.54e-6, 2.7606e-4, 1e-8);
}

// Zodiacal light 60, airglow 72, the green line 67, stars 60: 259 S10 are V = 21.75, 2.16e-4 cd/m2 and, evenly, 6.8e-4
// lx. Grass of 0.2 under it sends 6.175e-7 W/(m2 sr um): 0.62 electrons in a pixel of 10 um at f/1.4, 1/30 s, a
// quantum efficiency of 0.6, 0.5 to 0.9 um.
TEST(NightUnits, DarkSky) {
  EXPECT_NEAR(magnitude_of(259), 21.75, 0.005);
  const double luminance = 10.8e4 * flux_of(magnitude_of(259));
  EXPECT_NEAR(luminance, 2.16e-4, 5e-7);
  EXPECT_NEAR(kPi * luminance, 6.8e-4, 5e-6);
  const double grass = 0.2 * 259 * s10_radiance();
  EXPECT_NEAR(grass, 6.175e-7, 1e-10);    // 259 is rounded
  constexpr double kHc = 1.98644586e-25;  // J m
  const double photons = (0.81 - 0.25) / 2 * 1e-6 / kHc, optics = kPi / (1 + 4 * 1.4 * 1.4) * 1e-10;
  EXPECT_NEAR(grass * optics * photons * 0.6 / 30, 0.62, 0.002);
}

// 1 R = 1e10 / (4 pi) photons/(m2 s sr).
TEST(NightUnits, Rayleigh) {
  EXPECT_NEAR(rayleigh_radiance(250, 0.5577), 7.08608e-8, 1e-13);
  EXPECT_NEAR(rayleigh_radiance(0.3, 0.55) / 1e-4, 8.62235e-7, 1e-12);
  EXPECT_NEAR(rayleigh_radiance(0.3, 0.55) / 1e-4 / s10_radiance(), 72.3, 0.1);
}

// Closed form 1 / sqrt(1 - (R sin z / (R + h))^2), R = 6371 km.
TEST(Airglow, VanRhijn) {
  const double expected[][2] = {{30, 1.14958}, {60, 1.92425}, {75, 3.29768},
                                {80, 4.22168}, {85, 5.41097}, {90, 6.11283}};
  for (const auto& [z, times] : expected) EXPECT_NEAR(van_rhijn(std::sin(z * kDegree), 87e3), times, 1e-5) << z;
  EXPECT_NEAR(van_rhijn(std::sin(60 * kDegree), 250e3), 1.80903, 1e-5);
  EXPECT_EQ(van_rhijn(0, 87e3), 1);
}

double sum_of_lines(double low, double high) {
  double sum = 0;
  for (const AirglowLayer& layer : airglow_layers(130))
    for (const GlowSpectrum::Line& line : layer.spectrum.lines)
      if (line.wavelength_um >= low && line.wavelength_um < high) sum += line.power;
  return sum;
}

// A sensor at 400 km over the equator: 1 straight down, van Rhijn's 1 / cosine slantwise, and the chord of a ring along
// the limb, 2 sqrt((R + h + t / 2)^2 - (R + h)^2) over the thickness t.
TEST(GlowShells, SlantAndLimb) {
  const double height = 87e3, thick = GlowShells::thickness(height), far = INFINITY;
  const SceneFrame frame({0, 20, 0});
  const GlowShells shells(frame, std::vector<double>{height, 270e3});
  const Vec3 from{0, 0, 400e3};
  EXPECT_NEAR(shells.share(0, from, {0, 0, -1}, far).near, 1, 1e-9);
  constexpr double kEquator = 6378137.0;
  // In the plane of the equator, where the shells are rings; angle from straight down.
  const auto seen = [&](size_t layer, double nadir, double length) {
    return shells.share(layer, from, {std::sin(nadir), 0, -std::cos(nadir)}, length);
  };
  const double slant = 0.9, sine = std::sin(slant) * (kEquator + 400e3) / (kEquator + height);
  EXPECT_NEAR(seen(0, slant, far).near, 1 / std::sqrt(1 - sine * sine), 2e-4);
  for (const double tangent : {82e3, 87e3, 60e3, 91.9e3}) {
    const double nadir = std::asin((kEquator + tangent) / (kEquator + 400e3)), r = kEquator + tangent;
    const auto half = [&](double top) { return top > r ? std::sqrt(top * top - r * r) : 0.0; };
    const double chord = half(kEquator + height + thick / 2) - half(kEquator + height - thick / 2);
    const GlowShells::Share s = seen(0, nadir, far);
    EXPECT_NEAR(s.near, chord / thick, 1e-6 * chord / thick + 1e-6) << tangent;
    EXPECT_NEAR(s.far, s.near, 1e-6 * s.near + 1e-6) << tangent;
  }
  // The limb is some 50 times as bright as the zenith, and nothing shines above it but higher layers.
  const double limb = std::asin((kEquator + height) / (kEquator + 400e3)), above = limb + 0.02;
  EXPECT_NEAR(seen(0, limb, far).near + seen(0, limb, far).far,
              2 * std::sqrt(0.5 * thick * (2 * (kEquator + height) + 0.5 * thick)) / thick, 1e-3);
  EXPECT_EQ(seen(0, above, far).near + seen(0, above, far).far, 0);
  EXPECT_GT(seen(1, above, far).near, 1);
  // Clipped by what stands before it, and behind a place below it.
  EXPECT_EQ(seen(0, 0, 300e3).near, 0);
  EXPECT_NEAR(seen(0, 0, 313e3).near, 0.5, 1e-9);
  EXPECT_NEAR(shells.share(0, {0, 0, 61e3}, {0, 0, 1}, far).far, 1, 1e-9);
  EXPECT_TRUE(shells.is_below({0, 0, 61e3}));
  EXPECT_FALSE(shells.is_below({0, 0, 59e3}));
  EXPECT_TRUE(shells.meets_earth(from, {0, 0, -1}));
  EXPECT_FALSE(shells.meets_earth(from, {std::sin(limb), 0, -std::cos(limb)}));
}

// Sums of the list (Steed & Baker 1979): 1.4 to 1.8 um 5.0236e-6 W/(m2 sr).
TEST(Airglow, LinesAddUpHoweverBinsCutThem) {
  EXPECT_NEAR(sum_of_lines(1.4, 1.8), 5.0236e-6, 1e-10);
  GlowSpectrum lines = airglow_layers(130).back().spectrum;
  ASSERT_EQ(lines.lines.size(), 210u);
  for (const double width : {0.4, 0.01, 1e-4}) {
    const auto bins = static_cast<int>(std::lround(0.4 / width));
    double sum = 0;
    for (int i = 0; i < bins; ++i) sum += lines.mean(1.4 + i * 0.4 / bins, 1.4 + (i + 1) * 0.4 / bins) * 0.4 / bins;
    EXPECT_NEAR(sum, 5.0236e-6, 1e-10) << width;
  }
  // A line on the border between two bins is in one of them.
  const GlowSpectrum one{Curve::constant(0), {{0.5577, 2}}};
  EXPECT_NEAR(one.mean(0.5576, 0.5577) * 1e-4 + one.mean(0.5577, 0.5578) * 1e-4, 2, 1e-12);
}

// Smooth bands hold their rayleighs: photons of W/um.
// The same in kilorayleigh: 51.28 from 1.4 to 1.8 um, 49.29 from 1.0 to 1.7 um, 80.93 in all.
TEST(Airglow, LinesInRayleigh) {
  const std::vector<AirglowLayer> layers = airglow_layers(130);
  const auto kilorayleigh = [&](double low, double high) {
    double sum = 0;
    for (const GlowSpectrum::Line& line : layers.back().spectrum.lines)
      if (line.wavelength_um >= low && line.wavelength_um < high)
        sum += line.power / rayleigh_radiance(1000, line.wavelength_um);
    return sum;
  };
  EXPECT_NEAR(kilorayleigh(1.4, 1.8), 51.28, 0.005);
  EXPECT_NEAR(kilorayleigh(1.0, 1.7), 49.29, 0.005);
  EXPECT_NEAR(kilorayleigh(0.5, 3), 80.93, 0.005);
}

TEST(Airglow, BandsHoldTheirPhotons) {
  const double rayleighs[] = {430, 1950, 1000, 20e3, 80e3};
  const std::vector<AirglowLayer> layers = airglow_layers(130);
  for (size_t i = 0; i < std::size(rayleighs); ++i) {
    double photons = 0;
    const int n = 200000;
    for (int k = 0; k < n; ++k) {
      const double w = 0.25 + (k + 0.5) * 2 / n;
      photons += layers[i].spectrum.smooth.at(w) / rayleigh_radiance(1, w) * 2 / n;
    }
    EXPECT_NEAR(photons / rayleighs[i], 1, 2e-3) << i;
  }
}

// 0.9 + 0.0011 (flux - 100): oxygen and the continuum follow the Sun, OH and sodium do not.
TEST(Airglow, FollowsTheSun) {
  const auto quiet = airglow_layers(70), typical = airglow_layers(130), active = airglow_layers(230);
  for (size_t i = 0; i < typical.size(); ++i) {
    const auto power = [&](const std::vector<AirglowLayer>& all) { return all[i].spectrum.mean(0.3, 2.5); };
    const bool by_sun = i < 2 || typical[i].height > 95e3;
    EXPECT_NEAR(power(active) / power(typical), by_sun ? 1.043 / 0.933 : 1, 1e-9) << i;
    EXPECT_NEAR(power(quiet) / power(typical), by_sun ? 0.867 / 0.933 : 1, 1e-9) << i;
  }
}

// Leinert et al. 1998, table 16, at nodes; pole 60, antisolar 180, ecliptic at 90 degrees 202; mirrored.
TEST(Zodiacal, NodesAreExact) {
  const auto at = [](double longitude, double latitude) {
    return zodiacal_s10(longitude * kDegree, latitude * kDegree);
  };
  const double nodes[][3] = {{0, 15, 2450}, {15, 0, 9000}, {90, 0, 202},  {180, 0, 180}, {60, 30, 143},
                             {135, 75, 57}, {45, 45, 130}, {165, 5, 150}, {77, 90, 60}};
  for (const auto& [longitude, latitude, s10] : nodes) {
    EXPECT_NEAR(at(longitude, latitude), s10, 1e-9 * s10);
    EXPECT_NEAR(at(-longitude, -latitude), s10, 1e-9 * s10);
    EXPECT_NEAR(at(360 - longitude, latitude), s10, 1e-9 * s10);
  }
  EXPECT_NEAR(at(97.5, 0), std::sqrt(202.0 * 166), 1e-9);
  // Nearer to the Sun than the table: it grows, without end of the table's values.
  EXPECT_GT(at(10, 0), 9000);
  EXPECT_GT(at(5, 0), at(10, 0));
  EXPECT_TRUE(std::isfinite(at(0, 0)));
}

// The same paper's table 17, 1e-8 W/(m2 sr um) at 500 nm, at all its nodes: table 16 times the unit of section 8.2, to
// the rounding of both tables. Rows: longitude from the Sun; latitudes 0 to 90.
TEST(Zodiacal, IsTableSeventeenAtAllNodes) {
  const double latitudes[] = {0, 5, 10, 15, 20, 25, 30, 45, 60, 75, 90},
               rows[][12] = {{0, 0, 0, 0, 3140, 1610, 985, 640, 275, 150, 100, 77},
                             {5, 0, 0, 0, 2940, 1540, 945, 625, 271, 150, 100, 77},
                             {10, 0, 0, 4740, 2470, 1370, 865, 590, 264, 148, 100, 77},
                             {15, 11500, 6780, 3440, 1860, 1110, 755, 525, 251, 146, 100, 77},
                             {20, 6400, 4480, 2410, 1410, 910, 635, 454, 237, 141, 99, 77},
                             {25, 3840, 2830, 1730, 1100, 749, 545, 410, 223, 136, 97, 77},
                             {30, 2480, 1870, 1220, 845, 615, 467, 365, 207, 131, 95, 77},
                             {35, 1650, 1270, 910, 680, 510, 397, 320, 193, 125, 93, 77},
                             {40, 1180, 940, 700, 530, 416, 338, 282, 179, 120, 92, 77},
                             {45, 910, 730, 555, 442, 356, 292, 250, 166, 116, 90, 77},
                             {60, 505, 442, 352, 292, 243, 209, 183, 134, 104, 86, 77},
                             {75, 338, 317, 269, 227, 196, 172, 151, 116, 93, 82, 77},
                             {90, 259, 251, 225, 193, 166, 147, 132, 104, 86, 79, 77},
                             {105, 212, 210, 197, 170, 150, 133, 119, 96, 82, 77, 77},
                             {120, 188, 186, 177, 154, 138, 125, 113, 90, 77, 74, 77},
                             {135, 179, 178, 166, 147, 134, 122, 110, 90, 77, 73, 77},
                             {150, 179, 178, 165, 148, 137, 127, 116, 96, 79, 72, 77},
                             {165, 196, 192, 179, 165, 151, 141, 131, 104, 82, 72, 77},
                             {180, 230, 212, 195, 178, 163, 148, 134, 105, 83, 72, 77}};
  double most = 0;
  int nodes = 0;
  for (const auto& row : rows)
    for (int c = 0; c < 11; ++c) {
      if (row[c + 1] == 0) continue;
      const double found =
          zodiacal_s10(row[0] * kDegree, latitudes[c] * kDegree) * zodiacal_spectrum().mean(0.495, 0.505);
      most = std::max(most, std::fabs(found / (row[c + 1] * 1e-8) - 1));
      ++nodes;
    }
  std::printf("table 17: %d nodes, farthest %.2f %%\n", nodes, 100 * most);
  EXPECT_EQ(nodes, 201);
  EXPECT_LT(most, 0.012);
}

// Colour over the Sun's: 1 + 0.9 log10(w / 0.5), 0.6 above 0.5 um, at elongations from 90 degrees (Leinert, eq. 22).
TEST(Zodiacal, Colour) {
  const double r = zodiacal_reddening(kPi / 2, 0);
  const auto colour = [&](double w) { return 1 + r * zodiacal_red().smooth.at(w) / zodiacal_spectrum().smooth.at(w); };
  EXPECT_NEAR(colour(0.4), 0.91278, 6e-5);
  EXPECT_NEAR(colour(0.7), 1.08768, 2e-5);
  EXPECT_NEAR(colour(1.0), 1.18062, 2e-5);
  EXPECT_NEAR(zodiacal_reddening(20 * kDegree, 0), 1.2, 1e-12);
  // 202 S10 at 0.5 um: table 17 has 259e-8 W/(m2 sr um).
  EXPECT_NEAR(202 * zodiacal_spectrum().mean(0.49, 0.51), 259e-8, 0.012 * 259e-8);
}

// Sums of 10^(-0.4 V) and counts of the catalogue by limit of V.
TEST(Stars, CatalogueSumsAndCounts) {
  const double expected[][3] = {{0, 7.8247, 4},     {1, 14.9500, 15},     {2, 22.4408, 50},
                                {3, 34.1133, 174},  {4, 46.9301, 518},    {5, 63.3879, 1630},
                                {6, 84.0612, 5080}, {6.5, 94.5593, 8404}, {99, 96.0761, 9096}};
  for (const auto& [limit, flux, count] : expected) {
    double sum = 0;
    int n = 0;
    for (const CatalogueStar& s : bright_star_catalogue())
      if (s.v <= limit + 1e-9) sum += flux_of(s.v), ++n;
    EXPECT_NEAR(sum, flux, 1e-4) << limit;
    EXPECT_EQ(n, count) << limit;
  }
}

// Ballesteros 2012: T of B-V; E(w) / E(0.55 um) of blackbodies.
TEST(Stars, TemperaturesAndSpectra) {
  EXPECT_NEAR(star_temperature(0), 10125, 1);
  EXPECT_NEAR(star_temperature(0.653), 5767, 1);
  EXPECT_NEAR(star_temperature(1.5), 3794, 1);
  const double expected[][3] = {{3500, 1.59604, 0.70106}, {5800, 0.65116, 0.11626}, {10000, 0.38639, 0.04175}};
  for (const auto& [kelvin, at_08, at_16] : expected) {
    EXPECT_NEAR(star_shape(kelvin).at(0.8), at_08, 2e-4 * at_08);
    EXPECT_NEAR(star_shape(kelvin).at(1.6), at_16, 2e-4 * at_16);
  }
}

// The mean of 47.2 / (|sin b| + 0.12) over the sphere is 1092 stars of V = 1 (105.38 S10); examples by latitude.
TEST(Stars, IntegratedStarlight) {
  const double latitudes[][2] = {{0, 393}, {20, 102}, {60, 48}, {90, 42}};
  for (const auto& [b, s10] : latitudes) EXPECT_NEAR(starlight_s10(std::sin(b * kDegree)), s10, 0.5);
  double mean = 0;
  for (int i = 0; i < 100000; ++i) mean += starlight_s10((i + 0.5) / 100000) / 100000;
  EXPECT_NEAR(mean, kAllStars / flux_of(10) * kDegree * kDegree / (4 * kPi), 0.001 * mean);
}

// W/(m2 sr um) at 0.55 um of a part towards the zenith, in S10(V).
double zenith_s10(const NightMap& map, NightPart part, double low = 0.545, double high = 0.555) {
  std::vector<double> w(map.components().size());
  map.weights({0, 0, 1}, w);
  double sum = 0;
  for (size_t i = 0; i < w.size(); ++i)
    if (map.components()[i].part == part) sum += w[i] * map.components()[i].spectrum.mean(low, high);
  return sum / s10_radiance();
}

// Zodiacal 60 to 250, airglow continuum 72, stars 50 to 400 S10: a moonless sky of 21.4 to 22.0 mag/arcsec2 at the
// zenith with the green line over the V band (0.09 um wide), which adds 67 S10.
TEST(NightMap, DarkZenith) {
  for (const char* utc : {"2026-03-20T23:00:00Z", "2026-04-20T23:00:00Z", "2026-05-12T22:00:00Z"}) {
    const NightMap map(whole_sky(), sphere_at(utc, kPlace));
    const double zodiacal = zenith_s10(map, NightPart::zodiacal), airglow = zenith_s10(map, NightPart::airglow),
                 line = sum_of_lines(0.55, 0.56) / 0.089 / s10_radiance(),
                 stars = zenith_s10(map, NightPart::starlight) + zenith_s10(map, NightPart::galactic);
    EXPECT_GT(zodiacal, 55);
    EXPECT_LT(zodiacal, 150);
    EXPECT_NEAR(airglow, 72.3, 1);
    EXPECT_NEAR(line, 67, 1);
    EXPECT_GT(stars, 35);
    EXPECT_LT(stars, 130);
    const double magnitude = magnitude_of(zodiacal + airglow + line + stars);
    std::printf("zenith, %s: zodiacal %.0f, airglow %.0f, green line %.0f, stars %.0f S10: V = %.2f\n", utc, zodiacal,
                airglow, line, stars, magnitude);
    EXPECT_GT(magnitude, 21.4) << utc;
    EXPECT_LT(magnitude, 22.0) << utc;
  }
}

// Moved by place, date and solar flux as each part's own law says.
TEST(NightMap, EachPartMovesAsItsLaw) {
  const char *spring = "2026-03-20T23:00:00Z", *summer = "2026-07-20T23:00:00Z";
  const NightMap now(whole_sky(), sphere_at(spring, kPlace)), later(whole_sky(), sphere_at(summer, kPlace));
  EXPECT_EQ(zenith_s10(now, NightPart::airglow), zenith_s10(later, NightPart::airglow));
  // The Milky Way passes overhead on summer nights, and not in spring.
  EXPECT_GT(zenith_s10(later, NightPart::starlight), 1.5 * zenith_s10(now, NightPart::starlight));
  for (const char* utc : {spring, summer}) {
    const CelestialSphere sphere = sphere_at(utc, kPlace);
    const NightMap map(whole_sky(), sphere);
    const Vec3 e = sphere.ecliptic().to_local({0, 0, 1});
    const double s10 = std::pow(sphere.sun_distance_au(), -2.3) *
                       zodiacal_s10(std::atan2(e.y, e.x) - sphere.sun_longitude(), std::asin(e.z));
    const double red = 1 + zodiacal_reddening(std::atan2(e.y, e.x) - sphere.sun_longitude(), std::asin(e.z)) * 2 / 3 *
                               std::log10(0.55 / 0.5);
    EXPECT_NEAR(zenith_s10(map, NightPart::zodiacal),
                s10 * red * zodiacal_spectrum().mean(0.545, 0.555) / s10_radiance(), 1e-3 * s10);
    // Galactic latitude of the zenith, by the pole.
    const double sine = dot(sphere.to_scene(galactic_pole()), Dir{0, 0, 1});
    EXPECT_NEAR(zenith_s10(map, NightPart::starlight), (1 - 96.0761 / kAllStars) * starlight_s10(sine),
                0.01 * starlight_s10(sine));
  }
  NightSkySpec active = whole_sky();
  active.solar_flux = 230;
  const NightMap map(active, sphere_at(spring, kPlace));
  EXPECT_NEAR(zenith_s10(map, NightPart::airglow) / zenith_s10(now, NightPart::airglow), 1.043 / 0.933, 1e-3);
  EXPECT_EQ(zenith_s10(map, NightPart::starlight), zenith_s10(now, NightPart::starlight));
}

// The catalogue's stars over two places at opposite ends of the Earth are all there are, however they are spread; none
// shines below the horizon; and with a brighter limit the unresolved part takes what the stars lose.
TEST(NightMap, StarsKeepTheirLight) {
  const CelestialSphere sphere = sphere_at("2026-03-20T23:00:00Z", kPlace);
  const NightMap map(whole_sky(), sphere);
  double spread = 0;
  for (const Geodetic& place : {kPlace, Geodetic{-kPlace.latitude_deg, kPlace.longitude_deg + 180, 0}}) {
    const NightMap half(whole_sky(), sphere_at("2026-03-20T23:00:00Z", place));
    const NightMap::Integrals whole = half.integrals();
    for (size_t i = 0; i < whole.sky.size(); ++i)
      if (half.components()[i].part == NightPart::stars) spread += whole.sky[i];
  }
  EXPECT_NEAR(spread, 96.0761, 0.01 * 96.0761);  // cells of 3 degrees, looked at every half degree
  std::vector<double> w(map.components().size(), 1);
  map.weights({0.6, 0, -0.8}, w);
  for (const double v : w) EXPECT_EQ(v, 0);
  NightSkySpec few = whole_sky();
  few.faintest = 2;
  EXPECT_NEAR(zenith_s10(NightMap(few, sphere), NightPart::starlight) / zenith_s10(map, NightPart::starlight),
              (kAllStars - 22.4408) / (kAllStars - 96.0761), 1e-4);
}

// A sky of 259 S10 lights a plane with 6.8e-4 lx: the whole is near, and by night the eye sees more.
TEST(NightMap, Illuminance) {
  const char* const utc = "2026-03-20T23:00:00Z";
  const CelestialSphere sphere = sphere_at(utc, kPlace);
  const std::vector<SeenPlanet> planets = seen_planets(sphere, julian_tt(instant_from_utc(parse_iso8601(utc))));
  const NightIlluminance lx = illuminance_of(NightMap(whole_sky(), sphere, planets));
  const double photopic = std::accumulate(lx.photopic.begin(), lx.photopic.end(), 0.0),
               scotopic = std::accumulate(lx.scotopic.begin(), lx.scotopic.end(), 0.0);
  EXPECT_GT(photopic, 5e-4);
  EXPECT_LT(photopic, 1.5e-3);
  EXPECT_GT(scotopic, photopic);
  for (size_t p = 0; p < kNightParts; ++p)
    EXPECT_GT(lx.photopic[p], p == static_cast<size_t>(NightPart::city_glow) ? -1e-5 : 1e-5) << p;
  // Catalogue stars at V = 0.55 um: a plane facing a star of V = 0 has 2.54e-6 lx (within the spectrum's width).
  const GlowSpectrum vega{star_shape(9600).scaled(kVegaIrradiance)};
  EXPECT_NEAR(vega.photopic(), 2.54e-6, 0.06 * 2.54e-6);
}

}  // namespace
}  // namespace suite::test::night_sky_test
