// What a simulation needs of a prepared scene, and what a load read and left out.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace suite {

// Nothing given = everything is read.
struct SceneNeeds {
  std::vector<std::array<double, 2>> windows_um;  // wavelengths that some sensor sees; empty = all
  bool temperatures = false;                      // wanted for themselves (truth), whether they glow or not
};

// Parts of a scene that a simulation may do without.
struct LoadRow {
  std::string feature;            // "texture coordinates"
  std::string why;                // one clause: why it was read or left out
  uint64_t stored = 0, read = 0;  // bytes
};

struct LoadReport {
  std::vector<LoadRow> rows;
  std::vector<std::string> datasets;  // names of those of which something was read
  uint64_t left_out() const;          // bytes
  std::string text() const;           // a table, one line a feature that the scene has, and the sum
};

// What each feature of the table is, when it is needed, and how the reader decides; for --explain. Error with the known
// names for another one.
std::string explain_feature(const std::string& feature);

}  // namespace suite
