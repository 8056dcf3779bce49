#include "base/markup.h"

namespace suite {

std::string in_markup(std::string_view text) {
  std::string r;
  for (const char c : text) {
    if (c == '<')
      r += "&lt;";
    else if (c == '>')
      r += "&gt;";
    else if (c == '&')
      r += "&amp;";
    else if (c == '"')
      r += "&quot;";
    else
      r += c;
  }
  return r;
}

}  // namespace suite
