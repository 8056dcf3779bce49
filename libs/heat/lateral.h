// Conduction along the surface between a scene's elements: who conducts to whom, and what it would change where it is
// left out.
//
// Assumes: elements of one object that touch conduct to each other, layer by layer, where their layers are the same and
// both backs are open or both closed, whatever their optics; others, and elements without heat capacity, do not.
#pragma once
#include <string>
#include <vector>

#include "heat/heat_faces.h"
#include "heat/surfaces.h"

namespace suite {

struct LateralConduction {
  SurfaceNeighbours neighbours;
  size_t apart = 0;  // pairs that touch and do not conduct, as their layers or backs differ
};
LateralConduction lateral_conduction(const Elements& elements, const HeatOptics& optics);

// m, over which conduction along a surface of these layers evens temperatures out.
double evened_over(const std::vector<SlabLayer>& layers);

// Sentences. Of temperatures found without it, by material: how many elements are smaller than what it evens out, and
// by how much it would change them, as the first of the turns by which it would be found; with it: what does not
// conduct.
std::vector<std::string> lateral_notes(const Scene& scene, const Elements& elements, const HeatOptics& optics,
                                       const SurfaceHistory& history);
std::string apart_note(const LateralConduction& lateral);

}  // namespace suite
