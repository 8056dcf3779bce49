#include "light/night/night_map.h"

#include <algorithm>
#include <cmath>

#include "light/night/zodiacal.h"
#include "math/quick_angle.h"

namespace suite {

namespace {

constexpr double kTemperatures[] = {2500, 3500, 4500, 5500, 7000, 10000, 20000};  // K, of the colours
constexpr size_t kRows = 45, kColumns = 90;                                       // cells, of equal solid angle
constexpr double kCell = 4 * kPi / (kRows * kColumns);                            // sr
constexpr double kGalactic = 0.2, kExtragalactic = 1.5;                           // of starlight; S10

// Shares of two neighbouring colours, linear in 1 / T.
std::pair<size_t, double> between(double kelvin) {
  constexpr size_t kLast = std::size(kTemperatures) - 1;
  const double t = std::clamp(kelvin, kTemperatures[0], kTemperatures[kLast]);
  size_t i = 0;
  while (i + 2 <= kLast && kTemperatures[i + 1] <= t) ++i;
  const double low = 1 / kTemperatures[i], high = 1 / kTemperatures[i + 1];
  return {i, (1 / t - low) / (high - low)};
}

}  // namespace

std::string name_of(NightPart part) {
  constexpr const char* kNames[] = {"zodiacal", "airglow", "starlight", "galactic", "stars", "planets", "city_glow"};
  static_assert(std::size(kNames) == kNightParts);
  return kNames[static_cast<size_t>(part)];
}

std::vector<SeenPlanet> seen_planets(const CelestialSphere& sphere, JulianDate tt) {
  std::vector<SeenPlanet> all;
  const double year = 2000 + (tt.day + tt.fraction - 2451545) / 365.25;
  for (size_t i = 0; i < kPlanets; ++i) {
    const auto planet = static_cast<Planet>(i);
    const PlanetPlace place = planet_place(planet, sphere, tt);
    all.push_back({planet, place.place, planet_magnitude(planet, view_of(planet, place, year))});
  }
  return all;
}

NightMap::NightMap(const NightSkySpec& spec, const CelestialSphere& sphere, std::span<const SeenPlanet> planets)
    : sphere_(sphere), galactic_pole_(sphere.to_scene(galactic_pole())) {
  const auto scale = [&](NightPart p) { return spec.scale[static_cast<size_t>(p)]; };
  const auto add = [&](NightPart part, const GlowSpectrum& spectrum, double of_part) {
    components_.push_back({part, spectrum.scaled(of_part)});
  };
  first_.zodiacal = components_.size();
  if (const double s = scale(NightPart::zodiacal); s > 0) {
    // Dust is the denser the nearer to the Sun.
    zodiacal_scale_ = std::pow(sphere.sun_distance_au(), -2.3);
    add(NightPart::zodiacal, zodiacal_spectrum(), s);
    add(NightPart::zodiacal, zodiacal_red(), s);
  }
  first_.airglow = components_.size();
  if (const double s = scale(NightPart::airglow); s > 0)
    for (const AirglowLayer& layer : airglow_layers(spec.solar_flux)) {
      heights_.push_back(layer.height);
      add(NightPart::airglow, layer.spectrum, s);
    }
  first_.starlight = components_.size();
  const GlowSpectrum s10{star_shape(star_temperature(kStarlightColour)).scaled(s10_radiance())};
  if (const double s = scale(NightPart::starlight); s > 0) add(NightPart::starlight, s10, s);
  first_.galactic = components_.size();
  if (const double s = scale(NightPart::galactic); s > 0) add(NightPart::galactic, s10, s);
  first_.glow = components_.size();
  if (const double s = scale(NightPart::city_glow); s > 0)
    for (const CityGlow& glow : spec.glows) {
      glows_.push_back(glow);
      add(NightPart::city_glow, {glow.horizon}, s);
    }
  first_.stars = components_.size();
  if (spec.catalogue) add_stars(spec, sphere);
  first_.planets = components_.size();
  if (const double s = scale(NightPart::planets); s > 0) add_planets(s, planets);
}

void NightMap::add_planets(double scale, std::span<const SeenPlanet> planets) {
  for (const SeenPlanet& p : planets) {
    const Dir d = sphere_.to_celestial(sphere_.without_air(p.place));
    planets_.push_back({cell_of(d), flux_of(p.v) / kCell});
    components_.push_back({NightPart::planets, {planet_shape(p.planet).scaled(kVegaIrradiance * scale)}});
  }
}

void NightMap::add_stars(const NightSkySpec& spec, const CelestialSphere& sphere) {
  const double s = spec.scale[static_cast<size_t>(NightPart::stars)];
  double sum = 0;
  if (s > 0) cells_.resize(kRows * kColumns);
  for (const CatalogueStar& star : *spec.catalogue) {
    if (star.v > spec.faintest) continue;
    const double flux = flux_of(star.v);
    sum += flux;
    if (!(s > 0)) continue;
    const auto [i, t] = between(star.kelvin);
    auto& cell = cells_[cell_of(sphere.to_celestial(sphere.without_air(star.place)))];
    cell[i] += static_cast<float>((1 - t) * flux / kCell);
    cell[i + 1] += static_cast<float>(t * flux / kCell);
  }
  unresolved_ = std::max(0.0, 1 - sum / kAllStars);
  if (s > 0)
    for (const double kelvin : kTemperatures)
      components_.push_back({NightPart::stars, {star_shape(kelvin).scaled(kVegaIrradiance * s)}});
}

size_t NightMap::cell_of(Dir d) const {
  const auto row = static_cast<size_t>(std::clamp(0.5 * (1 + d.z), 0.0, 1.0) * kRows);
  double turn = quick_azimuth(d) / (2 * kPi);
  turn -= std::floor(turn);
  return std::min(row, kRows - 1) * kColumns + std::min(kColumns - 1, static_cast<size_t>(turn * kColumns));
}

void NightMap::weights(Dir d, std::span<double> w) const {
  if (d.z < 0) {
    std::fill(w.begin(), w.end(), 0.0);
    return;
  }
  weights_beyond(d, w);
  const double sine = std::sqrt(std::max(0.0, 1 - d.z * d.z));
  for (size_t i = 0; i < heights_.size(); ++i)
    w[first_.airglow + i] =
        i > 0 && heights_[i] == heights_[i - 1] ? w[first_.airglow + i - 1] : van_rhijn(sine, heights_[i]);
  for (size_t i = 0; i < glows_.size(); ++i) w[first_.glow + i] = relative_glow(glows_[i], d);
}

void NightMap::weights_beyond(Dir d, std::span<double> w) const {
  std::fill(w.begin(), w.end(), 0.0);
  if (first_.airglow > first_.zodiacal) {
    const Vec3 e = sphere_.ecliptic().to_local(d);
    const double longitude = std::atan2(e.y, e.x) - sphere_.sun_longitude(),
                 latitude = std::asin(std::clamp(e.z, -1.0, 1.0));
    w[0] = zodiacal_scale_ * zodiacal_s10(longitude, latitude);
    w[1] = w[0] * zodiacal_reddening(longitude, latitude);
  }
  const double stars = starlight_s10(dot(d, galactic_pole_));
  if (first_.galactic > first_.starlight) w[first_.starlight] = unresolved_ * stars;
  if (first_.glow > first_.galactic) w[first_.galactic] = kGalactic * stars + kExtragalactic;
  if (cells_.empty() && planets_.empty()) return;
  const size_t at = cell_of(sphere_.to_celestial(d));
  if (!cells_.empty())
    std::copy(cells_[at].begin(), cells_[at].end(), w.begin() + static_cast<ptrdiff_t>(first_.stars));
  for (size_t i = 0; i < planets_.size(); ++i) w[first_.planets + i] = planets_[i].cell == at ? planets_[i].weight : 0;
}

NightMap::Integrals NightMap::integrals() const {
  constexpr size_t kRings = 180, kSectors = 360;
  const size_t n = components_.size();
  Integrals sums{std::vector<double>(n, 0.0), std::vector<double>(n, 0.0)};
  std::vector<double> w(n);
  // Midpoints of rings of even angle: van Rhijn's horizon is finite.
  for (size_t r = 0; r < kRings; ++r) {
    const double theta = (static_cast<double>(r) + 0.5) / kRings * kPi / 2,
                 patch = std::sin(theta) * (kPi / 2 / kRings) * (2 * kPi / kSectors);
    for (size_t c = 0; c < kSectors; ++c) {
      weights(dir_from_angles(theta, (static_cast<double>(c) + 0.5) * 2 * kPi / kSectors), w);
      for (size_t i = 0; i < n; ++i) sums.sky[i] += patch * w[i], sums.plane[i] += patch * std::cos(theta) * w[i];
    }
  }
  return sums;
}

}  // namespace suite
