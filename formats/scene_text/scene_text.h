// The scene as a user writes it: YAML (or JSON) that names OBJ files, rasters and curves. See FORMAT.md.
#pragma once
#include <string>
#include <vector>

#include "base/report.h"
#include "scene/draft.h"

namespace suite {

struct SceneTextOptions {
  std::vector<std::string> search;    // folders in which files are also looked for, after the folder of the text
  std::vector<std::string> settings;  // "PATH=VALUE", values in place of the text's (base/params.h)
};

// Reads the text and every file it names. Whatever is wrong goes to `report`, item by item, so that one run tells all.
// Error only when the text itself cannot be read as YAML.
Draft read_scene_text(const std::string& path, const SceneTextOptions& options, Report& report);

// Do the files that a scene was made from still have these contents? Names are found as read_scene_text finds them;
// files that were not there (no hash) must not be there now.
bool inputs_unchanged(const std::string& path, const SceneTextOptions& options, const std::vector<InputFile>& inputs);

}  // namespace suite
