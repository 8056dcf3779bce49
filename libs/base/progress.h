// Progress and forecast of long work: a bar with rate and remaining time on a terminal, plain lines otherwise.
#pragma once
#include <atomic>
#include <chrono>
#include <mutex>
#include <string>

#include "base/time_left.h"

namespace suite {

class Progress {
 public:
  // label: "rendering"; total: units of work; unit: "pixel", empty for work that is not counted (add() nothing; a line
  // at its end says what it took). Writes to standard error unless quieted.
  Progress(std::string label, double total, std::string unit, TimeLeft::Bounds bounds = {});
  ~Progress();              // finishes the line
  void add(double amount);  // from any thread
  void finish();            // idempotent; prints the closing line with total time and mean rate
  double seconds() const;   // since construction
  static void set_quiet(bool quiet);
  static void set_silent(bool silent);  // the same, whatever --quiet says

 private:
  void draw(bool last);
  std::string label_, unit_;
  double total_;
  TimeLeft left_;
  std::atomic<double> done_{0};
  std::chrono::steady_clock::time_point start_, next_;
  std::mutex mutex_;
  bool terminal_, finished_ = false;
  int last_decile_ = 0;
};

// "3.2 s", "4 min 05 s", "2 h 13 min".
std::string human_seconds(double seconds);
// "12.3 k", "4.56 M".
std::string human_count(double count);
// "1.23 MB" (powers of ten).
std::string human_bytes(double bytes);

}  // namespace suite
