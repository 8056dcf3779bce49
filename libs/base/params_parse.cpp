// From text to the tree: YAML and strict JSON.
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/files.h"
#include "base/params_document.h"

namespace suite {

namespace {

constexpr int kMaxDepth = 200;
constexpr size_t kMaxNodes = 50'000'000;

// Builds the tree from parser events: unlike a ready-made tree this keeps duplicate keys visible and places exact.
class TreeBuilder : public YAML::EventHandler {
 public:
  using Node = Params::Node;
  explicit TreeBuilder(Params::Document& document, int setting = 0) : document_(document), setting_(setting) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (document_.root) throw Error(at(mark), "a second document starts here", "one document a file");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    leaf(mark, anchor, Params::Kind::null, "", false);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    const bool quoted = tag == "!";
    if (!quoted && (value.empty() || value == "~" || value == "null"))
      leaf(mark, anchor, Params::Kind::null, "", false);
    else
      leaf(mark, anchor, Params::Kind::scalar, value, quoted);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) throw Error(at(mark), "alias to a value that is not complete yet");
    attach(mark, found->second);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, anchor, Params::Kind::list);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, anchor, Params::Kind::map);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    Node* node;
    YAML::anchor_t anchor;
    bool have_key = false;
    std::string key;
    int key_line = 0, key_column = 0;
  };

  int line_of(const YAML::Mark& mark) const { return setting_ ? -setting_ : mark.line + 1; }
  Where at(const YAML::Mark& mark) const { return document_.where(line_of(mark), mark.column + 1); }

  Node* make(const YAML::Mark& mark, Params::Kind kind) {
    if (document_.nodes.size() >= kMaxNodes)
      throw Error(at(mark), "the document is too large", "use a binary or CSV table");
    Node& node = document_.nodes.emplace_back();
    node.kind = kind;
    node.line = line_of(mark);
    node.column = mark.column + 1;
    return &node;
  }
  void leaf(const YAML::Mark& mark, YAML::anchor_t anchor, Params::Kind kind, const std::string& text, bool quoted) {
    if (!stack_.empty() && stack_.back().node->kind == Params::Kind::map && !stack_.back().have_key)
      return set_key(mark, text);
    Node* node = make(mark, kind);
    node->scalar = text;
    node->quoted = quoted;
    if (anchor) anchors_[anchor] = node;
    attach(mark, node);
  }
  void set_key(const YAML::Mark& mark, const std::string& text) {
    Open& top = stack_.back();
    top.have_key = true;
    top.key = text;
    top.key_line = line_of(mark);
    top.key_column = mark.column + 1;
    if (const auto found = top.node->index.find(text); found != top.node->index.end())
      throw Error(at(mark), "duplicate key '" + text + "'",
                  top.key_line < 1 ? "keep one"
                                   : strf("first given in line %d; keep one", top.node->entries[found->second].line));
  }
  void attach(const YAML::Mark& mark, const Node* node) {
    if (stack_.empty()) {
      document_.root = node;
      return;
    }
    Open& top = stack_.back();
    if (top.node->kind == Params::Kind::list) {
      top.node->items.push_back(node);
      return;
    }
    if (!top.have_key) throw Error(at(mark), "a key must be a plain name");
    top.node->index[top.key] = top.node->entries.size();
    top.node->entries.push_back({top.key, top.key_line, top.key_column, node});
    top.have_key = false;
  }
  void open(const YAML::Mark& mark, YAML::anchor_t anchor, Params::Kind kind) {
    if (!stack_.empty() && stack_.back().node->kind == Params::Kind::map && !stack_.back().have_key)
      throw Error(at(mark), "a key must be a plain name");
    // The parser recurses once per level and tells each level here first, so this bounds its stack as well.
    if (stack_.size() >= kMaxDepth) throw Error(at(mark), strf("nested deeper than %d", kMaxDepth));
    stack_.push_back({make(mark, kind), anchor, false, {}, 0, 0});
  }
  void close() {
    const Open done = stack_.back();
    stack_.pop_back();
    if (done.anchor) anchors_[done.anchor] = done.node;
    YAML::Mark mark;
    mark.line = done.node->line - 1;
    mark.column = done.node->column - 1;
    attach(mark, done.node);
  }

  Params::Document& document_;
  int setting_;
  std::vector<Open> stack_;
  std::map<YAML::anchor_t, const Node*> anchors_;
};

