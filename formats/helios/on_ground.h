// Parts that HELIOS++ puts on the ground.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "formats/helios/helios.h"
#include "formats/helios/part.h"

namespace suite::helios {

// Changes the heights of parts whose `on_ground` is not 0, in order, as HELIOS++ does: the part's lowest vertex (by
// `on_ground` 1) or that of the tried ones which is lowest above the ground's plane is moved onto that plane, straight
// up or down. The plane is fitted (least squares of distances) to the corners of all triangles of the first part
// that is ground and whose bounds in x and y hold the part's lowest vertex. tell: what became of each of those parts,
// with a code of a report. Error, located: as `files`, but a missing file of materials, which is told.
// Based on: HELIOS++, Scene::doForceOnGround (https://github.com/3dgeo-heidelberg/helios, src/scene/Scene.cpp).
void put_on_ground(std::vector<Part>& parts, const HeliosFiles& files,
                   const std::function<void(const char* code, const Part& part, const std::string& what)>& add_finding);

}  // namespace suite::helios
