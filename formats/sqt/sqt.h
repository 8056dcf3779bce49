// .sqt: a fitted scattering function in one file (FORMAT.md). JSON header and payload compressed, checksum over both.
// This is the reader; sqt_write.h, a library of its own, writes.
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "sqt/bundle.h"

namespace suite {

// Versions read. A file is written as the oldest that can say what it holds.
inline constexpr int kSqtOldest = 3, kSqtRefined = 4, kSqtVersion = 5;

struct SqtFile {
  std::shared_ptr<const sqt::Bundle> bundle;
  std::string header;  // JSON text
  int version = 0;
  size_t bytes = 0;
};
// Errors: missing, not an SQT, a newer version, checksum mismatch, truncated, implausible sizes, inconsistent data.
SqtFile parse_sqt(std::span<const std::byte> bytes, const std::string& file_name);
SqtFile read_sqt(const std::string& path);

}  // namespace suite
