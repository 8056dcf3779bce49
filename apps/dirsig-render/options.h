// Command line of dirsig-render.
#pragma once
#include <string>

#include "base/run_app.h"

namespace suite {

struct RenderOptions {
  std::string simulation, output = "out";
  long long paths = 0, seed = -1;
  bool dry_run = false, list_sensors = false, list_models = false;
};

AppInfo render_info();
void declare_render(Cli& cli, RenderOptions& options);

}  // namespace suite
