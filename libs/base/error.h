// Somebody else's mistake, told once and completely: where it is, what is wrong, what would be right.
// Our own mistakes are CHECKs (check.h); "there is nothing" is std::optional.
#pragma once
#include <exception>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace suite {

// No number of a text is larger in size: its square and its cube are still far from the ends of a double.
inline constexpr double kLargestNumber = 1e30;

// A line of a text, for the caret under a fault. Many places share one copy of their text, so that a place costs the
// same whatever the length of its line.
class SourceLine {
 public:
  SourceLine() = default;
  // A line by itself, which is copied.
  SourceLine(const char* line) : SourceLine(std::string_view(line)) {}
  SourceLine(const std::string& line) : SourceLine(std::string_view(line)) {}
  SourceLine(std::string_view line) : text_(std::make_shared<const std::string>(line)), length_(line.size()) {}
  // `length` bytes of `text` from `begin` on; within the text.
  SourceLine(std::shared_ptr<const std::string> text, size_t begin, size_t length)
      : text_(std::move(text)), begin_(begin), length_(length) {}
  // Without its end; empty when there is none. Valid while this lives.
  std::string_view view() const {
    return text_ ? std::string_view(*text_).substr(begin_, length_) : std::string_view{};
  }

 private:
  std::shared_ptr<const std::string> text_;
  size_t begin_ = 0, length_ = 0;
};

// A place in a file. line and column count from 1; 0 means "the file as a whole" (binary files use byte_offset).
struct Where {
  std::string file;
  int line = 0;
  int column = 0;
  SourceLine source_line;      // text of that line, for the caret; may be empty
  long long byte_offset = -1;  // position in a binary file, or -1
};

// Thrown by formats, apps and constructors; caught once, in run_app (exit code 1).
class Error : public std::exception {
 public:
  // what: the fault, e.g. "unknown material 'asphlat'"; hint: what would be right, e.g. "did you mean 'asphalt'?";
  // code: stable issue code such as "SP104", or empty.
  Error(Where where, std::string what, std::string hint = {}, std::string code = {});
  explicit Error(std::string what, std::string hint = {}) : Error(Where{}, std::move(what), std::move(hint)) {}

  const Where& where() const { return where_; }
  const std::string& message() const { return message_; }
  const std::string& hint() const { return hint_; }
  const std::string& code() const { return code_; }
  // The whole text, without a trailing newline: "f.yaml:12:9: error: ... [SP104]; did you mean ...?" + source line +
  // caret.
  const char* what() const noexcept override { return text_.c_str(); }

 private:
  Where where_;
  std::string message_, hint_, code_, text_;
};

// "file:line:column" / "file: byte 123" / "file" of a place; empty for an empty place.
std::string to_text(const Where& where);

// The source line of a place with a caret under the column, each on a new line and indented; empty when there is none.
// Of a long line 160 bytes around the column are shown. Tabs are kept, so that the caret stands right in a terminal.
std::string excerpt(const Where& where);

// A text from outside as it may be shown in a terminal: control characters, what is not UTF-8, and characters that
// change the direction of writing are shown as \n, \t, \xHH or \u{HHHH}.
std::string printable(std::string_view text);
// The same for a whole message, whose line ends and tabs are its own.
std::string printable_lines(std::string_view text);
// Bytes of the longest beginning that is UTF-8, without surrogates and overlong forms.
size_t utf8_bytes(std::string_view text);

// The known name nearest to `name` (Damerau-Levenshtein distance at most max(1, length/3)), or empty.
std::string nearest_name(std::string_view name, std::span<const std::string> known);

// "did you mean 'x'?" when a near name exists, else "known: a, b, c".
std::string name_hint(std::string_view name, std::span<const std::string> known);

// printf-style formatting into a string.
[[gnu::format(printf, 1, 2)]] std::string strf(const char* format, ...);

// CHECK(condition, ...): our own bug. Outside the render loop it throws Bug (run_app: exit 3).
class Bug : public std::exception {
 public:
  explicit Bug(std::string text) : text_(std::move(text)) {}
  const char* what() const noexcept override { return text_.c_str(); }

 private:
  std::string text_;
};
[[noreturn]] void throw_bug(const char* file, int line, const char* condition, const std::string& values);

namespace detail {
template <class T>
std::string show(const T& value) {
  if constexpr (std::is_arithmetic_v<T>)
    return std::to_string(value);
  else if constexpr (std::is_convertible_v<T, std::string_view>)
    return std::string(std::string_view(value));
  else
    return "?";
}
}  // namespace detail

#define SUITE_CHECK(condition)                                                \
  do {                                                                        \
    if (!(condition)) ::suite::throw_bug(__FILE__, __LINE__, #condition, ""); \
  } while (false)

#define SUITE_CHECK_OP(a, op, b)                                                                         \
  do {                                                                                                   \
    const auto& suite_a = (a);                                                                           \
    const auto& suite_b = (b);                                                                           \
    if (!(suite_a op suite_b))                                                                           \
      ::suite::throw_bug(__FILE__, __LINE__, #a " " #op " " #b,                                          \
                         ::suite::detail::show(suite_a) + " against " + ::suite::detail::show(suite_b)); \
  } while (false)
#define SUITE_CHECK_EQ(a, b) SUITE_CHECK_OP(a, ==, b)
#define SUITE_CHECK_LT(a, b) SUITE_CHECK_OP(a, <, b)
#define SUITE_CHECK_LE(a, b) SUITE_CHECK_OP(a, <=, b)

}  // namespace suite
