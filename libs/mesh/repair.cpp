#include "mesh/repair.h"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <set>

#include "mesh/orient.h"
#include "mesh/weld.h"

namespace suite {

namespace {

// Vertices that agree in place, normal and UV become one.
size_t weld_vertices(SourceMesh& mesh, const std::vector<uint32_t>& first) {
  std::map<std::array<uint32_t, 4>, uint32_t> known;
  std::vector<uint32_t> to(mesh.positions.size());
  size_t welded = 0;
  for (uint32_t v = 0; v < to.size(); ++v) {
    std::array<uint32_t, 4> key{first[v], mesh.normals.empty() ? 0 : mesh.normals[v], 0, 0};
    if (!mesh.uvs.empty())
      for (size_t k = 0; k < 2; ++k) key[2 + k] = std::bit_cast<uint32_t>(mesh.uvs[2 * size_t{v} + k]);
    const auto [at, fresh] = known.try_emplace(key, v);
    to[v] = at->second;
    welded += !fresh;
  }
  for (uint32_t& v : mesh.indices) v = to[v];
  return welded;
}

}  // namespace

size_t keep_triangles(SourceMesh& mesh, const std::vector<bool>& kept) {
  size_t out = 0, run = 0;
  std::vector<SourceMesh::Run> runs;
  for (size_t t = 0; t < kept.size(); ++t) {
    while (run < mesh.runs.size() && mesh.runs[run].first_triangle == t) {
      runs.push_back(mesh.runs[run++]);
      runs.back().first_triangle = static_cast<uint32_t>(out);
    }
    if (!kept[t]) continue;
    for (size_t k = 0; k < 3; ++k) mesh.indices[3 * out + k] = mesh.indices[3 * t + k];
    if (!mesh.lines.empty()) mesh.lines[out] = mesh.lines[t];
    if (!mesh.smoothing.empty()) mesh.smoothing[out] = mesh.smoothing[t];
    ++out;
  }
  const size_t dropped = kept.size() - out;
  mesh.indices.resize(3 * out);
  if (!mesh.lines.empty()) mesh.lines.resize(out);
  if (!mesh.smoothing.empty()) mesh.smoothing.resize(out);
  mesh.runs = std::move(runs);
  return dropped;
}

namespace {

size_t drop_bad(SourceMesh& mesh, const std::vector<uint32_t>& first) {
  std::vector<bool> kept(mesh.indices.size() / 3, true);
  std::set<std::array<uint32_t, 3>> seen;
  for (size_t t = 0; t < kept.size(); ++t) {
    std::array<uint32_t, 3> v{first[mesh.indices[3 * t]], first[mesh.indices[3 * t + 1]],
                              first[mesh.indices[3 * t + 2]]};
    const Vec3 a = mesh.positions[v[0]], b = mesh.positions[v[1]], c = mesh.positions[v[2]];
    // The smallest corner first: same way round, same key.
    std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());
    kept[t] = v[0] != v[1] && v[1] != v[2] && v[2] != v[0] && length(cross(b - a, c - a)) > 0 && seen.insert(v).second;
  }
  return keep_triangles(mesh, kept);
}

}  // namespace

MeshRepairs tidy_mesh(SourceMesh& mesh) {
  MeshRepairs done;
  const std::vector<uint32_t> first = weld(mesh.positions);
  done.welded = weld_vertices(mesh, first);
  done.dropped = drop_bad(mesh, first);
  return done;
}

MeshRepairs repair_mesh(SourceMesh& mesh) {
  MeshRepairs done = tidy_mesh(mesh);
  const std::vector<bool> turn = to_be_turned(mesh.positions, welded_corners(mesh.positions, mesh.indices));
  for (size_t t = 0; t < turn.size(); ++t)
    if (turn[t]) std::swap(mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]);
  done.turned = static_cast<size_t>(std::count(turn.begin(), turn.end(), true));
  return done;
}

}  // namespace suite
