#include "run.h"

#include <cstdio>
#include <filesystem>

#include "base/files.h"
#include "base/report.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "formats/scene_text/scene_text.h"
#include "mesh/check.h"
#include "optics/models.h"
#include "scene/bake.h"
#include "scene/issues.h"
#include "scene/summary.h"

namespace suite {

namespace {

const std::string kGenerator = std::string("scene-prep ") + kVersion;

void list_issues() {
  for (const IssueKind& k : scene_issues())
    std::printf("%s  %-7s  %s\n", k.code.c_str(), to_text(k.severity), k.summary.c_str());
}

void list_models() {
  for (const ModelRow& row : models()) {
    std::printf("%s: %s\n", row.name.c_str(), row.summary.c_str());
    for (const ModelParameter& p : row.parameters)
      std::printf("    %s [%s]: %s%s\n", p.name.c_str(), p.unit.c_str(), p.summary.c_str(),
                  p.required ? "" : " (optional)");
  }
}

// The arguments that decide the result, without folders, so that the same work elsewhere gives the same bytes.
std::string canonical_arguments(const ScenePrepOptions& o) {
  std::string text = std::filesystem::path(o.input).filename().string();
  for (const std::string& code : o.mute) text += " --mute " + code;
  if (o.strict) text += " --strict";
  if (o.repair) text += " --repair";
  return text;
}

void write_report(const ScenePrepOptions& o, const Report& report) {
  if (o.report == "-")
    std::fputs(report.json().c_str(), stdout);
  else if (!o.report.empty())
    write_file(o.report, report.json());
}

// The output was made by this version from the same inputs with the same options.
bool up_to_date(const ScenePrepOptions& o) {
  if (o.force || o.output.empty() || !o.report.empty() || !file_exists(o.output)) return false;
  try {
    const Provenance p = read_provenance(o.output);
    return p.generator == kGenerator && p.arguments == canonical_arguments(o) && inputs_unchanged(o.input, {o.search}, p.inputs);
  } catch (const Error&) {
    return false;  // whatever stands there is replaced
  }
}

int prepare(const ScenePrepOptions& o) {
  if (up_to_date(o)) {
    note(o.output + " is up to date: inputs, options and version are unchanged (--force prepares it again)");
    return 0;
  }
  Report report(scene_issues());
  for (const std::string& code : o.mute) report.mute(code);
  report.set_strict(o.strict);
  Draft draft = read_scene_text(o.input, {o.search}, report);
  MeshCheck check;
  check.self_intersections = !o.quick;
  check_draft_meshes(draft, check, o.repair, report);
  const Scene scene = bake_scene(draft, report);
  write_report(o, report);
  if (o.report != "-") std::fputs(report.text().c_str(), report.ok() ? stdout : stderr);
  if (!report.ok()) return 1;
  if (o.output.empty()) return 0;
  write_scene(scene, {kGenerator, canonical_arguments(o), input_hash(draft), draft.inputs}, o.output);
  note(strf("wrote %s (%zu bytes)", o.output.c_str(), file_size(o.output)));
  return 0;
}

}  // namespace

int run_scene_prep(const ScenePrepOptions& o) {
  if (o.list_issues) return list_issues(), 0;
  if (o.list_models) return list_models(), 0;
  if (o.input.empty()) throw UsageError("an input is needed");
  if (!o.summary) return prepare(o);
  if (!o.output.empty()) throw UsageError("--summary writes no scene");
  const Scene scene = read_scene(o.input);
  const Provenance p = read_provenance(o.input);
  std::printf("%s", summary_text(scene).c_str());
  std::printf("made by       %s: %s\ninputs        sha256 %s\n", p.generator.c_str(), p.arguments.c_str(),
              p.input_sha256.c_str());
  return 0;
}

}  // namespace suite
