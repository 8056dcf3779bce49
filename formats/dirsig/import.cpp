#include "formats/dirsig/import.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "base/files.h"
#include "formats/dirsig/grammar.h"
#include "formats/dirsig/texts.h"

namespace suite::dirsig {

namespace fs = std::filesystem;

namespace {

// These texts are written by hand and by tools; geometry is read elsewhere.
constexpr size_t kLargestText = size_t{64} << 20;

// `name` below `folder`, letter case left aside; empty when there is none.
std::string ignoring_case(const std::string& folder, const std::string& name) {
  fs::path at = folder.empty() ? "." : folder;
  for (const fs::path& part : fs::path(name)) {
    if (part == "." || part.empty()) continue;
    if (part == ".." || fs::exists(at / part)) {
      at /= part;
      continue;
    }
    std::error_code fault;
    fs::path found;
    for (const fs::directory_entry& entry : fs::directory_iterator(at, fault))
      if (lower_case(entry.path().filename().string()) == lower_case(part.string())) found = entry.path();
    if (fault || found.empty()) return {};
    at = found;
  }
  return file_exists(at.string()) ? at.string() : std::string();
}

constexpr const char* kNotSet = "a variable that is not set";

std::string joined(const std::string& folder, const std::string& name) {
  if (fs::path(name).is_absolute() || folder.empty()) return name;
  return (fs::path(folder) / name).lexically_normal().string();
}

}  // namespace

std::string folder_of(const std::string& path) { return fs::path(path).parent_path().string(); }
std::string stem_of(const std::string& path) { return fs::path(path).stem().string(); }

Import::Import(std::vector<std::string> search, std::string base) : search_(std::move(search)), base_(std::move(base)) {
  if (const char* home = std::getenv("DIRSIG_HOME")) variables_["DIRSIG_HOME"] = home;
}

std::string Import::replaced(std::string_view name, std::string& how) const {
  std::string path(name);
  if (path.find('\\') != path.npos) {
    for (char& c : path) c = c == '\\' ? '/' : c;
    how = "a path of Windows";
  }
  while (path.starts_with('$')) {
    const size_t end = std::min(path.find('/'), path.size());
    std::string variable = path.substr(1, end - 1);
    if (variable.size() > 2 && variable.front() == '{' && variable.back() == '}')
      variable = variable.substr(1, variable.size() - 2);
    const auto known = variables_.find(variable);
    if (known == variables_.end()) {
      how = kNotSet;  // as of another machine
      return "/" + path;
    }
    path = known->second + path.substr(end);
    if (known->second.starts_with('$')) break;
    how = "$" + variable + " is " + known->second;
  }
  if (path.size() > 2 && path[1] == ':') {
    path.erase(0, 3);
    how = "a path of Windows, looked for below the folders that are known";
  }
  return path;
}

std::string Import::path_of(const Item& at, std::string_view name, const Folders& folders, std::string& how) {
  if (name.empty()) throw at.error("'" + at.name + "' names no file");
  if (name.find('\0') != name.npos) throw at.error("the name of a file with a character 0");
  const std::string path = replaced(name, how);
  Folders all = folders;
  all.insert(all.end(), search_.begin(), search_.end());
  if (fs::path(path).is_absolute()) all = {""};
  for (const std::string& folder : all)
    if (const std::string there = joined(folder, path); file_exists(there)) return there;
  for (const std::string& folder : all)
    if (const std::string there = ignoring_case(folder, path); !there.empty()) {
      how = "upper and lower case are passed over";
      return there;
    }
  // Of an absolute name of another machine only its end can be right.
  const std::string last = fs::path(path).filename().string();
  Folders near = folders;
  near.insert(near.end(), search_.begin(), search_.end());
  for (const std::string& folder : near)
    if (const std::string there = ignoring_case(folder, last); last != path && !there.empty()) {
      how = "found as " + there;
      return there;
    }
  if (how == kNotSet)
    throw at.error("'" + std::string(name.substr(0, 120)) +
                       "' begins with a variable that is not set, and there is no '" + last.substr(0, 120) + "'",
                   "set it in the environment (DIRSIG_HOME), or give --path");
  std::string looked;
  for (const std::string& folder : all) looked += (looked.empty() ? "" : ", ") + (folder.empty() ? "." : folder);
  throw at.error("there is no file '" + std::string(name.substr(0, 200)) + "'",
                 "looked for in " + looked + "; --path adds folders");
}

std::string Import::file_of(const Item& named, const Folders& folders) {
  if (named.value.empty()) {
    const auto inner = std::find_if(named.children.begin(), named.children.end(),
                                    [](const Item& child) { return !child.name.starts_with('@'); });
    throw named.error("'" + named.name + "' names no file",
                      inner == named.children.end()
                          ? "give it one"
                          : "the name is its own text, not that of '" + inner->name + "' in it");
  }
  std::string how;
  const std::string path = path_of(named, named.value, folders, how);
  named.mark(how.empty() ? Fate::exact : Fate::converted, how);
  return path;
}

std::string Import::name_of(const std::string& path) const {
  const fs::path whole = fs::absolute(path).lexically_normal();
  const fs::path near = whole.lexically_relative(fs::absolute(base_.empty() ? "." : base_).lexically_normal());
  return near.empty() ? whole.string() : near.string();
}

const Item& Import::added(const std::string& path, const std::string& kind, Item root, const std::string& how) {
  const Item& item = ledger_.add(path, kind, std::move(root));
  if (!how.empty()) item.mark(Fate::converted, how);
  return item;
}

const Item& Import::xml(const std::string& path, const std::string& kind) {
  if (const Item* there = known(path)) return *there;
  std::string how;
  const std::string text = plain_text_of(path, kLargestText, how);
  return added(path, kind, parse_xml(text, path), how);
}

const Item& Import::json(const std::string& path) {
  if (const Item* there = known(path)) return *there;
  std::string how;
  const std::string text = plain_text_of(path, kLargestText, how);
  return added(path, "simulation", parse_json(text, path), how);
}

const Item& Import::sections(const std::string& path, const std::string& kind, const std::string& root) {
  if (const Item* there = known(path)) return *there;
  std::string how;
  const std::string text = plain_text_of(path, kLargestText, how);
  return added(path, kind, parse_sections(text, path, root), how);
}

const Item& Import::keep(const std::string& path, const std::string& kind, Item root) {
  return ledger_.add(path, kind, std::move(root));
}

}  // namespace suite::dirsig
