// What of a scene's elements is solved together: some hundred of a group where each conducts for itself, or all that
// conduct to each other along the surface, directly or by others.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "heat/slab_neighbours.h"
#include "thermal/slab_grid.h"

namespace suite {

struct SurfaceGroup;  // heat/surfaces.h

// Conduction along the surface between elements, by the rows of their fronts.
struct SurfaceNeighbours {
  std::vector<SlabNeighbours::Contact> contacts;
  std::vector<double> areas;  // m2, by row; may be empty without contacts
};

struct SurfacePart {
  struct Member {
    uint32_t group, element;
  };
  std::vector<Member> members;                            // all of the same layers, with open backs or without
  std::shared_ptr<const SlabNeighbours> neighbours = {};  // none: each for itself
};

// Every element of the groups once, of an exchange of so many rows. Error: neighbours of other layers, or one with an
// open and one with a closed back.
std::vector<SurfacePart> surface_parts(std::span<const SurfaceGroup> groups, size_t rows,
                                       const SurfaceNeighbours& neighbours);

// Whether slabs of these are the same.
bool alike(std::span<const SlabLayer> a, std::span<const SlabLayer> b);

}  // namespace suite
