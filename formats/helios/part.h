// A part of a scene of HELIOS++: what it is loaded from, and where it stands.
#pragma once
#include <string>
#include <vector>

#include "base/error.h"
#include "math/vec.h"

namespace suite::helios {

struct Turn {
  Dir axis;  // of the scene
  double angle_deg = 0;
};

struct Part {
  enum class Kind { none, mesh, terrain, points, voxels } kind = Kind::none;
  std::string path;               // of its file, as written there, with slashes
  bool y_up = false;              // of a mesh
  std::string separators;         // of points
  double edge_m = 0;              // of the cubes of points
  std::string matfile, material;  // of its loader; empty: none
  std::string object;             // the name of the object or grid that is placed
  std::string id;
  double scale = 1;
  std::vector<Turn> turns;  // one after the other, before the shift
  Vec3 shift;               // m
  long long on_ground = 0;  // 'onGround': how many vertices are tried, -1 all of them, 0 it stays at its shift
  Where where;
};

}  // namespace suite::helios
