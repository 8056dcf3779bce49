// Elements: pieces of the scene's surface that have one temperature each, made of a material, an instance and a cell of
// its triangles or of its exact surface.
//
// Assumes: what is at rest in the tracer it is made from, be it there all the time or not, or rests there now and then
// (rests.h): areas and normals of that are those of its first rest. Instances that are more than the budget are put
// together with their neighbours of the same kind.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "heat/mesh_cells.h"
#include "heat/primitive_faces.h"
#include "heat/rests.h"
#include "math/sampling.h"
#include "surface/material_lookup.h"
#include "trace/tracer.h"

namespace suite {

struct HeatElement {
  uint32_t material = kNone;  // index, after overrides and class maps
  uint32_t cell = 0;
  double area = 0;   // m2, of the part of the cell that is of this material
  double share = 1;  // that part
  Vec3 centre;       // m, mean of its points
  Dir normal;        // of its front, mean; unit
};

// Two elements that touch.
struct ElementContact {
  uint32_t a = 0, b = 0;
  double ratio = 0;  // of the length that they touch along to the distance of their middles, of all their instances
};

// Numbers of the choice of a point; one block of four numbers (math/sampling.h) an attempt. stratum: of so many equal
// parts of the element, where it can be cut into such (strata.h), else it makes no difference. interval: of rest, where
// things stand; kNone: where they rest first.
struct PointDraw {
  const SampleStream& stream;
  uint32_t sample = 0, first_block = 0, stratum = 0, strata = 1, interval = kNone;
};

// What tells places apart: direct sun through the day on their fronts, W/m2, so many numbers a place.
struct DaySun {
  size_t numbers = 0;
  std::function<void(std::span<const Hit> places, std::span<float> sun)> at;  // [place][number]
};

// A cell that was cut in two: of which mesh or exact surface, in the order in which cells were cut.
struct CellSplit {
  uint32_t unit, cell;
  bool operator==(const CellSplit&) const = default;
};

class Elements {
 public:
  // heated: by material, whether it has elements. budget: about how many there will be, at least one an instance group.
  // Surfaces without end are cut off half the scene's size around it; beyond they are as warm as at the edge. Keeps a
  // reference to the tracer. time: s, within its window. sun: where it differs most within a cell, area counting, cells
  // are cut in two until there are as many as the budget (elements_split.cpp); none = all of about equal areas. known:
  // what was cut then, instead of asking the sun again. rests: of the tracer's window; what moves has elements where it
  // rests in one of them. Error: nothing of these materials is at rest; what was cut is not there.
  Elements(const Tracer& tracer, const std::vector<bool>& heated, size_t budget, double time,
           const DaySun* sun = nullptr, std::span<const CellSplit> known = {},
           std::span<const RestInterval> rests = {});
  const std::vector<RestInterval>& rests() const { return rests_; }
  // What changes from one to another; null without any.
  const ChangingRoom* changing() const { return changing_.get(); }
  const std::vector<CellSplit>& splits() const { return splits_; }

  size_t size() const { return elements_.size(); }
  const HeatElement& operator[](size_t i) const { return elements_[i]; }
  // Uniform over the element, as a ray would have hit it.
  Hit point(size_t element, const PointDraw& draw) const;
  // Places (m) all over the element's cell, so many on each instance that it is of, one instance after the other.
  std::vector<Vec3> places_by_instance(size_t element, const SampleStream& stream, uint32_t each) const;
  // The element of a material at a place; nothing where none is (what moves, what was left out). Where the cell never
  // had one of this material, as at the edges of maps, the largest one of the cell. time: s, of what moves.
  std::optional<uint32_t> at(const HeatedPlace& place, uint32_t material, double time) const;
  std::optional<uint32_t> at(const Hit& hit, uint32_t material) const;
  // False on what moves then, though it rests at other times.
  bool rests(const Hit& hit) const;
  // For how much of an interval of rest (of the tracer's window, where there are none) each element is there and rests;
  // empty when all are always.
  std::vector<float> presence(size_t interval) const;
  // Whether the element is of what stands in other places at other times.
  bool changes_place(size_t element) const;
  // The place as a hit; nothing where its instance has no elements, or stands elsewhere at other times.
  std::optional<Hit> hit_at(const HeatedPlace& place) const;
  // False beyond the places where surfaces without end are cut off, and on what has no elements.
  bool covers(const Hit& hit) const;

  // Which elements of one object touch (elements_contacts.cpp), each pair once. Elements that share a cell of a class
  // map touch those of other cells for their shares, and nothing of their own.
  std::vector<ElementContact> contacts() const;

