// Things that are made when they are first needed. Internal.
#pragma once
#include <atomic>
#include <mutex>

namespace suite {

// Runs a construction once, whichever thread comes first; the others wait. What it spawns is not mixed with other work
// of the thread, which might wait for this very construction.
class BuildOnce {
 public:
  bool done() const { return done_.load(std::memory_order_acquire); }
  template <class Work>
  void run(const Work& work) const {
    if (!done()) go(&work, [](const void* w) { (*static_cast<const Work*>(w))(); });
  }
  // What was constructed goes, and nobody uses it.
  void undo() { done_.store(false, std::memory_order_relaxed); }

 private:
  void go(const void* work, void (*call)(const void*)) const;
  mutable std::mutex turn_;
  mutable std::atomic<bool> done_{false};
};

}  // namespace suite
