// Techniques of light transport and the conditions under which they are used: one table. The list of parts before a run
// and in `--dry-run`, `--explain`, and the diagnostics read it; a test holds the kernels to it
// (tests/physics/scheduler/techniques_test.cpp).
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "light/environment.h"
#include "scene/scene.h"
#include "surface/optics.h"
#include "transport/options.h"
#include "transport/technique_switches.h"

namespace suite {

// What the conditions look at.
struct TechniqueFacts {
  PipelineOptions options;
  bool small_lights = false;  // sun, moon or lamps: what continuations hardly find
  bool sized_lights = false;  // of them such as have a size, so that continuations may meet them
  bool beams = false;         // sun or moon
  size_t laser_radars = 0;    // whose paths look for their other end
  size_t points = 0;          // lamps that are points
  size_t media = 0;
  bool even_media = false;                      // media of the scene, and no traced air
  size_t smooth = 0, not_matte = 0, rough = 0;  // materials: Dirac refraction; not Lambertian; these with wide lobes
  bool real_air = false, field = false, adjacency = false;  // of the air: a profile, a diffuse field, adjacency wanted
};
// Of the scene as it was loaded.
TechniqueFacts technique_facts(const Scene& scene, const SourceSpecs& sources, const PipelineOptions& options,
                               size_t laser_radars = 0);
// The same, without laser radars, with its materials as they were baked for a spectral state.
TechniqueFacts technique_facts(const Scene& scene, const SourceSpecs& sources, const PipelineOptions& options,
                               const Optics& optics);

struct TechniqueCondition {
  bool (*holds)(const TechniqueFacts& facts);
  const char* needs;      // "a sun, a moon or a lamp"
  const char* otherwise;  // why it is not used: "no sun, moon or lamp in the simulation"
};
struct TechniqueRow {
  ListedTechnique technique;  // whose name is that of the list of parts
  const char* text;           // what it does
  std::span<const TechniqueCondition> conditions;
};

// Those that have conditions, in the order of the enumeration: all but light_sampling, which every light decides for
// itself.
std::span<const TechniqueRow> technique_rows();
// Bug for one without conditions.
const TechniqueRow& technique_row(ListedTechnique technique);
// The first condition that does not hold; null when the technique is used.
const TechniqueCondition* unmet(const TechniqueRow& row, const TechniqueFacts& facts);
inline bool uses(ListedTechnique technique, const TechniqueFacts& facts) {
  return !unmet(technique_row(technique), facts);
}
// What a technique does, what it needs and how it is switched off; nothing for a name that is none.
std::optional<std::string> explain_technique(const std::string& name);

}  // namespace suite
