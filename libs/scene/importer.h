// What reads scenes from outside: one row a format, for the table of the program that prepares them. A new importer is
// a folder in formats and a row there.
#pragma once
#include <string>
#include <vector>

#include "base/registry.h"
#include "base/report.h"
#include "scene/draft.h"

namespace suite {

struct ImportOptions {
  std::vector<std::string> search;    // folders in which files are also looked for, after the folder of the input
  std::vector<std::string> settings;  // "PATH=VALUE", values in place of a text's (base/params.h)
  std::string account = {};           // where to write what became of every line of another program's file; empty = not
  bool strict = false;                // what such a file says must not be left out, however harmless
  bool uplift = false;                // display colours of models may be guessed into spectra
};

// make reads a file and every file it names; the draft lists them as its inputs. Whatever is wrong goes to the report,
// item by item, so that one run tells all; Error only when the file itself cannot be read.
struct ImporterRow : RegistryRow<Draft(const std::string& path, const ImportOptions& options, Report& report)> {
  // Whether a file is of this format, by its name and its first bytes (4 KiB, or all of a shorter one).
  bool (*sniff)(const std::string& path, std::string_view head);
  // Writes the scene as a text of ours into a folder, with the account; null for what is one already. True when nothing
  // is lost. Error: as make.
  bool (*convert)(const std::string& path, const ImportOptions& options, const std::string& folder) = nullptr;
};

}  // namespace suite
