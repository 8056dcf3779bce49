// The words of a line in tables where fields may be empty, quoted, or touch.
#pragma once
#include "base/text_lines.h"

namespace suite {

// At commas outside of "quotes"; blanks and quotes around a field are dropped, empty fields are words.
void split_at_commas(TextLines& lines);
// At blanks, and before a minus sign that follows a digit or a point: columns of fixed width may touch.
void split_at_blanks_and_signs(TextLines& lines);

// Word i, empty where there is none.
inline std::string_view field(const TextLines& lines, size_t i) {
  return i < lines.words() ? lines.word(i) : std::string_view{};
}
// A line without anything, split at commas.
inline bool no_fields(const TextLines& lines) { return lines.words() == 1 && lines.word(0).empty(); }

}  // namespace suite
