// Based on: the columns of the soundings of weather.uwyo.edu (eleven columns of seven characters, blank where nothing
// was measured).
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "base/files.h"
#include "base/text_lines.h"
#include "formats/profile/profile.h"

namespace suite {

namespace {

constexpr size_t kMostLevels = 100000;
constexpr double kFreezing = 273.15, kWaterToAir = 0.0180153 / 0.0289652;  // molar masses

// A row of a file: what it gives, and where it stands.
struct Row {
  AirLevel level;
  std::array<bool, kGases> given{};
  Where where;
};

void set(Row& row, Gas gas, double share) {
  row.level.share(gas) = share;
  row.given[static_cast<size_t>(gas)] = true;
}

// What a column says, and what its numbers become.
struct ColumnKind {
  enum class What { height, pressure, temperature, share, humidity, dew_point, mixing_ratio } what;
  double scale = 1, offset = 0;
  Gas gas = Gas::h2o;
};

std::optional<ColumnKind> column_kind(std::string_view name) {
  using What = ColumnKind::What;
  static const std::vector<std::pair<std::string_view, ColumnKind>> fixed = {
      {"height_m", {What::height, 1, 0, Gas::h2o}},
      {"height_km", {What::height, 1000, 0, Gas::h2o}},
      {"pressure_pa", {What::pressure, 1, 0, Gas::h2o}},
      {"pressure_hpa", {What::pressure, 100, 0, Gas::h2o}},
      {"temperature_k", {What::temperature, 1, 0, Gas::h2o}},
      {"temperature_c", {What::temperature, 1, kFreezing, Gas::h2o}},
      {"relative_humidity_percent", {What::humidity, 0.01, 0, Gas::h2o}},
      {"dew_point_c", {What::dew_point, 1, kFreezing, Gas::h2o}},
      {"h2o_g_per_kg", {What::mixing_ratio, 0.001, 0, Gas::h2o}}};
  for (const auto& [known, kind] : fixed)
    if (known == name) return kind;
  const size_t at = name.rfind('_');
  if (at == std::string_view::npos) return std::nullopt;
  const std::optional<Gas> gas = gas_of(name.substr(0, at));
  const std::string_view unit = name.substr(at + 1);
  if (!gas) return std::nullopt;
  for (const auto& [known, scale] :
       {std::pair<std::string_view, double>{"ppmv", 1e-6}, {"ppbv", 1e-9}, {"fraction", 1.0}})
    if (unit == known) return ColumnKind{What::share, scale, 0, *gas};
  return std::nullopt;
}

// Share of water of air that dew forms on at this temperature.
double share_at_dew_point(double dew_point, double pressure) { return water_share(1, pressure, dew_point); }
// Of a mixing ratio, mass of water to mass of dry air.
double share_of_mixing_ratio(double ratio) { return ratio / (ratio + kWaterToAir); }

void apply(Row& row, const ColumnKind& kind, double value) {
  using What = ColumnKind::What;
  switch (kind.what) {
    case What::height:
      row.level.height = value;
      break;
    case What::pressure:
      row.level.pressure = value;
      break;
    case What::temperature:
      row.level.temperature = value;
      break;
    case What::share:
      set(row, kind.gas, value);
      break;
    case What::humidity:
      set(row, Gas::h2o, water_share(value, row.level.pressure, row.level.temperature));
      break;
    case What::dew_point:
      set(row, Gas::h2o, share_at_dew_point(value, row.level.pressure));
      break;
    case What::mixing_ratio:
      set(row, Gas::h2o, share_of_mixing_ratio(value));
      break;
  }
}

std::vector<ColumnKind> header_of(const TextLines& lines) {
  using What = ColumnKind::What;
  std::vector<ColumnKind> columns;
  int found[3] = {}, water = 0;
  for (size_t i = 0; i < lines.words(); ++i) {
    const auto kind = column_kind(lines.word(i));
    if (!kind)
      throw lines.error(
          i, "unknown column '" + std::string(lines.word(i)) + "'",
          "columns are height_m or _km, pressure_hpa or _pa, temperature_k or _c, GAS_ppmv, _ppbv or _fraction, "
          "relative_humidity_percent, dew_point_c, h2o_g_per_kg");
    for (const ColumnKind& other : columns)
      if (other.what == What::share && kind->what == What::share && other.gas == kind->gas)
        throw lines.error(i, "a second column of " + std::string(gas_name(kind->gas)), "give each gas once");
    if (kind->what <= What::temperature && ++found[static_cast<int>(kind->what)] > 1)
      throw lines.error(i, "a second column of the same quantity", "give each once");
    if ((kind->what > What::share || (kind->what == What::share && kind->gas == Gas::h2o)) && ++water > 1)
      throw lines.error(i, "a second column of water", "give one");
    columns.push_back(*kind);
  }
  const char* names[] = {"height_m", "pressure_hpa", "temperature_k"};
  for (int q = 0; q < 3; ++q)
    if (found[q] == 0)
      throw lines.error(0, std::string("no column of ") + names[q], "height, pressure and temperature are needed");
  return columns;
}

std::vector<Row> parse_table(std::string_view text, const std::string& file) {
  TextLines lines(text, file, true);
  if (!lines.next()) throw lines.error_at_end("holds no profile", "the first line names the columns");
  const std::vector<ColumnKind> columns = header_of(lines);
  std::vector<Row> rows;
  while (lines.next()) {
    if (lines.words() != columns.size())
      throw lines.error(0, strf("a row of %zu numbers, the header has %zu columns", lines.words(), columns.size()));
    if (rows.size() == kMostLevels) throw lines.error(0, strf("more than %zu levels", kMostLevels));
    Row row;
    row.where = lines.where();
    // Humidity needs the pressure and temperature of its row, whatever the order of columns.
    for (const bool humid : {false, true})
      for (size_t i = 0; i < columns.size(); ++i) {
        if ((columns[i].what > ColumnKind::What::share) != humid) continue;
        const double value = lines.number(i, "value");
        if (value < 0 && columns[i].offset == 0 && columns[i].what != ColumnKind::What::height)
          throw lines.error(i, strf("%g is negative", value));
        apply(row, columns[i], columns[i].scale * value + columns[i].offset);
      }
    rows.push_back(std::move(row));
  }
  return rows;
}

// A number in a column of seven characters; nothing where it is blank.
std::optional<double> field(const TextLines& lines, size_t column) {
  const std::string_view line = lines.line();
  if (line.size() <= 7 * column) return std::nullopt;
  std::string_view text = line.substr(7 * column, 7);
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\r')) text.remove_suffix(1);
  if (text.empty()) return std::nullopt;
  double value = 0;
  const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || stop != text.data() + text.size() || !(std::abs(value) < kLargestNumber)) {
    Where where = lines.where();
    where.column = static_cast<int>(7 * column) + 1;
    throw Error(where, "'" + std::string(text) + "' is not a number", "columns are seven characters wide");
  }
  return value;
}

bool is_sounding_header(std::string_view line) {
  return line.find("PRES") != std::string_view::npos && line.find("HGHT") != std::string_view::npos &&
         line.find("DWPT") != std::string_view::npos;
}

std::vector<Row> parse_sounding(std::string_view text, const std::string& file, std::vector<std::string>& notes) {
  TextLines lines(text, file);
  while (lines.next_raw() && !is_sounding_header(lines.line())) {
  }
  const auto rule = [&] { return lines.line().find("----") != std::string_view::npos; };
  while (lines.next_raw() && !rule()) {
  }
  std::vector<Row> rows;
  size_t skipped = 0;
  while (lines.next_raw()) {
    const std::string_view line = lines.line();
    const size_t first = line.find_first_not_of(" \r");
    if (first == std::string_view::npos || std::string_view("0123456789.-").find(line[first]) == std::string_view::npos)
      break;
    const auto pressure = field(lines, 0), height = field(lines, 1), celsius = field(lines, 2), dew = field(lines, 3);
    if (!pressure || !height || !celsius || (!rows.empty() && *height <= rows.back().level.height)) {
      ++skipped;
      continue;
    }
    if (rows.size() == kMostLevels) throw lines.error(0, strf("more than %zu levels", kMostLevels));
    Row row;
    row.where = lines.where();
    row.level.height = *height, row.level.pressure = 100 * *pressure, row.level.temperature = *celsius + kFreezing;
    if (dew) set(row, Gas::h2o, share_at_dew_point(*dew + kFreezing, row.level.pressure));
    rows.push_back(std::move(row));
  }
  if (skipped)
    notes.push_back(strf("%zu rows without height or temperature, or not above the one before, are left out", skipped));
  return rows;
}

// Levels above the highest of the file: the standard's, its pressure scaled to meet.
void extend(AirProfile& profile, const AirProfile& standard, std::vector<std::string>& notes) {
  const AirLevel top = profile.levels.back();
  const double meet = standard.at(top.height).pressure;
  size_t added = 0;
  for (AirLevel level : standard.levels) {
    if (level.height <= top.height + 1 || !(meet > 0)) continue;
    level.pressure *= top.pressure / meet;
    profile.levels.push_back(level);
    ++added;
  }
  if (added) notes.push_back(strf("above %g m the air is that of %s", top.height, standard.name.c_str()));
}

void fill(std::vector<Row>& rows, const AirProfile& standard, std::vector<std::string>& notes) {
  std::string missing;
  for (size_t g = 0; g < kGases; ++g) {
    size_t without = 0;
    for (Row& row : rows)
      if (!row.given[g]) {
        row.level.fraction[g] = standard.at(row.level.height).fraction[g];
        ++without;
      }
    if (without == 0) continue;
    missing += (missing.empty() ? "" : ", ") + std::string(gas_name(static_cast<Gas>(g)));
    if (without < rows.size()) missing += strf(" (at %zu of %zu levels)", without, rows.size());
  }
  if (!missing.empty()) notes.push_back(missing + " from " + standard.name);
}

}  // namespace

