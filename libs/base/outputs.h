// Where the files of a program go: the one rule for their folders and names.
#pragma once
#include <string>
#include <vector>

namespace suite {

// Makes the folders (parents too) that the output files are to stand in; empty names and "-" are left out. To be called
// when the inputs are known to be good and before time is spent. Error, naming the file: a folder cannot be made or is
// not writable.
void make_folders_of(const std::vector<std::string>& files);

// The name of a file in a folder as the user wrote it, with or without slashes at its end: "out", "out/" -> "out/name".
std::string in_folder(const std::string& folder, const std::string& name);

}  // namespace suite
