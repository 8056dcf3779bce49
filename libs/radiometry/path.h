// A path is a complete record of what happened to one sensor ray: nodes (scattering events) joined by segments, with
// everything a processor needs to propagate radiance, or later polarisation or arrival times, along it.
//
// Based on: Goodenough & Brown, section IV-A and IV-B.
#pragma once
#include <array>
#include <cstdint>
#include <limits>

#include "surface/surface.h"

namespace suite {

// The explicit sources that a node may ask, one sample a slot.
// Of the lamps, the first node may ask several.
inline constexpr int kLampDraws = 4;
enum LightSlot : uint8_t { light_sun, light_moon, light_sky, light_lamp, light_slots = light_lamp + kLampDraws };

// Light that a node receives straight from an explicit source.
struct ExplicitLight {
  Dir direction;
  double density = 0;               // of having drawn this direction from the source, 1/sr; 0 = collimated
  float radiance_scale = 0;         // relative radiance of the source in this direction
  const float* spectrum = nullptr;  // null = the sky's, whose shape changes with wavelength
  // What arrives, when the scattering factors into a number and a spectrum: scale * spectrum[k] * scatter[k].
  const float* scatter = nullptr;
  float scale = 0;
  double distance = std::numeric_limits<double>::infinity();  // m to the source
};

struct Node {
  Hit hit;  // object kNone: the Earth under the scene
  Interaction at;
  Dir out;                     // back along the segment, ENU
  double optical_length = 0;   // m from the sensor, sum of segment lengths
  bool sunlit = false;         // the explicit sample of the sun arrived
  bool has_direct = false;     // explicit light that did not factor stands in the wave's store
  bool has_missed = false;     // light that did not arrive, but is known of, stands in the wave's store (lost_light.h)
  double spectral_factor = 1;  // c: 1 / sum over knots of P_k r_k of the prefix that leads here (1 with one knot)
  // Bit s is set when light[s] arrived and its scattering factored; the other entries hold nothing.
  uint8_t lights = 0;
  std::array<ExplicitLight, light_slots> light;
  // A glowing surface: its radiance towards the path, per bin, and the factor it counts with. Null = does not glow.
  const float* glow = nullptr;
  double glow_factor = 0;
  // The continuation. w / (density of having drawn it) is bounce_scale * bounce_spectrum[k].
  const float* bounce_spectrum = nullptr;
  float bounce_scale = 0;
  Dir in;
  int lobe = 0;
  bool delta = false, continues = false;
  double density = 0;  // at the path's own knot, roulette included; of Dirac lobes the probability
};

enum class PathEnd : uint8_t { escaped, absorbed, roulette, max_nodes };

// The nodes of a path stand in its wave (wave.h), next to their spectra.
struct Path {
  Ray ray;            // the sensor's
  double weight = 1;  // the sensor's
  int knot = 0;       // the knot whose shapes drew this path
  PathEnd end = PathEnd::absorbed;
  Dir escape;                // direction in which it left the scene
  double escape_factor = 1;  // spectral factor of the whole path
  double sun_factor = 0;     // the same when the Sun was met by chance, shared with explicit sampling
  double moon_factor = 0;
  double sky_factor = 0;
  double truncated = 0;  // throughput at the reference that was cut at the maximum number of nodes
  // Of light that is known to have been missed, the least chance of having met it; infinite when there is none.
  double missed_chance = std::numeric_limits<double>::infinity();
  int size = 0;                  // nodes
  bool received = false;         // node 0 is the sensor's own receiver (receiver.h), no surface
  bool scattered_first = false;  // a medium scattered it before it met anything
  bool missed() const { return missed_chance < std::numeric_limits<double>::infinity(); }
  int first_met() const { return received ? 1 : 0; }  // number of the node of the first surface

  // Member by member: a temporary would be cleared and copied for every path.
  void begin(const Ray& from, double sensor_weight) {
    ray = from;
    weight = sensor_weight;
    knot = size = 0;
    end = PathEnd::absorbed;
    escape_factor = 1;
    sun_factor = moon_factor = sky_factor = truncated = 0;
    missed_chance = std::numeric_limits<double>::infinity();
    received = scattered_first = false;
  }
};

}  // namespace suite
