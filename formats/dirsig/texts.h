// The bytes of a text file, whatever editor they come from, as UTF-8 with lines that end in '\n' or "\r\n".
#pragma once
#include <string>

namespace suite::dirsig {

// Without a byte order mark; UTF-16 with one becomes UTF-8, what is no UTF-8 is taken as Latin-1, a carriage return by
// itself ends a line. how: one clause of what was done beyond leaving out the mark; empty = nothing. Error naming
// `file`: UTF-16 that is cut or has halves of pairs.
std::string plain_text(std::string bytes, const std::string& file, std::string& how);
// The same of a file of at most `most` bytes. Error: as reading.
std::string plain_text_of(const std::string& path, size_t most, std::string& how);

}  // namespace suite::dirsig
