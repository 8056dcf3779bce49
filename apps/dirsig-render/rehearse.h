// --dry-run --ranks: what a job would take on several ranks.
#pragma once
#include <memory>
#include <vector>

#include "cluster/makespan.h"
#include "formats/sim_text/sim_text.h"
#include "options.h"

namespace suite {

// The numbers of ranks asked for; empty = none. UsageError for anything else than whole numbers from 1 to 65536, and
// with options that it cannot be combined with.
std::vector<int> ranks_of(const Cli& cli, const RenderOptions& options);

// What --link says; UsageError unless it is four positive numbers.
LinkCosts link_of(const Cli& cli, const RenderOptions& options);

// Runs a few blocks of the job here, plays it through for each number of ranks and prints a line each. load_seconds:
// that reading the scene took.
int rehearse(const std::shared_ptr<const Scene>& scene, const Simulation& sim, const JobOptions& options,
             const std::vector<int>& ranks, const LinkCosts& link, double load_seconds);

}  // namespace suite
