// The triangles of a mesh put together into cells of about equal area, or large ones cut into several: what elements on
// meshes are made of. In the mesh's own frame, so that all instances of a mesh may share them.
#pragma once
#include <vector>

#include "heat/cell_contacts.h"
#include "heat/cell_cuts.h"
#include "scene/scene.h"

namespace suite {

class MeshCells {
 public:
  // About `wanted` cells of the triangles for which material_of gives another number than kNone; triangles of different
  // materials are never in one cell. Cells are compact in place and in the direction they face: folds are cut first,
  // and both sides of one are in one cell only where so few cells are wanted. The mesh's arrays must be here.
  MeshCells(const Mesh& mesh, const std::vector<uint32_t>& material_of_part, double wanted);

  size_t size() const { return areas_.size(); }
  double area(size_t cell) const { return areas_[cell]; }  // m2, local
  size_t triangles(size_t cell) const { return end_[cell] - first_[cell]; }
  uint32_t material(size_t cell) const { return materials_[cell]; }  // as material_of_part has it
  double total_area() const { return total_; }

  struct Point {
    uint32_t triangle = 0;
    double u = 0, v = 0;  // barycentrics of vertices 1 and 2
  };
  // Uniform over the cell's area; x, y, z in [0, 1).
  Point point(size_t cell, double x, double y, double z) const;
  // Tells the middle of each of its pieces of triangles, with the piece's area (m2, local).
  template <class Put>
  void each_piece(size_t cell, const Put& put) const {
    for (uint32_t k = first_[cell]; k < end_[cell]; ++k)
      put(within(cell, order_[k], 1.0 / 3, 1.0 / 3), k > first_[cell] ? until_[k] - until_[k - 1] : until_[k]);
  }
  // The cell of a place on a triangle (local, mesh origin included); kNone when it belongs to none.
  uint32_t cell_of(uint32_t triangle, Vec3 local) const;
  // Then cell_of does not ask the place.
  bool whole(uint32_t triangle) const {
    return split_[triangle] <= 1 && (cell_[triangle] == kNone || !cuts_.cut(cell_[triangle]));
  }
  // Cuts a cell in two of about equal areas, the second of which becomes the last cell: pieces of triangles through the
  // middle of their longest side, several triangles as the constructor does.
  void split(uint32_t cell);
  // Which cells touch, as the mesh lies in the world (mesh_contacts.cpp).
  std::vector<CellContact> contacts(const Affine3& to_world) const;

 private:
  class Touching;
  struct Facet {
    Vec3 centre, normal;
    double area;
    uint32_t triangle;
  };
  using Piece = std::array<Vec2, 3>;  // corners, barycentrics of vertices 1 and 2
  Piece piece_of(size_t cell) const;
  Point within(size_t cell, uint32_t triangle, double u, double v) const;  // of its piece of the triangle
  template <class Iterator, class Key>
  static void put_in_order(Iterator from, Iterator to, const Key& key);
  void cut_piece(uint32_t cell);
  void halve(uint32_t cell);
  static size_t divide(std::vector<Facet>& facets, size_t begin, size_t end, double area);
  void cut(const Facet& facet, double target, uint32_t material);
  void gather(std::vector<Facet>& facets, size_t begin, size_t end, double target, uint32_t material);
  void add_cell(double area, uint32_t material);
  std::array<Vec3, 3> corners(uint32_t triangle) const;

  const Mesh& mesh_;
  std::vector<uint32_t> cell_;         // by triangle: its cell, or the first of its cells; kNone
  std::vector<uint16_t> split_;        // by triangle: it has the square of this many cells; 0 = none
  std::vector<uint32_t> first_, end_;  // by cell: where its triangles begin and end
  std::vector<uint32_t> order_;        // triangles by cell
  std::vector<double> until_;          // area of the cell up to and including each
  std::vector<uint32_t> part_;         // by cell: number of the part of a cut triangle
  CellCuts cuts_;
  std::vector<Piece> pieces_;    // that were cut from parts
  std::vector<uint32_t> piece_;  // by cell: of these; kNone
  std::vector<uint32_t> materials_;
  std::vector<double> areas_;
  double total_ = 0;
};

}  // namespace suite
