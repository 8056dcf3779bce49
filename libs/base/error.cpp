#include "base/error.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

namespace suite {

namespace {

// Damerau-Levenshtein (optimal string alignment) distance, case-insensitive.
size_t distance(std::string_view a, std::string_view b) {
  auto lower = [](char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c); };
  std::vector<std::vector<size_t>> d(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (size_t i = 1; i <= a.size(); ++i)
    for (size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]))
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

}  // namespace

std::string excerpt(const Where& where) {
  const std::string_view line = where.source_line.view();
  if (line.empty() || where.column < 1) return {};
  // A window of a long line, whose ends do not cut a character in two.
  constexpr size_t kBefore = 100, kWidth = 160;
  const auto inside = [&](size_t at) { return at < line.size() && (line[at] & 0xc0) == 0x80; };
  const size_t column = std::min(static_cast<size_t>(where.column) - 1, line.size());
  size_t begin = line.size() > kWidth && column > kBefore ? column - kBefore : 0;
  while (inside(begin)) ++begin;
  size_t end = std::min(line.size(), begin + kWidth);
  while (inside(end)) --end;
  const std::string head = begin > 0 ? "... " : "", tail = end < line.size() ? " ..." : "";
  std::string caret(head.size(), ' ');
  const std::string before = printable_lines(line.substr(begin, std::max(begin, column) - begin));
  for (const char c : before)
    if ((c & 0xc0) != 0x80) caret += c == '\t' ? '\t' : ' ';
  return "\n  " + head + printable_lines(line.substr(begin, end - begin)) + tail + "\n  " + caret + "^";
}

std::string to_text(const Where& where) {
  if (where.file.empty()) return {};
  if (where.line > 0 && where.column > 0) return strf("%s:%d:%d", where.file.c_str(), where.line, where.column);
  if (where.line > 0) return strf("%s:%d", where.file.c_str(), where.line);
  if (where.byte_offset >= 0) return strf("%s: byte %lld", where.file.c_str(), where.byte_offset);
  return where.file;
}

Error::Error(Where where, std::string what, std::string hint, std::string code)
    : where_(std::move(where)), message_(std::move(what)), hint_(std::move(hint)), code_(std::move(code)) {
  const std::string place = to_text(where_);
  text_ = place.empty() ? "error: " : printable(place) + ": error: ";
  text_ += printable(message_);
  if (!code_.empty()) text_ += " [" + code_ + "]";
  if (!hint_.empty()) text_ += "; " + printable(hint_);
  text_ += excerpt(where_);
}

std::string nearest_name(std::string_view name, std::span<const std::string> known) {
  if (name.size() > 200) return {};  // nobody misspells that long a name; keeps the table small
  size_t best = std::max<size_t>(1, name.size() / 3) + 1;
  std::string found;
  for (const std::string& candidate : known) {
    if (candidate.size() > 200) continue;
    if (const size_t d = distance(name, candidate); d < best) best = d, found = candidate;
  }
  return found;
}

std::string name_hint(std::string_view name, std::span<const std::string> known) {
  if (const std::string near = nearest_name(name, known); !near.empty()) return "did you mean '" + near + "'?";
  if (known.empty()) return "none is known here";
  std::string list = "known: ";
  for (size_t i = 0; i < known.size() && i < 20; ++i) list += (i ? ", " : "") + known[i];
  if (known.size() > 20) list += ", ...";
  return list;
}

std::string strf(const char* format, ...) {
  va_list args;
  va_start(args, format);
  va_list again;
  va_copy(again, args);
  const int size = std::vsnprintf(nullptr, 0, format, args);
  va_end(args);
  std::string text(size > 0 ? static_cast<size_t>(size) : 0, '\0');
  if (size > 0) std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  return text;
}

void throw_bug(const char* file, int line, const char* condition, const std::string& values) {
  const std::string_view path = file;
  const size_t cut = path.find("libs/") != std::string_view::npos ? path.find("libs/") : path.rfind('/') + 1;
  throw Bug(strf("%s:%d: this should hold and does not: %s%s%s", file + cut, line, condition,
                 values.empty() ? "" : ": ", values.c_str()));
}

}  // namespace suite
