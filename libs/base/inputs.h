// Which files this program has read, so that none of them is replaced by what it writes. A file is what device and
// inode say it is, whatever its names: links and "./x" are seen through.
#pragma once
#include <string>
#include <vector>

namespace suite {

// From now on what is read through files.h is noted, and an AtomicFile over it is refused. run_app calls it; without it
// the functions below do nothing.
void track_inputs();

// Notes a file that another library reads, or that is going to be read. Nothing when there is no such file.
void note_input(const std::string& path);

// The name under which the file at `path` was read; empty when it was not, or when nothing is there.
std::string input_at(const std::string& path);

// Before work begins: refuses outputs that are inputs noted so far, or each other. Empty names and "-" are left out.
// Throws UsageError.
void check_outputs(const std::vector<std::string>& outputs);

// While it lives, what this thread reads is the program's own (the state of a run, an earlier result), which it may
// replace.
class OwnResults {
 public:
  OwnResults();
  ~OwnResults();
  OwnResults(const OwnResults&) = delete;
  OwnResults& operator=(const OwnResults&) = delete;
};

}  // namespace suite
