// What a path finds on its way, and who takes it.
//
// A path runs from the sensor towards the light. Whenever it gets light (an explicit sample of a light arrives, a light
// is met by chance, matter or air emits) it makes a contribution: the throughput from the sensor up to there, times a
// factor (the scattering towards the light, what is left of it on its way), times the light's radiance. The kernel
// hands the contributions of a stage to a sink as one array; the throughput stays where it is (throughput.h) and does
// not contain the factor or the radiance.
#pragma once
#include <cstdint>
#include <limits>
#include <span>

#include "math/mueller.h"
#include "math/vec.h"

namespace suite {

// A number times a spectrum; null = ones. One value per bin.
struct Factor {
  float scale = 1;
  const float* spectrum = nullptr;
};

// What an event does to polarised light, where polarisation is carried: Mueller matrices over their m11, between the
// meridian frames of both directions of travel in the world, one for all bins or one a bin; and the share of the light
// whose matrix is not known and counts as depolarised.
struct PolarisedEvent {
  std::span<const Mueller> matrices;
  float unknown = 0;
};

// An event of a path, for algebras that must know more of it than a number for each wavelength.
struct Event {
  Dir out, in;        // ENU, away from the place: towards the sensor, towards the light
  uint32_t material;  // index into Scene::materials; kNone = the receiver, or scattered in a medium
  bool medium, dirac;
  const PolarisedEvent* polarised = nullptr;  // null: not carried
};

// Light that comes from no entry of Environment::lights.
inline constexpr uint16_t kFromMatter = 0xffff;  // emission of surfaces and media
inline constexpr uint16_t kFromAir = 0xfffe;     // path radiance of the air

// What happened to the light between its source and the sensor.
enum EventKind : uint8_t { by_surface = 1, by_medium = 2, by_dirac = 4 };

// What a line of sight has come to since it left the sensor, as far as water tells it apart. Water: whatever is
// looked into through a refracting surface (models `dielectric` and `ggx_dielectric`), and the model `sea`.
enum class WaterSeen : uint8_t {
  nothing,   // yet; or nobody asks (KernelContext::waters)
  mirrored,  // reflected by surfaces of water, from outside, and met nothing else
  air,       // so, and then scattered in what fills space above
  entered,   // went into water, whatever it met there
  other,     // anything else came first
};

struct Contribution {
  uint32_t path = 0;                     // lane of the kernel
  uint32_t order = 0;                    // scattering events between the light and the sensor
  uint32_t smooth = 0;                   // of them those at smooth surfaces, which only turn light
  uint16_t light = kFromMatter;          // index into Environment::lights, or kFromMatter, kFromAir
  uint8_t events = 0;                    // kinds of events on the way, a set of EventKind
  bool asked = false;                    // an explicit sample; else met by chance
  bool beam = false;                     // of the sun's or the moon's disk
  WaterSeen water = WaterSeen::nothing;  // on the way to the light; `mirrored` for lights outside the scene only
  float scale = 1;                       // shares and densities (shares.h); may be negative where a sink allows it
  Factor factor;                         // stays valid while the sink runs
  const float* radiance = nullptr;  // of the light, per bin, W/(m2 sr um) (times what its density lacks); null = ones
  double arrival = 0;               // m, from the light to the sensor: way times group index of the matter around
  // Light that is known of, but did not arrive (lost_light.h): the chance that a continuation would have met it.
  // Infinite where light arrived.
  float missed = std::numeric_limits<float>::infinity();
  // Where polarisation is carried: of the scattering towards the light; null = none. And the
  // share of the light of which it is not known whether it is polarised.
  const PolarisedEvent* polarised = nullptr;
  float unknown = 0;
  // The Stokes vector of the light, over its intensity, in the meridian frame of the way on which it left its source;
  // null = unpolarised.
  const Stokes* source = nullptr;
  bool arrived() const { return missed == std::numeric_limits<float>::infinity(); }
};

// Takes contributions. Throughputs: the algebra of the kernel.
template <class Throughputs>
class Sink {
 public:
  virtual ~Sink() = default;
  // All contributions of a stage, or a part of them; throughputs stand where the contributions were made.
  virtual void add(std::span<const Contribution> stage, Throughputs& throughputs) = 0;
};

}  // namespace suite
