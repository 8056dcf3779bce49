// Everything that shines on a scene and what lies around it: as it was asked for (SourceSpecs) and baked for a spectral
// state (Environment).
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "radiometry/sources/atmosphere.h"
#include "radiometry/sources/clear_sky.h"
#include "radiometry/sources/earth.h"
#include "radiometry/sources/lamps.h"
#include "radiometry/sources/moon.h"
#include "radiometry/sources/source.h"

namespace suite {

struct MoonSpec {
  SunSpec disk;           // irradiance: taken as given unless by_phase
  bool by_phase = true;   // irradiance from the phase, the distances and the Sun's spectrum at 1 AU
  MoonGeometry geometry;  // filled from the date when disk.time is given
};

// Sources before they are baked for a state. Plain ones may be baked at once; dates and clear skies are turned into
// directions, spectra and tables by resolve_sources. Dates are those of second 0; bodies that have one go on with time.
struct SourceSpecs {
  std::optional<SunSpec> sun = {};
  std::optional<SkySpec> sky = {};
  std::optional<MoonSpec> moon = {};
  std::optional<ClearSkySpec> clear =
      {};  // instead of `sky`: sky and direct beam from the sun's irradiance above the air
  std::vector<LampSpec> lamps = {};
  std::optional<AtmosphereSpec> atmosphere = {};
  std::optional<EarthSpec> earth = {};
  double dut1 = 0;  // s, UT1 - UTC, -0.9..0.9
  bool any() const { return sun || sky || moon || clear || !lamps.empty() || atmosphere; }
  // Something follows from a date, so that it is another one at every moment.
  bool dated() const { return (sun && sun->time) || (moon && moon->disk.time); }
};

// Null = none. The sky is black where there is none.
struct Environment {
  std::shared_ptr<const Sun> sun, moon;
  std::shared_ptr<const Sky> sky;
  std::shared_ptr<const Lamps> lamps;
  std::shared_ptr<const Atmosphere> atmosphere;
  std::shared_ptr<const Earth> earth;
};

// Computes what follows from dates, phases and models: directions, sizes, distances and spectra of Sun and Moon, clear
// skies, `seconds` after the dates. Returns a sentence about each body. What is resolved already stays. Error: a date
// without a geodetic origin of the scene; a clear sky without a sun, beside a sky or beside an atmosphere (it stands
// for both), or with the sun below the horizon.
std::vector<std::string> resolve_sources(SourceSpecs& specs, const Scene& scene, double seconds = 0);

// Bakes resolved sources. periodic: the scene repeats itself. Error: as the sources' constructors; unknown material of
// the Earth, or one that bounds a medium; an Earth in a periodic scene.
Environment bake_environment(const SourceSpecs& specs, const Tracer& tracer, bool periodic, const SpectralState& state);

// Puts what dates move (Sun, Moon, a clear sky, the beams of the air) into an environment that was baked for another
// moment, and leaves the rest (lamps, other skies, the Earth) alone. written: the sources before they were resolved;
// now: resolved for the moment. The result is the same as that of bake_environment(now, ...).
void rebake_dated(Environment& environment, const SourceSpecs& written, const SourceSpecs& now,
                  const SpectralState& state);

// Index of the Earth's material. Error when the scene has none of that name.
uint32_t earth_material(const EarthSpec& spec, const Scene& scene);

}  // namespace suite
