#include "base/report.h"

#include "base/json.h"

namespace suite {

const char* to_text(Severity severity) {
  switch (severity) {
    case Severity::info:
      return "info";
    case Severity::warning:
      return "warning";
    case Severity::error:
      return "error";
  }
  return "?";
}

const IssueKind& Report::kind(const std::string& code) const {
  for (const IssueKind& k : kinds_)
    if (k.code == code) return k;
  throw Bug("unlisted issue code " + code);
}

void Report::add(const std::string& code, const std::string& asset, Finding finding, size_t count) {
  kind(code);
  Entry& entry = entries_[{code, asset}];
  entry.count += count;
  if (entry.examples.size() < 3) entry.examples.push_back(std::move(finding));
}

void Report::add(const Error& error, const std::string& asset, const std::string& fallback_code) {
  std::string code = fallback_code;
  for (const IssueKind& k : kinds_)
    if (k.code == error.code()) code = k.code;
  add(code, asset, {error.where(), error.message() + (error.hint().empty() ? "" : "; " + error.hint())});
}

void Report::mute(const std::string& code) {
  std::vector<std::string> known;
  for (const IssueKind& k : kinds_) known.push_back(k.code);
  for (const std::string& k : known)
    if (k == code) {
      muted_.insert(code);
      return;
    }
  throw Error("unknown issue code '" + code + "'", name_hint(code, known));
}

size_t Report::count(Severity severity) const {
  size_t sum = 0;
  for (const auto& [key, entry] : entries_)
    if (!muted_.count(key.first) && kind(key.first).severity == severity) sum += entry.count;
  return sum;
}

size_t Report::count(const std::string& code) const {
  size_t sum = 0;
  for (const auto& [key, entry] : entries_)
    if (key.first == code) sum += entry.count;
  return sum;
}

bool Report::ok() const { return count(Severity::error) == 0 && !(strict_ && count(Severity::warning) > 0); }

std::vector<PlacedFinding> Report::placed() const {
  std::vector<PlacedFinding> out;
  for (const auto& [key, entry] : entries_)
    for (const Finding& f : entry.examples)
      if (f.at && !muted_.count(key.first)) out.push_back({key.first, key.second, kind(key.first).severity, f});
  return out;
}

namespace {

std::string examples_text(const std::vector<Finding>& examples) {
  std::string out;
  for (const Finding& f : examples) {
    const std::string place = printable(to_text(f.where));
    out += "    " + (place.empty() ? "" : place + ": ") + printable(f.message) + excerpt(f.where) + "\n";
  }
  return out;
}

std::string hint_text(const IssueKind& kind) { return kind.hint.empty() ? "" : "    hint: " + kind.hint + "\n"; }

}  // namespace

// A kind that many assets share is told once, with the asset that has most of it; errors have to be mended one by one.
std::string Report::text() const {
  constexpr size_t kFolded = 4;  // assets
  std::string out;
  for (auto at = entries_.begin(); at != entries_.end();) {
    const IssueKind& k = kind(at->first.first);
    auto end = at, worst = at;
    size_t assets = 0, faults = 0;
    for (; end != entries_.end() && end->first.first == k.code; ++end, ++assets) {
      faults += end->second.count;
      if (end->second.count > worst->second.count) worst = end;
    }
    const bool folded = assets >= kFolded && k.severity != Severity::error;
    if (muted_.count(k.code)) at = end;
    for (; !folded && at != end; ++at)
      out += strf("%s: %s [%s] x%zu: %s\n", printable(at->first.second).c_str(), to_text(k.severity), k.code.c_str(),
                  at->second.count, k.summary.c_str()) +
             examples_text(at->second.examples) + hint_text(k);
    if (folded && at != end)
      out +=
          strf("%zu files or objects: %s [%s] x%zu: %s\n    most, x%zu, in %s:\n", assets, to_text(k.severity),
               k.code.c_str(), faults, k.summary.c_str(), worst->second.count, printable(worst->first.second).c_str()) +
          examples_text(worst->second.examples) + hint_text(k);
    at = end;
  }
  // Many faults of few kinds are one thing to mend, however many they are.
  const auto many = [&](Severity severity, const char* what) {
    std::set<std::string> codes;
    for (const auto& [key, entry] : entries_)
      if (!muted_.count(key.first) && kind(key.first).severity == severity) codes.insert(key.first);
    const size_t faults = count(severity), kinds = codes.size();
    return strf("%zu %s", faults, what) +
           (faults > kinds ? strf(" of %zu %s", kinds, kinds == 1 ? "kind" : "kinds") : "");
  };
  out += strf("verdict: %s (%s, %s%s)\n", ok() ? "accepted" : "refused", many(Severity::error, "errors").c_str(),
              many(Severity::warning, "warnings").c_str(), strict_ ? ", strict" : "");
  return out;
}

std::string Report::json() const {
  Json root = Json::object();
  root.set("schema", "suite.report/1");
  root.set("verdict", ok() ? "accepted" : "refused");
  root.set("errors", count(Severity::error));
  root.set("warnings", count(Severity::warning));
  Json list = Json::array();
  for (const auto& [key, entry] : entries_) {
    const IssueKind& k = kind(key.first);
    Json item = Json::object();
    item.set("code", k.code);
    item.set("severity", to_text(k.severity));
    item.set("muted", muted_.count(key.first) > 0);
    item.set("asset", key.second);
    item.set("summary", k.summary);
    item.set("count", entry.count);
    item.set("hint", k.hint);
    Json examples = Json::array();
    for (const Finding& f : entry.examples) {
      Json e = Json::object();
      e.set("file", f.where.file);
      e.set("line", f.where.line);
      e.set("column", f.where.column);
      e.set("message", f.message);
      examples.push(std::move(e));
    }
    item.set("examples", std::move(examples));
    list.push(std::move(item));
  }
  root.set("issues", std::move(list));
  return root.text();
}

}  // namespace suite
