// Point clouds of text as HELIOS++ takes them: cubes where points are.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "math/vec.h"

namespace suite::helios {

struct Cubes {
  std::string
      obj;  // the faces between full and empty cells, outwards, as Wavefront OBJ in the points' own coordinates, m
  std::vector<Vec3> centres;  // of the cubes; columns of one x and y together
  size_t points = 0;
};

// Rows x y z and anything behind, numbers between blanks, tabs and the characters of `separators`; lines that begin
// with '#' or "//" are comments. Cells are edge_m wide (> 0) from the least coordinates on. Error, located: no row, a
// row without three numbers; more than 2^25 cells or 2^20 triangles.
Cubes cubes_of_xyz(std::string_view text, const std::string& file, const std::string& separators, double edge_m);

}  // namespace suite::helios
