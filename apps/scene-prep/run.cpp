#include "run.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <regex>

#include "base/files.h"
#include "base/inputs.h"
#include "base/outputs.h"
#include "base/params.h"
#include "base/progress.h"
#include "base/renamed.h"
#include "base/report.h"
#include "formats/obj/obj.h"
#include "formats/picture/picture.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "gases.h"
#include "importers.h"
#include "mesh/check.h"
#include "optics/phase_function.h"
#include "page/page.h"
#include "scene/bake.h"
#include "scene/issues.h"
#include "scene/summary.h"
#include "surface/quick_look.h"
#include "thermal/models.h"
#include "view.h"

namespace suite {

namespace {

const std::string kGenerator = std::string("scene-prep ") + kVersion;

void list_issues() {
  for (const IssueKind& k : scene_issues())
    std::printf("%s  %-7s  %s\n", k.code.c_str(), to_text(k.severity), k.summary.c_str());
}

// The tables of kinds that were asked for; nothing when none was.
std::string lists(const ScenePrepOptions& o) {
  return (o.list_models ? models().list() : "") + (o.list_phases ? phases().list() : "") +
         (o.list_temperatures ? temperature_models().list() : "") + (o.list_importers ? importers().list() : "");
}

// The arguments that decide the result, without folders, so that the same work elsewhere gives the same bytes.
std::string canonical_arguments(const ScenePrepOptions& o) {
  std::string text = printable(std::filesystem::path(o.input).filename().string());
  for (const std::string& setting : o.settings) text += " --set " + printable(setting);
  for (const std::string& code : o.mute) text += " --mute " + code;
  if (o.strict) text += " --strict";
  if (o.repair) text += " --repair";
  if (o.uplift) text += " --uplift";
  for (const std::string& how : o.compress) text += " --compress " + how;
  return text;
}

void write_report(const ScenePrepOptions& o, const Report& report) {
  if (o.report == "-")
    std::fputs(report.json().c_str(), stdout);
  else if (!o.report.empty())
    write_file(o.report, report.json());
}

// A program that is newer than the scene may make another one of it, whatever its version says.
bool program_is_newer(const std::string& output) {
  std::error_code fault;
  const auto program = std::filesystem::last_write_time("/proc/self/exe", fault);
  if (fault) return false;
  const auto made = std::filesystem::last_write_time(output, fault);
  return fault || program > made;
}

// The output was made by this version from the same inputs with the same options.
bool up_to_date(const ScenePrepOptions& o) {
  if (o.force || o.output.empty() || !o.report.empty() || !o.account.empty() || !o.view.empty() ||
      !file_exists(o.output) || program_is_newer(o.output))
    return false;
  try {
    const Provenance p = [&] {
      const OwnResults own;
      return read_provenance(o.output);
    }();
    return p.generator == kGenerator && p.arguments == canonical_arguments(o) &&
           inputs_unchanged(o.input, o.search, p.inputs);
  } catch (const Error&) {
    return false;  // whatever stands there is replaced
  }
}

std::string page_of_report(const ScenePrepOptions& o) {
  return o.report.empty() || o.report == "-" ? "" : std::filesystem::path(o.report).replace_extension(".html").string();
}

// What each step of the preparation took, as a page beside the report: memory against seconds, and what was found.
class Steps {
 public:
  void done(const char* step) {
    struct rusage use {};
    ::getrusage(RUSAGE_SELF, &use);
    const double bytes = 1024.0 * static_cast<double>(use.ru_maxrss);
    const double now = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    csv_ += strf("%s,%.6f,%.6f,%.0f\n", step, now - before_, now, bytes);
    before_ = now;
  }
  void write(const ScenePrepOptions& o, const Report& report) const {
    std::string head = "# " + command_line() + "\n";
    const std::string text = report.text();
    for (size_t at = 0, end; at < text.size(); at = end + 1) {
      end = std::min(text.find('\n', at), text.size());
      head += "# " + text.substr(at, end - at) + "\n";
    }
    write_file(page_of_report(o), html_of(page_of_csv(head + "step,seconds,seconds_in_all,peak_bytes\n" + csv_,
                                                      "Preparation of " + o.input + ": memory against seconds",
                                                      {"seconds_in_all"}, {"peak_bytes"}, "", o.report)));
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double before_ = 0;
  std::string csv_;
};

Compression compression_of(const ScenePrepOptions& o) {
  Compression compression;
  try {
    for (const std::string& how : o.compress) compression.add(how);
  } catch (const Error& e) {
    throw UsageError("--compress: " + e.message() + "; " + e.hint());
  }
  return compression;
}

int prepare(const ScenePrepOptions& o) {
  const Compression compression = compression_of(o);
  const std::vector<std::string> outputs{o.output, o.report, page_of_report(o), o.view};
  note_input(o.input);
  check_outputs(outputs);
  if (up_to_date(o)) {
    note(o.output + " is up to date: inputs, options and version are unchanged (--force prepares it again)");
    return 0;
  }
  Steps steps;
  Report report(scene_issues());
  for (const std::string& code : o.mute) report.mute(code);
  report.set_strict(o.strict);
  Draft draft = importer_of(o.input).make(o.input, {o.search, o.settings, o.account, o.strict, o.uplift}, report);
  for (const RenamedUse& use : take_renamed_uses()) report.add("SP004", o.input, {use.where, text_of(use)});
  check_outputs(outputs);  // what the text reads is known now
  steps.done("read");
  MeshCheck check;
  check.self_intersections = !o.quick;
  check_draft_meshes(draft, check, o.repair, report);
  steps.done("check");
  const Scene scene = bake_scene(draft, report);
  const std::vector<ViewedFinding> findings =
      o.view.empty() ? std::vector<ViewedFinding>{} : findings_to_view(draft, report);
  steps.done("bake");
  make_folders_of({o.report});
  if (report.ok()) make_folders_of({o.output});
  write_report(o, report);
  if (o.report != "-") std::fputs(report.text().c_str(), report.ok() ? stdout : stderr);
  if (report.ok() && !o.output.empty()) {
    write_scene(scene, {kGenerator, canonical_arguments(o), input_hash(draft.inputs), draft.inputs}, o.output,
                compression);
    steps.done("write");
  }
  if (!o.report.empty() && o.report != "-") steps.write(o, report);
  if (report.ok() && !o.view.empty()) write_scene_view(scene, findings, o.view);
  if (!report.ok()) {
    if (!o.output.empty() && file_exists(o.output)) warn(o.output + " is left as it was: it does not hold this scene");
    return 1;
  }
  if (o.output.empty()) return 0;
  note(strf("wrote %s (%zu bytes)", o.output.c_str(), file_size(o.output)));
  return 0;
}

}  // namespace

namespace {

void print_summary(const ScenePrepOptions& o, const Scene& scene, const LoadReport& stored) {
  const Provenance p = read_provenance(o.input);
  std::printf("%s", printable_lines(summary_text(scene)).c_str());
  for (const LoadRow& row : stored.rows)
    if (row.stored)
      std::printf("%-13s %s, loaded when needed (--explain '%s')\n", "stored",
                  (row.feature + " " + human_bytes(static_cast<double>(row.stored))).c_str(), row.feature.c_str());
  std::printf("made by       %s: %s\ninputs        %zu files, sha256 %s\n", printable(p.generator).c_str(),
              printable(p.arguments).c_str(), p.inputs.size(), printable(p.input_sha256).c_str());
}

// "1 2, 3" as numbers.
std::vector<double> parse_numbers(const std::string& text, const char* option) {
  return Params::parse_text("[" + std::regex_replace(text, std::regex("[ ,]+"), ", ") + "]", option).as_numbers();
}

Ray parse_ray(const std::string& text) {
  const std::vector<double> v = parse_numbers(text, "--raycast");
  const Vec3 direction = v.size() == 6 ? Vec3{v[3], v[4], v[5]} : Vec3{};
  if (!(length(direction) > 0)) throw UsageError("--raycast needs six numbers, the last three not all 0");
  return {{v[0], v[1], v[2]}, normalized(direction), 0};
}

LookAt parse_look(const ScenePrepOptions& o, const Tracer& tracer, double time) {
  LookAt look;
  look.box = tracer.bounds(), look.size_m = o.look_size, look.time = time;
  if (o.look_size < 0 || !(o.look_size <= 1e9)) throw UsageError("--look-size is up to 1e9 m");
  if (!o.look_from.empty()) {
    const std::vector<double> v = parse_numbers(o.look_from, "--look-from");
    if (v.size() != 2 || !(std::fabs(v[0]) <= 360 && std::fabs(v[1]) <= 90))
      throw UsageError("--look-from is a compass azimuth and an elevation from -90 to 90, degrees");
    look.azimuth_deg = v[0], look.elevation_deg = v[1];
  }
  if (o.look_at.empty()) return look;
  if (o.look_at.find_first_of(" ,") == std::string::npos) {
    try {
      look.box = box_of(tracer, o.look_at);
      look.margin = 1.1;
    } catch (const Error& e) {
      throw Error(Where{o.input, 0, 0, {}, -1}, "--look-at: " + e.message(), e.hint());
    }
    return look;
  }
  const std::vector<double> v = parse_numbers(o.look_at, "--look-at");
  if (v.size() < 2 || v.size() > 3) throw UsageError("--look-at is a name, or two or three numbers, m");
  if (!(o.look_size > 0)) throw UsageError("a place to look at needs a --look-size");
  look.box = {};
  look.box.grow(Vec3{v[0], v[1], v.size() == 3 ? v[2] : height_at(tracer, v[0], v[1], time).value_or(0)});
  return look;
}

// Anything of how a scene text is prepared was asked for, but where to and with what values.
bool goes_with_a_scene(const ScenePrepOptions& o) {
  return !o.input.empty() || !o.search.empty() || !o.report.empty() || !o.mute.empty() || !o.compress.empty() ||
         o.strict || o.repair || o.quick || o.force || o.uplift;
}

// Questions about a scene that has been prepared.
int inspect(const ScenePrepOptions& o) {
  if (!o.output.empty() || !o.settings.empty() || !o.report.empty() || !o.mute.empty() || !o.compress.empty() ||
      o.strict || o.repair || o.quick || o.force || o.uplift)
    throw UsageError(
        "--output, --set, --report, --mute, --strict, --repair, --compress, --uplift, --no-crossing-check and --force "
        "prepare a scene text; --quick-look, --summary, --raycast and --export-obj ask a prepared one: two commands, "
        "scene-prep SCENE.yaml -o SCENE.h5, then scene-prep SCENE.h5 --quick-look LOOK.png");
  if (o.quick_look.empty() && (!o.look_at.empty() || !o.look_from.empty() || o.look_size != 0))
    throw UsageError("--look-at, --look-from and --look-size go with --quick-look");
  if (o.pixels < 1 || o.pixels > 16384) throw UsageError("--pixels is 1 to 16384");
  note_input(o.input);
  check_outputs({o.export_obj, o.quick_look, o.view});
  LoadReport stored;
  const auto scene = std::make_shared<const Scene>(read_scene(o.input, {}, {}, &stored));
  make_folders_of({o.export_obj, o.quick_look});
  if (o.summary) print_summary(o, *scene, stored);
  const double time = time_of_all(*scene);
  if (!o.export_obj.empty()) {
    if (const size_t left = write_obj(*scene, time, o.export_obj))
      warn(strf("%zu exact primitives were left out", left));
    if (changes_in_time(*scene)) note(strf("the OBJ holds what is there at %.9g s, where it is then", time));
  }
  if (!o.view.empty()) write_scene_view(*scene, {}, o.view);
  if (o.raycast.empty() && o.quick_look.empty()) return 0;
  const Tracer tracer(scene, std::nullopt, {time, time});
  if (!o.raycast.empty()) std::fputs(printable_lines(describe_hit(tracer, parse_ray(o.raycast))).c_str(), stdout);
  if (!o.quick_look.empty()) {
    const View view = view_of(tracer, parse_look(o, tracer, time), static_cast<int>(o.pixels));
    write_png(o.quick_look, view.width, view.height, view.rgb, command_line());
  }
  return 0;
}

}  // namespace

namespace {

// An HDF5 file, by its first bytes.
bool is_prepared(const std::string& path) {
  if (!file_exists(path) || file_size(path) < 8) return false;
  std::array<std::byte, 4> first{};
  RandomAccessFile(path).read_at(0, first);
  return first == std::array{std::byte{0x89}, std::byte{'H'}, std::byte{'D'}, std::byte{'F'}};
}

int convert(const ScenePrepOptions& o) {
  if (!o.output.empty() || !o.report.empty() || !o.account.empty() || !o.settings.empty())
    throw UsageError("--convert goes without --output, --report, --import-report and --set");
  note_input(o.input);
  const ImporterRow& importer = importer_of(o.input);
  if (!importer.convert)
    throw Error(Where{o.input, 0, 0, {}, -1}, "is a scene text already", "--convert is for scenes of other programs");
  const bool whole = importer.convert(o.input, {o.search, {}, "", o.strict, o.uplift}, o.convert);
  if (!whole) warn("something of it is lost: the account says what");
  return whole || !o.strict ? 0 : 1;
}

}  // namespace

int run_scene_prep(const ScenePrepOptions& o) {
  for (const RenamedUse& use : take_renamed_uses())  // options: keys are not read yet
    if (std::ranges::find(o.mute, "SP004") == o.mute.end()) warn(text_of(use) + " [SP004]");
  if (o.list_issues) return list_issues(), 0;
  if (const std::string list = lists(o); !list.empty()) return std::fputs(list.c_str(), stdout), 0;
  if (!o.explain.empty()) return std::fputs(explain_feature(o.explain).c_str(), stdout), 0;
  const bool questions = o.summary || !o.raycast.empty() || !o.export_obj.empty() || !o.quick_look.empty() ||
                         (!o.view.empty() && is_prepared(o.input));
  if (!o.gases.empty()) {
    if (questions || goes_with_a_scene(o)) throw UsageError("--gases takes --output and --set alone");
    return bake_gases(o);
  }
  if (o.input.empty()) throw UsageError("an input is needed");
  if (!o.convert.empty()) return convert(o);
  return questions ? inspect(o) : prepare(o);
}

}  // namespace suite
