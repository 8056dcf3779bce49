// Numbers as words of other people's texts.
#pragma once
#include <optional>
#include <string_view>

namespace suite {

// The number that all of a word writes, with or without a leading +; nothing when it writes none. What is too small for
// a double is 0, what is too large is infinite; "nan" and "inf" are numbers here, which the caller may refuse.
std::optional<double> number_of(std::string_view word);

}  // namespace suite
