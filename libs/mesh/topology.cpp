// Edges by sorting: every fault of an edge shows in how many triangles run along it, and which way. Boundary loops are
// then walked in OpenMesh's half-edge structure. OpenMesh aborts the process on anything but a manifold, so it is shown
// only meshes whose edges and vertices have been found to be one.
#include <algorithm>
#include <numeric>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include "mesh/check.h"
#include "mesh/quiet.h"

namespace suite {

namespace {

struct Edge {
  uint64_t key;  // smaller vertex, larger vertex
  uint32_t triangle;
  uint32_t forward;  // 1 = from the smaller to the larger
};

uint32_t root(std::vector<uint32_t>& parent, uint32_t v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

bool repeated(const uint32_t* v) { return v[0] == v[1] || v[1] == v[2] || v[2] == v[0]; }

// Joins the corners that triangles have on common edges: around a sound vertex they become one fan. Returns the
// triangles at vertices with several fans, in ascending order.
std::vector<uint32_t> several_fans(std::span<const uint32_t> corners, size_t vertices, std::span<const Edge> edges) {
  std::vector<uint32_t> parent(corners.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto corner = [&](uint32_t triangle, uint32_t vertex) {
    uint32_t k = 3 * triangle;
    while (corners[k] != vertex) ++k;
    return k;
  };
  for (size_t i = 0; i + 1 < edges.size(); ++i)
    if (edges[i].key == edges[i + 1].key)
      for (const auto v : {static_cast<uint32_t>(edges[i].key >> 32), static_cast<uint32_t>(edges[i].key)})
        parent[root(parent, corner(edges[i].triangle, v))] = root(parent, corner(edges[i + 1].triangle, v));
  std::vector<uint32_t> fan(vertices, kNone), bad;
  for (size_t t = 0; t + 2 < corners.size(); t += 3)
    for (uint32_t k = 0; k < 3 && !repeated(&corners[t]); ++k) {
      const uint32_t mine = root(parent, static_cast<uint32_t>(t + k));
      uint32_t& known = fan[corners[t + k]];
      if (known == kNone) known = mine;
      if (known != mine) bad.push_back(static_cast<uint32_t>(t / 3));
    }
  bad.erase(std::unique(bad.begin(), bad.end()), bad.end());
  return bad;
}

size_t count_loops(std::span<const uint32_t> corners, size_t vertices) {
  using Mesh = OpenMesh::TriMesh_ArrayKernelT<>;
  quiet_openmesh();
  Mesh mesh;
  mesh.reserve(vertices, corners.size() / 2, corners.size() / 3);
  for (size_t v = 0; v < vertices; ++v) mesh.add_vertex(Mesh::Point(0, 0, 0));
  for (size_t t = 0; t + 2 < corners.size(); t += 3) {
    if (repeated(&corners[t])) continue;
    const auto v = [&](size_t k) { return Mesh::VertexHandle(static_cast<int>(corners[t + k])); };
    mesh.add_face(v(0), v(1), v(2));
  }
  std::vector<bool> seen(mesh.n_halfedges());
  size_t loops = 0;
  for (const auto h : mesh.halfedges()) {
    if (!mesh.is_boundary(h) || seen[static_cast<size_t>(h.idx())]) continue;
    ++loops;
    for (auto at = Mesh::HalfedgeHandle(h); !seen[static_cast<size_t>(at.idx())]; at = mesh.next_halfedge_handle(at))
      seen[static_cast<size_t>(at.idx())] = true;
  }
  return loops;
}

size_t most_faces_at_a_vertex(std::span<const uint32_t> corners, size_t vertices) {
  std::vector<uint32_t> faces(vertices, 0);
  for (const uint32_t v : corners) ++faces[v];
  return faces.empty() ? 0 : *std::max_element(faces.begin(), faces.end());
}

}  // namespace

Topology topology(std::span<const uint32_t> corners, size_t vertices) {
  Topology result;
  std::vector<Edge> edges;
  edges.reserve(corners.size());
  std::vector<uint32_t> parent(vertices);
  std::iota(parent.begin(), parent.end(), 0u);
  std::vector<bool> used(vertices);
  for (size_t t = 0; t + 2 < corners.size(); t += 3) {
    const uint32_t v[3] = {corners[t], corners[t + 1], corners[t + 2]};
    if (repeated(v)) continue;
    for (int k = 0; k < 3; ++k) {
      const uint32_t a = v[k], b = v[(k + 1) % 3];
      edges.push_back({uint64_t{std::min(a, b)} << 32 | std::max(a, b), static_cast<uint32_t>(t / 3), a < b});
      parent[root(parent, a)] = root(parent, b);
      used[a] = true;
    }
  }
  for (uint32_t v = 0; v < vertices; ++v) result.pieces += used[v] && root(parent, v) == v;
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return a.key != b.key ? a.key < b.key : a.triangle < b.triangle; });
  for (size_t i = 0; i < edges.size();) {
    size_t end = i;
    while (end < edges.size() && edges[end].key == edges[i].key) ++end;
    const size_t n = end - i;
    if (n == 1) ++result.boundary_edges, result.boundary.push_back(edges[i].triangle);
    if (n > 2)
      for (size_t k = i; k < end; ++k) result.non_manifold.push_back(edges[k].triangle);
    if (n == 2 && edges[i].forward == edges[i + 1].forward) result.misoriented.push_back(edges[i + 1].triangle);
    i = end;
  }
  for (auto* list : {&result.boundary, &result.non_manifold, &result.misoriented}) {
    std::sort(list->begin(), list->end());
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  if (!result.non_manifold.empty() || !result.misoriented.empty()) return result;
  result.pinched = several_fans(corners, vertices, edges);
  // OpenMesh walks around a vertex for every face it gets there.
  if (result.boundary_edges && result.pinched.empty() && most_faces_at_a_vertex(corners, vertices) <= 4096)
    result.boundary_loops = count_loops(corners, vertices);
  return result;
}

}  // namespace suite
