// Techniques of light transport by name: the one list of their names. `techniques` of a simulation text,
// `--explain`, the list of parts and the table of conditions (scheduler/techniques.h) use these words.
//
// A study may switch those that have a switch off, to see what they are worth (ablation): pictures stay the same in the
// mean, their noise does not. What light a technique would bring is then found by what is left, by chance in the end;
// where chance hardly finds it, that is reported (DR207).
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "transport/options.h"

namespace suite {

enum class ListedTechnique : uint8_t {
  light_sampling,  // next-event estimation (NEE)
  manifold,        // of lights behind smooth interfaces (MNEE)
  volume_chains,   // of lights behind media under smooth interfaces (multi-vertex NEE)
  side_vertex,     // splitting with a light-directed scattering vertex
  equiangular,     // vertices near lamps in media
  caustic_guide,   // photon-guided sampling of caustics
  adjacency,       // residual estimator over a 1-D field of air
};

struct NamedTechnique {
  ListedTechnique technique;
  const char* name;                       // of texts and options: the enumerator's
  const char* term;                       // the field's
  void (*off)(PipelineOptions& options);  // null: no switch here, the key of a light or of the air decides
};

// All of them, in the order of the enumeration.
std::span<const NamedTechnique> named_techniques();
const char* name_of(ListedTechnique technique);
// The one of a name; null for a name that is none.
const NamedTechnique* technique_of(const std::string& name);
// The names of those that have a switch, for messages: "a, b, c".
std::string names_of_switches();

}  // namespace suite
