#include "dirsig_import.h"

#include <algorithm>

#include "base/files.h"
#include "base/inputs.h"
#include "base/kept_texts.h"
#include "base/outputs.h"
#include "base/run_app.h"
#include "formats/dirsig/dirsig.h"
#include "formats/scene_text/scene_text.h"

namespace suite {

namespace {

using dirsig::Fate;

// What an import leaves out or changes, among the findings of the scene.
void file_account(const std::string& path, const dirsig::Ledger& ledger, bool strict, Report& report) {
  std::vector<dirsig::Entry> entries = ledger.entries();
  // Texts show the first of a kind: what says something of its own goes before the parts of what is lost.
  std::stable_partition(entries.begin(), entries.end(), [](const dirsig::Entry& e) { return !e.part; });
  for (const dirsig::Entry& e : entries) {
    if (e.fate == Fate::exact || e.fate == Fate::converted) continue;
    const std::string text = e.path + (e.value.empty() ? "" : " = " + e.value) + (e.note.empty() ? "" : ": " + e.note);
    const bool left_out = e.fate != Fate::approximated;
    report.add(e.fate == Fate::unsupported ? "SP701" : left_out ? "SP702" : "SP703", path, {e.where, text});
    if (strict && left_out) report.add("SP704", path, {e.where, text});
  }
}

Draft read(const std::string& path, const ImportOptions& options, Report& report) {
  dirsig::Import import(options.search, dirsig::folder_of(path));
  const dirsig::SceneMade made = dirsig::scene_of(import, path);
  dirsig::Ledger& ledger = import.ledger();
  ledger.close();
  TrackedInputs inputs(path, options.search);
  for (const std::string& file : ledger.files())
    if (file != path) inputs.add(import.name_of(file));
  file_account(path, ledger, options.strict, report);
  if (!options.account.empty()) {
    check_outputs({options.account});
    make_folders_of({options.account});
    write_file(options.account, ledger.json());
  }
  if (!made.lamps.empty()) note("the sources of light in it belong to the simulation, where dirsig-render puts them");
  const Params root = Params::parse_made(made.text.yaml, path, made.text.origins, options.settings);
  return read_scene_tree(root, inputs, report);
}

bool convert(const std::string& path, const ImportOptions& options, const std::string& folder) {
  dirsig::Import import(options.search, folder);
  const dirsig::SceneMade made = dirsig::scene_of(import, path);
  dirsig::Ledger& ledger = import.ledger();
  ledger.close();
  const std::string stem = in_folder(folder, dirsig::stem_of(path));
  const std::string text = stem + ".yaml", json = stem + "_import.json", account = stem + "_import.txt";
  check_outputs({text, json, account});
  make_folder(folder);
  const NamedText texts[] = {{text, made.text.yaml}, {json, ledger.json()}, {account, ledger.text()}};
  write_kept_texts(texts);
  note("wrote " + text + " and what became of every line, " + account);
  const auto counts = ledger.counts();
  return counts[static_cast<size_t>(Fate::unsupported)] == 0 &&
         (!options.strict || counts[static_cast<size_t>(Fate::ignored)] == 0);
}

}  // namespace

ImporterRow dirsig_importer() {
  return {{"dirsig", "a scene of DIRSIG, .scene or a .cfg of DIRSIG3 (formats/dirsig/FORMAT.md)", "", read},
          dirsig::is_scene,
          convert};
}

}  // namespace suite
