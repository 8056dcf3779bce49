// Inside of Params: the tree of a parsed document, and what builds it. Not for users of the library.
#pragma once
#include <deque>
#include <map>
#include <set>

#include "base/params.h"

namespace suite {

struct Params::Node {
  struct Entry {
    std::string key;
    int line, column;
    const Node* value;
    mutable bool read = false;
  };
  Kind kind = Kind::null;
  int line = 0, column = 0;  // line -n: column of the n-th setting
  std::string scalar;
  bool quoted = false;
  std::string missing;  // the key of one that must be there and is not; line and column are those of its map
  std::vector<const Node*> items;
  std::vector<Entry> entries;
  std::map<std::string, size_t, std::less<>> index;  // key -> entry
  mutable std::set<std::string, std::less<>> asked;  // names asked of this map: the candidates for "did you mean"
};

struct Params::Document {
  std::string file;
  std::shared_ptr<const std::string> text;  // the whole, which every place shares
  std::vector<size_t> lines;                // where each begins, and the end
  std::vector<Where> origins;               // of a text that a program made: where each line comes from
  std::vector<std::string> settings;        // applied so far, or being applied
  std::deque<Node> nodes;
  const Node* root = nullptr;
  mutable std::vector<std::string> paths;  // asked for, each once

  Where where(int line, int column) const {
    if (line < 0) {
      const std::string& setting = settings[static_cast<size_t>(-line) - 1];
      return Where{"--set " + setting.substr(0, setting.find('=')), 0, column, setting, -1};
    }
    if (line >= 1 && line <= static_cast<int>(origins.size())) return origins[static_cast<size_t>(line) - 1];
    Where w{file, line, column, {}, -1};
    if (line < 1 || line >= static_cast<int>(lines.size())) return w;
    const size_t begin = lines[static_cast<size_t>(line) - 1];
    size_t end = lines[static_cast<size_t>(line)];
    while (end > begin && ((*text)[end - 1] == '\n' || (*text)[end - 1] == '\r')) --end;
    w.source_line = SourceLine(text, begin, end - begin);
    return w;
  }
  void keep(std::string_view whole) {
    text = std::make_shared<const std::string>(whole);
    lines = {0};
    for (size_t at = 0; (at = text->find('\n', at)) != std::string::npos;) lines.push_back(++at);
    if (lines.back() != text->size()) lines.push_back(text->size());
  }
};

// Adds the tree of a YAML text to the document, as its root; setting: of which the text is the value, 0 = none. Error:
// malformed, duplicate keys, too deep.
void parse_into(Params::Document& document, const std::string& text, int setting);

// Replaces, adds or takes out one value, as params.h says of parse_file.
void apply(Params::Document& document, const std::string& setting);

}  // namespace suite
