// The files that something is made from: found by name, hashed once, listed with it, so that later one can ask whether
// they still are what they were. What a program must not write over is base/inputs.h.
#pragma once
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace suite {

// One file: the name as written, and its SHA-256. A file that another one brings along is called "grid.vox ->
// density.raw"; one that would be read if it were there has no hash.
struct InputFile {
  std::string name, sha256;
};

class TrackedInputs {
 public:
  // file: where everything starts; it is the first input, without a name. search: folders in which files are also
  // looked for, after the folder of `file`. Error: as read_bytes.
  TrackedInputs(std::string file, std::vector<std::string> search);
  const std::string& file() const { return file_; }
  // Where a name leads: beside `file`, then in the search folders; beside `file` when it is nowhere.
  std::string path_of(const std::string& name) const;
  struct Added {
    std::string path;
    bool first = false;  // the file had not been added before
  };
  // Error: as read_bytes.
  Added add(const std::string& name);
  // A file that stands beside the one that `name` leads to and is read with it, or would be: hashed too, or noted as
  // not being there.
  void add_companion(const std::string& name, const std::string& other);
  const std::vector<InputFile>& all() const { return all_; }

 private:
  std::string file_;
  std::vector<std::string> search_;
  std::vector<InputFile> all_;
  std::unordered_map<std::string, std::string> hashes_;  // path -> SHA-256
};

// Do the files have these contents, found as TrackedInputs finds them? Those that were not there must not be there now.
// False for no inputs.
bool inputs_unchanged(const std::string& file, const std::vector<std::string>& search,
                      std::span<const InputFile> inputs);

// SHA-256 over names and hashes, in an order that does not depend on how they were found.
std::string input_hash(std::span<const InputFile> inputs);

}  // namespace suite
