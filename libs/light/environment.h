// Everything that shines on a scene and what lies around it: as it was asked for (SourceSpecs) and baked for a spectral
// state (Environment).
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "air/air_spec.h"
#include "air/column.h"
#include "light/atmosphere.h"
#include "light/earth.h"
#include "light/light_spec.h"
#include "light/tabled_air.h"

namespace suite {

// Sources before they are baked for a state. Dates are those of second 0; what has one goes on with time.
struct SourceSpecs {
  std::vector<LightSpecPtr> lights = {};  // the index is a light's identity, in the environment as well
  // Air: quick layers in closed form, real air (air_spec.h), or tables of other programs; at most one of them.
  std::optional<AtmosphereSpec> atmosphere = {};
  std::shared_ptr<const AirSpec> air = {};
  std::shared_ptr<const TabledAirSpec> tabled = {};
  std::optional<EarthSpec> earth = {};
  double dut1 = 0;  // s, UT1 - UTC, -0.9..0.9

  // Adds lights; those that can be one with others become so (LightSpec::joined).
  void add(std::vector<LightSpecPtr> more);
  // What one kind is made of, from the header of the kind, which has a make_light for it.
  template <class Spec>
  void add(Spec spec) {
    add(std::vector<LightSpecPtr>{make_light(std::move(spec))});
  }
  // The first sun; null = none.
  LightSpecPtr sun() const;
  bool any() const { return !lights.empty() || has_air(); }
  bool has_air() const { return atmosphere || air || tabled; }
  Where where_air() const {
    return air ? air->where : tabled ? tabled->where : atmosphere ? atmosphere->where : Where{};
  }
  // Of the first light that follows from one; null = none does. Dates are all that of second 0.
  const SourceTime* date() const;
  // Something is another one at every moment.
  bool dated() const { return date() != nullptr; }
};

inline constexpr size_t kNoLight = static_cast<size_t>(-1);

// Lights that nothing else changes may be shared by environments of several moments.
struct Environment {
  std::vector<std::shared_ptr<const Light>> lights;  // as asked for; the index is a light's identity
  size_t sun = kNoLight;                             // index of the light that truth calls the sun, if any
  std::vector<LightSpecPtr> specs;                   // what each was baked from
  // Null = none.
  std::shared_ptr<const Atmosphere> atmosphere;
  std::shared_ptr<const AirColumn> column;  // of real air: what no moment changes
  std::shared_ptr<const Earth> earth;

  // Of the sun.
  std::optional<Dir> towards_sun() const {
    if (sun == kNoLight) return std::nullopt;
    return lights[sun]->beam()->direction;
  }
};

// Computes what follows from dates, phases and models: directions, sizes, distances and spectra of Sun and Moon, clear
// skies, `seconds` after the dates; and where real air lies over the scene. Returns a sentence about each body. What is
// resolved already stays. Error: as LightSpec::resolved and settle; a sun below the horizon of flat real air.
std::vector<std::string> resolve_sources(SourceSpecs& specs, const Scene& scene, double seconds = 0);

// Bakes resolved sources. periodic: the scene repeats itself. Error: as the sources' constructors; unknown material of
// the Earth, or one that bounds a medium; an Earth in a periodic scene.
Environment bake_environment(const SourceSpecs& specs, const Tracer& tracer, bool periodic, const SpectralState& state);

// Brings an environment to another moment: bakes the lights that are no longer what they were baked from, and the air
// when one of them was, and leaves the rest alone. now: the same sources, resolved for the moment. The result is the
// same as that of bake_environment(now, ...).
void rebake_changed(Environment& environment, const SourceSpecs& now, const Tracer& tracer, const SpectralState& state);

// Index of the Earth's material. Error when the scene has none of that name.
uint32_t earth_material(const EarthSpec& spec, const Scene& scene);

}  // namespace suite
