#include "scheduler/share.h"

#include "base/error.h"
#include "estimate/block.h"
#include "math/sampling.h"

namespace suite {

bool Share::takes(uint64_t block) const {
  constexpr uint64_t lot = 0x7368617265;
  return runs() && (block + hash_of(lot, block / parts) % parts) % parts == part;
}

std::string Share::text() const { return strf("part %u of %u", part + 1, parts); }

std::vector<std::vector<uint8_t>> blocks_of_share(std::span<const std::unique_ptr<Sensor>> sensors,
                                                  const Share& share) {
  std::vector<std::vector<uint8_t>> all;
  uint64_t number = 0;
  for (const auto& sensor : sensors)
    for (const Task& task : sensor->tasks())
      for (const Capture& capture : task.captures) {
        std::vector<uint8_t> mine(blocks_of(capture).size());
        for (uint8_t& m : mine) m = share.takes(number++);
        all.push_back(std::move(mine));
      }
  return all;
}

}  // namespace suite
