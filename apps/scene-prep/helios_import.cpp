#include "helios_import.h"

#include <cmath>
#include <filesystem>

#include "base/files.h"
#include "base/inputs.h"
#include "base/kept_texts.h"
#include "base/outputs.h"
#include "base/run_app.h"
#include "formats/helios/helios.h"
#include "formats/obj/obj.h"
#include "formats/raster/raster.h"
#include "formats/scene_text/scene_text.h"
#include "scene/issues.h"

namespace suite {

namespace {

HeliosGrid grid_of(const std::string& path) {
  const GeoReference ref = read_georeference(path);
  return {{ref.to_map[0], ref.to_map[3]}, {ref.to_map[1], -ref.to_map[5]}, ref.no_data};
}

HeliosHeights heights_of(const std::string& path) {
  Raster raster = read_raster(path);
  HeliosHeights made{grid_of(path), raster.width, raster.height, {}};
  const size_t step = raster.channels;
  const std::vector<float> heights = values_of(std::move(raster), Numbers::scaled);
  for (size_t i = 0; i < heights.size(); i += step) made.heights.push_back(heights[i]);
  return made;
}

HeliosText text_of(const std::string& path, TrackedInputs& inputs, Report& report) {
  Report again(scene_issues());  // what is found in meshes is told where they are read_helios for the scene
  const HeliosFiles files{[&](const std::string& name) { return grid_of(inputs.path_of(name)); },
                          [&](const std::string& name) { return read_text(inputs.add(name).path, size_t{1} << 30); },
                          [&](const std::string& name) { return heights_of(inputs.path_of(name)); },
                          [&](const std::string& name) { return read_obj(inputs.path_of(name), again); }};
  return parse_helios(read_text(path), path, files, report);
}

Draft read_helios(const std::string& path, const ImportOptions& options, Report& report) {
  TrackedInputs inputs(path, options.search);
  const HeliosText made = text_of(path, inputs, report);
  const Params root = Params::parse_made(made.yaml, path, made.origins, options.settings);
  return read_scene_tree(root, inputs, report);
}

// File names stay as they are: the text is to be read with the same --path.
bool convert_helios(const std::string& path, const ImportOptions& options, const std::string& folder) {
  namespace fs = std::filesystem;
  Report report(scene_issues());
  TrackedInputs inputs(path, options.search);
  const HeliosText made = text_of(path, inputs, report);
  const std::string text = (fs::path(folder) / fs::path(path).stem()).string() + ".yaml";
  check_outputs({text});
  make_folder(folder);
  const NamedText made_text[] = {{text, made.yaml}};
  write_kept_texts(made_text);
  std::fputs(report.text().c_str(), stdout);
  note("wrote " + text);
  return report.count("SP705") == 0;
}

}  // namespace

ImporterRow helios_importer() {
  return {
      {"helios", "a scene of HELIOS++, .xml (formats/helios/FORMAT.md)", "", read_helios}, is_helios, convert_helios};
}

}  // namespace suite
