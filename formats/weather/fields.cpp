#include "formats/weather/fields.h"

namespace suite {

namespace {

bool blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

bool ends_number(char c) { return (c >= '0' && c <= '9') || c == '.'; }

std::string_view bare(std::string_view text) {
  const auto around = [](char c) { return blank(c) || c == '"'; };
  while (!text.empty() && around(text.front())) text.remove_prefix(1);
  while (!text.empty() && around(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace

void split_at_commas(TextLines& lines) {
  const std::string_view line = lines.line();
  std::vector<std::string_view> words;
  size_t begin = 0;
  bool quoted = false;
  for (size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (line[i] != ',' || quoted)) continue;
    words.push_back(bare(line.substr(begin, i - begin)));
    begin = i + 1;
  }
  lines.set_words(std::move(words));
}

void split_at_blanks_and_signs(TextLines& lines) {
  const std::string_view line = lines.line();
  std::vector<std::string_view> words;
  for (size_t i = 0; i < line.size();) {
    if (blank(line[i])) {
      ++i;
      continue;
    }
    size_t end = i + 1;
    while (end < line.size() && !blank(line[end]) && !(line[end] == '-' && ends_number(line[end - 1]))) ++end;
    words.push_back(line.substr(i, end - i));
    i = end;
  }
  lines.set_words(std::move(words));
}

}  // namespace suite
