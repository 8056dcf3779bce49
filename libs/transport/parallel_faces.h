// Light through a stack of parallel faces of smooth interfaces, each of which reflects a share of it to and fro.
#pragma once
#include <span>

namespace suite {

// The share of light that passes faces of these reflectances (0..1, the same from either side), met in this order, in
// the end: 1 / (1 + sum R / (1 - R)). 0 where one of them reflects all. Based on: G. Stokes, "On the intensity of the
// light reflected from or transmitted through a pile of plates", Proc. R. Soc. 11, 1862.
double passed(std::span<const double> reflectance);

// The part of it that meets faces at most `most` times in all.
double passed_within(std::span<const double> reflectance, int most);

}  // namespace suite
