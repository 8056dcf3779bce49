// Command line of dirsig-render.
#pragma once
#include <string>
#include <vector>

#include "base/run_app.h"

namespace suite {

struct RenderOptions {
  std::string simulation, output = "out";
  std::vector<std::string> plugins, settings, search;
  std::string explain, paths, target_error, target_bands = "reference", time, stop, method = "standard", kit_memory,
                                            memory, ranks, link, against, air_lut, heat, heat_operator, account,
                                            convert;
  std::string view, view_size = "256MiB";  // page
  std::string detect;                      // stored responses of laser pulses
  std::string preset, lidar_preset;        // names
  std::string part, plan;                  // K/N; folder of a state of the whole
  std::vector<std::string> merge;          // folders of parts
  std::string study, study_budgets = "4,8,16,32,64", reference;
  long long study_seeds = 4;
  double target_floor = -1;
  long long seed = -1, more = -1;
  bool state = false, resume = false, load_all = false, heat_only = false, strict = false;
  bool dry_run = false, air = false, list_sensors = false, list_sources = false, list_models = false,
       list_truth = false, list_channels = false, list_detectors = false, list_image_detectors = false,
       list_deflectors = false, list_presets = false, lidar_presets = false, list_diagnostics = false;
  std::vector<std::string> mute;  // codes of diagnostics that are not printed
};

AppInfo render_info();
void declare_render(Cli& cli, RenderOptions& options);

}  // namespace suite
