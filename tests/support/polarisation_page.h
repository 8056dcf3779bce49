// What docs/theory/polarisation.md says of each thing: of lines "| `name` | class | ...", by the heading above them.
#pragma once
#include <fstream>
#include <map>
#include <set>
#include <string>

namespace suite::test {

// name -> class ("matrix", "partly", "depolarises", "not known", ...) of the section under "### heading".
inline std::map<std::string, std::string> polarisation_of(const std::string& heading) {
  std::ifstream page(SUITE_SOURCE_DIR "/docs/theory/polarisation.md");
  std::map<std::string, std::string> classes;
  bool within = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("#")) within = line == "### " + heading;
    if (!within || !line.starts_with("| `")) continue;
    const size_t end = line.find('`', 3), from = line.find("| ", end) + 2, to = line.find(" |", from);
    classes[line.substr(3, end - 3)] = line.substr(from, to - from);
  }
  return classes;
}
template <class Rows>
std::set<std::string> row_names(const Rows& rows) {
  std::set<std::string> names;
  for (const auto& row : rows) names.insert(row.name);
  return names;
}
inline std::set<std::string> names_on_page(const std::string& heading) {
  std::set<std::string> names;
  for (const auto& [name, of] : polarisation_of(heading)) names.insert(name);
  return names;
}

}  // namespace suite::test
