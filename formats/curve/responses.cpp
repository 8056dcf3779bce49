// Spectral responses as agencies publish them: one table, a column a band.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "base/files.h"
#include "base/number_text.h"
#include "base/text_lines.h"
#include "formats/curve/internal.h"

namespace suite {

namespace {

constexpr size_t kMostBands = 4096;

// Cells between commas, semicolons or tabs, without blanks and quotes around them; an empty cell is one.
std::vector<std::string> cells_of(std::string_view line, char separator) {
  std::vector<std::string> cells;
  for (size_t from = 0; from <= line.size();) {
    const size_t to = std::min(line.find(separator, from), line.size());
    std::string_view cell = line.substr(from, to - from);
    const auto around = [](char c) { return c == ' ' || c == '"' || c == '\r' || c == '\t'; };
    while (!cell.empty() && around(cell.front())) cell.remove_prefix(1);
    while (!cell.empty() && around(cell.back())) cell.remove_suffix(1);
    cells.emplace_back(cell);
    from = to + 1;
  }
  return cells;
}

// Micron of one unit of the first column, as its name says; nothing when it says none.
std::optional<double> unit_of(std::string name) {
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const auto has = [&](const char* word) { return name.find(word) != std::string::npos; };
  if (has("nm") || has("nanomet")) return 1e-3;
  if (has("um") || has("micromet") || has("micron") || has("\u00b5m") || has("\u03bcm")) return 1.0;
  return std::nullopt;
}

struct Table {
  std::vector<std::string> names;  // of the columns behind the first
  std::vector<std::vector<double>> x, y;
};

// One row into the columns that it has values for.
void add_row(const std::vector<std::string>& cells, double to_um, const TextLines& lines, Table& table) {
  const auto number = [&](const std::string& cell) {
    const std::optional<double> value = number_of(cell);
    if (!value || !std::isfinite(*value))
      throw Error(lines.where(), "'" + printable(cell) + "' is no number",
                  "rows are a wavelength and a response of each band");
    return *value;
  };
  if (cells.size() != table.names.size() + 1)
    throw Error(lines.where(), strf("a row of %zu cells, the header names %zu", cells.size(), table.names.size() + 1));
  const double um = number(cells[0]) * to_um;
  if (!(um >= 0.01 && um <= 10000))
    throw Error(lines.where(), strf("wavelength %g um is not between 0.01 and 10000 um", um), "is the unit right?");
  for (size_t k = 0; k < table.names.size(); ++k) {
    if (cells[k + 1].empty()) continue;
    if (!table.x[k].empty() && !(um > table.x[k].back()))
      throw Error(lines.where(), strf("wavelength %g um follows %g um", um, table.x[k].back()), "sort the rows");
    table.x[k].push_back(um), table.y[k].push_back(number(cells[k + 1]));
  }
}

}  // namespace

Curve response_of(std::vector<double> x, std::vector<double> y, const std::string& name, const std::string& path) {
  const auto some = [](double v) { return v != 0; };
  const auto first = std::ranges::find_if(y, some) - y.begin();
  const auto last = y.rend() - std::find_if(y.rbegin(), y.rend(), some);
  if (first >= last)
    throw Error(Where{path, 0, 0, {}, -1}, "band '" + name + "' has no response other than 0", "leave it out");
  const auto from = std::max<std::ptrdiff_t>(first - 1, 0), to = std::min<std::ptrdiff_t>(last + 1, std::ssize(y));
  return Curve({x.begin() + from, x.begin() + to}, {y.begin() + from, y.begin() + to}, Outside::zero,
               Where{path, 0, 0, {}, -1});
}

std::vector<NamedCurve> read_responses(const std::string& path) {
  if (is_response_file(path)) return read_response_file(path);
  const std::string text = read_text(path, size_t{256} << 20);
  TextLines lines(text, path);
  Table table;
  double to_um = 0;
  char separator = ',';
  while (lines.next()) {
    const std::string_view line = lines.line();
    if (line.find_first_not_of(" \t\r,;") == line.npos || line.front() == '#') continue;
    if (!table.names.empty()) {
      add_row(cells_of(line, separator), to_um, lines, table);
      continue;
    }
    for (const char c : {'\t', ';', ','})
      if (line.find(c) != line.npos) separator = c;
    const std::vector<std::string> cells = cells_of(line, separator);
    const std::optional<double> unit = unit_of(cells[0]);
    if (cells.size() < 2 || cells.size() > kMostBands || !unit)
      throw Error(lines.where(), "is no header of a table of responses",
                  "the first line names the columns: 'wavelength_nm,B1,B2,...' (nm or um)");
    to_um = *unit;
    table.names.assign(cells.begin() + 1, cells.end());
    for (size_t k = 0; k < table.names.size(); ++k)
      if (table.names[k].empty()) throw Error(lines.where(), strf("column %zu has no name", k + 2), "name every band");
    table.x.resize(table.names.size()), table.y.resize(table.names.size());
  }
  std::vector<NamedCurve> curves;
  for (size_t k = 0; k < table.names.size(); ++k)
    curves.push_back({table.names[k], response_of(std::move(table.x[k]), std::move(table.y[k]), table.names[k], path)});
  if (curves.empty()) throw Error(Where{path, 0, 0, {}, -1}, "holds no table of responses");
  return curves;
}

}  // namespace suite
