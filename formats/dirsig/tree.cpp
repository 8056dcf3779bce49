#include "formats/dirsig/tree.h"

#include <algorithm>
#include <charconv>

namespace suite::dirsig {

namespace {

std::string short_number(double value) {
  char buffer[64];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return std::string(buffer, end);
}

// YAML reads these words as something else than themselves, or not at all.
bool plain(const std::string& text) {
  if (text.empty() || text.size() > 60) return false;
  for (const char c : text)
    if (!(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z') && !(c >= '0' && c <= '9') && c != '_' && c != '.' &&
        c != '/' && c != '-')
      return false;
  return text != "null" && text[0] != '-' && text[0] != '.' ? true
                                                            : text.size() > 2 && text[0] == '.' && text[1] == '.';
}

std::string quoted(const std::string& text) {
  if (plain(text)) return text;
  std::string out = "\"";
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += std::string("\\") + c;
    else if (c == '\n')
      out += "\\n";
    else if (c == '\t')
      out += "\\t";
    else if (u < 0x20 || u == 0x7f)
      out += strf("\\x%02x", u);
    else
      out += c;
  }
  return out + "\"";
}

class Printer {
 public:
  explicit Printer(MadeText& to) : to_(to) {}
  void line(const std::string& text, const Where& where) {
    to_.yaml += text + "\n";
    to_.origins.push_back(where);
  }
  static bool flat(const Tree& t) {
    return t.kind == Tree::Kind::list && std::all_of(t.entries.begin(), t.entries.end(), [](const auto& e) {
             return e.second.kind == Tree::Kind::scalar || (flat(e.second) && e.second.entries.size() <= 4);
           });
  }
  static std::string flow(const Tree& t) {
    if (t.kind == Tree::Kind::scalar) return t.text;
    std::string out = "[";
    for (size_t i = 0; i < t.entries.size(); ++i) out += (i ? ", " : "") + flow(t.entries[i].second);
    return out + "]";
  }
  void block(const Tree& t, size_t indent) {
    for (const auto& [key, value] : t.entries) {
      const std::string lead = std::string(indent, ' ') + (t.kind == Tree::Kind::map ? quoted(key) + ":" : "-");
      if (value.kind == Tree::Kind::scalar)
        line(lead + " " + value.text, value.where);
      else if (value.empty())
        line(lead + (value.kind == Tree::Kind::map ? " {}" : " []"), value.where);
      else if (flat(value))
        line(lead + " " + flow(value), value.where);
      else {
        line(lead, value.where);
        block(value, indent + 2);
      }
    }
  }

 private:
  MadeText& to_;
};

}  // namespace

Tree Tree::number(double value, const Where& where) { return {Kind::scalar, short_number(value), where, {}}; }
Tree Tree::word(const std::string& value, const Where& where) { return {Kind::scalar, quoted(value), where, {}}; }
Tree Tree::flag(bool value, const Where& where) { return {Kind::scalar, value ? "true" : "false", where, {}}; }
Tree Tree::numbers(const std::vector<double>& values, const Where& where) {
  Tree t = list(where);
  for (const double v : values) t.push(number(v, where));
  return t;
}

Tree& Tree::set(const std::string& key, Tree value) {
  if (Tree* there = find(key)) return *there = std::move(value);
  entries.emplace_back(key, std::move(value));
  return entries.back().second;
}
Tree& Tree::push(Tree value) {
  entries.emplace_back("", std::move(value));
  return entries.back().second;
}
Tree* Tree::find(const std::string& key) {
  for (auto& [k, v] : entries)
    if (k == key) return &v;
  return nullptr;
}
Tree& Tree::map_at(const std::string& key, const Where& where_new) {
  Tree* there = find(key);
  return there ? *there : set(key, map(where_new));
}
Tree& Tree::list_at(const std::string& key, const Where& where_new) {
  Tree* there = find(key);
  return there ? *there : set(key, list(where_new));
}

MadeText print(const Tree& tree, const std::vector<std::string>& head) {
  MadeText made;
  Printer printer(made);
  for (const std::string& text : head) printer.line("# " + printable(text), tree.where);
  if (tree.empty()) printer.line("{}", tree.where);
  printer.block(tree, 0);
  return made;
}

}  // namespace suite::dirsig
