// What a simulation needs of a prepared scene, and what a load read and left out.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace suite {

class SpillFile;  // base/mapped_file.h

// Nothing given = everything is read.
struct SceneNeeds {
  std::vector<std::array<double, 2>> windows_um;  // wavelengths that some sensor sees; empty = all
  bool temperatures = false;                      // wanted for themselves (truth), whether they glow or not
  // Bytes: arrays of geometry from there on are not held but mapped. Plain ones are the file itself, read mesh by mesh
  // when asked for; packed ones are unpacked into a file at once.
  uint64_t later_from = UINT64_MAX;
  // Where packed ones go; processes that read the same scenes may share it. Null = each scene in one of its own.
  std::shared_ptr<SpillFile> spill = nullptr;
};

// What has been read since of the arrays that were left for later; several threads count.
struct LaterReads {
  size_t meshes = 0;    // that were left
  uint64_t stored = 0;  // bytes of their arrays
  std::atomic<size_t> meshes_read{0};
  std::atomic<uint64_t> read{0};
  std::string text() const;  // one line
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
  std::shared_ptr<LaterReads> later;  // null: nothing was left for later
  uint64_t left_out() const;          // bytes
  std::string text() const;           // a table, one line a feature that the scene has, and the sum
};

// What each feature of the table is, when it is needed, and how the reader decides; for --explain. Error with the known
// names for another one.
std::string explain_feature(const std::string& feature);

}  // namespace suite
