// Many findings at once. A finding has a stable code, a severity and a place; a Report counts all of them, keeps the
// first three examples per code and asset, prints a verdict line and can be written as JSON.
#pragma once
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"

namespace suite {

enum class Severity { info, warning, error };
const char* to_text(Severity severity);

// One kind of finding: the published row of an issue table.
struct IssueKind {
  std::string code;  // stable, e.g. "SP104"
  Severity severity;
  std::string summary;  // one line for --list-issues
  std::string hint;     // what would be right
};

struct Finding {
  Where where;
  std::string message;
  std::optional<std::array<double, 3>> at = std::nullopt;  // in the asset's own coordinates, where it has a place
};
// A finding with a place, and what it is an example of.
struct PlacedFinding {
  std::string code, asset;
  Severity severity = Severity::info;
  Finding finding;
};

class Report {
 public:
  explicit Report(std::vector<IssueKind> kinds) : kinds_(std::move(kinds)) {}

  // code must be one of the kinds. asset: the file or object it is about (groups the examples).
  // count: how many single faults this finding stands for.
  void add(const std::string& code, const std::string& asset, Finding finding, size_t count = 1);
  // Takes over an Error thrown while reading; unknown or empty code is filed under `fallback_code`.
  void add(const Error& error, const std::string& asset, const std::string& fallback_code);

  void mute(const std::string& code);                 // Error with the nearest code when unknown
  void set_strict(bool strict) { strict_ = strict; }  // warnings count as errors in ok()

  bool ok() const;                        // no (unmuted) errors
  size_t count(Severity severity) const;  // single faults of that severity, muted ones left out
  size_t count(const std::string& code) const;
  std::string text() const;                   // findings + verdict line
  std::string json() const;                   // schema "suite.report/1", see formats/report/FORMAT.md
  std::vector<PlacedFinding> placed() const;  // of the examples those with a place, muted ones left out
  const std::vector<IssueKind>& kinds() const { return kinds_; }

 private:
  struct Entry {
    size_t count = 0;
    std::vector<Finding> examples;
  };
  const IssueKind& kind(const std::string& code) const;
  std::vector<IssueKind> kinds_;
  std::map<std::pair<std::string, std::string>, Entry> entries_;  // (code, asset)
  std::set<std::string> muted_;
  bool strict_ = false;
};

}  // namespace suite
