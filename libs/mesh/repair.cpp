// Orientation spreads over manifold edges from the first triangle of each piece; a closed piece is then turned outwards
// by the sign of its volume. Based on: the usual flood over the dual graph.
#include "mesh/repair.h"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <numeric>
#include <set>

#include "mesh/check.h"
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

// Keeps the triangles marked, with their lines and runs.
size_t keep(SourceMesh& mesh, const std::vector<bool>& kept) {
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
  return keep(mesh, kept);
}

struct HalfEdge {
  uint64_t key;
  uint32_t triangle;
  bool forward;
};

size_t orient(SourceMesh& mesh, const std::vector<uint32_t>& first) {
  const size_t n = mesh.indices.size() / 3;
  std::vector<HalfEdge> edges;
  for (uint32_t t = 0; t < n; ++t)
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t a = first[mesh.indices[3 * size_t{t} + k]], b = first[mesh.indices[3 * size_t{t} + (k + 1) % 3]];
      edges.push_back({uint64_t{std::min(a, b)} << 32 | std::max(a, b), t, a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return a.key != b.key ? a.key < b.key : a.triangle < b.triangle;
  });
  // Neighbours over edges of exactly two triangles; opposed: the two run the edge the same way, so one must turn.
  struct Link {
    uint32_t to;
    bool opposed;
  };
  std::vector<std::vector<Link>> links(n);
  std::vector<bool> open(n);
  for (size_t i = 0; i < edges.size();) {
    size_t end = i;
    while (end < edges.size() && edges[end].key == edges[i].key) ++end;
    if (end - i == 2) {
      const bool opposed = edges[i].forward == edges[i + 1].forward;
      links[edges[i].triangle].push_back({edges[i + 1].triangle, opposed});
      links[edges[i + 1].triangle].push_back({edges[i].triangle, opposed});
    } else {
      for (size_t k = i; k < end; ++k) open[edges[k].triangle] = true;
    }
    i = end;
  }
  std::vector<int8_t> turn(n, -1);
  size_t turned = 0;
  for (uint32_t start = 0; start < n; ++start) {
    if (turn[start] >= 0) continue;
    std::vector<uint32_t> piece{start};
    turn[start] = 0;
    bool closed = true, consistent = true;
    double volume = 0;
    const Vec3 base = mesh.positions[mesh.indices[3 * size_t{start}]];
    for (size_t at = 0; at < piece.size(); ++at) {
      const uint32_t t = piece[at];
      closed = closed && !open[t];
      const auto p = [&](size_t k) { return mesh.positions[mesh.indices[3 * size_t{t} + k]] - base; };
      volume += dot(p(0), cross(p(1), p(2))) * (turn[t] ? -1 : 1);
      for (const Link& l : links[t]) {
        const auto wanted = static_cast<int8_t>(turn[t] ^ (l.opposed ? 1 : 0));
        if (turn[l.to] < 0)
          turn[l.to] = wanted, piece.push_back(l.to);
        else if (turn[l.to] != wanted)
          consistent = false;
      }
    }
    const auto flips =
        static_cast<size_t>(std::count_if(piece.begin(), piece.end(), [&](uint32_t t) { return turn[t] == 1; }));
    // Closed pieces face outwards; open ones follow their majority.
    const bool invert = closed ? volume < 0 : 2 * flips > piece.size();
    for (const uint32_t t : piece)
      if (consistent && (turn[t] == 1) != invert)
        std::swap(mesh.indices[3 * size_t{t} + 1], mesh.indices[3 * size_t{t} + 2]), ++turned;
  }
  return turned;
}

}  // namespace

MeshRepairs repair_mesh(SourceMesh& mesh) {
  MeshRepairs done;
  const std::vector<uint32_t> first = weld(mesh.positions);
  done.welded = weld_vertices(mesh, first);
  done.dropped = drop_bad(mesh, first);
  done.turned = orient(mesh, first);
  return done;
}

}  // namespace suite
