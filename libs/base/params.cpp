#include "base/params.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "base/files.h"

namespace suite {

struct Params::Node {
  struct Entry {
    std::string key;
    int line, column;
    const Node* value;
    mutable bool read = false;
  };
  Kind kind = Kind::null;
  int line = 0, column = 0;
  std::string scalar;
  bool quoted = false;
  std::vector<const Node*> items;
  std::vector<Entry> entries;
  std::map<std::string, size_t, std::less<>> index;  // key -> entry
  mutable std::set<std::string, std::less<>> asked;  // names asked of this map: the candidates for "did you mean"
};

struct Params::Document {
  std::string file;
  std::shared_ptr<const std::string> text;  // the whole, which every place shares
  std::vector<size_t> lines;                // where each begins, and the end
  std::deque<Node> nodes;
  const Node* root = nullptr;

  Where where(int line, int column) const {
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

namespace {

constexpr size_t kLongestName = 48;  // five in a row, with an ending, are a file name
constexpr const char* kGoodName = "1 to 48 bytes without '/' and control characters, not beginning with a dot";
constexpr int kMaxDepth = 200;
constexpr size_t kMaxNodes = 50'000'000;

// Builds the tree from parser events: unlike a ready-made tree this keeps duplicate keys visible and places exact.
class TreeBuilder : public YAML::EventHandler {
 public:
  using Node = Params::Node;
  explicit TreeBuilder(Params::Document& document) : document_(document) {}

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

  Where at(const YAML::Mark& mark) const { return document_.where(mark.line + 1, mark.column + 1); }

  Node* make(const YAML::Mark& mark, Params::Kind kind) {
    if (document_.nodes.size() >= kMaxNodes)
      throw Error(at(mark), "the document is too large", "use a binary or CSV table");
    Node& node = document_.nodes.emplace_back();
    node.kind = kind;
    node.line = mark.line + 1;
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
    top.key_line = mark.line + 1;
    top.key_column = mark.column + 1;
    if (const auto found = top.node->index.find(text); found != top.node->index.end())
      throw Error(
          at(mark), "duplicate key '" + text + "'",
          mark.line < 0 ? "keep one" : strf("first given in line %d; keep one", top.node->entries[found->second].line));
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

const char* kind_name(Params::Kind kind) {
  switch (kind) {
    case Params::Kind::null:
      return "nothing";
    case Params::Kind::scalar:
      return "a single value";
    case Params::Kind::list:
      return "a list";
    case Params::Kind::map:
      return "a map of keys";
  }
  return "?";
}

bool parse_double(const std::string& text, double& value) {
  const char* begin = text.data();
  const char* end = begin + text.size();
  if (begin != end && *begin == '+') ++begin;
  const auto [stop, code] = std::from_chars(begin, end, value);
  return code == std::errc() && stop == end && std::isfinite(value);
}

}  // namespace

std::string fault_of_name(const std::string& name) {
  if (name.empty()) return "is empty";
  if (name.size() > kLongestName)
    return "'" + name.substr(0, utf8_bytes(name.substr(0, kLongestName))) + "...' " +
           strf("has %zu bytes", name.size());
  if (name.front() == '.') return "'" + name + "' begins with a dot";
  if (name.find('/') != std::string::npos) return "'" + name + "' has a '/'";
  if (printable(name) != name) return "'" + name + "' has control characters";
  return {};
}

Params Params::parse_file(const std::string& path) { return parse_text(read_text(path, size_t{256} << 20), path); }

Params Params::parse_text(std::string_view yaml, const std::string& file_name) {
  auto document = std::make_shared<Document>();
  document->file = file_name;
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
  try {
    std::istringstream in(text);
    YAML::Parser parser(in);
    TreeBuilder builder(*document);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const YAML::Exception& e) {
    const Where at = document->where(e.mark.line + 1, e.mark.column + 1);
    const std::string_view line = at.source_line.view();
    if (const size_t tab = line.find('\t'); tab < line.find_first_not_of(" \t"))
      throw Error(document->where(e.mark.line + 1, static_cast<int>(tab) + 1), "a tab in the indentation",
                  "YAML is indented by spaces");
    throw Error(at, "malformed YAML: " + e.msg);
  }
  if (!document->root) throw Error(Where{file_name, 0, 0, {}, -1}, "is empty", "a YAML map is expected");
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

Params::Kind Params::kind() const { return node_->kind; }
Where Params::where() const { return document_->where(node_->line, node_->column); }
Where Params::where(std::string_view key) const {
  const auto found = node_->index.find(key);
  if (found == node_->index.end()) return where();
  const Node::Entry& entry = node_->entries[found->second];
  return document_->where(entry.line, entry.column);
}
const std::string& Params::file() const { return document_->file; }

Error Params::error(std::string what, std::string hint, std::string code) const {
  return Error(where(), std::move(what), std::move(hint), std::move(code));
}

std::optional<Params> Params::find(std::string_view key) const {
  if (node_->kind != Kind::map)
    throw error(strf("expected a map with the key '%.*s', found %s", static_cast<int>(key.size()), key.data(),
                     kind_name(node_->kind)));
  node_->asked.emplace(key);
  const auto found = node_->index.find(key);
  if (found == node_->index.end()) return std::nullopt;
  const Node::Entry& entry = node_->entries[found->second];
  entry.read = true;
  return Params(document_, entry.value);
}

bool Params::has(std::string_view key) const {
  if (node_->kind != Kind::map) return false;
  node_->asked.emplace(key);
  return node_->index.find(key) != node_->index.end();
}

std::optional<Error> Params::misspelt(std::string_view key) const {
  std::vector<std::string> present;
  for (const Node::Entry& e : node_->entries)
    if (!e.read) present.push_back(e.key);
  const std::string near = nearest_name(key, present);
  if (near.empty()) return std::nullopt;
  return Error(where(near), "unknown key '" + near + "'", "did you mean '" + std::string(key) + "', which is missing?");
}

Params Params::at(std::string_view key) const {
  if (auto found = find(key)) return *found;
  if (const auto near = misspelt(key)) throw *near;
  throw error("the key '" + std::string(key) + "' is missing");
}

std::vector<std::string> Params::keys() const {
  if (node_->kind != Kind::map) throw error(strf("expected a map, found %s", kind_name(node_->kind)));
  std::vector<std::string> names;
  for (const Node::Entry& e : node_->entries) names.push_back(e.key);
  return names;
}

size_t Params::size() const { return node_->kind == Kind::map ? node_->entries.size() : node_->items.size(); }
Params Params::operator[](size_t i) const {
  if (node_->kind != Kind::list) throw error(strf("expected a list, found %s", kind_name(node_->kind)));
  if (i >= node_->items.size()) throw error(strf("expected at least %zu items, found %zu", i + 1, node_->items.size()));
  return Params(document_, node_->items[i]);
}
std::vector<Params> Params::items() const {
  std::vector<Params> all;
  if (node_->kind == Kind::scalar || node_->kind == Kind::map) all.push_back(*this);
  for (const Node* item : node_->items) all.push_back(Params(document_, item));
  return all;
}

std::string Params::as_text() const {
  if (node_->kind != Kind::scalar) throw error(strf("expected a text, found %s", kind_name(node_->kind)));
  for (const char c : node_->scalar)
    if ((static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' && c != '\r') || c == 0x7f)
      throw error("a text with the control character " + printable({&c, 1}), "leave it out");
  return node_->scalar;
}
std::string Params::as_name() const {
  const std::string name = as_text();
  if (const std::string fault = fault_of_name(name); !fault.empty())
    throw error("the name " + fault + "; it becomes part of file names", kGoodName);
  return name;
}
double Params::as_number() const {
  double value = 0;
  if (node_->kind != Kind::scalar || !parse_double(node_->scalar, value))
    throw error(strf("expected a finite number, found %s", node_->kind == Kind::scalar
                                                               ? ("'" + node_->scalar.substr(0, 60) + "'").c_str()
                                                               : kind_name(node_->kind)));
  if (std::fabs(value) > kLargestNumber)
    throw error(strf("%g is too large", value), strf("give a number of at most %g in size", kLargestNumber));
  return value;
}
double Params::as_number_in(double low, double high, const char* unit) const {
  const double value = as_number();
  if (!(value >= low && value <= high))
    throw error(strf("%g is outside the valid range", value), strf("give a value from %g to %g %s", low, high, unit));
  return value;
}
long long Params::as_integer(long long low, long long high) const {
  const double value = as_number();
  if (value != std::floor(value)) throw error("expected a whole number, found " + node_->scalar);
  const auto outside = [&] {
    return error(node_->scalar + " is outside the valid range",
                 strf("give a whole number from %lld to %lld", low, high));
  };
  // Digits alone are taken exactly; "1e6" goes through a double, which is exact up to 2^53.
  long long whole = 0;
  const char* end = node_->scalar.data() + node_->scalar.size();
  const auto [stop, code] =
      std::from_chars(node_->scalar.data() + (node_->scalar.starts_with('+') ? 1 : 0), end, whole);
  if (code != std::errc() || stop != end) {
    if (!(std::fabs(value) <= 0x1p53)) throw outside();
    whole = static_cast<long long>(value);
  }
  if (whole < low || whole > high) throw outside();
  return whole;
}
bool Params::as_bool() const {
  const std::string text = node_->kind == Kind::scalar ? node_->scalar : "";
  if (text == "true" || text == "yes" || text == "on") return true;
  if (text == "false" || text == "no" || text == "off") return false;
  throw error("expected true or false", {});
}
size_t Params::as_choice(std::initializer_list<const char*> names) const {
  const std::string text = as_text();
  std::vector<std::string> known(names.begin(), names.end());
  for (size_t i = 0; i < known.size(); ++i)
    if (known[i] == text) return i;
  throw error("'" + text + "' is none of the choices here", name_hint(text, known));
}
std::vector<double> Params::as_numbers() const {
  std::vector<double> values;
  if (node_->kind != Kind::list) throw error(strf("expected a list of numbers, found %s", kind_name(node_->kind)));
  for (const Params& item : items()) values.push_back(item.as_number());
  return values;
}
std::array<double, 3> Params::as_vec3() const {
  const std::vector<double> v = as_numbers();
  if (v.size() != 3) throw error(strf("expected three numbers, found %zu", v.size()));
  return {v[0], v[1], v[2]};
}
std::array<double, 3> Params::as_direction() const {
  const std::array<double, 3> v = as_vec3();
  const double largest = std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});
  if (!(largest >= 1 / kLargestNumber)) throw error("a direction of no length", "three numbers, not all 0");
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  return {v[0] / length, v[1] / length, v[2] / length};
}
std::string Params::as_path() const { return resolve_path(file(), as_text()); }

std::string Params::text(std::string_view key, const std::string& otherwise) const {
  const auto found = find(key);
  return found ? found->as_text() : otherwise;
}
std::string Params::name(std::string_view key, const std::string& otherwise) const {
  const auto found = find(key);
  return found ? found->as_name() : otherwise;
}
double Params::number(std::string_view key, double otherwise) const {
  const auto found = find(key);
  return found ? found->as_number() : otherwise;
}
double Params::number_in(std::string_view key, double low, double high, const char* unit) const {
  return at(key).as_number_in(low, high, unit);
}
double Params::number_in(std::string_view key, double low, double high, const char* unit, double otherwise) const {
  const auto found = find(key);
  return found ? found->as_number_in(low, high, unit) : otherwise;
}
long long Params::integer(std::string_view key, long long low, long long high, long long otherwise) const {
  const auto found = find(key);
  return found ? found->as_integer(low, high) : otherwise;
}
bool Params::boolean(std::string_view key, bool otherwise) const {
  const auto found = find(key);
  return found ? found->as_bool() : otherwise;
}

namespace {
// Visits each node once, however many aliases lead to it.
template <class Visit>
void walk(const Params::Node* node, std::set<const Params::Node*>& seen, const Visit& visit) {
  if (!seen.insert(node).second) return;
  visit(node);
  for (const Params::Node* item : node->items) walk(item, seen, visit);
  for (const Params::Node::Entry& e : node->entries)
    if (e.read) walk(e.value, seen, visit);
}
}  // namespace

std::vector<Error> Params::unread() const {
  std::vector<Error> found;
  std::set<const Node*> seen;
  walk(node_, seen, [&](const Node* node) {
    const std::vector<std::string> asked(node->asked.begin(), node->asked.end());
    for (const Node::Entry& e : node->entries)
      if (!e.read)
        found.emplace_back(document_->where(e.line, e.column), "unknown key '" + e.key + "'", name_hint(e.key, asked));
  });
  return found;
}
void Params::reject_unread() const {
  const std::vector<Error> found = unread();
  if (!found.empty()) throw found.front();
}
void Params::mark_read() const {
  std::vector<const Node*> todo{node_};
  std::set<const Node*> seen;
  while (!todo.empty()) {
    const Node* node = todo.back();
    todo.pop_back();
    if (!seen.insert(node).second) continue;
    for (const Node* item : node->items) todo.push_back(item);
    for (const Node::Entry& e : node->entries) e.read = true, todo.push_back(e.value);
  }
}

}  // namespace suite
