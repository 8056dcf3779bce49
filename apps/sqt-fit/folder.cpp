#include "folder.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <numeric>
#include <sstream>

#include "base/error.h"
#include "base/files.h"
#include "base/inputs.h"
#include "base/outputs.h"
#include "base/progress.h"
#include "base/run_lock.h"
#include "fit.h"
#include "formats/measured/measured.h"
#include "page/page.h"

namespace suite {

namespace {

namespace fs = std::filesystem;

constexpr const char* kMagic = "# suite.sqt-fit-table/1";

const std::vector<std::string>& columns() {
  static const std::vector<std::string> list{
      "file", "channels", "bytes", "sqt_bytes",     "ratio",         "leaves",        "order",  "seconds",
      "l1",   "cos_rmse", "rmse",  "peak_ratio_20", "peak_ratio_45", "peak_ratio_70", "sha256", "fault"};
  return list;
}
size_t column(const char* name) {
  return static_cast<size_t>(std::find(columns().begin(), columns().end(), name) - columns().begin());
}

using Row = std::vector<std::string>;  // a cell for each of the columns

std::string quoted(std::string cell) {
  if (cell.find_first_of(",\"\n\r") == std::string::npos) return cell;
  for (char& c : cell)
    if (c == '\n' || c == '\r') c = ' ';  // a row is a line
  for (size_t i = 0; (i = cell.find('"', i)) != std::string::npos; i += 2) cell.insert(i, 1, '"');
  return '"' + cell + '"';
}

Row unquoted(const std::string& line) {
  Row cells(1);
  bool inside = false;
  for (size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      if (inside && i + 1 < line.size() && line[i + 1] == '"')
        cells.back() += line[++i];
      else
        inside = !inside;
    } else if (line[i] == ',' && !inside) {
      cells.emplace_back();
    } else {
      cells.back() += line[i];
    }
  }
  return cells;
}

// Everything that a row follows from but the file.
std::string settings_of(const SqtFitOptions& o) {
  return strf(
      "sqt-fit %s method %s order %lld views %lld threshold %.17g max_error %.17g max_bytes %lld min_peak %.17g "
      "mueller_error %.17g swap %d strict %d",
      kVersion, o.method.c_str(), o.order, o.views, o.threshold, o.max_error, o.max_bytes, o.min_peak, o.mueller_error,
      o.swap, o.strict);
}

// Rows of an earlier table of the same settings, by the content of their files. Error: what stands there is no table of
// ours, and may be somebody's measurement.
std::map<std::string, Row> finished_rows(const SqtFitOptions& o) {
  std::map<std::string, Row> rows;
  if (!file_exists(o.output)) return rows;
  const OwnResults own;
  std::istringstream in(read_text(o.output));
  std::string line;
  if (!std::getline(in, line) || line != kMagic)
    throw Error(Where{o.output, 0, 0, {}, -1}, "is no table of sqt-fit and is not replaced", "give another -o");
  bool same = false;
  while (std::getline(in, line)) {
    if (line == "# settings: " + settings_of(o)) same = true;
    if (line.empty() || line[0] == '#' || !same) continue;
    Row row = unquoted(line);
    if (row.size() == columns().size() && row.back().empty() && row[column("sha256")].size() == 64)
      rows[row[column("sha256")]] = std::move(row);
  }
  if (!same) note(o.output + ": of other settings or of another version; every file is fitted again");
  return rows;
}

// Measured files under the folder, by their names within it.
std::vector<std::string> files_of(const SqtFitOptions& o) {
  std::vector<std::string> names;
  size_t others = 0;
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(o.input, fs::directory_options::skip_permission_denied)) {
    if (!entry.is_regular_file(ignored) || fs::equivalent(entry.path(), o.output, ignored)) continue;
    if (looks_measured(entry.path().string()))
      names.push_back(entry.path().lexically_relative(o.input).string());  // links stay names in the folder
    else
      ++others;
  }
  if (names.empty())
    throw Error(Where{o.input, 0, 0, {}, -1}, "holds no measured file", "known formats:\n" + measured_formats());
  if (others) note(strf("%s: %zu files are of no format that is fitted and are passed over", o.input.c_str(), others));
  std::sort(names.begin(), names.end());
  return names;
}

std::string fit_of(const SqtFitOptions& o, const std::string& name) { return in_folder(o.fits, name + ".sqt"); }

Row fitted_row(const SqtFitOptions& o, const std::string& name, size_t bytes, const std::string& sum) {
  SqtFitOptions one = o;
  one.input = (fs::path(o.input) / name).string();
  const FitInput input = load_input(one);
  const Outcome out = fit_function(one, input);
  judge_fit(one, input, out);
  if (!o.fits.empty()) {
    make_folders_of({fit_of(o, name)});
    write_file(fit_of(o, name), out.file);
  }
  const sqt::ErrorFigures& e = out.errors.back();
  return {name,
          strf("%zu", input.function->info().wavelength_um.size()),
          strf("%zu", bytes),
          strf("%zu", out.file.size()),
          strf("%.4g", static_cast<double>(bytes) / static_cast<double>(out.file.size())),
          strf("%zu", out.bundle->info().leaves),
          strf("%d", out.bundle->info().max_order),
          strf("%.3g", out.seconds),
          strf("%.6g", e.l1),
          strf("%.6g", e.cos_rmse),
          strf("%.6g", e.rmse),
          strf("%.4f", e.peak_ratio_20),
          strf("%.4f", e.peak_ratio_45),
          strf("%.4f", e.peak_ratio_70),
          sum,
          ""};
}

