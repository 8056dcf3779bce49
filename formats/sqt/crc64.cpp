#include <lzma.h>

#include "formats/sqt/container.h"

namespace suite::sqt_file {

uint64_t crc64(std::span<const std::byte> bytes, uint64_t crc) {
  return lzma_crc64(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), crc);
}

}  // namespace suite::sqt_file
