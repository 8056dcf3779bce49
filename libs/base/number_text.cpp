#include "base/number_text.h"

#include <charconv>
#include <cmath>

namespace suite {

std::optional<double> number_of(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  double value = 0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (code == std::errc::invalid_argument || end != word.data() + word.size()) return std::nullopt;
  if (code != std::errc::result_out_of_range) return value;
  // Without an exponent only hundreds of digits lead out of range: to the left of the point, or behind zeros.
  const size_t digit = word.find_first_not_of("-0.");
  const bool small = word.find_first_of("eE") == word.npos ? word.find('.') < digit : word.find('-', 1) != word.npos;
  return small ? 0 : std::copysign(INFINITY, word.front() == '-' ? -1.0 : 1.0);
}

}  // namespace suite
