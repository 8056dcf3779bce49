// A text file line by line, split into words, every one of which knows its place: for plain tables of numbers.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"

namespace suite {

class TextLines {
 public:
  // text must outlive this. Words are separated by blanks and tabs, and by commas when `commas`; "\r\n" ends a line,
  // too.
  // '#' starts a comment that reaches to the end of the line. A byte order mark before UTF-8 is skipped.
  TextLines(std::string_view text, std::string file, bool commas = false);

  // Moves to the next line that has words. False at the end.
  bool next();
  // Moves to the next line whatever it holds, for lines whose blanks or '#' matter. False at the end.
  bool next_raw();
  std::string_view line() const { return line_; }        // without line end, comment included
  std::string_view comment() const { return comment_; }  // after '#', of this line
  size_t words() const { return words_.size(); }
  std::string_view word(size_t i) const { return words_[i]; }
  // Other words of this line than those between separators: parts of line(), which may be empty or touch.
  void set_words(std::vector<std::string_view> words) { words_ = std::move(words); }
  // Word i as a number. Error when there is no such word, it is not a number, (without allow_nan) not finite or larger
  // than kLargestNumber in size.
  double number(size_t i, const char* what, bool allow_nan = false) const;
  double number_in(size_t i, const char* what, double low, double high) const;
  // A whole number.
  long long integer(size_t i, const char* what, long long low, long long high) const;
  Where where(size_t word = 0) const;
  Error error(size_t word, std::string what, std::string hint = {}) const {
    return Error(where(word), std::move(what), std::move(hint));
  }
  // At the end of the file.
  Error error_at_end(std::string what, std::string hint = {}) const {
    return Error(Where{file_, number_, 0, {}, -1}, std::move(what), std::move(hint));
  }
  size_t bytes() const { return text_.size(); }

 private:
  std::string_view text_;
  std::string file_;
  bool commas_;
  size_t offset_ = 0;
  int number_ = 0;
  std::string_view line_, comment_;
  mutable SourceLine shared_;  // a copy of line_, once somebody asked for a place
  std::vector<std::string_view> words_;
};

}  // namespace suite
