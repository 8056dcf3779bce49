// Meshes for tests, as if read from a file.
#pragma once
#include "scene/draft.h"

namespace suite {

// Triangles of one run, a line each of "m.obj".
inline SourceMesh soup(std::vector<Vec3> positions, std::vector<uint32_t> indices) {
  SourceMesh m;
  m.file = "m.obj";
  m.positions = std::move(positions);
  m.indices = std::move(indices);
  for (size_t t = 0; t < m.indices.size() / 3; ++t) m.lines.push_back(static_cast<int>(t + 1));
  m.runs = {{"", "", 0, 1}};
  return m;
}

}  // namespace suite
