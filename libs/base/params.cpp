#include "base/params.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/files.h"
#include "base/params_document.h"
#include "base/renamed.h"
#include "base/required.h"

namespace suite {

namespace {

constexpr size_t kLongestName = 48;  // five in a row, with an ending, are a file name
constexpr const char* kGoodName = "1 to 48 bytes without '/' and control characters, not beginning with a dot";
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

// What the ending of a key says of its unit, in words; empty where it says nothing.
std::string unit_of(std::string_view key) {
  static constexpr std::pair<std::string_view, const char*> kUnits[] = {
      {"_w_m2_k", "watt per square metre and kelvin"},
      {"_j_m3_k", "joule per cubic metre and kelvin"},
      {"_j_kg_k", "joule per kilogram and kelvin"},
      {"_w_m_k", "watt per metre and kelvin"},
      {"_w_m2", "watt per square metre"},
      {"_kg_m3", "kilogram per cubic metre"},
      {"_g_m3", "gram per cubic metre"},
      {"_deg_s", "degree per second"},
      {"_m_s", "metre per second"},
      {"_deg", "degree"},
      {"_urad", "microradian"},
      {"_mrad", "milliradian"},
      {"_rad", "radian"},
      {"_percent", "percent"},
      {"_ppm", "parts per million"},
      {"_hpa", "hectopascal"},
      {"_pa", "pascal"},
      {"_hz", "hertz"},
      {"_nm", "nanometre"},
      {"_um", "micrometre"},
      {"_mm", "millimetre"},
      {"_cm", "centimetre"},
      {"_km", "kilometre"},
      {"_m2", "square metre"},
      {"_m3", "cubic metre"},
      {"_sr", "steradian"},
      {"_du", "Dobson unit"},
      {"_ms", "millisecond"},
      {"_us", "microsecond"},
      {"_h", "hour"},
      {"_m", "metre"},
      {"_s", "second"},
      {"_k", "kelvin"},
  };
  for (const auto& [ending, unit] : kUnits)  // the longest first
    if (key.ends_with(ending)) return unit;
  return {};
}

// Refuses to read a key that is not there; hint: what would be right.
void need(const Params& p, const Params::Node* node, const std::string& hint = {}) {
  if (node->missing.empty()) return;
  const std::string unit = unit_of(node->missing);
  throw p.error("the key '" + node->missing + "'" + (unit.empty() ? "" : " (" + unit + ")") + " is missing", hint);
}

// The entry of a key, which may have an old name of it (renamed.h); null where there is none. Error: both are given.
const Params::Node::Entry* entry_of(const Params::Document& document, const Params::Node& node, std::string_view key) {
  const auto named = [&](std::string_view name) {
    const auto found = node.index.find(name);
    return found == node.index.end() ? nullptr : &node.entries[found->second];
  };
  const Params::Node::Entry* entry = named(key);
  for (const RenamedName* row : old_names_of_key(key)) {
    const Params::Node::Entry* old = named(row->old_name);
    if (!old) continue;
    const Where place = document.where(old->line, old->column);
    if (entry) throw both_given(*row, place, document.where(entry->line, entry->column));
    if (document.text) note_renamed(*row, place);  // without a text a program wrote it: nobody can mend that
    entry = old;
  }
  return entry;
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

Params::Kind Params::kind() const {
  need(*this, node_);
  return node_->kind;
}
Where Params::where() const { return document_->where(node_->line, node_->column); }
Where Params::where(std::string_view key) const {
  const Node::Entry* entry = entry_of(*document_, *node_, key);
  return entry ? document_->where(entry->line, entry->column) : where();
}
const std::string& Params::file() const { return document_->file; }

Error Params::error(std::string what, std::string hint, std::string code) const {
  return Error(where(), std::move(what), std::move(hint), std::move(code));
}

std::optional<Params> Params::find(std::string_view key) const {
  need(*this, node_);
  if (node_->kind != Kind::map)
    throw error(strf("expected a map with the key '%.*s', found %s", static_cast<int>(key.size()), key.data(),
                     kind_name(node_->kind)));
  node_->asked.emplace(key);
  const Node::Entry* entry = entry_of(*document_, *node_, key);
  if (!entry) return std::nullopt;
  entry->read = true;
  return Params(document_, entry->value);
}

bool Params::has(std::string_view key) const {
  need(*this, node_);
  if (node_->kind != Kind::map) return false;
  node_->asked.emplace(key);
  return entry_of(*document_, *node_, key) != nullptr;
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
  // Told where it is read, which knows what it may be.
  Node gone;
  gone.line = node_->line, gone.column = node_->column, gone.missing = key;
  return Params(document_, &document_->nodes.emplace_back(std::move(gone)));
}

std::vector<std::string> Params::keys() const {
  need(*this, node_);
  if (node_->kind != Kind::map) throw error(strf("expected a map, found %s", kind_name(node_->kind)));
  std::vector<std::string> names;
  for (const Node::Entry& e : node_->entries) names.push_back(e.key);
  return names;
}

size_t Params::size() const {
  need(*this, node_);
  return node_->kind == Kind::map ? node_->entries.size() : node_->items.size();
}
Params Params::operator[](size_t i) const {
  need(*this, node_, "a list");
  if (node_->kind != Kind::list) throw error(strf("expected a list, found %s", kind_name(node_->kind)));
  if (i >= node_->items.size()) throw error(strf("expected at least %zu items, found %zu", i + 1, node_->items.size()));
  return Params(document_, node_->items[i]);
}
std::vector<Params> Params::items() const {
  need(*this, node_, "a list");
  std::vector<Params> all;
  if (node_->kind == Kind::scalar || node_->kind == Kind::map) all.push_back(*this);
  for (const Node* item : node_->items) all.push_back(Params(document_, item));
  return all;
}

std::string Params::as_text() const {
  need(*this, node_);
  if (node_->kind != Kind::scalar) throw error(strf("expected a text, found %s", kind_name(node_->kind)));
  for (const char c : node_->scalar)
    if ((static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' && c != '\r') || c == 0x7f)
      throw error("a text with the control character " + printable({&c, 1}), "leave it out");
  return node_->scalar;
}
std::string Params::as_name() const {
  need(*this, node_, "a name");
  const std::string name = as_text();
  if (const std::string fault = fault_of_name(name); !fault.empty())
    throw error("the name " + fault + "; it becomes part of file names", kGoodName);
  return name;
}
double Params::as_number() const {
  need(*this, node_, "a number");
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
  need(*this, node_, strf("give a value from %g to %g%s%s", low, high, *unit ? " " : "", unit));
  const double value = as_number();
  if (!(value >= low && value <= high))
    throw error(strf("%g is outside the valid range", value),
                strf("give a value from %g to %g%s%s", low, high, *unit ? " " : "", unit));
  return value;
}
long long Params::as_integer(long long low, long long high) const {
  need(*this, node_, strf("give a whole number from %lld to %lld", low, high));
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
  need(*this, node_, "true or false");
  const std::string text = node_->kind == Kind::scalar ? node_->scalar : "";
  if (text == "true" || text == "yes" || text == "on") return true;
  if (text == "false" || text == "no" || text == "off") return false;
  throw error("expected true or false", {});
}
size_t Params::as_choice(std::initializer_list<const char*> names) const {
  return as_choice(std::vector<std::string>(names.begin(), names.end()));
}
size_t Params::as_choice(const std::vector<std::string>& known) const {
  need(*this, node_, choices_text(known));
  const std::string text = as_text();
  for (size_t i = 0; i < known.size(); ++i)
    if (known[i] == text) return i;
  throw error("'" + text + "' is none of the choices here", name_hint(text, known));
}
std::vector<double> Params::as_numbers() const {
  need(*this, node_, "a list of numbers");
  std::vector<double> values;
  if (node_->kind != Kind::list) throw error(strf("expected a list of numbers, found %s", kind_name(node_->kind)));
  for (const Params& item : items()) values.push_back(item.as_number());
  return values;
}
std::array<double, 3> Params::as_vec3() const {
  need(*this, node_, "three numbers");
  const std::vector<double> v = as_numbers();
  if (v.size() != 3) throw error(strf("expected three numbers, found %zu", v.size()));
  return {v[0], v[1], v[2]};
}
std::array<double, 3> Params::as_direction() const {
  need(*this, node_, "three numbers, not all 0");
  const std::array<double, 3> v = as_vec3();
  const double largest = std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});
  if (!(largest >= 1 / kLargestNumber)) throw error("a direction of no length", "three numbers, not all 0");
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  return {v[0] / length, v[1] / length, v[2] / length};
}
std::string Params::as_path() const {
  need(*this, node_, "the name of a file");
  std::string path = resolve_path(file(), as_text());
  std::vector<std::string>& all = document_->paths;
  if (std::find(all.begin(), all.end(), path) == all.end()) all.push_back(path);
  return path;
}
std::span<const std::string> Params::paths() const { return document_->paths; }

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
