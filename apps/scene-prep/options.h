// The options of scene-prep.
#pragma once
#include <string>
#include <vector>

#include "base/run_app.h"

namespace suite {

struct ScenePrepOptions {
  std::string input, output, gases, report, raycast, explain, export_obj, quick_look, look_at, look_from, view, account,
      convert;
  double look_size = 0;
  long long pixels = 800;
  std::vector<std::string> search, mute, compress, settings;
  bool repair = false, quick = false, force = false, uplift = false;
  bool strict = false, list_issues = false, list_models = false, list_phases = false, list_temperatures = false,
       list_importers = false, summary = false;
};

AppInfo scene_prep_info();
void declare(Cli& cli, ScenePrepOptions& options);

}  // namespace suite
