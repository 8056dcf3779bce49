// Ctrl-C (SIGINT) and SIGTERM. A program ends at once with exit code 128 + signal and takes its unfinished files with
// it; one that can stop in good order asks for that while it works, and then only the second signal ends it at once.
#pragma once

namespace suite {

// run_app calls it. A signal that the parent had switched off stays off. name: of the program, for the message; must
// outlive the program.
void end_on_signals(const char* name);

// While it lives, the first signal only sets stop_signal().
class StopInGoodOrder {
 public:
  StopInGoodOrder();
  ~StopInGoodOrder();
  StopInGoodOrder(const StopInGoodOrder&) = delete;
  StopInGoodOrder& operator=(const StopInGoodOrder&) = delete;
};

// The signal that asked the program to stop; 0 = none.
int stop_signal();

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

}  // namespace suite
