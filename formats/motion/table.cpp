#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "base/number_text.h"
#include "formats/motion/fields.h"

namespace suite {

namespace {

constexpr const char* kColumns[] = {"time_s",
                                    "utc",
                                    "east_m",
                                    "north_m",
                                    "up_m",
                                    "ecef_x_m",
                                    "ecef_y_m",
                                    "ecef_z_m",
                                    "utm_zone",
                                    "easting_m",
                                    "northing_m",
                                    "latitude_deg",
                                    "longitude_deg",
                                    "height_m",
                                    "heading_deg",
                                    "pitch_deg",
                                    "roll_deg",
                                    "qw",
                                    "qx",
                                    "qy",
                                    "qz"};

bool blank(char c) { return c == ' ' || c == '\t'; }

// Cuts a line into cells; `columns` receives where each starts, from 1.
void split(std::string_view line, bool by_comma, std::vector<std::string_view>& cells, std::vector<int>& columns) {
  cells.clear();
  columns.clear();
  size_t i = 0;
  while (i <= line.size()) {
    size_t end = i;
    if (by_comma) {
      end = std::min(line.find(',', i), line.size());
    } else {
      while (i < line.size() && blank(line[i])) ++i;
      if (i == line.size()) break;
      for (end = i; end < line.size() && !blank(line[end]);) ++end;
    }
    size_t a = i, b = end;
    while (a < b && blank(line[a])) ++a;
    while (b > a && blank(line[b - 1])) --b;
    cells.push_back(line.substr(a, b - a));
    columns.push_back(static_cast<int>(a) + 1);
    i = end + 1;
  }
}

}  // namespace

std::optional<size_t> TableRow::find(const char* name) const {
  for (size_t i = 0; i < names->size(); ++i)
    if ((*names)[i] == name) return i;
  return std::nullopt;
}

std::optional<double> finite_number(std::string_view text) {
  const std::optional<double> value = number_of(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

double TableRow::number(size_t column) const {
  if (const auto value = finite_number(cells[column])) return *value;
  Where at = where;
  at.column = columns[column];
  throw Error(at, (*names)[column] + " is no number: '" + std::string(cells[column]) + "'", "write a finite number");
}

double TableRow::time(const MotionContext& context) const {
  const auto seconds = find("time_s"), utc = find("utc");
  if (seconds.has_value() == utc.has_value()) throw Error(where, "a table needs one column of times", "time_s or utc");
  if (seconds) return number(*seconds);
  if (!context.clock) throw Error(where, "times in UTC need the date of the simulation", "use time_s");
  try {
    return context.clock->seconds(parse_iso8601(cells[*utc]));
  } catch (const Error& e) {
    throw Error(where, e.message(), e.hint());
  }
}

void for_each_row(std::string_view text, const std::string& file_name, std::span<const char* const> known_names,
                  const std::function<void(const TableRow&)>& visit) {
  std::vector<std::string> names;
  TableRow row;
  bool by_comma = false;
  int number = 0, rows = 0;
  while (!text.empty()) {
    const size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    ++number;
    while (!line.empty() && (line.back() == '\r' || blank(line.back()))) line.remove_suffix(1);
    if (line.empty() || line[0] == '#') continue;
    row.where = {file_name, number, 1, std::string(line.substr(0, 200)), -1};
    if (names.empty()) {
      by_comma = line.find(',') != std::string_view::npos;
      split(line, by_comma, row.cells, row.columns);
      const std::vector<std::string> known(known_names.begin(), known_names.end());
      for (size_t i = 0; i < row.cells.size(); ++i) {
        const std::string name(row.cells[i]);
        Where at = row.where;
        at.column = row.columns[i];
        if (std::find(known.begin(), known.end(), name) == known.end())
          throw Error(at, "unknown column '" + name + "'", name_hint(name, known));
        if (std::find(names.begin(), names.end(), name) != names.end())
          throw Error(at, "column '" + name + "' is there twice");
        names.push_back(name);
      }
      row.names = &names;
      continue;
    }
    split(line, by_comma, row.cells, row.columns);
    if (row.cells.size() != names.size())
      throw Error(row.where, strf("this row has %zu cells, the header %zu", row.cells.size(), names.size()));
    visit(row);
    ++rows;
  }
  if (rows == 0) throw Error({file_name, 0, 0, {}, -1}, "a table without a row", "a header of column names, then rows");
}

std::vector<PoseKey> parse_pose_keys(std::string_view text, const std::string& file_name,
                                     const MotionContext& context) {
  std::vector<PoseKey> keys;
  for_each_row(text, file_name, kColumns, [&](const TableRow& row) {
    PoseFields fields;
    fields.has = [&](const char* name) { return row.find(name).has_value(); };
    fields.number = [&](const char* name) { return row.number(*row.find(name)); };
    fields.text = [&](const char* name) { return std::string(row.cells[*row.find(name)]); };
    fields.error = [&](std::string what, std::string hint) {
      return Error(row.where, std::move(what), std::move(hint));
    };
    const double time = row.time(context);
    if (!keys.empty() && !(time > keys.back().time))
      throw fields.error("the times do not ascend", "each row later than the one before");
    keys.push_back({time, fields.pose(context)});
  });
  return keys;
}

std::vector<PoseKey> read_pose_keys(const std::string& path, const MotionContext& context) {
  return parse_pose_keys(read_text(path), path, context);
}

Psd read_psd(const std::string& path, const std::string& density_column, Psd::Between between) {
  Psd psd;
  psd.between = between;
  const std::string text = read_text(path, size_t{64} << 20);
  const char* const names[] = {"frequency_hz", density_column.c_str()};
  for_each_row(text, path, names, [&](const TableRow& row) {
    const auto f = row.find(names[0]), s = row.find(names[1]);
    if (!f || !s) throw Error(row.where, "the table needs the columns frequency_hz and " + density_column);
    psd.frequency.push_back(row.number(*f));
    psd.density.push_back(row.number(*s));
  });
  try {
    psd.check();
  } catch (const Error& e) {
    throw Error({path, 0, 0, {}, -1}, e.message(), e.hint());
  }
  return psd;
}

}  // namespace suite
