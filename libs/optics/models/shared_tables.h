// Tables that are costly to make and the same for many baked models: made once for each key, kept until the program
// ends.
#pragma once
#include <map>
#include <memory>
#include <mutex>

#include "base/parallel.h"

namespace suite {

template <class Key, class Table>
class SharedTables {
 public:
  // The table of `key`, made by Table(key) when it is asked for first. Safe to call from many threads: who comes second
  // waits for the first, and what the first does in parallel takes up nothing that could wait for itself.
  std::shared_ptr<const Table> get(const Key& key) {
    Slot* slot;
    {
      const std::lock_guard lock(mutex_);
      slot = &slots_[key];
    }
    std::call_once(slot->made, [&] { isolated([&] { slot->table = std::make_shared<const Table>(key); }); });
    return slot->table;
  }

 private:
  struct Slot {
    std::once_flag made;
    std::shared_ptr<const Table> table;
  };
  std::mutex mutex_;
  std::map<Key, Slot> slots_;  // its elements stay where they are
};

}  // namespace suite
