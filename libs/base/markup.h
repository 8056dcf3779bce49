// Text inside XML and HTML.
#pragma once
#include <string>
#include <string_view>

namespace suite {

// The text with &, <, > and " as entities, for elements and attributes in double quotes.
std::string in_markup(std::string_view text);

}  // namespace suite
