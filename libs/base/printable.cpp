// Texts from outside made safe to show: a terminal obeys control characters, and a report is UTF-8.
#include "base/error.h"

namespace suite {

namespace {

struct Decoded {
  uint32_t code = 0;
  size_t bytes = 0;  // 0: not UTF-8
};

// The character that begins at `at`. Based on: The Unicode Standard, table 3-7, well-formed UTF-8.
Decoded decode(std::string_view text, size_t at) {
  const auto byte = [&](size_t i) { return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0u; };
  const uint32_t first = byte(0);
  if (first < 0x80) return {first, 1};
  const size_t n = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4) return {};
  uint32_t code = first & (0xffu >> (n + 1));
  for (size_t i = 1; i < n; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3f);
  }
  constexpr uint32_t least[5] = {0, 0, 0x80, 0x800, 0x10000};
  if (code < least[n] || code > 0x10ffff || (code >= 0xd800 && code <= 0xdfff)) return {};
  return {code, n};
}

// Control characters, and marks that turn the direction of what follows.
bool hidden(uint32_t c) {
  return c < 0x20 || (c >= 0x7f && c < 0xa0) || c == 0x200e || c == 0x200f || (c >= 0x2028 && c <= 0x202e) ||
         (c >= 0x2066 && c <= 0x2069) || c == 0xfeff;
}

std::string shown(std::string_view text, bool keep_lines) {
  std::string out;
  out.reserve(text.size());
  for (size_t at = 0; at < text.size();) {
    const Decoded d = decode(text, at);
    if (!d.bytes)
      out += strf("\\x%02x", static_cast<unsigned char>(text[at]));
    else if (keep_lines && (d.code == '\n' || d.code == '\t'))
      out += text[at];
    else if (d.code == '\n' || d.code == '\t' || d.code == '\r')
      out += d.code == '\n' ? "\\n" : d.code == '\t' ? "\\t" : "\\r";
    else if (!hidden(d.code))
      out += text.substr(at, d.bytes);
    else
      out += d.code < 0x80 ? strf("\\x%02x", d.code) : strf("\\u{%x}", d.code);
    at += d.bytes ? d.bytes : 1;
  }
  return out;
}

}  // namespace

size_t utf8_bytes(std::string_view text) {
  size_t at = 0;
  while (at < text.size()) {
    const size_t n = decode(text, at).bytes;
    if (!n) return at;
    at += n;
  }
  return at;
}

std::string printable(std::string_view text) { return shown(text, false); }
std::string printable_lines(std::string_view text) { return shown(text, true); }

}  // namespace suite
