// The natural night sky over a place at an instant: which parts shine where, and with which spectra. A direction's
// radiance is the sum of weights, which depend on direction alone, times spectra, which do not.
//
// Assumes: seen from the ground, so that nothing shines below the horizon, and the layers of airglow lie above.
// Catalogue stars and planets are spread over cells of the sky of about 10 square degrees: right for surfaces, not for
// pictures of the sky.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "light/night/airglow.h"
#include "light/night/city_glow.h"
#include "light/night/planets.h"
#include "light/night/stars.h"
#include "motion/celestial.h"

namespace suite {

enum class NightPart : uint8_t {
  zodiacal,   // sunlight on dust
  airglow,    // of the upper air
  starlight,  // of stars that the catalogue does not hold
  galactic,   // starlight scattered by dust between the stars, and galaxies
  stars,      // of the catalogue
  planets,    // Mercury to Neptune
  city_glow,  // of far cities
};
inline constexpr size_t kNightParts = 7;
std::string name_of(NightPart part);

struct NightSkySpec {
  std::array<double, kNightParts> scale{1, 1, 1, 1, 1, 1, 1};        // of the parts; 0 = it is left out
  std::shared_ptr<const std::vector<CatalogueStar>> catalogue = {};  // null = none
  std::vector<CityGlow> glows = {};
  double faintest = 8;      // V: fainter stars of it are not used
  double solar_flux = 130;  // sfu
};

// A planet at the moment.
struct SeenPlanet {
  Planet planet;
  CatalogPlace place;
  double v = 0;  // magnitude, above the air
};
std::vector<SeenPlanet> seen_planets(const CelestialSphere& sphere, JulianDate tt);

class NightMap {
 public:
  // planets: of the moment of the sphere.
  NightMap(const NightSkySpec& spec, const CelestialSphere& sphere, std::span<const SeenPlanet> planets = {});

  // Of what cells hold, stars and planets; as many as components() where there are none.
  size_t first_point() const { return first_.stars; }
  // One thing that shines with one spectrum.
  struct Component {
    NightPart part;
    GlowSpectrum spectrum;  // W/(m2 sr um) for a weight of 1
  };
  const std::vector<Component>& components() const { return components_; }
  // Of each component, >= 0 but for the reddening of zodiacal light. direction: unit, scene ENU; weights: as many as
  // components. All 0 below the horizon.
  void weights(Dir direction, std::span<double> weights) const;
  // The same from above the air, in any direction, of what lies beyond it: 0 of airglow and city glow.
  void weights_beyond(Dir direction, std::span<double> weights) const;
  // m, of the layers of airglow, whose components follow each other from first_layer() on.
  std::span<const double> layers() const { return heights_; }
  size_t first_layer() const { return first_.airglow; }
  // Integrals of the weights over the upper hemisphere, sr, times the cosine or not.
  struct Integrals {
    std::vector<double> sky, plane;
  };
  Integrals integrals() const;

 private:
  void add_stars(const NightSkySpec& spec, const CelestialSphere& sphere);
  void add_planets(double scale, std::span<const SeenPlanet> planets);
  size_t cell_of(Dir celestial) const;

  static constexpr size_t kColours = 7;
  // Where the components of a part begin; as many as components() where there are none.
  struct First {
    size_t zodiacal, airglow, starlight, galactic, glow, stars, planets;
  };
  CelestialSphere sphere_;
  double zodiacal_scale_ = 0;
  std::vector<CityGlow> glows_;
  Dir galactic_pole_;  // scene ENU
  std::vector<Component> components_;
  First first_{};
  std::vector<double> heights_;                     // m, of the layers
  double unresolved_ = 1;                           // share of starlight that the catalogue does not hold
  std::vector<std::array<float, kColours>> cells_;  // 1/sr, stars of V = 0 of each colour
  struct Lit {
    size_t cell;
    double weight;  // 1/sr, stars of V = 0
  };
  std::vector<Lit> planets_;
};

}  // namespace suite