std::vector<std::string> table_head(const SqtFitOptions& o) {
  return {
      "settings: " + settings_of(o), command_line(),
      "rmse: root mean square of fit - data, 1/sr, over uniform directions of the hemisphere (the paper's Figure 8, "
      "with 2e5 pairs instead of 1e6, half of them near the mirror direction and weighed); l1 and cos_rmse: relative "
      "and cosine-weighted, up to 80 deg; peak_ratio: height of the lobe over the data's at that view angle; ratio: "
      "bytes over sqt_bytes; seconds of fitting and measuring"};
}

std::string csv_of(const SqtFitOptions& o, const std::vector<Row>& rows) {
  std::string csv = std::string(kMagic) + '\n';
  for (const std::string& t : table_head(o)) csv += "# " + t + '\n';
  auto add = [&csv](const Row& row) {
    for (size_t c = 0; c < row.size(); ++c) csv += (c ? "," : "") + quoted(row[c]);
    csv += '\n';
  };
  add(columns());
  for (const Row& row : rows) add(row);
  return csv;
}

// Errors of the materials in ascending order, and against the size.
Page page_of(const SqtFitOptions& o, const std::vector<Row>& rows) {
  Page page{"Measured files as quad-trees", table_head(o), {}, {}};
  auto number = [](const Row& row, const char* name) { return std::strtod(row[column(name)].c_str(), nullptr); };
  Plot ranked{"Errors, in ascending order", "file (rank)", "rmse [1/sr], l1 and cos_rmse [relative]", false, true, {}};
  Plot sized{"Error against size", "bytes of the .sqt", "l1 [relative]", true, true, {}};
  sized.series.push_back({"l1", {}, {}, {}, {}});
  for (const char* name : {"rmse", "cos_rmse", "l1"}) {
    PlotSeries s{name, {}, {}, {}, {}};
    for (const Row& row : rows)
      if (row.back().empty()) s.y.push_back(number(row, name));
    std::sort(s.y.begin(), s.y.end());
    s.x.resize(s.y.size());
    std::iota(s.x.begin(), s.x.end(), 1.0);
    ranked.series.push_back(std::move(s));
  }
  std::vector<std::pair<double, double>> points;
  for (const Row& row : rows)
    if (row.back().empty()) points.emplace_back(number(row, "sqt_bytes"), number(row, "l1"));
  std::sort(points.begin(), points.end());
  for (const auto& [x, y] : points) sized.series[0].x.push_back(x), sized.series[0].y.push_back(y);
  page.plots = {std::move(ranked), std::move(sized)};
  PageTable table{"Files", columns(), rows};
  const auto sum = static_cast<std::ptrdiff_t>(column("sha256"));  // is for machines
  table.columns.erase(table.columns.begin() + sum);
  for (Row& row : table.rows) row.erase(row.begin() + sum);
  page.tables.push_back(std::move(table));
  return page;
}

}  // namespace

int fit_folder(const SqtFitOptions& o) {
  const std::string page = fs::path(o.output).replace_extension(".html").string();
  const std::vector<std::string> names = files_of(o);
  std::vector<std::string> outputs{o.output, page};
  for (const std::string& name : names) {
    note_input((fs::path(o.input) / name).string());
    if (!o.fits.empty()) outputs.push_back(fit_of(o, name));
  }
  check_outputs(outputs);
  make_folders_of({o.output});
  const RunLock lock = RunLock::of_file(o.output);
  std::map<std::string, Row> finished = finished_rows(o);
  std::vector<Row> rows;
  size_t kept = 0, bad = 0;
  Progress progress("fitting", static_cast<double>(names.size()), "file");
  for (const std::string& name : names) {
    const std::string path = (fs::path(o.input) / name).string();
    std::string sum;
    try {
      const std::vector<std::byte> bytes = read_bytes(path, size_t{1} << 32);
      sum = sha256(bytes);
      const auto found = finished.find(sum);
      if (found != finished.end() && (o.fits.empty() || file_exists(fit_of(o, name)))) {
        rows.push_back(found->second);
        rows.back()[0] = name;
        ++kept;
      } else {
        rows.push_back(fitted_row(o, name, bytes.size(), sum));
      }
    } catch (const Error& e) {
      warn(std::string(e.what()));
      Row row(columns().size());
      row[0] = name, row[column("sha256")] = sum, row.back() = e.message();
      rows.push_back(std::move(row));
      ++bad;
    }
    // After each, so that a stopped run goes on where it was; what is still ahead of an earlier table stays in it.
    std::vector<Row> so_far = rows;
    for (size_t i = rows.size(); i < names.size(); ++i)
      for (const auto& [key, row] : finished)
        if (row[0] == names[i]) so_far.push_back(row);
    write_file(o.output, csv_of(o, so_far));
    progress.add(1);
  }
  progress.finish();
  write_file(page, html_of(page_of(o, rows)));
  note(strf("%s: %zu files, %zu of them kept from before, %zu that cannot be fitted", o.output.c_str(), rows.size(),
            kept, bad));
  return bad ? 1 : 0;
}

}  // namespace suite
