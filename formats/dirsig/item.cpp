#include "formats/dirsig/item.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace suite::dirsig {

namespace {

constexpr const char* kBlanks = " \t\r\n\f\v";

}  // namespace

const char* to_text(Fate fate) {
  constexpr const char* names[kFates] = {"exact", "converted", "approximated", "ignored-harmless", "unsupported"};
  return names[static_cast<size_t>(fate)];
}

std::string_view trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(kBlanks);
  return first == text.npos ? std::string_view{} : text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string lower_case(std::string_view text) {
  std::string low(text);
  for (char& c : low) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return low;
}

std::string upper_case(std::string_view text) {
  std::string high(text);
  for (char& c : high) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return high;
}

std::vector<std::string_view> words_of(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> words;
  for (size_t at = text.find_first_not_of(separators); at != text.npos;) {
    const size_t end = std::min(text.find_first_of(separators, at), text.size());
    words.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(separators, end);
  }
  return words;
}

std::optional<double> number_in_text(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || stop != text.data() + text.size() || !(std::fabs(value) <= kLargestNumber))
    return std::nullopt;
  return value;
}

void expect_word(const Item* item, std::initializer_list<std::string_view> known, const std::string& note) {
  if (!item) return;
  const bool one = std::find(known.begin(), known.end(), lower_case(item->value)) != known.end();
  item->mark(one ? Fate::exact : Fate::unsupported, one ? "" : note);
}

const Item* Item::find(std::string_view key) const {
  asked_.emplace(key);
  for (const Item& child : children)
    if (child.name == key) return child.seen_ = true, &child;
  return nullptr;
}

const Item& Item::at(std::string_view key) const {
  if (const Item* found = find(key)) return *found;
  std::vector<std::string> there;
  for (const Item& child : children) there.push_back(child.name);
  const std::string near = nearest_name(key, there);
  const std::string what =
      key.starts_with('@') ? "attribute '" + std::string(key.substr(1)) + "'" : "'" + std::string(key) + "'";
  throw error("'" + name + "' has no " + what, near.empty() ? "" : "is '" + near + "' meant?");
}

std::vector<const Item*> Item::all(std::string_view key) const {
  asked_.emplace(key);
  std::vector<const Item*> found;
  for (const Item& child : children)
    if (child.name == key) child.seen_ = true, found.push_back(&child);
  return found;
}

bool Item::has(std::string_view key) const {
  asked_.emplace(key);
  return std::any_of(children.begin(), children.end(), [&](const Item& child) { return child.name == key; });
}

const Item* Item::any(std::initializer_list<std::string_view> keys) const {
  for (const std::string_view key : keys)
    if (const Item* found = find(key)) return found;
  return nullptr;
}

const std::string& Item::text(Fate fate, std::string note) const {
  if (value.empty()) throw error("'" + name + "' has no value");
  mark(fate, std::move(note));
  return value;
}

double Item::number(Fate fate, std::string note) const {
  const auto found = number_in_text(text(fate, std::move(note)));
  if (!found) throw error("'" + name + "' is no number: '" + value.substr(0, 60) + "'", "a finite number is expected");
  return *found;
}

double Item::number_in(double low, double high, Fate fate, std::string note) const {
  const double found = number(fate, std::move(note));
  if (!(found >= low && found <= high))
    throw error(strf("'%s' is %g", name.c_str(), found), strf("%g to %g are expected", low, high));
  return found;
}

long long Item::integer(long long low, long long high) const {
  const double found = number();
  if (found != std::floor(found) || found < static_cast<double>(low) || found > static_cast<double>(high))
    throw error(strf("'%s' is %g", name.c_str(), found),
                strf("a whole number from %lld to %lld is expected", low, high));
  return static_cast<long long>(found);
}

bool Item::boolean() const { return choice({"false", "true", "no", "yes", "off", "on", "0", "1"}) % 2 == 1; }

std::vector<double> Item::numbers(Fate fate, std::string note) const {
  std::vector<double> list;
  for (const std::string_view word : words_of(text(fate, std::move(note)), " \t\r\n,")) {
    const auto found = number_in_text(word);
    if (!found) throw error("'" + std::string(word.substr(0, 60)) + "' is no number", "in '" + name + "'");
    list.push_back(*found);
  }
  return list;
}

size_t Item::choice(std::initializer_list<const char*> names) const {
  const std::string low = lower_case(text());
  std::vector<std::string> known;
  for (const char* n : names) {
    if (low == lower_case(n)) return known.size();
    known.push_back(n);
  }
  throw error("'" + name + "' is '" + value.substr(0, 60) + "'", name_hint(value, known));
}

void Item::mark(Fate fate, std::string note) const {
  seen_ = true;
  // What is lost in one use is not made whole by another.
  if (fate_ && *fate_ > fate) return;
  fate_ = fate;
  if (!note.empty()) note_ = std::move(note);
}

void Item::mark_all(Fate fate, const std::string& note) const {
  std::vector<const Item*> todo{this};
  while (!todo.empty()) {
    const Item* one = todo.back();
    todo.pop_back();
    if (!one->fate_) one->mark(fate, note);
    for (const Item& child : one->children) todo.push_back(&child);
  }
}

}  // namespace suite::dirsig
