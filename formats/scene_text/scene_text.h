// The scene as a user writes it: YAML (or JSON) that names OBJ files, rasters and curves. See FORMAT.md.
#pragma once
#include "base/params.h"
#include "base/tracked_inputs.h"
#include "scene/importer.h"

namespace suite {

// Reads the text and every file it names; see importer.h. Error only when the text itself cannot be read as YAML.
Draft read_scene_text(const std::string& path, const ImportOptions& options, Report& report);

// The same of a text that a program made of other files (Params::parse_made); `inputs` holds those already, begins with
// the file that all started from, and gets what the text names.
Draft read_scene_tree(const Params& root, TrackedInputs& inputs, Report& report);

// The row of the table of importers.
ImporterRow scene_text_importer();

}  // namespace suite
