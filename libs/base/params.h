// Located key-values: what a user wrote, where it was written, and whether anybody read it. YAML in, and therefore
// JSON. A key nobody asked for is an error with the nearest name that was asked for, so a misspelt option cannot be
// ignored.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace suite {

class Report;

// Empty when a text may become part of a file name, as as_name() has it; else what is wrong with it.
std::string fault_of_name(const std::string& name);

// A handle to one node of a parsed document (cheap to copy; keeps the document alive). Asking marks keys as read.
class Params {
 public:
  enum class Kind { null, scalar, list, map };

  // Error: not UTF-8, malformed YAML, duplicate key, nesting above 200, alias to an unfinished node, more than 50
  // million nodes.
  // settings: "PATH=VALUE", applied in turn to what the file says. PATH: keys of maps, indices (from 0) or `name`s of
  // the items of lists, joined by dots; the last may be a new key of its map. VALUE: YAML; null takes a key out. Places
  // in them are told as "--set PATH". Error: no such place, malformed.
  static Params parse_file(const std::string& path, std::span<const std::string> settings = {});
  static Params parse_text(std::string_view yaml, const std::string& file_name);
  // A text that a program made of others: places are those of `origins`, one a line, and file names are relative to
  // the folder of file_name. Settings as above.
  static Params parse_made(std::string_view yaml, const std::string& file_name, std::vector<Where> origins,
                           std::span<const std::string> settings = {});
  // The same from strict JSON that a program wrote into another file: some ten times faster, but places name the file
  // only. Error: malformed JSON, duplicate key, nesting above 200.
  static Params parse_json(std::string_view json, const std::string& file_name);

  Kind kind() const;
  Where where() const;                      // of this value
  Where where(std::string_view key) const;  // of the key of a map (its name, not its value)
  const std::string& file() const;

  // Maps.
  bool has(std::string_view key) const;   // marks as asked for, not as read
  Params at(std::string_view key) const;  // Error when missing, at the key that may be meant for it
  // Of a missing key: the fault of an unread one with nearly its name.
  std::optional<Error> misspelt(std::string_view key) const;
  std::optional<Params> find(std::string_view key) const;
  std::vector<std::string> keys() const;  // in the order written; marks none
  // Lists.
  size_t size() const;                // of a list or map
  Params operator[](size_t i) const;  // of a list
  std::vector<Params> items() const;  // of a list; a single scalar or map counts as a list of one

  // Scalars. Error with place and expectation when the value is of another kind or outside [low, high].
  std::string as_text() const;  // without control characters but line ends and tabs
  // A name that may become part of a file name: 1 to 48 bytes, without '/' and control characters, not beginning with a
  // dot.
  std::string as_name() const;
  double as_number() const;  // finite, at most kLargestNumber in size
  double as_number_in(double low, double high, const char* unit) const;
  long long as_integer(long long low, long long high) const;
  bool as_bool() const;  // true/false/yes/no/on/off
  size_t as_choice(std::initializer_list<const char*> names) const;
  size_t as_choice(const std::vector<std::string>& names) const;
  std::vector<double> as_numbers() const;  // list of finite numbers
  std::array<double, 3> as_vec3() const;
  std::array<double, 3> as_direction() const;  // three numbers, not all 0, made a unit vector
  std::string as_path() const;                 // resolved against the folder of this file
  // What as_path() has given of this document, each once, in the order of asking.
  std::span<const std::string> paths() const;

  // Shorthands: required, and with a default.
  std::string text(std::string_view key) const { return at(key).as_text(); }
  std::string text(std::string_view key, const std::string& otherwise) const;
  std::string name(std::string_view key, const std::string& otherwise) const;  // as_name
  double number(std::string_view key) const { return at(key).as_number(); }
  double number(std::string_view key, double otherwise) const;
  double number_in(std::string_view key, double low, double high, const char* unit) const;
  double number_in(std::string_view key, double low, double high, const char* unit, double otherwise) const;
  long long integer(std::string_view key, long long low, long long high) const { return at(key).as_integer(low, high); }
  long long integer(std::string_view key, long long low, long long high, long long otherwise) const;
  bool boolean(std::string_view key, bool otherwise) const;

  // The fault `what` located at this value.
  Error error(std::string what, std::string hint = {}, std::string code = {}) const;

  // Every key of this document that was not read, with the nearest name asked for at that place. The first overload
  // throws the first one; the second files all under `code`.
  void reject_unread() const;
  std::vector<Error> unread() const;
  // Marks this value and everything below it as read (for values deliberately handed on as text).
  void mark_read() const;

  struct Node;
  struct Document;

 private:
  Params(std::shared_ptr<Document> document, const Node* node) : document_(std::move(document)), node_(node) {}
  std::shared_ptr<Document> document_;
  const Node* node_;
};

}  // namespace suite
