// The scenes of a simulation.
#pragma once
#include <memory>
#include <vector>

#include "cluster/ranks.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "formats/sim_text/sim_text.h"
#include "options.h"

namespace suite {

struct LoadedScene {
  std::shared_ptr<Scene> scene;
  std::vector<std::shared_ptr<const LaterReads>> later;  // of each file that is read on while rendering
  double seconds = 0;
};

// All scenes as one, without what neither a sensor nor the balance of heat can see (--load-all: with it). ranks: those
// that share what has to be unpacked; may be null. Error: a file that cannot be read, scenes that do not fit each
// other.
LoadedScene load_scenes(const Simulation& simulation, const JobOptions& options, const RenderOptions& render,
                        Ranks* ranks);

}  // namespace suite
