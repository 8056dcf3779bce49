// What a user chooses of how light is estimated.
#pragma once
#include <cstdint>

#include "light/light.h"

namespace suite {

// When a problem stops taking samples.
enum class StopRule : uint8_t {
  plan,    // at the count that was planned for it beforehand: unbiased
  change,  // the paper's: when one more sample changes the running mean at the reference band by less than a threshold.
           // It looks at the samples that it keeps and is biased low where rare events carry the light.
};

// How light is estimated.
enum class Method : uint8_t {
  standard,  // estimators/standard.h
  paper,     // estimators/paper.h: Goodenough & Brown as written, for comparison
};

// Where the paper's estimator, which knows no other end of paths, cuts them when max_nodes is 0.
inline constexpr int kPaperNodes = 16;

struct PipelineOptions {
  uint64_t seed = 1;
  // Most nodes of a path: consecutive scattering events at surfaces; 0 = no limit, paths end by chance (shares.h).
  int max_nodes = 0;
  uint32_t max_scatterings = 0;   // the same inside media, beside the nodes
  int roulette_after = 3;         // events before paths may end by chance
  bool explicit_sources = true;   // ask lights at every node (off only for comparisons)
  bool refracted_sources = true;  // ask lights through smooth interfaces, too (refracted/sight.h)
  bool volume_chains = true;      // and along chains of scatterings (techniques/volume_chains.h; off for comparisons)
  bool side_flights =
      true;  // flights aside in media that scatter forwards (techniques/side_vertex.h; off for comparisons)
  bool equiangular = true;  // vertices near lamps in media (techniques/equiangular.h; off for comparisons)
  // Photons that look for light which glossy surfaces throw (gloss_photons.h); 0: none, and nobody is guided there.
  uint32_t gloss_photons = 32768;
  Method method = Method::standard;
  int lamp_draws = LightNature::kMostDraws;  // 1..kMostDraws: samples of a light at the first node of a path
  StopRule stop = StopRule::plan;
  uint32_t change_after = 20;  // StopRule::change: samples before the first test
  double change = 1e-3;        // StopRule::change: relative change that counts as convergence
  bool specialise = true;      // use kernels made for what a state really contains (off only for comparisons)
};

// Whether paths go back to places in real air, for shadows in it and the light of single places
// (techniques/air_residual.h).
inline bool goes_back(const PipelineOptions& options) {
  return options.explicit_sources && options.method == Method::standard;
}

// Error when a value is out of its range.
void check(const PipelineOptions& options);

}  // namespace suite
