// Based on: G. Turk, "The PLY Polygon File Format", Stanford University, 1994.
#include "formats/ply/header.h"

#include <charconv>

#include "base/error.h"

namespace suite::ply {

namespace {

constexpr size_t kLongestHeader = size_t{1} << 20, kMostProperties = 1000;

struct TypeName {
  const char* name;
  Type type;
};
constexpr TypeName kTypes[] = {
    {"char", Type::int8},     {"int8", Type::int8},       {"uchar", Type::uint8},    {"uint8", Type::uint8},
    {"short", Type::int16},   {"int16", Type::int16},     {"ushort", Type::uint16},  {"uint16", Type::uint16},
    {"int", Type::int32},     {"int32", Type::int32},     {"uint", Type::uint32},    {"uint32", Type::uint32},
    {"float", Type::float32}, {"float32", Type::float32}, {"double", Type::float64}, {"float64", Type::float64}};

class Lines {
 public:
  Lines(std::string_view text, const std::string& file) : text_(text), file_(file) {}
  // The words of the next line. Error at the end of the text.
  std::vector<std::string_view> next() {
    if (at_ >= text_.size() || at_ > kLongestHeader) throw fault("the header has no 'end_header'");
    size_t end = text_.find('\n', at_);
    const size_t cr = text_.substr(at_, end - at_).find('\r');
    if (cr != text_.npos) end = at_ + cr;
    if (end == text_.npos) end = text_.size();
    line_ = text_.substr(at_, end - at_);
    at_ = std::min(text_.size(), end + (text_.substr(end, 2) == "\r\n" ? 2 : 1));
    ++number_;
    std::vector<std::string_view> words;
    for (size_t i = 0; i < line_.size();) {
      const size_t first = line_.find_first_not_of(" \t", i);
      if (first == line_.npos) break;
      i = std::min(line_.find_first_of(" \t", first), line_.size());
      words.push_back(line_.substr(first, i - first));
    }
    return words;
  }
  Error fault(const std::string& what, const std::string& hint = {}) const {
    return {Where{file_, number_, 1, line_.substr(0, 200), -1}, what, hint};
  }
  size_t position() const { return at_; }
  int number() const { return number_; }

 private:
  std::string_view text_, line_;
  const std::string& file_;
  size_t at_ = 0;
  int number_ = 0;
};

Type type_of(std::string_view word, const Lines& lines) {
  for (const TypeName& t : kTypes)
    if (word == t.name) return t.type;
  std::vector<std::string> known;
  for (const TypeName& t : kTypes) known.emplace_back(t.name);
  throw lines.fault("unknown type '" + printable(word.substr(0, 40)) + "'", name_hint(word, known));
}

Property property_of(const std::vector<std::string_view>& w, const Lines& lines) {
  Property p;
  p.list = w.size() > 1 && w[1] == "list";
  if (w.size() != (p.list ? 5 : 3)) throw lines.fault("a property is 'TYPE NAME' or 'list TYPE TYPE NAME'");
  if (p.list) {
    p.count_type = type_of(w[2], lines);
    if (p.count_type == Type::float32 || p.count_type == Type::float64)
      throw lines.fault("a list is counted by whole numbers");
  }
  p.type = type_of(w[w.size() - 2], lines);
  p.name = std::string(w.back());
  return p;
}

Element element_of(const std::vector<std::string_view>& w, const Lines& lines) {
  if (w.size() != 3) throw lines.fault("an element is 'element NAME COUNT'");
  Element e;
  e.name = std::string(w[1]);
  const auto [end, code] = std::from_chars(w[2].data(), w[2].data() + w[2].size(), e.count);
  if (code != std::errc() || end != w[2].data() + w[2].size())
    throw lines.fault("'" + printable(w[2].substr(0, 40)) + "' is no count");
  return e;
}

}  // namespace

size_t size_of(Type type) {
  constexpr size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<size_t>(type)];
}

int Element::find(std::initializer_list<const char*> names) const {
  for (size_t k = 0; k < properties.size(); ++k)
    for (const char* known : names)
      if (properties[k].name == known) return static_cast<int>(k);
  return -1;
}

Header header_of(std::string_view text, const std::string& file) {
  Lines lines(text, file);
  if (text.substr(0, 3) != "ply") throw Error(Where{file, 0, 0, {}, 0}, "is no PLY file", "it begins with 'ply'");
  lines.next();
  Header header;
  bool has_format = false;
  for (;;) {
    const std::vector<std::string_view> w = lines.next();
    if (w.empty() || w[0] == "comment" || w[0] == "obj_info") continue;
    if (w[0] == "end_header") break;
    if (w[0] == "format") {
      if (w.size() != 3 || w[2] != "1.0") throw lines.fault("a format is 'format KIND 1.0'");
      if (w[1] != "ascii" && w[1] != "binary_little_endian" && w[1] != "binary_big_endian")
        throw lines.fault("unknown format '" + printable(w[1].substr(0, 40)) + "'",
                          "ascii, binary_little_endian or binary_big_endian");
      header.format = w[1] == "ascii"                  ? Header::Format::ascii
                      : w[1] == "binary_little_endian" ? Header::Format::little
                                                       : Header::Format::big;
      has_format = true;
    } else if (w[0] == "element") {
      header.elements.push_back(element_of(w, lines));
    } else if (w[0] == "property") {
      if (header.elements.empty()) throw lines.fault("a property before the first element");
      std::vector<Property>& to = header.elements.back().properties;
      if (to.size() >= kMostProperties) throw lines.fault("more than 1000 properties of one element");
      to.push_back(property_of(w, lines));
    } else {
      throw lines.fault("unknown statement '" + printable(w[0].substr(0, 40)) + "'",
                        "format, element, property, comment, obj_info or end_header");
    }
  }
  if (!has_format) throw lines.fault("the header has no 'format'");
  header.bytes = lines.position(), header.lines = lines.number();
  return header;
}

}  // namespace suite::ply
