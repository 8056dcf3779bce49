#include "formats/dirsig/grammar.h"

#include <algorithm>

#include "base/params.h"
#include "formats/xml/xml.h"

namespace suite::dirsig {

namespace {

constexpr size_t kDeepest = 60;
constexpr const char* kSections = "a section begins and ends on lines of its own";

void fill(const XmlElement& from, Item& to) {
  to.name = std::string(from.name());
  to.value = from.text();
  to.where = from.where();
  from.each_attribute([&](std::string_view name, std::string_view value) {
    Item& a = to.children.emplace_back();
    a.name = "@" + std::string(name);
    a.value = std::string(trimmed(value));
    a.where = to.where;
  });
  from.each_child([&](const XmlElement& child) { fill(child, to.children.emplace_back()); });
}

void fill(const Params& from, Item& to) {
  to.where = from.where();
  switch (from.kind()) {
    case Params::Kind::null:
      break;
    case Params::Kind::scalar:
      to.value = from.as_text();
      break;
    case Params::Kind::list:
      for (size_t i = 0; i < from.size(); ++i) {
        Item& child = to.children.emplace_back();
        child.name = "item";
        fill(from[i], child);
      }
      break;
    case Params::Kind::map:
      for (const std::string& key : from.keys()) {
        Item& child = to.children.emplace_back();
        child.name = key;
        fill(from.at(key), child);
      }
  }
}

// Goes through the lines of a text of sections.
class SectionReader {
 public:
  SectionReader(std::string_view text, const std::string& file)
      : text_(std::make_shared<const std::string>(text)), file_(file) {}

  Item run(const std::string& root) {
    Item top;
    top.name = root;
    top.where = {file_, 1, 1, {}, -1};
    open_ = {&top};
    const std::string_view text = *text_;
    for (size_t begin = 0; begin < text.size();) {
      const size_t end = std::min(text.find('\n', begin), text.size());
      ++line_;
      begin_ = begin, length_ = end - begin;
      take(text.substr(begin, end - begin));
      begin = end + 1;
    }
    if (!waiting_.empty()) throw Error(waiting_at_, not_a_line(waiting_), kSections);
    if (open_.size() > 1)
      throw open_.back()->error("the section '" + open_.back()->name + "' has no end", "a line '}' closes it");
    return top;
  }

 private:
  Where here(std::string_view part) const {
    const auto column = part.data() - (text_->data() + begin_);
    size_t length = length_;
    while (length && (*text_)[begin_ + length - 1] == '\r') --length;
    return {file_, line_, static_cast<int>(column) + 1, SourceLine(text_, begin_, length), -1};
  }

  void take(std::string_view line) {
    // A '#' inside of a value belongs to it where no blank stands before it ("part#2.obj").
    for (size_t at = line.find('#'); at != line.npos; at = line.find('#', at + 1))
      if (at == 0 || line[at - 1] == ' ' || line[at - 1] == '\t') {
        line = line.substr(0, at);
        break;
      }
    line = trimmed(line);
    if (line.empty()) return;
    if (line == "}") return close(line);
    // A name whose '{' stands on the next line.
    if (!waiting_.empty()) {
      const std::string_view name = waiting_;
      waiting_ = {};
      if (line.front() != '{') throw Error(waiting_at_, not_a_line(name), kSections);
      return section(name, line.substr(1), waiting_at_);
    }
    const size_t brace = line.find('{'), equals = line.find('=');
    if (equals != line.npos && (brace == line.npos || equals < brace)) return key(line, equals);
    // Tables of digital counts have lines "0:grass".
    if (const size_t colon = line.find(':'); brace == line.npos && colon != line.npos) return key(line, colon);
    if (brace == line.npos) {
      waiting_ = line, waiting_at_ = here(line);
      if (line.find_first_of(" \t/*<>") != line.npos) throw Error(waiting_at_, not_a_line(line), kSections);
      return;
    }
    section(trimmed(line.substr(0, brace)), line.substr(brace + 1), here(line));
  }
  static std::string not_a_line(std::string_view line) {
    return "'" + std::string(line.substr(0, 60)) + "' is neither KEY = VALUE nor SECTION {";
  }

  void key(std::string_view line, size_t equals) {
    Item& item = open_.back()->children.emplace_back();
    item.name = upper_case(trimmed(line.substr(0, equals)));
    item.where = here(line);
    std::string_view value = trimmed(line.substr(equals + 1));
    if (value.size() >= 2 && (value.front() == '"' || value.front() == '\'') && value.back() == value.front())
      value = value.substr(1, value.size() - 2);
    item.value = std::string(value);
    if (item.name.empty()) throw item.error("a value without a key", "KEY = VALUE");
  }

  // rest: what stands behind the '{': nothing, one key, or the end of the section.
  void section(std::string_view name, std::string_view rest, const Where& where) {
    Item& item = open_.back()->children.emplace_back();
    item.name = upper_case(name);
    item.where = where;
    if (item.name.empty()) throw item.error("a section without a name", "NAME {");
    rest = trimmed(rest);
    const bool ends = rest.ends_with('}');
    if (ends) rest = trimmed(rest.substr(0, rest.size() - 1));
    if (rest.find_first_of("{}") != rest.npos)
      throw item.error("more than one section in a line", "a section's content begins on a new line");
    if (open_.size() >= kDeepest) throw item.error(strf("sections nested deeper than %zu", kDeepest));
    open_.push_back(&item);
    const size_t equals = rest.find('=');
    if (equals != rest.npos && rest.find('=', equals + 1) != rest.npos)
      throw item.error("more than one key in a line", "every key stands on a line of its own");
    if (equals != rest.npos)
      key(rest, equals);
    else if (!rest.empty())
      throw item.error("something stands behind the '{'", "a section's content begins on a new line");
    if (ends) open_.pop_back();
  }

  void close(std::string_view line) {
    if (open_.size() == 1) throw Error(here(line), "a '}' without a section", "take it out");
    open_.pop_back();
  }

  std::shared_ptr<const std::string> text_;
  const std::string& file_;
  std::vector<Item*> open_;
  int line_ = 0;
  size_t begin_ = 0, length_ = 0;
  std::string_view waiting_;  // a name that may be a section's
  Where waiting_at_;
};

}  // namespace

Item parse_xml(std::string_view text, const std::string& file) {
  Item root;
  fill(XmlElement::parse(text, file), root);
  return root;
}

Item parse_json(std::string_view text, const std::string& file) {
  const size_t first = text.find_first_not_of(" \t\r\n");
  if (first == text.npos || (text[first] != '[' && text[first] != '{'))
    throw Error(Where{file, 1, 1, {}, -1}, "this is no JSON", "a list or an object is expected");
  Item root;
  root.name = "jsim";
  // Strings of JSON hold no tabs, so that all of them are blanks, which YAML does not take tabs for.
  std::string blanks(text);
  std::replace(blanks.begin(), blanks.end(), '\t', ' ');
  fill(Params::parse_text(blanks, file), root);
  return root;
}

Item parse_sections(std::string_view text, const std::string& file, const std::string& root) {
  if (text.find('\0') != text.npos) throw Error(Where{file, 0, 0, {}, -1}, "is not a text file");
  return SectionReader(text, file).run(root);
}

}  // namespace suite::dirsig
