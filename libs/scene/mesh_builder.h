// What readers of mesh files share: vertices at one place that become one, polygons cut into triangles, runs of groups
// and materials, and the findings that go with them.
#pragma once
#include <span>
#include <string>
#include <unordered_map>

#include "base/report.h"
#include "scene/draft.h"

namespace suite {

class MeshBuilder {
 public:
  // report must outlive this.
  MeshBuilder(const std::string& file, Report& report) : report_(report) { mesh_.file = file; }

  // What the triangles that follow belong to. line: of the file, or 0.
  void part(std::string group, std::string material, int line);
  // False, and SP203, where a place is not finite or farther than 1e15 of the file's units.
  bool is_place(Vec3 place, const Where& where);
  // The vertex at exactly this place, made when there is none since the last forget(). Error: 2^32 - 4 vertices.
  uint32_t vertex(Vec3 place, const Where& where);
  // Vertices made so far are shared no more.
  void forget() { shared_.clear(); }
  void triangle(uint32_t a, uint32_t b, uint32_t c);
  // SP202 and nothing else for fewer than 3 corners; SP206 where it cannot be cut cleanly, and a fan stands for it.
  void polygon(std::span<const uint32_t> corners, const Where& where);
  // A polygon with holes: ring_ends says where its rings end among the corners, the outer one first. Left in
  // SourceMesh::holed.
  void holed_polygon(std::vector<uint32_t> corners, std::vector<size_t> ring_ends, const Where& where);
  void add(const char* code, const Where& where, const std::string& what, size_t count = 1) {
    report_.add(code, mesh_.file, {where, what}, count);
  }

  // What has been made so far, for what a format has beside places: it may be added to.
  SourceMesh& mesh() { return mesh_; }
  bool empty() const { return mesh_.indices.empty() && mesh_.holed.empty(); }
  // The mesh; with one run at least.
  SourceMesh take();

 private:
  struct HashOfPlace {
    size_t operator()(const Vec3& v) const;
  };
  Report& report_;
  SourceMesh mesh_;
  std::unordered_map<Vec3, uint32_t, HashOfPlace> shared_;
  SourceMesh::Run next_;
  bool new_run_ = true;
  std::vector<Vec3> ring_;
};

}  // namespace suite
