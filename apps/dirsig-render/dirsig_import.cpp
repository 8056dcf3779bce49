#include "dirsig_import.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "base/diagnostics.h"
#include "base/files.h"
#include "base/inputs.h"
#include "base/kept_texts.h"
#include "base/outputs.h"
#include "formats/dirsig/dirsig.h"
#include "formats/tape5/tape5.h"
#include "formats/weather/weather.h"
#include "helios_survey.h"

namespace suite {

namespace {

using dirsig::Fate;

constexpr size_t kMostPrinted = 12;  // lines of what is lost that are printed

// The file that a prepared scene has in a folder; of scenes with one name the later ones get a number.
std::string place_for(std::vector<std::string>& taken, const std::string& folder, const std::string& scene) {
  const std::string stem = in_folder(folder, dirsig::stem_of(scene));
  std::string place = stem + ".h5";
  for (int k = 2; std::find(taken.begin(), taken.end(), place) != taken.end(); ++k)
    place = strf("%s_%d.h5", stem.c_str(), k);
  taken.push_back(place);
  return place;
}

dirsig::DeckAir air_of_deck(const std::string& path) {
  const std::vector<Tape5Run> runs = read_tape5(path);
  constexpr const char* profiles[] = {"us_standard",        "tropical",         "midlatitude_summer",
                                      "midlatitude_winter", "subarctic_summer", "subarctic_winter",
                                      "us_standard"};
  const Tape5Run& run = runs.at(0);
  if (run.model < 1 || run.model > 6) throw Error(run.where, strf("profile %d is not one of the six", run.model));
  dirsig::DeckAir air{profiles[run.model], "", {}};
  struct Haze {
    int number;
    const char* model;
    double km;
  };
  constexpr Haze hazes[] = {{1, "rural", 23}, {2, "rural", 5},    {3, "maritime", 23},        {4, "maritime", 23},
                            {5, "urban", 5},  {10, "desert", 75}, {6, "free_troposphere", 50}};
  for (const Haze& h : hazes)
    if (h.number == run.haze) air.aerosol = h.model, air.visibility_km = run.visibility ? *run.visibility * 1e-3 : h.km;
  return air;
}

// The seconds that a file of weather covers; read as the simulation's text will ask for it.
double span_of_weather(const dirsig::WeatherAsked& asked) {
  WeatherOptions options;
  options.site = Geodetic{asked.site[0], asked.site[1], asked.site[2]};
  options.utc_offset = asked.utc_offset_h * 3600;
  options.date = parse_iso8601(asked.date);
  const Weather weather = read_weather(asked.path, options);
  return weather.table().rows.back().end - weather.table().rows.front().end;
}

// Whether an import may go on: nothing was left out that must not be.
bool report_import(const dirsig::Ledger& ledger, bool strict) {
  const auto counts = ledger.counts();
  const size_t lost = counts[static_cast<size_t>(Fate::unsupported)],
               ignored = counts[static_cast<size_t>(Fate::ignored)];
  size_t printed = 0;
  for (const dirsig::Entry& e : ledger.entries()) {
    if (e.fate != Fate::unsupported && !(strict && e.fate == Fate::ignored)) continue;
    if (e.part || ++printed > kMostPrinted) continue;
    emit({Dr::import_unsupported, to_text(e.where) + ": " + to_text(e.fate) + ": " + e.path +
                                      (e.value.empty() ? "" : " = " + e.value) +
                                      (e.note.empty() ? "" : ": " + e.note)});
  }
  if (printed > kMostPrinted)
    emit({Dr::import_more,
          strf("and %zu more (--import-report FILE.json, or --convert FOLDER)", printed - kMostPrinted)});
  note(
      strf("import: %zu elements and keys, %zu exact, %zu converted, %zu approximated, %zu ignored-harmless, %zu "
           "unsupported",
           ledger.items(), counts[0], counts[1], counts[2], ignored, lost));
  return !strict || lost + ignored == 0;
}

}  // namespace

bool is_of_dirsig(const std::string& path) {
  if (path.empty() || !file_exists(path)) return false;
  const RandomAccessFile file(path);
  std::string head(std::min<size_t>(file.size(), 4096), '\0');
  file.read_at(0, std::as_writable_bytes(std::span(head)));
  return dirsig::is_simulation(path, head);
}

void prepare_scene(const std::string& scene, const std::string& place, const std::vector<std::string>& search) {
  const std::string program = (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "scene-prep").string();
  std::vector<std::string> words{program, scene, "-o", place, "-q"};
  for (const std::string& folder : search) words.insert(words.end(), {"--path", folder});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int fault = posix_spawn(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  const std::string hint = "scene-prep " + scene + " -o " + place;
  if (fault != 0)
    throw Error(Where{scene, 0, 0, {}, -1}, "the scene cannot be prepared: there is no '" + program + "'", hint);
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) throw Error(Where{scene, 0, 0, {}, -1}, "the scene cannot be prepared", hint);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw Error(Where{scene, 0, 0, {}, -1}, "scene-prep refuses this scene", "its report stands above");
}

void check_import_usage(const RenderOptions& o) {
  if (o.account.empty() && o.convert.empty() && o.search.empty() && !o.strict) return;
  const bool survey = is_of_helios(o.simulation);
  if (!survey && !is_of_dirsig(o.simulation))
    throw UsageError(
        "--path, --import-report, --convert and --strict go with a simulation of DIRSIG (.sim, .jsim) or a survey of "
        "HELIOS++ (.xml)");
  if (survey && !o.account.empty())
    throw UsageError("--import-report goes with a simulation of DIRSIG; what a survey loses is printed");
  if (!o.convert.empty() && (!o.account.empty() || !o.settings.empty()))
    throw UsageError("--convert goes without --import-report and --set");
}

Simulation import_simulation(const RenderOptions& o, const SimulationCallbacks& callbacks, bool alone) {
  dirsig::Import import(o.search, dirsig::folder_of(o.simulation));
  std::vector<std::string> taken;
  dirsig::SimulationHelp help;
  help.deck = air_of_deck;
  help.weather = span_of_weather;
  help.prepared = [&](const std::string& scene, const dirsig::SceneMade&) {
    const std::string place = place_for(taken, o.output, scene);
    if (!alone && !file_exists(place))
      throw Error(Where{scene, 0, 0, {}, -1}, "is not prepared, and several ranks are to read it",
                  "scene-prep " + scene + " -o " + place);
    if (!alone) return place;
    make_folder(o.output);
    prepare_scene(scene, place, o.search);
    return place;
  };
  const dirsig::MadeText made = dirsig::simulation_of(import, o.simulation, help);
  dirsig::Ledger& ledger = import.ledger();
  ledger.close();
  for (const std::string& file : ledger.files()) note_input(file);  // also those that are read later
  if (!o.account.empty()) {
    check_outputs({o.account});
    make_folders_of({o.account});
    write_file(o.account, ledger.json());
  }
  if (!report_import(ledger, o.strict))
    throw Error(Where{o.simulation, 0, 0, {}, -1}, "a strict import leaves nothing out",
                "--import-report FILE.json lists every line");
  const Params root = Params::parse_made(made.yaml, o.simulation, made.origins, o.settings);
  Simulation sim = read_simulation_tree(root, o.simulation, callbacks, o.settings);
  for (const std::string& file : ledger.files()) sim.files.push_back(file);
  return sim;
}

int convert_simulation(const RenderOptions& o) {
  note_input(o.simulation);
  dirsig::Import import(o.search, o.convert);
  std::vector<std::string> taken;
  std::vector<NamedText> texts;
  dirsig::SimulationHelp help;
  help.deck = air_of_deck;
  help.weather = span_of_weather;
  help.prepared = [&](const std::string& scene, const dirsig::SceneMade& made) {
    const std::string place = place_for(taken, o.convert, scene);
    texts.push_back({std::filesystem::path(place).replace_extension("yaml").string(), made.text.yaml});
    return place;
  };
  const dirsig::MadeText made = dirsig::simulation_of(import, o.simulation, help);
  dirsig::Ledger& ledger = import.ledger();
  ledger.close();
  texts.push_back({in_folder(o.convert, "simulation.yaml"), made.yaml});
  texts.push_back({in_folder(o.convert, "simulation_import.json"), ledger.json()});
  texts.push_back({in_folder(o.convert, "simulation_import.txt"), ledger.text()});
  std::vector<std::string> names;
  for (const NamedText& t : texts) names.push_back(t.file);
  check_outputs(names);
  make_folder(o.convert);
  write_kept_texts(texts);
  for (const std::string& place : taken)
    note("scene-prep " + std::filesystem::path(place).replace_extension("yaml").string() + " -o " + place);
  note("wrote " + in_folder(o.convert, "simulation.yaml") +
       " and what became of every line, simulation_import.txt beside it");
  return report_import(ledger, o.strict) ? 0 : 1;
}

}  // namespace suite
