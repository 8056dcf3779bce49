#include "base/files.h"
#include "base/number_text.h"
#include "base/text_lines.h"
#include "formats/pulse/pulse.h"

namespace suite {

namespace {

constexpr size_t kMostRows = 10000000;

// The number of the column of powers; the line is one of names.
size_t column_of(const TextLines& lines, const std::string& column) {
  std::vector<std::string> names;
  for (size_t k = 1; k < lines.words(); ++k) names.emplace_back(lines.word(k));
  if (column.empty() && names.size() == 1) return 1;
  for (size_t k = 0; k < names.size(); ++k)
    if (names[k] == column) return k + 1;
  if (column.empty())
    throw lines.error(0, strf("the pulse is one of %zu columns", names.size()),
                      "column: " + (names.empty() ? "NAME" : names[0]));
  throw lines.error(0, "no column '" + printable(column) + "'", name_hint(column, names));
}

}  // namespace

PulseTable read_pulse_file(const std::string& path, const std::string& column) {
  const std::string text = read_text(path, size_t{256} << 20);
  TextLines lines(text, path, true);
  PulseTable t;
  size_t power = 1, columns = 0;
  while (lines.next()) {
    const bool first = columns == 0;
    if (first) columns = lines.words();
    if (first && !number_of(lines.word(0))) {
      power = column_of(lines, column);
      continue;
    }
    if (first && !column.empty())
      throw lines.error(0, "a column is asked for by name, and the first line has no names", "time_ns,power");
    if (first && columns != 2)
      throw lines.error(0, strf("%zu numbers", columns), "time in ns and power, or a first line of names");
    if (lines.words() != columns)
      throw lines.error(0, strf("%zu numbers, the first line has %zu", lines.words(), columns));
    if (t.time.size() == kMostRows) throw lines.error(0, strf("more than %zu rows", kMostRows));
    t.time.push_back(lines.number_in(0, "a time in ns", -1e12, 1e12) * 1e-9);
    t.power.push_back(lines.number(power, "a power"));
  }
  if (t.time.size() < 2)
    throw lines.error_at_end(strf("%zu rows of a pulse", t.time.size()), "at least two of: time in ns, power");
  return t;
}

}  // namespace suite
