#include "transport/technique_switches.h"

namespace suite {

std::span<const TechniqueSwitch> technique_switches() {
  static constexpr TechniqueSwitch kAll[] = {
      {"light_sampling", [](PipelineOptions& o) { o.explicit_sources = false; }},
      {"manifold", [](PipelineOptions& o) { o.refracted_sources = false; }},
      {"volume_chains", [](PipelineOptions& o) { o.volume_chains = false; }},
      {"side_vertex", [](PipelineOptions& o) { o.side_flights = false; }},
      {"equiangular", [](PipelineOptions& o) { o.equiangular = false; }},
      {"caustic_guide", [](PipelineOptions& o) { o.gloss_photons = 0; }},
  };
  return kAll;
}

std::string names_of_techniques() {
  std::string all;
  for (const TechniqueSwitch& s : technique_switches()) all += (all.empty() ? "" : ", ") + std::string(s.name);
  return all;
}

}  // namespace suite
