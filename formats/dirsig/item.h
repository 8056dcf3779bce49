// What a file of DIRSIG says, whatever its grammar: a tree of elements, attributes and keys, each with its place and,
// once it was dealt with, what became of it. What nobody dealt with shows.
#pragma once
#include <deque>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace suite::dirsig {

// What became of a value here. exact: it holds as it was written; converted: in other units or words, without loss;
// approximated: by something near it, the note says what differs; ignored: without effect on results; unsupported: with
// effect, and lost.
enum class Fate { exact, converted, approximated, ignored, unsupported };
inline constexpr size_t kFates = 5;
const char* to_text(Fate fate);

// Reading marks: `find`, `at`, `all` the element that they give (its content stays to be dealt with), `text`, `number`
// and their like the value. Marks are what the account counts, so that a const tree is marked.
class Item {
 public:
  std::string name;   // of the element or key; attributes begin with '@'
  std::string value;  // trimmed; may stand beside children
  Where where;
  std::deque<Item> children;

  // Structure. find: the first of that name, or null; at: Error naming what is near; all: every one.
  const Item* find(std::string_view key) const;
  const Item& at(std::string_view key) const;
  std::vector<const Item*> all(std::string_view key) const;
  // Whether there is one, which marks nothing.
  bool has(std::string_view key) const;
  // Any of several names, the first that is there.
  const Item* any(std::initializer_list<std::string_view> keys) const;

  // Values. Error, located, when there is none or it is none of the kind.
  const std::string& text(Fate fate = Fate::exact, std::string note = {}) const;
  double number(Fate fate = Fate::exact, std::string note = {}) const;
  double number_in(double low, double high, Fate fate = Fate::exact, std::string note = {}) const;
  long long integer(long long low, long long high) const;
  bool boolean() const;  // true/false, yes/no, on/off, 1/0 in any case
  // Numbers between blanks or commas.
  std::vector<double> numbers(Fate fate = Fate::exact, std::string note = {}) const;
  // One of the names in any case; its number. Error lists them.
  size_t choice(std::initializer_list<const char*> names) const;

  void mark(Fate fate, std::string note = {}) const;
  // This and everything below that has no fate yet.
  void mark_all(Fate fate, const std::string& note) const;
  Error error(std::string what, std::string hint = {}) const { return Error(where, std::move(what), std::move(hint)); }

  const std::optional<Fate>& fate() const { return fate_; }
  const std::string& note() const { return note_; }
  // An element that was asked for and has content of its own, which is counted by itself.
  bool seen() const { return seen_; }
  const std::set<std::string, std::less<>>& asked() const { return asked_; }

 private:
  mutable std::optional<Fate> fate_;
  mutable std::string note_;
  mutable bool seen_ = false;
  mutable std::set<std::string, std::less<>> asked_;
};

// Marks a word (of a type, of a unit) that must be one of those, in any case, for what is made of the rest to hold:
// exact, else unsupported with the note. item: may be null.
void expect_word(const Item* item, std::initializer_list<std::string_view> known, const std::string& note);

// A number as these files write them ("+5.0e-01", "1.", ".5"); nothing when it is none or not finite.
std::optional<double> number_in_text(std::string_view text);
std::string lower_case(std::string_view text);
std::string upper_case(std::string_view text);
std::string_view trimmed(std::string_view text);
std::vector<std::string_view> words_of(std::string_view text, std::string_view separators);

}  // namespace suite::dirsig
