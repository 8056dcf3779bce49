// Rows of what paths find: one of each face as things stand in the first interval of rest (rests.h), which holds in all
// of them unless its paths pass where things change; of such faces one more for each later interval.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace suite {

struct PathRows {
  std::vector<uint8_t> changing;  // by face: its paths pass there; empty without intervals
  size_t faces = 0, intervals = 1;

  size_t size() const { return faces + seeing.size() * (intervals - 1); }
  bool has_more(size_t face) const { return !seeing.empty() && changing[face]; }
  // Whether a row is of one interval alone. Known of a face as soon as its paths are.
  bool changes(size_t row) const { return row >= faces || (!changing.empty() && changing[row]); }
  size_t row(size_t face, size_t interval) const {
    return interval == 0 || !has_more(face) ? face : faces + rank[face] * (intervals - 1) + interval - 1;
  }
  uint32_t face(size_t row) const {
    return row < faces ? static_cast<uint32_t>(row) : seeing[(row - faces) / (intervals - 1)];
  }
  uint32_t interval(size_t row) const {
    return row < faces ? 0 : static_cast<uint32_t>((row - faces) % (intervals - 1) + 1);
  }
  // Which rows are traced one after the other with a row: those of faces, or all after them.
  struct Alike {
    size_t begin, end;
  };
  Alike alike(size_t row) const { return row < faces ? Alike{0, faces} : Alike{faces, size()}; }
  // When `changing` is known of all faces.
  void add_more() {
    rank.assign(faces, 0), seeing.clear();
    for (size_t f = 0; f < changing.size(); ++f)
      if (changing[f]) rank[f] = static_cast<uint32_t>(seeing.size()), seeing.push_back(static_cast<uint32_t>(f));
  }

 private:
  std::vector<uint32_t> seeing, rank;  // faces that have more; by face, which of these it is
};

}  // namespace suite
