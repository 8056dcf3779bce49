// Ctrl-C (SIGINT), SIGTERM and SIGHUP. A program ends at once with exit code 128 + signal and takes its unfinished
// files with it; one that can stop in good order asks for that while it works, and then only the second signal ends it
// at once.
#pragma once
#include <signal.h>

#include <atomic>

namespace suite {

// run_app calls it. A signal that the parent had switched off stays off. name: of the program, for the message; must
// outlive the program.
void end_on_signals(const char* name);

// While it lives, the first signal only sets stop_signal(), and stop points throw from then on.
class StopInGoodOrder {
 public:
  StopInGoodOrder();
  ~StopInGoodOrder();
  StopInGoodOrder(const StopInGoodOrder&) = delete;
  StopInGoodOrder& operator=(const StopInGoodOrder&) = delete;
};

// The signal that asked the program to stop; 0 = none.
int stop_signal();

// Thrown through work that is given up because of a signal. No fault, so no std::exception: nobody reports it as one.
struct Stopped {};

namespace interrupt {
extern std::atomic<bool> stop_is_due;
void at_stop_point(double grace_s);
}  // namespace interrupt

// To be passed at least every 100 ms by long work, at any depth and in any thread: throws Stopped once a signal has
// asked for the end in good order. parallel_for passes one before each of its pieces. grace_s: what has nearly finished
// goes on for so long after the signal. Without a signal it costs one load.
inline void stop_point(double grace_s = 0) {
  if (interrupt::stop_is_due.load(std::memory_order_relaxed)) interrupt::at_stop_point(grace_s);
}

// Whether a stop point would throw here: for what cannot be left by an exception.
inline bool stop_is_due() {
  if (!interrupt::stop_is_due.load(std::memory_order_relaxed)) return false;
  try {
    interrupt::at_stop_point(0);
  } catch (const Stopped&) {
    return true;
  }
  return false;
}

// While it lives, this thread and what it runs in parallel do not stop: results that are complete are being written.
class FinishFirst {
 public:
  FinishFirst();
  ~FinishFirst();
  FinishFirst(const FinishFirst&) = delete;
  FinishFirst& operator=(const FinishFirst&) = delete;
  static bool here();  // on this thread
};

// A file that is to vanish when the program is ended by a signal.
class Temporary {
 public:
  explicit Temporary(const char* path);
  ~Temporary();
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

 private:
  struct Slot;
  Slot* slot_;
  friend void end_now(int signal);
};

// Lives while a Temporary is created: a program that ends waits for it, so that no file appears after they were
// removed; once it ends, no file is created any more.
class CreatingFile {
 public:
  CreatingFile();
  ~CreatingFile();
  CreatingFile(const CreatingFile&) = delete;
  CreatingFile& operator=(const CreatingFile&) = delete;

 private:
  sigset_t before_;
};

}  // namespace suite
