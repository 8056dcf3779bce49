// Words of YAML texts that programs make.
#pragma once
#include <cstdio>
#include <string>
#include <string_view>

namespace suite {

// A text between double quotes, as YAML reads it.
inline std::string yaml_quoted(std::string_view text) {
  std::string q = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') q += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      char code[8];
      std::snprintf(code, sizeof code, "\\x%02x", static_cast<unsigned>(c));
      q += code;
    } else {
      q += c;
    }
  }
  return q + "\"";
}

}  // namespace suite
