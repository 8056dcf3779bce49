// Azimuths of a file as grids of half-vector angles want them.
#pragma once
#include <cstddef>
#include <vector>

#include "math/mueller.h"

namespace suite::sqt {

struct CirclePlace {
  double phi;     // rad, in [-pi, pi)
  size_t from;    // entry of the file
  bool mirrored;  // its matrix as the other side of the plane of the normal and the half vector has it (mirror_image)
};
// phi: rad, the whole circle in any order (its end may be its start again), 0 to pi (the other half is its mirror
// image), or one angle (it does not matter). Error: what they leave out, angles beyond +-2 pi, one given twice.
std::vector<CirclePlace> whole_circle(const std::vector<double>& phi);

// A matrix in the plane of scattering, of directions that are mirrored.
constexpr Mueller mirror_image(const Mueller& m) { return converted(m, {"", "", {1, 1, -1, -1}}); }

}  // namespace suite::sqt
