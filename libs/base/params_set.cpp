// Settings: values of a document that are replaced from outside, one path each.
#include <algorithm>

#include "base/params_document.h"

namespace suite {

namespace {

using Node = Params::Node;

// One setting on its way through the tree. Nodes on the way are copied, because aliases may share them.
class Setting {
 public:
  Setting(Params::Document& document, const std::string& text)
      : document_(document), text_(text), path_(std::string_view(text_).substr(0, text.find('='))) {}

  // A copy of `node` in which `value` stands at the rest of the path from `begin` on; null takes it out.
  const Node* put(const Node* node, size_t begin, const Node* value) {
    Node& copy = document_.nodes.emplace_back(*node);
    const std::string_view rest = path_.substr(begin);
    if (rest.empty()) throw fault(begin, "the path ends with a dot", "leave it out");
    if (copy.kind == Params::Kind::map) return put_key(copy, begin, value);
    if (copy.kind == Params::Kind::list) return put_item(copy, begin, value);
    throw fault(begin, "'" + std::string(path_.substr(0, begin - (begin > 0))) + "' is a single value, not a map",
                "the path must end here");
  }

 private:
  Error fault(size_t at, const std::string& what, const std::string& hint) const {
    return Error(Where{"--set " + std::string(path_), 0, static_cast<int>(at) + 1, text_, -1}, what, hint);
  }
  // Is `name` the first step of the rest? Names may have dots themselves.
  static bool leads(std::string_view rest, std::string_view name) {
    return rest.starts_with(name) && (rest.size() == name.size() || rest[name.size()] == '.');
  }
  static std::string first_step(std::string_view rest) { return std::string(rest.substr(0, rest.find('.'))); }

  // A name that is near, else how a map that is not there yet is written as one value.
  std::string new_map_hint(size_t begin, std::span<const std::string> known) const {
    const std::string_view rest = path_.substr(begin);
    const std::string step = first_step(rest);
    if (rest.size() <= step.size() + 1 || !nearest_name(step, known).empty()) return name_hint(step, known);
    std::string inner(rest.substr(step.size() + 1)), ends = "}";
    for (size_t dot = inner.find('.'); dot != std::string::npos; dot = inner.find('.', dot + 3), ends += '}')
      inner.replace(dot, 1, ": {");
    return "write --set '" + std::string(path_.substr(0, begin)) + step + "={" + inner + ": " +
           text_.substr(path_.size() + 1) + ends + "'";
  }

  const Node* put_key(Node& map, size_t begin, const Node* value) {
    const std::string_view rest = path_.substr(begin);
    Node::Entry* longest = nullptr;
    std::vector<std::string> known;
    for (Node::Entry& e : map.entries) {
      known.push_back(e.key);
      if (leads(rest, e.key) && (!longest || e.key.size() > longest->key.size())) longest = &e;
    }
    if (longest && longest->key.size() < rest.size()) {
      longest->value = put(longest->value, begin + longest->key.size() + 1, value);
    } else if (value) {
      if (!longest && rest.find('.') != std::string_view::npos)
        throw fault(begin, "there is no '" + first_step(rest) + "' here", new_map_hint(begin, known));
      if (!longest) {
        map.index[std::string(rest)] = map.entries.size();
        longest = &map.entries.emplace_back();
        longest->key = rest;
      }
      longest->line = -static_cast<int>(document_.settings.size()), longest->column = static_cast<int>(begin) + 1;
      longest->value = value;
    } else {
      if (!longest) throw fault(begin, "there is no '" + std::string(rest) + "' to take out", name_hint(rest, known));
      map.entries.erase(map.entries.begin() + (longest - map.entries.data()));
      map.index.clear();
      for (size_t i = 0; i < map.entries.size(); ++i) map.index[map.entries[i].key] = i;
    }
    return &map;
  }

  const Node* put_item(Node& list, size_t begin, const Node* value) {
    const std::string_view rest = path_.substr(begin);
    const std::string step = first_step(rest);
    if (list.items.empty()) throw fault(begin, "this list is empty", "give the whole list");
    size_t at = list.items.size(), length = step.size();
    std::vector<std::string> known;
    for (size_t i = 0; i < list.items.size(); ++i)
      if (std::to_string(i) == step) at = i;
    for (size_t i = 0; i < list.items.size(); ++i) {
      const auto name = list.items[i]->index.find("name");
      if (name == list.items[i]->index.end()) continue;
      known.push_back(list.items[i]->entries[name->second].value->scalar);
      if (leads(rest, known.back())) at = i, length = known.back().size();
    }
    if (at == list.items.size())
      throw fault(begin, "there is no item '" + step + "' in this list",
                  strf("its items are 0 to %zu", list.items.size() - 1) +
                      (known.empty() ? "" : ", or by name; " + name_hint(step, known)));
    if (length < rest.size())
      list.items[at] = put(list.items[at], begin + length + 1, value);
    else if (value)
      list.items[at] = value;
    else
      throw fault(begin, "an item cannot be taken out of a list", "give the whole list");
    return &list;
  }

  Params::Document& document_;
  const std::string text_;
  const std::string_view path_;
};

}  // namespace

void apply(Params::Document& document, const std::string& setting) {
  const size_t equals = setting.find('=');
  const Where where{"--set " + setting.substr(0, equals), 0, 0, {}, -1};
  if (equals == std::string::npos || equals == 0)
    throw Error(where, "a setting without a path and a value", "PATH=VALUE, such as sensors.0.paths=64");
  if (utf8_bytes(setting) < setting.size() || setting.find('\0') != std::string::npos)
    throw Error(where, "this is not UTF-8");
  if (setting.find_first_not_of(" \t\n\r", equals + 1) == std::string::npos)
    throw Error(where, "a setting without a value", "null takes a key out, \"\" is an empty text");
  document.settings.push_back(setting);
  const Node* before = document.root;
  // Spaces stand for the path, so that places in the value are places in the setting.
  parse_into(document, std::string(equals + 1, ' ') + setting.substr(equals + 1),
             static_cast<int>(document.settings.size()));
  const Node* value = document.root;
  if (value && value->kind == Params::Kind::null) value = nullptr;
  document.root = Setting(document, setting).put(before, 0, value);
}

}  // namespace suite
