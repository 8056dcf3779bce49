// Techniques that a study may switch off, to see what they are worth (ablation): pictures stay the same in the mean,
// their noise does not. What light a technique would bring is then found by what is left, by chance in the end; where
// chance hardly finds it, that is reported (DR207).
#pragma once
#include <span>
#include <string>

#include "transport/options.h"

namespace suite {

struct TechniqueSwitch {
  const char* name;
  void (*off)(PipelineOptions& options);
};
std::span<const TechniqueSwitch> technique_switches();
// Their names, for messages: "a, b, c".
std::string names_of_techniques();

}  // namespace suite
