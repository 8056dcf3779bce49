// One table of kinds: models, phase functions, temperatures, lights, truth, sensors, importers. A row is
// {name, summary, unit, make} and what its kind adds; from the table come construction, the error for an unknown name,
// what `--list-...` prints, and the tests that run over all rows. Tables are written out (no self-registration, which
// static libraries lose).
#pragma once
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"

namespace suite {

// What a row takes beside its name.
struct Parameter {
  enum class Kind { number, curve, text };
  std::string name;  // "roughness"
  Kind kind;
  std::string unit;  // "1", "rad", "um"; empty for texts
  std::string summary;
  double low, high;  // valid range of numbers and of curve values, both ends included
  bool required = true;
  double otherwise = 0;  // value when not required and not given; NaN = stays absent
};
std::vector<std::string> names_of(std::span<const Parameter> parameters);
// Error "OF: NAME = VALUE is outside its range" with the range unless low <= value <= high.
void check_range(const std::string& of, const Parameter& parameter, double value, const Where& where,
                 const std::string& code = {});

// Signature: what make takes and gives, e.g. std::unique_ptr<Sensor>(const Params&). Kinds of rows derive from this and
// add their own facts behind; with a member `parameters` these are listed too.
template <class Signature>
struct RegistryRow {
  std::string name;     // as texts give it, "lambert"; unique in its table
  std::string summary;  // one line, with author and year where there are any
  std::string unit;     // of what it gives, "K"; empty where that says nothing
  std::function<Signature> make;
};

namespace detail {
[[noreturn]] void throw_unknown_row(const std::string& kind, const std::string& code, const std::string& name,
                                    std::span<const std::string> known, const Where& where);
// "name   summary [unit]" and a line a parameter.
std::string listing(const std::string& name, const std::string& summary, const std::string& unit,
                    std::span<const Parameter> parameters);
}  // namespace detail

// Row: a RegistryRow or what derives from one.
template <class Row>
class Registry {
 public:
  // kind: what messages call a row, "phase function"; code: of the error for an unknown name, or empty.
  Registry(std::string kind, std::string code, std::vector<Row> rows)
      : kind_(std::move(kind)), code_(std::move(code)), rows_(std::move(rows)) {
    for (const Row& row : rows_) SUITE_CHECK(look_up(row.name) == &row);
  }
  auto begin() const { return rows_.begin(); }
  auto end() const { return rows_.end(); }
  size_t size() const { return rows_.size(); }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const Row& row : rows_) names.push_back(row.name);
    return names;
  }
  // Null when there is none of the name.
  const Row* look_up(std::string_view name) const {
    for (const Row& row : rows_)
      if (row.name == name) return &row;
    return nullptr;
  }
  // Error "unknown KIND 'NAME'" at `where`, with the nearest name or all of them.
  const Row& find(const std::string& name, const Where& where = {}) const {
    if (const Row* row = look_up(name)) return *row;
    detail::throw_unknown_row(kind_, code_, name, names(), where);
  }
  // A row from outside (a plug-in's). Error when the name is taken. Rows found before are no longer valid.
  void add(Row row) {
    if (look_up(row.name))
      throw Error("there is a " + kind_ + " '" + row.name + "' already", "give this one another name");
    rows_.push_back(std::move(row));
  }
  // What --list-... prints: a line a row, in the order of the table, and below it a line a parameter.
  std::string list() const {
    std::string text;
    for (const Row& row : rows_)
      if constexpr (requires { row.parameters; })
        text += detail::listing(row.name, row.summary, row.unit, row.parameters);
      else
        text += detail::listing(row.name, row.summary, row.unit, {});
    return text;
  }

 private:
  std::string kind_, code_;
  std::vector<Row> rows_;
};

}  // namespace suite
