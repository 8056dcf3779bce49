#include "formats/assimp/long_numbers.h"

#include <charconv>
#include <cmath>
#include <string_view>

#include "base/error.h"

namespace suite {

namespace {

constexpr size_t kShort = 16;         // characters that no reader gets wrong
constexpr size_t kLongestOfFbx = 31;  // characters of a token (assimp: FBXParser.cpp, ParseTokenAsFloat)
constexpr size_t kWholeDigits = 19;   // that surely fit into 64 bits (assimp: fast_atof.h, strtoul10_64)
constexpr size_t kDecimals = 15;      // that are read (fast_atof.h, AI_FAST_ATOF_RELAVANT_DECIMALS)

bool digit(char c) { return c >= '0' && c <= '9'; }
bool of_number(char c) { return digit(c) || c == '+' || c == '-' || c == '.' || c == 'e' || c == 'E'; }

double value_of(std::string_view text) {
  double value = 0;
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  return code == std::errc() && stop == text.data() + text.size() ? value : NAN;
}

// What is wrong with a token; empty = nothing, or it is no number.
std::string fault_of(std::string_view token, bool fbx) {
  const double right = value_of(token);
  if (std::isnan(right)) return {};
  if (fbx && token.size() > kLongestOfFbx) return strf("a number of %zu characters, which is read as 0", token.size());
  size_t first = token.find_first_not_of("+-0");
  if (first == token.npos) return {};
  const size_t point = std::min(token.find_first_of(".eE"), token.size());
  if (first < point && point - first > kWholeDigits)
    return strf("a number with %zu digits before its point, which does not fit into 64 bits", point - first);
  if (point == token.size() || token[point] != '.') return {};
  const size_t end = std::min(token.find_first_of("eE", point), token.size());
  if (end - point - 1 <= kDecimals) return {};
  const double cut = value_of(std::string(token.substr(0, point + 1 + kDecimals)) + std::string(token.substr(end)));
  // Places are single precision in the library; what is less than any length counts for nothing.
  if (std::fabs(cut - right) <= 1e-6 * std::fabs(right) || std::fabs(right) < 1e-12) return {};
  return strf("a number with %zu decimals, of which %zu are read", end - point - 1, kDecimals);
}

}  // namespace

void check_long_numbers(std::span<const std::byte> bytes, const std::string& file, const std::string& extension) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const bool fbx = extension == "fbx";
  if ((!fbx && extension != "dae") || text.starts_with("Kaydara FBX Binary")) return;
  bool skip = false;  // in quotes or a comment of FBX, in a tag of Collada
  char until = 0;
  int line = 1;
  size_t line_start = 0;
  for (size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '\n') ++line, line_start = at + 1;
    if (skip) {
      skip = c != until;
      ++at;
    } else if (fbx ? c == '"' || c == ';' : c == '<') {
      skip = true, until = c == '"' ? '"' : c == ';' ? '\n' : '>';
      ++at;
    } else if (!of_number(c)) {
      ++at;
    } else {
      size_t end = at;
      while (end < text.size() && of_number(text[end])) ++end;
      if (end - at > kShort)
        if (const std::string what = fault_of(text.substr(at, end - at), fbx); !what.empty())
          throw Error(Where{file, line, static_cast<int>(at - line_start) + 1, {}, -1},
                      what + " by the library for this format (assimp): '" +
                          std::string(text.substr(at, std::min<size_t>(end - at, 60))) + "'",
                      "write it with at most 17 digits, as its value is");
      at = end;
    }
  }
}

}  // namespace suite
