#include <algorithm>
#include <pugixml.hpp>

#include "formats/xml/xml.h"

namespace suite {

namespace {

constexpr int kDeepest = 200;
// Of a line, kept for the caret under a fault.
constexpr size_t kLongestLine = 200;

pugi::xml_node node_of(void* node) { return pugi::xml_node(static_cast<pugi::xml_node_struct*>(node)); }

}  // namespace

struct XmlElement::Document {
  std::string file;
  std::shared_ptr<const std::string> text;
  std::vector<size_t> ends;  // of lines
  pugi::xml_document xml;

  Where place(std::ptrdiff_t offset) const {
    if (offset < 0) return {file, 0, 0, {}, -1};
    const size_t at = std::min(static_cast<size_t>(offset), text->size());
    const auto line = static_cast<size_t>(std::lower_bound(ends.begin(), ends.end(), at) - ends.begin());
    const size_t from = line ? ends[line - 1] + 1 : 0;
    const size_t to = line < ends.size() ? ends[line] : text->size();
    return {file, static_cast<int>(line) + 1, static_cast<int>(at - from) + 1,
            SourceLine(text, from, std::min(to - from, kLongestLine)), -1};
  }
};

XmlElement XmlElement::parse(std::string_view text, const std::string& file_name) {
  auto document = std::make_shared<Document>();
  document->file = file_name;
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  document->text = std::make_shared<const std::string>(text);
  for (size_t at = text.find('\n'); at != text.npos; at = text.find('\n', at + 1)) document->ends.push_back(at);
  if (const size_t good = utf8_bytes(text); good < text.size())
    throw Error(document->place(static_cast<std::ptrdiff_t>(good)), "this is not UTF-8", "save the text as UTF-8");
  // Of a file that nests too deeply nothing is built, for what reads the tree goes down it by calls.
  int depth = 0;
  for (size_t at = 0; at + 1 < text.size(); ++at) {
    if (text.compare(at, 9, "<![CDATA[") == 0)
      at = std::min(text.find("]]>", at), text.size());
    else if (text.compare(at, 4, "<!--") == 0)
      at = std::min(text.find("-->", at), text.size());
    else if (text[at] == '<' && text[at + 1] == '/')
      --depth;
    else if (text[at] == '<' && text[at + 1] != '?' && text[at + 1] != '!')
      ++depth;
    else if (text[at] == '/' && text[at + 1] == '>')
      --depth;
    if (depth > kDeepest)
      throw Error(document->place(static_cast<std::ptrdiff_t>(at)), strf("nested deeper than %d", kDeepest));
  }
  const pugi::xml_parse_result parsed =
      document->xml.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!parsed) throw Error(document->place(parsed.offset), std::string("this is no XML: ") + parsed.description());
  const pugi::xml_node root = document->xml.document_element();
  if (!root) throw Error({file_name, 0, 0, {}, -1}, "there is no XML element in it");
  return XmlElement(document, root.internal_object());
}

std::string_view XmlElement::name() const { return node_of(node_).name(); }

std::string XmlElement::text() const {
  std::string all;
  for (const pugi::xml_node part : node_of(node_).children())
    if (part.type() == pugi::node_pcdata || part.type() == pugi::node_cdata) all += part.value();
  const size_t first = all.find_first_not_of(" \t\r\n"), last = all.find_last_not_of(" \t\r\n");
  return first == all.npos ? std::string() : all.substr(first, last - first + 1);
}

std::optional<std::string> XmlElement::attribute(const char* name) const {
  const pugi::xml_attribute found = node_of(node_).attribute(name);
  return found ? std::optional<std::string>(found.value()) : std::nullopt;
}

void XmlElement::each_attribute(const std::function<void(std::string_view, std::string_view)>& visit) const {
  for (const pugi::xml_attribute a : node_of(node_).attributes()) visit(a.name(), a.value());
}

void XmlElement::each_child(const std::function<void(const XmlElement&)>& visit) const {
  for (const pugi::xml_node child : node_of(node_).children())
    if (child.type() == pugi::node_element) visit(XmlElement(document_, child.internal_object()));
}

void XmlElement::each_child(const char* name, const std::function<void(const XmlElement&)>& visit) const {
  for (const pugi::xml_node child : node_of(node_).children(name))
    visit(XmlElement(document_, child.internal_object()));
}

Where XmlElement::where() const { return document_->place(node_of(node_).offset_debug()); }

}  // namespace suite
