#include "helios_survey.h"

#include <filesystem>

#include "base/diagnostics.h"
#include "base/files.h"
#include "base/inputs.h"
#include "base/kept_texts.h"
#include "base/outputs.h"
#include "base/tracked_inputs.h"
#include "dirsig_import.h"
#include "formats/helios/survey.h"

namespace suite {

namespace {

constexpr size_t kMostPrinted = 12;  // lines of what is lost that are printed

HeliosSurvey survey_of(const RenderOptions& o, TrackedInputs& inputs,
                       const std::function<std::string(const std::string& scene)>& prepared) {
  const HeliosSurveyFiles files{[&](const std::string& name) {
                                  const std::string path = inputs.add(name).path;
                                  return HeliosSurveyFiles::Named{path, read_text(path)};
                                },
                                [&](const std::string& scene) { return prepared(inputs.path_of(scene)); }};
  return parse_helios_survey(read_text(o.simulation), o.simulation, files);
}

std::string place_of(const std::string& folder, const std::string& scene) {
  return in_folder(folder, std::filesystem::path(scene).stem().string() + ".h5");
}

// Whether the import may go on.
bool report(const HeliosSurvey& survey, const RenderOptions& o) {
  size_t printed = 0;
  for (const HeliosFinding& f : survey.findings)
    if (++printed <= kMostPrinted) emit({Dr::import_unsupported, to_text(f.where) + ": " + f.text});
  if (printed > kMostPrinted) emit({Dr::import_more, strf("and %zu more", printed - kMostPrinted)});
  return !o.strict || survey.findings.empty();
}

}  // namespace

bool is_of_helios(const std::string& path) {
  if (path.empty() || !file_exists(path)) return false;
  const RandomAccessFile file(path);
  std::string head(std::min<size_t>(file.size(), 65536), '\0');
  file.read_at(0, std::as_writable_bytes(std::span(head)));
  return is_helios_survey(path, head);
}

Simulation import_survey(const RenderOptions& o, const SimulationCallbacks& callbacks) {
  TrackedInputs inputs(o.simulation, o.search);
  const HeliosSurvey survey = survey_of(o, inputs, [&](const std::string& scene) {
    const std::string place = std::filesystem::absolute(place_of(o.output, scene)).string();
    make_folder(o.output);
    prepare_scene(scene, place, o.search);
    return place;
  });
  if (!report(survey, o))
    throw Error(Where{o.simulation, 0, 0, {}, -1}, "a strict import leaves nothing out", "drop --strict");
  const Params root = Params::parse_made(survey.text.yaml, o.simulation, survey.text.origins, o.settings);
  return read_simulation_tree(root, o.simulation, callbacks, o.settings);
}

int convert_survey(const RenderOptions& o) {
  note_input(o.simulation);
  TrackedInputs inputs(o.simulation, o.search);
  std::string scene_file;
  const HeliosSurvey survey = survey_of(o, inputs, [&](const std::string& scene) {
    scene_file = scene;
    return std::filesystem::path(scene).stem().string() + ".h5";
  });
  const std::string text = in_folder(o.convert, std::filesystem::path(o.simulation).stem().string() + ".yaml");
  check_outputs({text});
  make_folder(o.convert);
  const NamedText made[] = {{text, survey.text.yaml}};
  write_kept_texts(made);
  note("wrote " + text + "; its scene: scene-prep " + scene_file + " -o " + place_of(o.convert, scene_file));
  return report(survey, o) ? 0 : 1;
}

}  // namespace suite
