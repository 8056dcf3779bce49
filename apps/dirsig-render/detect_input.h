// Where responses come from: stored ones, or DIRSIG's photons.
#pragma once
#include <functional>
#include <string>

#include "detection/response.h"

namespace suite {

struct ResponseSource {
  ResponseHead head;
  uint64_t pulses = 0;
  // Hands all blocks over, in order.
  std::function<void(ResponseSink&)> read;
};
// Error: as of formats/response and formats/dirsig_bin; a .bin whose pulses have bins of different widths, several
// tasks, or several samples a bin.
ResponseSource open_response(const std::string& path);

}  // namespace suite
