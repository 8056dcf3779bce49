// Command line of dirsig-render.
#pragma once
#include <string>
#include <vector>

#include "base/run_app.h"

namespace suite {

struct RenderOptions {
  std::string simulation, output = "out";
  std::vector<std::string> plugins;
  long long paths = 0, seed = -1;
  bool dry_run = false, list_sensors = false, list_models = false, list_truth = false;
};

AppInfo render_info();
void declare_render(Cli& cli, RenderOptions& options);

}  // namespace suite
