// One run at a time writes to a place: a lock file beside the results, which says who holds it.
#pragma once
#include <string>

namespace suite {

// Holds `<place>/run.lock` of a folder, or `<place>.lock` of a file, while it lives; the file goes with the run, also
// when a signal ends it. It holds the host, the process and the command line. A lock whose run has died is taken over:
// the system drops the lock of a process that ends (flock); where the file system knows no locks, a run on this host is
// looked up by its process, and one on another host counts as running.
class RunLock {
 public:
  RunLock() = default;  // holds nothing
  // Error: another run holds the lock (with its host and process), or it cannot be written. A folder that is not there
  // is made, and goes with the lock when nothing else came into it.
  static RunLock of_folder(const std::string& folder);
  static RunLock of_file(const std::string& file);
  RunLock(RunLock&& other) noexcept;
  RunLock& operator=(RunLock&& other) noexcept;
  ~RunLock();

 private:
  RunLock(const std::string& path, const std::string& place, std::string made = {});
  struct Held;
  Held* held_ = nullptr;
};

}  // namespace suite
