// Keys that must be there, of what a table of kinds knows the choices.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "base/params.h"

namespace suite {

// "one of: a, b, c".
inline std::string choices_text(const std::vector<std::string>& choices) {
  std::string text;
  for (const std::string& c : choices) text += (text.empty() ? "one of: " : ", ") + c;
  return text;
}

// The value of the key of a map. Error: it is missing (with the choices), or misspelt.
inline Params required(const Params& map, std::string_view key, const std::vector<std::string>& choices) {
  const Params value = map.at(key);
  if (!map.has(key)) value.as_choice(choices);  // tells
  return value;
}

}  // namespace suite
