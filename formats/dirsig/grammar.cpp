#include "formats/dirsig/grammar.h"

#include <algorithm>

#include "base/params.h"
#include "formats/xml/xml.h"

namespace suite::dirsig {

namespace {

constexpr size_t kDeepest = 60;

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
    const size_t brace = line.find('{'), equals = line.find('=');
    if (equals != line.npos && (brace == line.npos || equals < brace)) return key(line, equals);
    // Tables of digital counts have lines "0:grass".
    if (const size_t colon = line.find(':'); brace == line.npos && colon != line.npos) return key(line, colon);
    if (brace == line.npos)
      throw Error(here(line), "'" + std::string(line.substr(0, 60)) + "' is neither KEY = VALUE nor SECTION {",
                  "a section begins and ends on lines of its own");
    section(line, brace);
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

  void section(std::string_view line, size_t brace) {
    Item& item = open_.back()->children.emplace_back();
    item.name = upper_case(trimmed(line.substr(0, brace)));
    item.where = here(line);
    if (item.name.empty()) throw item.error("a section without a name", "NAME {");
    const std::string_view rest = trimmed(line.substr(brace + 1));
    if (rest == "}") return;
    if (!rest.empty()) throw item.error("something stands behind the '{'", "a section's content begins on a new line");
    if (open_.size() >= kDeepest) throw item.error(strf("sections nested deeper than %zu", kDeepest));
    open_.push_back(&item);
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
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  return SectionReader(text, file).run(root);
}

}  // namespace suite::dirsig
