#include "transport/technique_switches.h"

#include <algorithm>

namespace suite {

std::span<const NamedTechnique> named_techniques() {
  static constexpr NamedTechnique kAll[] = {
      {ListedTechnique::light_sampling, "light_sampling", "next-event estimation (NEE)",
       [](PipelineOptions& o) { o.explicit_sources = false; }},
      {ListedTechnique::manifold, "manifold", "manifold next-event estimation (MNEE)",
       [](PipelineOptions& o) { o.refracted_sources = false; }},
      {ListedTechnique::volume_chains, "volume_chains", "multi-vertex volumetric NEE",
       [](PipelineOptions& o) { o.volume_chains = false; }},
      {ListedTechnique::side_vertex, "side_vertex", "splitting with a light-directed vertex",
       [](PipelineOptions& o) { o.side_flights = false; }},
      {ListedTechnique::equiangular, "equiangular", "equiangular sampling of point lamps in media",
       [](PipelineOptions& o) { o.equiangular = false; }},
      {ListedTechnique::caustic_guide, "caustic_guide", "photon-guided sampling of caustics",
       [](PipelineOptions& o) { o.gloss_photons = 0; }},
      {ListedTechnique::adjacency, "adjacency", "residual estimator over the 1-D field of real air", nullptr},
  };
  return kAll;
}

const char* name_of(ListedTechnique technique) { return named_techniques()[static_cast<size_t>(technique)].name; }

const NamedTechnique* technique_of(const std::string& name) {
  const auto all = named_techniques();
  const auto found = std::ranges::find_if(all, [&](const NamedTechnique& t) { return t.name == name; });
  return found == all.end() ? nullptr : &*found;
}

std::string names_of_switches() {
  std::string all;
  for (const NamedTechnique& t : named_techniques())
    if (t.off) all += (all.empty() ? "" : ", ") + std::string(t.name);
  return all;
}

}  // namespace suite