ReadProfile parse_profile(std::string_view text, const std::string& file, std::string_view standard_name) {
  const AirProfile standard = standard_profile(standard_name);
  ReadProfile out;
  const bool sounding = is_sounding_header(text.substr(0, std::min<size_t>(text.size(), 4096)));
  std::vector<Row> rows = sounding ? parse_sounding(text, file, out.notes) : parse_table(text, file);
  const Where whole{file, 0, 0, {}, -1};
  if (rows.size() < 2) throw Error(whole, strf("a profile of %zu levels", rows.size()), "two at least");
  if (rows.front().level.height > rows.back().level.height) std::reverse(rows.begin(), rows.end());
  for (size_t i = 1; i < rows.size(); ++i)
    if (!(rows[i].level.height > rows[i - 1].level.height))
      throw Error(rows[i].where, strf("a height of %g m next to %g m", rows[i].level.height, rows[i - 1].level.height),
                  "heights ascend or descend throughout");
  fill(rows, standard, out.notes);
  out.profile.name = file;
  for (const Row& row : rows) {
    // Nitrogen gives way where the file has more of the rest than the standard.
    AirLevel level = row.level;
    double sum = 0;
    for (size_t g = 0; g < kGases; ++g) sum += level.fraction[g];
    if (!row.given[static_cast<size_t>(Gas::n2)])
      level.share(Gas::n2) = std::max(0.0, level.share(Gas::n2) - std::max(0.0, sum - 0.99));
    check_level(level, out.profile.levels.empty() ? nullptr : &out.profile.levels.back(), row.where);
    out.profile.levels.push_back(level);
  }
  extend(out.profile, standard, out.notes);
  check_profile(out.profile, whole);
  return out;
}

ReadProfile read_profile(const std::string& path, std::string_view standard) {
  return parse_profile(read_text(path, size_t{64} << 20), path, standard);
}

}  // namespace suite
