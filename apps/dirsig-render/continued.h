// Runs that can be continued: the state file beside the results, and what it must belong to.
#pragma once
#include <memory>
#include <string>

#include "formats/render_state/render_state.h"
#include "formats/sim_text/sim_text.h"
#include "options.h"

namespace suite {

// SHA-256 of the simulation's text and of the settings that replace some of it.
std::string hash_of_text(const Simulation& simulation);

// SHA-256 of the scenes' files.
std::string hash_of_scenes(const Simulation& simulation);

// What a state belongs to, and what all ranks of a run must have in common.
StateIdentity identity_of(const Simulation& simulation, const JobOptions& options);

// Makes, opens or extends FOLDER/result.state.h5 as --state, --resume and --more say, and --part, --plan and --merge;
// null without any of them. Sets the budget of `options` to the one that the run has, and the share to that of a part
// that goes on. UsageError for options that contradict each other.
std::unique_ptr<StateStore> open_store(const RenderOptions& o, const std::string& folder, const Simulation& simulation,
                                       JobOptions& options);

}  // namespace suite
