// The options that say how much a run may spend, as they stand on the command line.
#pragma once
#include "estimate/budget.h"
#include "options.h"
#include "scheduler/kits.h"

namespace suite {

// UsageError for anything that cannot be meant. "64" and "32,1024" paths; "1%" or "0.01"; "90s", "10min", "2h".
Budget budget_of(const RenderOptions& options);
size_t kit_bytes_of(const RenderOptions& options);   // "512MiB"
size_t view_bytes_of(const RenderOptions& options);  // the same, of a page
size_t tile_bytes_of(const RenderOptions& options);  // the same, more than nothing; 0 when nothing was asked for
StopRule stop_rule_of(const RenderOptions& options);
Method method_of(const RenderOptions& options);

}  // namespace suite