// Hands what the JSON parser finds to the builder; nothing has a line.
class JsonEvents {
 public:
  JsonEvents(TreeBuilder& builder, const std::string& file) : builder_(builder), file_(file) {
    mark_.line = mark_.column = -1;
  }
  bool null() { return builder_.OnNull(mark_, 0), true; }
  bool boolean(bool value) { return plain(value ? "true" : "false"); }
  bool number_integer(long long value) { return plain(std::to_string(value)); }
  bool number_unsigned(unsigned long long value) { return plain(std::to_string(value)); }
  bool number_float(double, const std::string& text) { return plain(text); }
  bool string(const std::string& text) { return builder_.OnScalar(mark_, "!", 0, text), true; }
  bool binary(const std::vector<uint8_t>&) { return false; }  // JSON has none
  bool start_object(size_t) { return builder_.OnMapStart(mark_, "", 0, YAML::EmitterStyle::Flow), true; }
  bool key(const std::string& text) { return string(text); }
  bool end_object() { return builder_.OnMapEnd(), true; }
  bool start_array(size_t) { return builder_.OnSequenceStart(mark_, "", 0, YAML::EmitterStyle::Flow), true; }
  bool end_array() { return builder_.OnSequenceEnd(), true; }
  bool parse_error(size_t position, const std::string&, const nlohmann::json::exception&) {
    throw Error(Where{file_, 0, 0, {}, -1}, strf("malformed JSON at character %zu", position));
  }

 private:
  bool plain(const std::string& text) { return builder_.OnScalar(mark_, "?", 0, text), true; }
  TreeBuilder& builder_;
  const std::string& file_;
  YAML::Mark mark_;
};

}  // namespace

void parse_into(Params::Document& document, const std::string& text, int setting) {
  document.root = nullptr;
  try {
    std::istringstream in(text);
    YAML::Parser parser(in);
    TreeBuilder builder(document, setting);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const YAML::Exception& e) {
    const Where at = document.where(setting ? -setting : e.mark.line + 1, e.mark.column + 1);
    const std::string_view line = at.source_line.view();
    if (const size_t tab = line.find('\t'); !setting && tab < line.find_first_not_of(" \t"))
      throw Error(document.where(e.mark.line + 1, static_cast<int>(tab) + 1), "a tab in the indentation",
                  "YAML is indented by spaces");
    throw Error(at, "malformed YAML: " + e.msg);
  }
}

Params Params::parse_file(const std::string& path, std::span<const std::string> settings) {
  const Params file = parse_text(read_text(path, size_t{256} << 20), path);
  for (const std::string& setting : settings) apply(*file.document_, setting);
  return Params(file.document_, file.document_->root);
}

Params Params::parse_text(std::string_view yaml, const std::string& file_name) {
  return parse_made(yaml, file_name, {});
}

Params Params::parse_made(std::string_view yaml, const std::string& file_name, std::vector<Where> origins,
                          std::span<const std::string> settings) {
  auto document = std::make_shared<Document>();
  document->file = file_name;
  document->origins = std::move(origins);
  document->keep(yaml);
  const std::string& text = *document->text;
  if (const size_t zero = text.find('\0'); zero != std::string::npos)
    throw Error(Where{file_name, 0, 0, {}, static_cast<long long>(zero)}, "is not a text file",
                "YAML or JSON is expected");
  if (const size_t good = utf8_bytes(text); good < text.size()) {
    const auto line = std::upper_bound(document->lines.begin(), document->lines.end() - 1, good);
    throw Error(
        document->where(static_cast<int>(line - document->lines.begin()), static_cast<int>(good - line[-1]) + 1),
        "this is not UTF-8", "save the text as UTF-8");
  }
  parse_into(*document, text, 0);
  if (!document->root) throw Error(Where{file_name, 0, 0, {}, -1}, "is empty", "a YAML map is expected");
  for (const std::string& setting : settings) apply(*document, setting);
  const Node* root = document->root;
  return Params(std::move(document), root);
}

Params Params::parse_json(std::string_view json, const std::string& file_name) {
  auto document = std::make_shared<Document>();
  document->file = file_name;
  TreeBuilder builder(*document);
  JsonEvents events(builder, file_name);
  nlohmann::json::sax_parse(json.begin(), json.end(), &events);
  const Node* root = document->root;
  return Params(std::move(document), root);
}

}  // namespace suite
