#include "formats/dirsig/texts.h"

#include <cstdint>

#include "base/error.h"
#include "base/files.h"

namespace suite::dirsig {

namespace {

void put_utf8(uint32_t c, std::string& to) {
  if (c < 0x80) {
    to += static_cast<char>(c);
    return;
  }
  const int more = c < 0x800 ? 1 : c < 0x10000 ? 2 : 3;
  constexpr uint32_t lead[] = {0, 0xc0, 0xe0, 0xf0};
  to += static_cast<char>(lead[more] | c >> (6 * more));
  for (int i = more - 1; i >= 0; --i) to += static_cast<char>(0x80 | (c >> (6 * i) & 0x3f));
}

// Of UTF-16, mark included.
std::string from_utf16(const std::string& bytes, const std::string& file) {
  const bool big = static_cast<unsigned char>(bytes[0]) == 0xfe;
  const auto fault = [&](size_t at) {
    return Error(Where{file, 0, 0, {}, static_cast<long long>(at)}, "text in UTF-16 that is cut or damaged",
                 "save it as UTF-8");
  };
  if (bytes.size() % 2) throw fault(bytes.size() - 1);
  const auto unit = [&](size_t at) -> uint32_t {
    const auto byte = [&](size_t i) { return static_cast<uint32_t>(static_cast<unsigned char>(bytes[i])); };
    return big ? byte(at) << 8 | byte(at + 1) : byte(at + 1) << 8 | byte(at);
  };
  std::string out;
  for (size_t at = 2; at < bytes.size(); at += 2) {
    uint32_t c = unit(at);
    if (c >= 0xd800 && c < 0xe000) {
      const uint32_t low = at + 2 < bytes.size() ? unit(at + 2) : 0;
      if (c >= 0xdc00 || low < 0xdc00 || low >= 0xe000) throw fault(at);
      c = 0x10000 + ((c - 0xd800) << 10) + (low - 0xdc00);
      at += 2;
    }
    put_utf8(c, out);
  }
  return out;
}

// Carriage returns that no '\n' follows.
bool end_lines(std::string& text) {
  bool any = false;
  for (size_t at = text.find('\r'); at != text.npos; at = text.find('\r', at + 1))
    if (at + 1 == text.size() || text[at + 1] != '\n') text[at] = '\n', any = true;
  return any;
}

}  // namespace

std::string plain_text(std::string bytes, const std::string& file, std::string& how) {
  how.clear();
  if (bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff")) {
    bytes = from_utf16(bytes, file);
    how = "the file is UTF-16";
  } else if (bytes.starts_with("\xef\xbb\xbf")) {
    bytes.erase(0, 3);
  }
  if (utf8_bytes(bytes) < bytes.size()) {
    std::string out;
    for (const char c : bytes) put_utf8(static_cast<unsigned char>(c), out);
    bytes = std::move(out);
    how = "the file is not UTF-8 and is taken as Latin-1";
  }
  if (end_lines(bytes)) how += std::string(how.empty() ? "" : "; ") + "its lines end with carriage returns";
  return bytes;
}

std::string plain_text_of(const std::string& path, size_t most, std::string& how) {
  return plain_text(read_text(path, most), path, how);
}

}  // namespace suite::dirsig
