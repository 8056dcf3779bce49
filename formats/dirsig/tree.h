// Our own YAML on its way out: values that know which line of DIRSIG's files they come from.
#pragma once
#include <array>
#include <deque>
#include <string>
#include <vector>

#include "base/error.h"

namespace suite::dirsig {

struct Tree {
  enum class Kind { scalar, list, map } kind = Kind::map;
  std::string text;  // of a scalar, as YAML reads it
  Where where;
  std::deque<std::pair<std::string, Tree>> entries;  // of a list without keys; references to them stay good

  static Tree number(double value, const Where& where);
  static Tree word(const std::string& value, const Where& where);  // quoted where YAML would read something else
  static Tree flag(bool value, const Where& where);
  static Tree numbers(const std::vector<double>& values, const Where& where);
  static Tree list(const Where& where) { return {Kind::list, {}, where, {}}; }
  static Tree map(const Where& where) { return {Kind::map, {}, where, {}}; }

  Tree& set(const std::string& key, Tree value);  // of a map; replaces
  Tree& push(Tree value);                         // of a list
  Tree* find(const std::string& key);
  Tree& map_at(const std::string& key, const Where& where_new);  // makes an empty one when missing
  Tree& list_at(const std::string& key, const Where& where_new);
  bool empty() const { return kind != Kind::scalar && entries.empty(); }
};

struct MadeText {
  std::string yaml;
  std::vector<Where> origins;  // of each line
};

// One scalar, or one list of scalars, a line. head: comment lines without '#'.
MadeText print(const Tree& tree, const std::vector<std::string>& head);

}  // namespace suite::dirsig
