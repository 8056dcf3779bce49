#include "study/rows.h"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "base/error.h"

namespace suite {

namespace {

const char* kColumns =
    "by_time,budget,seed,seconds,build_seconds,file_seconds,paths,rays,nodes,paths_per_problem,share_trace,share_"
    "sample,share_shade,share_sensor,peak_bytes,"
    "relative_rmse,bias,bias_error,reference_bias_error,coverage,counted,zero_variance,flagged,exceeding,found,"
    "efficiency,series,ended";
constexpr size_t kNumbers = 26;

// Texts stand last and unquoted: commas and ends of line in them become semicolons.
std::string plain(std::string text) {
  for (char& c : text)
    if (c == ',' || c == '\n' || c == '\r') c = ';';
  return text;
}

}  // namespace

std::string rows_to_csv(const std::vector<StudyRow>& rows, const std::string& identity) {
  std::string csv = "# study " + identity + "\n" + kColumns + "\n";
  for (const StudyRow& r : rows) {
    const Comparison& f = r.figures;
    const double values[] = {r.by_time ? 1.0 : 0.0,
                             r.budget,
                             static_cast<double>(r.seed),
                             r.seconds,
                             r.build_seconds,
                             r.file_seconds,
                             r.paths,
                             r.rays,
                             r.nodes,
                             r.paths_per_problem,
                             r.share_in_embree,
                             r.share_sample,
                             r.share_shade,
                             r.share_sensor,
                             r.peak_bytes,
                             f.relative_rmse,
                             f.bias,
                             f.bias_error,
                             f.reference_bias_error,
                             f.coverage,
                             static_cast<double>(f.counted),
                             static_cast<double>(f.zero_variance),
                             static_cast<double>(f.flagged),
                             static_cast<double>(f.exceeding),
                             static_cast<double>(f.found),
                             r.efficiency()};
    for (const double v : values) csv += strf("%.17g,", v);
    csv += plain(f.series) + "," + plain(r.ended) + "\n";
  }
  return csv;
}

std::vector<StudyRow> rows_from_csv(std::string_view text, const std::string& identity, const std::string& file) {
  std::istringstream in{std::string(text)};
  std::string line;
  Where where{file, 1, 0, {}, -1};
  if (!std::getline(in, line) || line.rfind("# study ", 0) != 0)
    throw Error(where, "this is no table of a study", "give another folder");
  if (line != "# study " + identity)
    throw Error(where, "this study is of another scene, simulation, reference or build",
                "give another folder, or remove this one");
  std::getline(in, line);
  if (++where.line; line != kColumns) throw Error(where, "the columns are not those of a study");
  std::vector<StudyRow> rows;
  while (++where.line, std::getline(in, line)) {
    double v[kNumbers];
    const char *at = line.data(), *end = at + line.size();
    for (double& value : v) {
      const auto [next, error] = std::from_chars(at, end, value);
      if (error != std::errc() || next == end || *next != ',')
        throw Error(where, "a row of the study is damaged", "remove the line: its run is done again");
      at = next + 1;
    }
    StudyRow r{v[0] != 0, v[1],  static_cast<uint64_t>(v[2]),
               v[3],      v[4],  v[5],
               v[6],      v[7],  v[8],
               v[9],      v[10], v[11],
               v[12],     v[13], v[14],
               {},        {}};
    const char* comma = std::find(at, end, ',');
    if (comma == end) throw Error(where, "a row of the study is damaged", "remove the line: its run is done again");
    r.figures = {std::string(at, comma),
                 v[15],
                 v[16],
                 v[17],
                 v[18],
                 v[19],
                 static_cast<size_t>(v[20]),
                 static_cast<size_t>(v[21]),
                 static_cast<size_t>(v[22]),
                 static_cast<size_t>(v[23]),
                 static_cast<size_t>(v[24])};
    r.ended.assign(comma + 1, end);
    rows.push_back(std::move(r));
  }
  return rows;
}

}  // namespace suite
