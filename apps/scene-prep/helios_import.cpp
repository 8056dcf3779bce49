#include "helios_import.h"

#include <filesystem>

#include "base/files.h"
#include "base/inputs.h"
#include "base/outputs.h"
#include "base/run_app.h"
#include "formats/helios/helios.h"
#include "formats/raster/raster.h"
#include "formats/scene_text/scene_text.h"
#include "scene/issues.h"

namespace suite {

namespace {

HeliosText text_of(const std::string& path, TrackedInputs& inputs, Report& report) {
  const HeliosFiles files{[&](const std::string& name) {
                            const GeoReference ref = read_georeference(inputs.path_of(name));
                            return std::array<double, 4>{ref.to_map[0], ref.to_map[3], ref.to_map[1], -ref.to_map[5]};
                          },
                          [&](const std::string& name) { return read_text(inputs.add(name).path, size_t{1} << 30); }};
  return parse_helios(read_text(path), path, files, report);
}

Draft read(const std::string& path, const ImportOptions& options, Report& report) {
  TrackedInputs inputs(path, options.search);
  const HeliosText made = text_of(path, inputs, report);
  const Params root = Params::parse_made(made.yaml, path, made.origins, options.settings);
  return read_scene_tree(root, inputs, report);
}

// File names stay as they are: the text is to be read with the same --path.
bool convert(const std::string& path, const ImportOptions& options, const std::string& folder) {
  namespace fs = std::filesystem;
  Report report(scene_issues());
  TrackedInputs inputs(path, options.search);
  const HeliosText made = text_of(path, inputs, report);
  const std::string text = (fs::path(folder) / fs::path(path).stem()).string() + ".yaml";
  check_outputs({text});
  make_folder(folder);
  write_file(text, made.yaml);
  std::fputs(report.text().c_str(), stdout);
  note("wrote " + text);
  return report.count("SP705") == 0;
}

}  // namespace

ImporterRow helios_importer() {
  return {{"helios", "a scene of HELIOS++, .xml (formats/helios/FORMAT.md)", "", read}, is_helios, convert};
}

}  // namespace suite
