// Runs in parts: --part runs a share of the job, --merge joins the shares, --plan begins the second round of a job with
// targets.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/sim_text/sim_text.h"
#include "options.h"

namespace suite {

// Refuses what makes no sense together (UsageError).
void check_parts_usage(const Cli& cli, const RenderOptions& o);
// The share that --part or --merge asks for; nothing without them.
std::optional<Share> share_of(const RenderOptions& o);

// --time with --part: finds out by the first pilot what the time is worth, to name the --paths to use in the UsageError
// that it throws.
[[noreturn]] void refuse_time(const std::shared_ptr<const Scene>& scene, const Simulation& simulation,
                              const JobOptions& options);

// What a part has run and what comes next; or what joined parts still wait for.
void report_share(const JobReport& report, const Share& share, const std::string& folder);

}  // namespace suite
