#include "mesh/check.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/weld.h"

namespace suite {

namespace {

class Checker {
 public:
  Checker(const SourceMesh& mesh, const MeshCheck& options) : mesh_(mesh), options_(options) {}

  std::vector<MeshFinding> run() {
    if (mesh_.indices.empty()) return {};
    extents();
    first_ = weld(mesh_.positions);
    corners_.reserve(mesh_.indices.size());
    for (const uint32_t v : mesh_.indices) corners_.push_back(first_[v]);
    shapes();
    duplicates();
    edges();
    if (options_.self_intersections) crossings();
    return std::move(findings_);
  }

 private:
  const Vec3& point(size_t corner) const { return mesh_.positions[mesh_.indices[corner]]; }
  Where where(uint32_t triangle) const {
    return {mesh_.file, triangle < mesh_.lines.size() ? mesh_.lines[triangle] : 0, 0, {}, -1};
  }

  void add(const char* code, Where place, const std::string& message, size_t count = 1) {
    add(code, Finding{std::move(place), message}, count);
  }
  // Of a triangle, at its centre.
  void add(const char* code, uint32_t t, const std::string& message, size_t count = 1) {
    const Vec3 middle = (point(3 * size_t{t}) + point(3 * size_t{t} + 1) + point(3 * size_t{t} + 2)) * (1.0 / 3);
    add(code, Finding{where(t), message, std::array{middle.x, middle.y, middle.z}}, count);
  }
  void add(const char* code, Finding finding, size_t count) {
    auto found = std::find_if(findings_.begin(), findings_.end(),
                              [&](const MeshFinding& f) { return std::string(f.code) == code; });
    if (found == findings_.end()) found = findings_.insert(findings_.end(), {code, 0, {}});
    found->count += count;
    if (found->examples.size() < 3) found->examples.push_back(std::move(finding));
  }
  void list(const char* code, const std::vector<uint32_t>& triangles, const std::string& message) {
    for (const uint32_t t : triangles) add(code, t, message);
  }

  struct Against {
    size_t triangles = 0;
    double deepest = 0;  // cosine
    uint32_t worst = 0;
  };

  void crossings() {
    if (const auto found = self_intersecting(mesh_.positions, corners_))
      list("SP308", *found, "crosses another one");
    else
      add("SP315", {mesh_.file, 0, 0, {}, -1},
          strf("more than %zu pairs of triangles are close enough to cross", most_pairs(mesh_.indices.size() / 3)));
  }

  void extents() {
    Box3 box;
    for (const uint32_t v : mesh_.indices) box.grow(mesh_.positions[v]);
    const Vec3 s = box.size();
    const double size = std::max({s.x, s.y, s.z});
    const Where file{mesh_.file, 0, 0, {}, -1};
    if (size > 1e6) add("SP313", file, strf("%g units across", size));
    if (size < 1e-5) add("SP313", file, strf("%g units across", size));
  }

  void shapes() {
    std::vector<bool> used(mesh_.positions.size());
    for (uint32_t t = 0; t < mesh_.indices.size() / 3; ++t) {
      const size_t c = 3 * size_t{t};
      for (size_t k = 0; k < 3; ++k) used[mesh_.indices[c + k]] = true;
      if (corners_[c] == corners_[c + 1] || corners_[c + 1] == corners_[c + 2] || corners_[c + 2] == corners_[c]) {
        add("SP301", t, "two corners are at one place");
        continue;
      }
      const Vec3 a = point(c), b = point(c + 1), d = point(c + 2), n = cross(b - a, d - a);
      const double edge = std::max({length(b - a), length(d - b), length(a - d)}), height = length(n) / edge;
      // Coordinates far from the origin carry their own rounding: height below that is none.
      const double rounding = 4e-16 * std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(a.z), edge});
      if (!(height > rounding)) {
        add("SP302", t, "its corners are on a line");
        continue;
      }
      if (height < options_.sliver * edge) add("SP303", t, strf("height %.3g of its longest edge", height / edge));
      if (!mesh_.normals.empty()) against_winding(t, n);
    }
    report_against_winding();
    const size_t unused = static_cast<size_t>(std::count(used.begin(), used.end(), false));
    if (unused) add("SP309", {mesh_.file, 0, 0, {}, -1}, strf("%zu positions belong to no face", unused), unused);
  }
  void against_winding(uint32_t t, Vec3 n) {
    int given = 0, against = 0;
    double deepest = 0;
    for (size_t k = 0; k < 3; ++k)
      if (const uint32_t code = mesh_.normals[mesh_.indices[3 * size_t{t} + k]]; code != kNoNormal) {
        const double cosine = dot(oct_decode(code), n) / length(n);
        ++given, against += cosine < 0, deepest = std::min(deepest, cosine);
      }
    if (!against) return;
    Against& of = against == given ? turned_ : bent_;
    if (of.triangles++ == 0 || deepest < of.deepest) of.deepest = deepest, of.worst = t;
  }
  // Two causes with cures of their own: each is told once, at its worst triangle.
  void report_against_winding() {
    const auto add_finding = [&](const Against& of, const char* cause) {
      if (of.triangles)
        add("SP311", of.worst,
            strf("%zu triangles %s; the worst by %.0f degrees, here", of.triangles, cause,
                 std::acos(std::max(-1.0, of.deepest)) * 180 / kPi),
            of.triangles);
    };
    add_finding(turned_, "whose normals all do: the faces or their normals are turned");
    add_finding(bent_, "some of whose normals do: they are bent, as is usual for leaves and low polygons");
  }

