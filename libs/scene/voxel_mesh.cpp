#include "scene/voxel_mesh.h"

#include <unordered_map>

namespace suite {

SourceMesh voxel_faces(const std::array<uint32_t, 3>& cells, const Affine3& to_local,
                       std::span<const uint16_t> material, const std::set<uint16_t>& solid) {
  SourceMesh mesh;
  std::unordered_map<uint64_t, uint32_t> corner_ids;
  const auto at = [&](const std::array<int64_t, 3>& c) -> int {
    for (size_t a = 0; a < 3; ++a)
      if (c[a] < 0 || c[a] >= int64_t{cells[a]}) return -1;
    const uint16_t m = material[(static_cast<size_t>(c[2]) * cells[1] + static_cast<size_t>(c[1])) * cells[0] +
                                static_cast<size_t>(c[0])];
    return solid.count(m) ? m : -1;
  };
  const auto corner = [&](const std::array<int64_t, 3>& c) {
    const uint64_t key = (static_cast<uint64_t>(c[2]) * (uint64_t{cells[1]} + 1) + static_cast<uint64_t>(c[1])) *
                             (uint64_t{cells[0]} + 1) +
                         static_cast<uint64_t>(c[0]);
    const auto [found, fresh] = corner_ids.try_emplace(key, static_cast<uint32_t>(mesh.positions.size()));
    if (fresh)
      mesh.positions.push_back(
          to_local.point({static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])}));
    return found->second;
  };
  // Two triangles on the side of the cell that looks along +-axis, counter-clockwise seen from outside.
  const auto face = [&](const std::array<int64_t, 3>& cell, size_t axis, bool positive) {
    const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<int64_t, 3> low = cell;
    low[axis] += positive;
    std::array<uint32_t, 4> q;
    for (size_t k = 0; k < 4; ++k) {
      std::array<int64_t, 3> c = low;
      c[u] += k == 1 || k == 2;
      c[v] += k >= 2;
      q[k] = corner(c);
    }
    if (!positive) std::swap(q[1], q[3]);
    mesh.indices.insert(mesh.indices.end(), {q[0], q[1], q[2], q[0], q[2], q[3]});
  };
  for (const uint16_t value : solid) {
    const size_t first = mesh.indices.size() / 3;
    for (int64_t k = 0; k < cells[2]; ++k)
      for (int64_t j = 0; j < cells[1]; ++j)
        for (int64_t i = 0; i < cells[0]; ++i) {
          if (at({i, j, k}) != value) continue;
          for (size_t axis = 0; axis < 3; ++axis)
            for (const bool positive : {false, true}) {
              std::array<int64_t, 3> beyond{i, j, k};
              beyond[axis] += positive ? 1 : -1;
              if (at(beyond) < 0) face({i, j, k}, axis, positive);
            }
        }
    if (mesh.indices.size() / 3 > first)
      mesh.runs.push_back({"", std::to_string(value), static_cast<uint32_t>(first), 0});
    if (mesh.indices.size() / 3 > 0xfffffffeu) throw Error("too many faces", "use fewer cells");
  }
  return mesh;
}

}  // namespace suite
