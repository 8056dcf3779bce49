// Prints the table of extreme cases. Usage: stability [--sweep] [--only GROUP] [--json FILE] [--html FILE]
// Exit code 1 when a case fails.
#include <cmath>
#include <cstdio>
#include <cstring>

#include "base/error.h"
#include "base/files.h"
#include "base/json.h"
#include "extreme/case.h"

namespace suite::extreme {
namespace {

struct Row {
  Case c;
  Outcome outcome;
  double limit = 0;
  bool to_end = false;
  std::string verdict() const { return !c.open.empty() ? "open" : outcome.held ? "held" : "FAILED"; }
  std::string limit_text() const {
    if (!(c.sweep.to != c.sweep.from) || c.sweep.parameter.empty() || !c.open.empty()) return "";
    return strf("%s%.3g %s", to_end ? (c.sweep.to > c.sweep.from ? ">= " : "<= ") : "", limit,
                c.sweep.unit == "1" ? "" : c.sweep.unit.c_str());
  }
};

std::string escaped(const std::string& text) {
  std::string r;
  for (const char ch : text) {
    if (ch == '<')
      r += "&lt;";
    else if (ch == '>')
      r += "&gt;";
    else if (ch == '&')
      r += "&amp;";
    else
      r += ch;
  }
  return r;
}

std::string html_of(const std::vector<Row>& rows, const std::string& summary) {
  std::string h =
      "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>Stability</title><style>"
      "body{font:14px sans-serif;margin:2em}table{border-collapse:collapse}td,th{padding:3px 10px;text-align:left;"
      "border-bottom:1px solid "
      "#ddd}.held{color:#063}.FAILED{color:#fff;background:#b00}.open{color:#850}</style></head><body>"
      "<h1>Stiff and extreme cases</h1><p>" +
      escaped(summary) +
      "</p><table><tr><th>group</th><th>case</th><th>reference</th>"
      "<th>error</th><th>bound</th><th>unit</th><th>verdict</th><th>driven by</th><th>holds to</th></tr>\n";
  for (const Row& r : rows)
    h += "<tr><td>" + escaped(r.c.group) + "</td><td>" + escaped(r.c.name) + "</td><td>" + escaped(r.c.reference) +
         "</td><td>" + (r.c.open.empty() ? strf("%.2e", r.outcome.error) : escaped(r.c.open)) +
         strf("</td><td>%.1e</td><td>", r.c.bound) + escaped(r.c.unit) + "</td><td class=\"" + r.verdict() + "\">" +
         r.verdict() + "</td><td>" + escaped(r.c.sweep.parameter) + "</td><td>" + escaped(r.limit_text()) +
         "</td></tr>\n";
  return h + "</table></body></html>\n";
}

Json json_of(const std::vector<Row>& rows) {
  Json all = Json::array();
  for (const Row& r : rows) {
    Json j = Json::object();
    j.set("group", r.c.group);
    j.set("case", r.c.name);
    j.set("reference", r.c.reference);
    j.set("unit", r.c.unit);
    j.set("bound", r.c.bound);
    j.set("verdict", r.verdict());
    if (!r.c.open.empty())
      j.set("reason", r.c.open);
    else
      j.set("error", r.outcome.error), j.set("seconds", r.outcome.seconds);
    if (!r.limit_text().empty())
      j.set("parameter", r.c.sweep.parameter), j.set("holds_to", r.limit), j.set("reaches_end_of_sweep", r.to_end),
          j.set("parameter_unit", r.c.sweep.unit);
    all.push(std::move(j));
  }
  return all;
}

int run(bool sweep, const char* only, const char* json, const char* html) {
  std::vector<Row> rows;
  size_t held = 0, failed = 0, open = 0;
  std::printf("%-15s %-64s %10s %9s  %-20s %-7s %s\n", "group", "case", "error", "bound", "unit", "verdict",
              sweep ? "holds to" : "");
  for (Case& c : all_cases()) {
    if (only && c.group != only) continue;
    Row r{std::move(c), {}, 0, false};
    if (r.c.open.empty()) r.outcome = measure(r.c, production());
    const bool drive = sweep && r.outcome.held && !r.c.sweep.parameter.empty() && r.c.sweep.to != r.c.sweep.from;
    if (drive)
      r.limit = limit_of(r.c, production(), r.to_end);
    else
      r.c.sweep.to = r.c.sweep.from;  // nothing to print
    ++(r.c.open.empty() ? r.outcome.held ? held : failed : open);
    std::printf("%-15s %-64s %10s %9.1e  %-20s %-7s %s\n", r.c.group.c_str(), r.c.name.c_str(),
                r.c.open.empty() ? strf("%.2e", r.outcome.error).c_str() : "-", r.c.bound, r.c.unit.c_str(),
                r.verdict().c_str(),
                !r.c.open.empty() ? r.c.open.c_str()
                : drive           ? (r.c.sweep.parameter + " " + r.limit_text()).c_str()
                                  : "");
    std::fflush(stdout);
    rows.push_back(std::move(r));
  }
  const std::string summary = strf("%zu cases: %zu held, %zu failed, %zu open", rows.size(), held, failed, open);
  std::printf("%s\n", summary.c_str());
  if (json) write_file(json, json_of(rows).text());
  if (html) write_file(html, html_of(rows, summary));
  return failed ? 1 : 0;
}

}  // namespace
}  // namespace suite::extreme

int main(int argc, char** argv) try {
  bool sweep = false;
  const char *only = nullptr, *json = nullptr, *html = nullptr;
  for (int i = 1; i < argc; ++i) {
    if (!std::strcmp(argv[i], "--sweep"))
      sweep = true;
    else if (!std::strcmp(argv[i], "--only") && i + 1 < argc)
      only = argv[++i];
    else if (!std::strcmp(argv[i], "--json") && i + 1 < argc)
      json = argv[++i];
    else if (!std::strcmp(argv[i], "--html") && i + 1 < argc)
      html = argv[++i];
    else
      return std::fprintf(stderr, "usage: stability [--sweep] [--only GROUP] [--json FILE] [--html FILE]\n"), 2;
  }
  return suite::extreme::run(sweep, only, json, html);
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