  // Leaves out those that are not kept, by element: their places have none. The others keep their order.
  void keep(const std::vector<bool>& kept);
  // The number that an element had among all.
  uint32_t number(size_t element) const {
    return numbers_.empty() ? static_cast<uint32_t>(element) : numbers_[element];
  }
  struct LeftOut {
    uint32_t number, cell, material;
  };
  const std::vector<LeftOut>& left_out() const { return left_out_; }  // ascending

  size_t budget() const { return budget_; }  // as asked
  double total_area() const { return total_area_; }
  size_t instances() const { return slots_.size(); }
  size_t moving() const { return moving_; }          // instances of these materials that move: they have none
  size_t resting() const { return places_.size(); }  // that move, and rest now and then
  static constexpr int kLooks = 64;  // points of a cell of a class map that are looked at, to find its materials
  size_t shared_cells() const { return shared_cells_; }  // that hold several materials
  double largest() const;                                // m2, of an element
  // Two tracers of one scene, and files, fit when this is equal: materials, areas and places of all elements.
  uint64_t fingerprint() const;

 private:
  struct Slot {  // an instance
    uint32_t object, instance, group;
    Affine3 to_world, to_local;  // where it rests first
    uint32_t places = kNone;     // of those of what is elsewhere at other times
  };
  struct Group {  // instances that share elements
    uint32_t first_slot = 0, slots = 0, first_cell = 0;
    const MeshCells* mesh = nullptr;  // or
    uint32_t grid = kNone;            // number of the grid of an exact surface
    std::vector<double> until;        // areas of the slots, summed up; empty for one
  };
  struct Grid {  // on an exact surface
    PrimitiveFaces faces;
    struct Face {
      uint32_t columns, rows, first;  // cells: first + row * columns + column
    };
    std::vector<Face> parts;
    struct Cell {
      uint32_t face;
      Vec2 low, high;  // of the face's unit square
    };
    std::vector<Cell> cells = {};
    CellCuts cuts = {};
    double area(uint32_t cell) const {
      const Cell& c = cells[cell];
      return faces.area(c.face) * (c.high.x - c.low.x) * (c.high.y - c.low.y);
    }
    void split(uint32_t cell);
    uint32_t cell_at(const PrimitiveFaces::Place& place) const;
  };
  struct Planned {  // a group to be
    std::vector<Slot> slots;
    MeshCells* mesh;
    uint32_t grid;
  };
  class Refinement;
  class GridTouching;
  struct Seen;  // while they are made
  struct Local {
    Vec3 position, normal;
    uint32_t triangle = 0;
    double u = 0, v = 0, stretch = 1;
    Vec2 uv;
  };
  void gather(Seen& seen, const std::vector<bool>& heated);
  std::optional<Slot> slot_for(uint32_t number, const TracedObject& object);
  double time_of(const Slot& slot, uint32_t interval = kNone) const;
  Affine3 to_local_at(const Slot& slot, double time) const;
  // together: m2 below whose half instances are put together. target: m2 of a cell.
  void group_meshes(Seen& seen, double together, double target, std::vector<Planned>& planned);
  static double size_of(const Affine3& m);  // what areas grow by, as a mean over directions
  void refine(const std::vector<Planned>& planned, const DaySun& sun, std::span<const CellSplit> known);
  void add_group(Planned planned);
  uint32_t make_grid(const Slot& slot, const Primitive& primitive, double target);
  double look_over(uint32_t cell, const std::function<void(const Hit&, double weight)>& look) const;
  void make_elements(const std::vector<bool>& heated);
  Local local_point(const Group& group, uint32_t cell, const std::array<double, 4>& u) const;
  Hit cell_point(uint32_t cell, const PointDraw& draw, uint32_t& attempt) const;
  void stratify(const Group& group, uint32_t cell, const PointDraw& draw, std::array<double, 4>& u) const;
  std::optional<uint32_t> cell_at(const HeatedPlace& place, double time) const;

  const Tracer& tracer_;
  size_t budget_;
  double time_;
  MaterialLookup lookup_;
  std::vector<std::unique_ptr<MeshCells>> meshes_;
  std::vector<Grid> grids_;
  std::vector<Slot> slots_;
  std::vector<RestInterval> rests_;
  std::vector<RestPlaces> places_;
  std::unique_ptr<const ChangingRoom> changing_;
  std::vector<Group> groups_;
  std::unordered_map<uint32_t, uint32_t> slot_of_;  // by instance
  std::vector<uint32_t> group_of_cell_;
  std::vector<uint32_t> first_element_;  // by cell; cells + 1
  std::vector<HeatElement> elements_;
  std::vector<uint32_t> numbers_;  // among all, where some were left out
  std::vector<LeftOut> left_out_;
  std::vector<CellSplit> splits_;
  double total_area_ = 0;
  size_t moving_ = 0, shared_cells_ = 0;
};

}  // namespace suite
