#include "formats/dirsig/ledger.h"

#include "base/json.h"

namespace suite::dirsig {

namespace {

// Of a value, as much as says what it was.
constexpr size_t kShown = 120;
constexpr const char* kPart = "part of what is lost";

constexpr size_t kNamed = 16;  // names that are read in an element, which a message lists

// The one name that has all of another in it, or the other way round, as "sceneorigin" of "origin".
std::string containing(const std::string& name, const std::vector<std::string>& names) {
  std::string found;
  for (const std::string& n : names) {
    if (std::min(n.size(), name.size()) < 4 || (n.find(name) == n.npos && name.find(n) == name.npos)) continue;
    if (!found.empty()) return {};
    found = n;
  }
  return found;
}

// What an element that nobody read should have been: a name that is near, else those that are read in its parent.
std::string unknown_note(const Item& item, const Item* parent) {
  if (!parent) return "not known here";
  const std::vector<std::string> asked(parent->asked().begin(), parent->asked().end());
  std::string near = nearest_name(item.name, asked);
  if (near == item.name) return "given more than once; the first holds";
  if (near.empty()) near = containing(item.name, asked);
  if (!near.empty()) return "not known here; is '" + near + "' meant?";
  std::string names;
  size_t listed = 0;
  for (const std::string& name : asked)
    if (!name.starts_with('@') && ++listed <= kNamed) names += (names.empty() ? "" : ", ") + name;
  if (names.empty()) return "not known here";
  return "not known here; '" + parent->name + "' has " + names + (listed > kNamed ? ", ..." : "");
}

template <class Visit>
void walk(const Item& item, const std::string& path, const Item* parent, const Visit& visit) {
  visit(item, path, parent);
  for (const Item& child : item.children) walk(child, path + "/" + child.name, &item, visit);
}

}  // namespace

const Item& Ledger::add(std::string file, std::string kind, Item root) {
  files_.push_back({std::move(file), std::move(kind), std::make_unique<Item>(std::move(root))});
  files_.back().root->mark(Fate::exact);
  return *files_.back().root;
}

const Item* Ledger::of(const std::string& file) const {
  for (const File& f : files_)
    if (f.path == file) return f.root.get();
  return nullptr;
}

void Ledger::close() {
  for (const File& file : files_)
    walk(*file.root, file.root->name, nullptr, [](const Item& item, const std::string&, const Item* parent) {
      if (item.fate()) return;
      // An element that was looked into says nothing by itself.
      if (item.seen() && item.value.empty()) return item.mark(Fate::exact);
      if (parent && parent->fate() == Fate::unsupported) return item.mark(Fate::unsupported, kPart);
      if (item.seen()) return item.mark(Fate::unsupported, "its value was not used");
      if (item.value.empty() && item.children.empty() && (item.name == "clocktable" || item.name == "rotationdeviates"))
        return item.mark(Fate::ignored, "DIRSIG's own editors write it, empty");
      item.mark(Fate::unsupported, unknown_note(item, parent));
    });
}

size_t Ledger::items() const {
  size_t sum = 0;
  for (const File& file : files_)
    walk(*file.root, "", nullptr, [&](const Item&, const std::string&, const Item*) { ++sum; });
  return sum;
}

std::array<size_t, kFates> Ledger::counts() const {
  std::array<size_t, kFates> sums{};
  for (const File& file : files_)
    walk(*file.root, "", nullptr, [&](const Item& item, const std::string&, const Item*) {
      if (item.fate()) ++sums[static_cast<size_t>(*item.fate())];
    });
  return sums;
}

std::vector<Entry> Ledger::entries() const {
  std::vector<Entry> all;
  for (const File& file : files_)
    walk(*file.root, file.root->name, nullptr, [&](const Item& item, const std::string& path, const Item*) {
      if (item.fate())
        all.push_back(
            {item.where, path, item.value.substr(0, kShown), *item.fate(), item.note(), item.note() == kPart});
    });
  return all;
}

std::vector<std::string> Ledger::files() const {
  std::vector<std::string> names;
  for (const File& file : files_) names.push_back(file.path);
  return names;
}

std::string Ledger::text() const {
  std::string out;
  for (const Entry& e : entries()) {
    if (e.fate == Fate::exact || (e.fate == Fate::converted && e.note.empty())) continue;
    out += printable(to_text(e.where)) + ": " + to_text(e.fate) + ": " + printable(e.path) +
           (e.value.empty() ? "" : " = " + printable(e.value)) + (e.note.empty() ? "" : ": " + printable(e.note)) +
           "\n";
  }
  const auto sums = counts();
  out += strf("%zu elements and keys of %zu files:", items(), files_.size());
  for (size_t i = 0; i < kFates; ++i) out += strf("%s %zu %s", i ? "," : "", sums[i], to_text(static_cast<Fate>(i)));
  size_t sum = 0;
  for (const size_t s : sums) sum += s;
  return out + strf("; %zu unread\n", items() - sum);
}

std::string Ledger::json() const {
  Json root = Json::object();
  root.set("schema", "suite.import/1");
  root.set("items", items());
  const auto sums = counts();
  size_t sum = 0;
  Json numbers = Json::object();
  for (size_t i = 0; i < kFates; ++i) numbers.set(to_text(static_cast<Fate>(i)), sums[i]), sum += sums[i];
  numbers.set("unread", items() - sum);
  root.set("counts", std::move(numbers));
  Json files = Json::array();
  for (const File& f : files_) {
    Json one = Json::object();
    one.set("file", f.path), one.set("kind", f.kind);
    files.push(std::move(one));
  }
  root.set("files", std::move(files));
  Json list = Json::array();
  for (const Entry& e : entries()) {
    Json one = Json::object();
    one.set("file", e.where.file), one.set("line", e.where.line);
    one.set("path", e.path), one.set("value", e.value);
    one.set("fate", to_text(e.fate)), one.set("note", e.note);
    list.push(std::move(one));
  }
  root.set("entries", std::move(list));
  return root.text();
}

}  // namespace suite::dirsig