  // Triangles on the same three places, equal or opposite way round.
  void duplicates() {
    struct Key {
      uint32_t v[3];
      uint32_t triangle;
      bool even;
    };
    std::vector<Key> keys;
    keys.reserve(corners_.size() / 3);
    for (uint32_t t = 0; t < corners_.size() / 3; ++t) {
      Key k{{corners_[3 * size_t{t}], corners_[3 * size_t{t} + 1], corners_[3 * size_t{t} + 2]}, t, true};
      const auto order = [&](int i, int j) {
        if (k.v[i] > k.v[j]) std::swap(k.v[i], k.v[j]), k.even = !k.even;
      };
      order(0, 1), order(1, 2), order(0, 1);
      if (k.v[0] != k.v[1] && k.v[1] != k.v[2]) keys.push_back(k);
    }
    const auto tied = [](const Key& k) { return std::tie(k.v[0], k.v[1], k.v[2]); };
    std::sort(keys.begin(), keys.end(), [&](const Key& a, const Key& b) {
      return tied(a) != tied(b) ? tied(a) < tied(b) : a.triangle < b.triangle;
    });
    std::vector<std::pair<uint32_t, uint32_t>> same, opposite;
    for (size_t i = 1; i < keys.size(); ++i)
      if (tied(keys[i]) == tied(keys[i - 1]))
        (keys[i].even == keys[i - 1].even ? same : opposite).push_back({keys[i].triangle, keys[i - 1].triangle});
    std::sort(same.begin(), same.end());
    std::sort(opposite.begin(), opposite.end());
    for (const auto& [t, other] : same) add("SP304", t, strf("repeats the triangle of line %d", where(other).line));
    for (const auto& [t, other] : opposite)
      add("SP314", t, strf("lies on the back of the triangle of line %d", where(other).line));
  }

  void edges() {
    const Topology topo = topology(corners_, mesh_.positions.size());
    list("SP305", topo.non_manifold, "more than two triangles meet at an edge");
    list("SP307", topo.misoriented, "wound against its neighbour");
    list("SP312", topo.pinched, "touches another surface in one vertex");
    const Where file{mesh_.file, 0, 0, {}, -1};
    if (topo.boundary_edges)
      add("SP306", file,
          topo.boundary_loops ? strf("%zu boundary edges in %zu loops", topo.boundary_edges, topo.boundary_loops)
                              : strf("%zu boundary edges", topo.boundary_edges));
    if (topo.pieces > 1) add("SP310", file, strf("%zu pieces", topo.pieces));
  }

  const SourceMesh& mesh_;
  const MeshCheck& options_;
  std::vector<uint32_t> first_, corners_;
  Against turned_, bent_;  // triangles with normals against them
  std::vector<MeshFinding> findings_;
};

}  // namespace

std::vector<MeshFinding> check_mesh_quality(const SourceMesh& mesh, const MeshCheck& options) {
  return Checker(mesh, options).run();
}

}  // namespace suite
