// What dirsig-render does.
#pragma once
#include "cluster/ranks.h"
#include "options.h"

namespace suite {

// ranks: those that run the same together; null = this process is alone.
int run_render(const Cli& cli, const RenderOptions& options, Ranks* ranks);

}  // namespace suite
