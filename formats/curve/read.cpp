// Based on: the header of the ECOSTRESS spectral library's files (speclib.jpl.nasa.gov; Meerdink et al. 2019).
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string_view>

#include "base/files.h"
#include "formats/curve/internal.h"

namespace suite {

namespace {

constexpr size_t kMaxRows = 10'000'000;

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

bool separator(char c) { return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\r'; }

// A comma between two digits of a row whose columns are parted by something else: "400;0,2", "400 0,2".
bool has_decimal_comma(std::string_view line) {
  const auto digit = [&](size_t i) { return i < line.size() && std::isdigit(static_cast<unsigned char>(line[i])); };
  bool comma = false, parted = false;
  for (size_t i = 1; i < line.size(); ++i) {
    comma = comma || (line[i] == ',' && digit(i - 1) && digit(i + 1));
    if (!separator(line[i]) || line[i] == ',' || line[i] == '\r') continue;
    const size_t first = i;  // of the gap between two columns
    while (i < line.size() && separator(line[i])) ++i;
    const std::string_view gap = line.substr(first, i - first);
    parted = parted || (i < line.size() && line[first - 1] != ',' && gap.find(',') == gap.npos);
    --i;
  }
  return comma && parted;
}

// Numbers of a row; false when something else stands in it. An empty row has none.
bool numbers(std::string_view line, std::vector<double>& out) {
  out.clear();
  size_t i = 0;
  while (i < line.size()) {
    if (separator(line[i])) {
      ++i;
      continue;
    }
    size_t end = i;
    while (end < line.size() && !separator(line[end])) ++end;
    double value = 0;
    const char* begin = line.data() + i + (line[i] == '+' ? 1 : 0);
    const auto [stop, code] = std::from_chars(begin, line.data() + end, value);
    if (code != std::errc() || stop != line.data() + end) return false;
    out.push_back(value);
    i = end;
  }
  return true;
}

struct Header {
  double to_um = 1, to_share = 1;
  void note(std::string_view line) {
    const std::string text = lower(line);
    const bool x = text.rfind("x units", 0) == 0, y = text.rfind("y units", 0) == 0;
    if (y && text.find("percent") != std::string::npos) to_share = 0.01;
    if (y) return;
    if (text.find("nanomet") != std::string::npos || has_word(text, "nm") || has_word(text, "wavelength_nm"))
      to_um = 1e-3;
    if (x && text.find("micromet") != std::string::npos) to_um = 1;
  }
  static bool has_word(const std::string& text, const std::string& word) {
    const auto letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
    for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
      if ((at == 0 || !letter(text[at - 1])) && (at + word.size() == text.size() || !letter(text[at + word.size()])))
        return true;
    return false;
  }
};

}  // namespace

Curve read_table(const std::string& path, const CurveOptions& options) {
  const std::string text = read_text(path, size_t{512} << 20);
  if (const size_t zero = text.find('\0'); zero != std::string::npos)
    throw Error(Where{path, 0, 0, {}, static_cast<long long>(zero)}, "is not a text file",
                "two columns, CSV or ECOSTRESS are expected");
  Header header;
  std::vector<double> x, y, row;
  const size_t column = options.column > 0 ? static_cast<size_t>(options.column) : 1;
  size_t start = 0;
  for (int line_no = 1; start < text.size(); ++line_no) {
    size_t end = text.find_first_of("\n\r", start);
    if (end == std::string::npos) end = text.size();
    std::string_view line(text.data() + start, end - start);
    start = end + (end + 1 < text.size() && text[end] == '\r' && text[end + 1] == '\n' ? 2 : 1);
    const Where where{path, line_no, 1, std::string(line.substr(0, 200)), -1};
    line.remove_prefix(std::min(line.find_first_not_of(" \t,\r"), line.size()));
    if (line.empty()) continue;
    const bool comment = std::string_view("#;!%").find(line.front()) != std::string_view::npos;
    if (const size_t mark = line.find_first_of("#!"); mark != line.npos && !comment) line = line.substr(0, mark);
    if (comment || !numbers(line, row)) {
      if (!comment && (!x.empty() || !row.empty()))
        throw Error(where, "a row that is not numbers",
                    "rows are 'wavelength value'; a '#' begins what is none and begins with a number");
      header.note(line);
      continue;
    }
    if (has_decimal_comma(line))
      throw Error(where, "a comma within a number, or columns parted in two ways",
                  "decimals have points; columns are parted by blanks, tabs, semicolons or commas");
    if (row.size() <= column)
      throw Error(where, strf("a row of %zu numbers, column %zu was asked for", row.size(), column),
                  "rows are 'wavelength value'");
    if (x.size() >= kMaxRows) throw Error(where, strf("more than %zu rows", kMaxRows));
    const double um = row[0] * header.to_um,
                 value = is_mark(row[column]) ? NAN : row[column] * header.to_share * options.scale;
    if (!(um >= 0.01 && um <= 10000))
      throw Error(where, strf("wavelength %g um is not between 0.01 and 10000 um", um),
                  "nanometres need a header with 'nm'");
    if (!std::isfinite(value) && !is_mark(row[column])) throw Error(where, "the value is not finite");
    if (!x.empty() && um == x.back()) throw Error(where, strf("wavelength %g um is given twice", um), "give each once");
    if (x.size() > 1 && (um > x.back()) != (x[1] > x[0]))
      throw Error(where, strf("wavelengths are not monotonic: %g um follows %g um", um, x.back()), "sort the rows");
    x.push_back(um);
    y.push_back(value);
  }
  if (x.empty()) throw Error(Where{path, 0, 0, {}, -1}, "holds no rows of numbers", "rows are 'wavelength value'");
  return curve_of(std::move(x), std::move(y), options, Where{path, 0, 0, {}, -1});
}

Curve curve_of(std::vector<double> um, std::vector<double> value, const CurveOptions& options, const Where& where) {
  const auto missing =
      static_cast<size_t>(std::count_if(value.begin(), value.end(), [](double v) { return std::isnan(v); }));
  if (missing == 0) return Curve(std::move(um), std::move(value), options.outside, where);
  if (missing == value.size()) throw Error(where, "every value is the mark of a deleted channel (-1.23e34)");
  const bool open = std::isnan(value.front()) || std::isnan(value.back());
  std::string gaps;
  std::vector<double> x, y;
  for (size_t i = 0; i < value.size(); ++i) {
    if (!std::isnan(value[i])) {
      x.push_back(um[i]), y.push_back(value[i]);
      continue;
    }
    size_t last = i;
    while (last + 1 < value.size() && std::isnan(value[last + 1])) ++last;
    if (gaps.size() < 80) gaps += strf("%s%.4g to %.4g", gaps.empty() ? "" : ", ", um[i], um[last]);
    i = last;
  }
  if (options.on_warning)
    options.on_warning(
        where.file,
        strf("%zu of %zu values are marks of deleted channels (-1.23e34; %s um): the curve is linear "
             "across them%s",
             missing, value.size(), gaps.c_str(), open ? ", and nothing is held beyond an end that is marked" : ""));
  return Curve(std::move(x), std::move(y), open ? Outside::error : options.outside, where);
}

}  // namespace suite
