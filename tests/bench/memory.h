// What a process occupies, for benches.
#pragma once
#include <fstream>
#include <string>

namespace suite::bench {

// Bytes that /proc/self/status gives for a key: "VmRSS:" now, "VmHWM:" at the peak. 0 where there is no such file.
inline double memory(const char* key) {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;)
    if (word == key) {
      double kb = 0;
      file >> kb;
      return 1024 * kb;
    }
  return 0;
}

}  // namespace suite::bench
