// What dirsig-render does.
#pragma once
#include "options.h"

namespace suite {

int run_render(const Cli& cli, const RenderOptions& options);

}  // namespace suite
