// Which blocks of a job a process runs, when several share a job and do not talk to each other until their states are
// joined.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scheduler/items.h"

namespace suite {

struct Share {
  uint32_t part = 0, parts = 1;  // 0 .. parts - 1; parts = 0: no block, results are made of what a store holds
  bool runs() const { return parts > 0; }
  // Of every `parts` blocks that follow one another each part has one; which, is drawn by lot, so that the shares do
  // not follow the lines of a picture and cost alike. block: counted over all captures in the order of their numbers.
  bool takes(uint64_t block) const;
  std::string text() const;  // "part 2 of 8"
};

// The blocks of each capture that are a share's: [capture][block], 1 or 0.
std::vector<std::vector<uint8_t>> blocks_of_share(std::span<const std::unique_ptr<Sensor>> sensors, const Share& share);

}  // namespace suite
