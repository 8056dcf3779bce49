// The spectra whose products make up what a sensor can see of a scene: what shines, and what it is multiplied by on the
// way (reflectances, transmittances, emissivities).
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "light/environment.h"
#include "sensor/sensor.h"

namespace suite {

// What a spectrum does in products.
enum class SpectrumRole : uint8_t {
  light,     // shines
  glow,      // blackbody radiance
  emitting,  // an emissivity: multiplies what glows, once
  scatters,  // multiplies light, again and again
  passes,    // a transmittance: multiplies light
  part,      // multiplies light once: the piece of a reflectance that a channel of a map stands for
};

// Spectra that are made together. Each is >= 0 and constant factors do not matter.
struct SeenSpectra {
  SpectrumRole role;
  std::vector<std::string> names;  // "the sun", "reflectance of asphalt"
  // Means over the bins of a state, one row a name.
  std::function<std::vector<std::vector<float>>(const SpectralState&)> over;
  // Of lights that gases have absorbed on their way: the same without gases, to which errors of what is left are held.
  std::function<std::vector<std::vector<float>>(const SpectralState&)> unabsorbed = nullptr;
};

// Kelvin that the balance of heat found for surfaces that wait for it.
struct FoundHeat {
  double hottest = 0;  // 0: not found (yet)
};

// K: what simulated surfaces are taken to stay below until more is known of them.
inline constexpr double kSimulatedBelow = 400;

// Of a scene under some sources (resolved; several when they change with time) for the bands of one state. Only what
// changes with wavelength: constants are left out. Keeps references to scene and sources. What stands in for the rest:
// models whose curves enter in another way than as a factor, and phase functions, are asked at a few directions at 200
// wavelengths; of tabulated skies and of spectral maps some places are taken; media and atmospheres are taken at some
// depths and along some paths; temperatures that are simulated, at some from 200 to 400 K, and on to what a surface's
// own loads can hold it at and to what was found.
std::vector<SeenSpectra> spectra_of(const Scene& scene, std::span<const SourceSpecs> sources,
                                    std::span<const Band> bands, FoundHeat heat = {});

}  // namespace suite
