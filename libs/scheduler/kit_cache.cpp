#include "scheduler/kit_cache.h"

#include <algorithm>

namespace suite {

void KitCache::make_room() {
  while (bytes_ > budget_) {
    auto oldest = entries_.end();
    for (auto e = entries_.begin(); e != entries_.end(); ++e)
      if (e->second.value.use_count() == 1 && (oldest == entries_.end() || e->second.used < oldest->second.used))
        oldest = e;
    if (oldest == entries_.end()) return;  // all of it is in use
    bytes_ -= oldest->second.bytes;
    entries_.erase(oldest);
  }
}

void KitCache::drop(size_t state) {
  std::erase_if(entries_, [&](const auto& e) {
    if (e.first.state == state) bytes_ -= e.second.bytes;
    return e.first.state == state;
  });
}

size_t KitCache::held(Kind kind) const {
  return static_cast<size_t>(
      std::count_if(entries_.begin(), entries_.end(), [&](const auto& e) { return e.first.kind == kind; }));
}

}  // namespace suite
