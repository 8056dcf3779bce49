#include <lzma.h>

#include <algorithm>

#include "base/error.h"
#include "formats/sqt/container.h"

namespace suite::sqt_file {

std::vector<std::byte> lzma_compress(std::span<const std::byte> raw) {
  lzma_options_lzma options;
  SUITE_CHECK(!lzma_lzma_preset(&options, 9 | LZMA_PRESET_EXTREME));
  options.dict_size = std::clamp<uint32_t>(static_cast<uint32_t>(std::min<size_t>(raw.size(), options.dict_size)),
                                           LZMA_DICT_SIZE_MIN, options.dict_size);
  lzma_filter filters[] = {{LZMA_FILTER_LZMA2, &options}, {LZMA_VLI_UNKNOWN, nullptr}};
  std::vector<std::byte> out(lzma_stream_buffer_bound(raw.size()));
  size_t size = 0;
  const lzma_ret result =
      lzma_stream_buffer_encode(filters, LZMA_CHECK_NONE, nullptr, reinterpret_cast<const uint8_t*>(raw.data()),
                                raw.size(), reinterpret_cast<uint8_t*>(out.data()), &size, out.size());
  if (result == LZMA_MEM_ERROR) throw std::bad_alloc();
  SUITE_CHECK_EQ(static_cast<int>(result), static_cast<int>(LZMA_OK));
  out.resize(size);
  return out;
}

std::vector<std::byte> lzma_expand(std::span<const std::byte> packed, size_t raw_size) {
  lzma_stream stream = LZMA_STREAM_INIT;
  if (lzma_stream_decoder(&stream, uint64_t{256} << 20, 0) != LZMA_OK) throw std::bad_alloc();
  struct End {
    lzma_stream* s;
    ~End() { lzma_end(s); }
  } end{&stream};
  stream.next_in = reinterpret_cast<const uint8_t*>(packed.data());
  stream.avail_in = packed.size();
  std::vector<std::byte> out;
  lzma_ret result = LZMA_OK;
  while (result == LZMA_OK) {
    const size_t done = stream.total_out, room = std::min(raw_size + 1, std::max<size_t>(2 * done, 1 << 16));
    out.resize(room);
    stream.next_out = reinterpret_cast<uint8_t*>(out.data()) + done;
    stream.avail_out = room - done;
    result = lzma_code(&stream, LZMA_FINISH);
    if (stream.total_out > raw_size) break;
  }
  if (result != LZMA_STREAM_END || stream.total_out != raw_size)
    throw Error("damaged SQT file: LZMA data do not expand to the declared size");
  out.resize(raw_size);
  return out;
}

}  // namespace suite::sqt_file
