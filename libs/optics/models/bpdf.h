// What natural ground polarises, by models that were fitted to POLDER's and airborne measurements: mirrors of index 1.5
// at half the phase angle, of an amount that depends on the geometry. They say nothing of what light is scattered
// unpolarised: a BRDF does, and theirs is a part of it.
//
//   f M = (f - b) E11 + b F / F11,   b = min(f, R11 / pi),   E11: the ideal depolariser
//
// so that f stays the BRDF's and M is the matrix of something that exists.
// Based on: F. Breon, D. Tanre, P. Lecomte, M. Herman, IEEE TGRS 33, 1995 (soil, vegetation); F. Nadal & F. Breon, IEEE
// TGRS 37, 1999; F. Maignan, F. Breon, E. Fedele, M. Bouvier, RSE 113, 2009; P. Litvinov, O. Hasekamp, B. Cairns, RSE
// 115, 2011.
#pragma once
#include <string>

#include "math/mueller.h"

namespace suite {

class Bpdf {
 public:
  Bpdf() = default;  // none
  // "breon cover 0.6", "maignan c 6.11 ndvi 0.5", "nadal_breon rho 0.0145 beta 120",
  // "litvinov alpha 0.8 variance 0.146 shadow 1"; empty = none. Error: what it is not.
  explicit Bpdf(const std::string& text);
  bool any() const { return kind_ != Kind::none; }
  // R11, which is pi times its part of f, and the matrix R / R11 between the meridian frames of the local frame. Both
  // directions on one side. Cosines of the amount are not below those of 85 deg (ground.h).
  struct Polarised {
    double r11;
    Mueller matrix;
  };
  Polarised at(Dir out, Dir in) const;

 private:
  enum class Kind { none, breon, maignan, nadal_breon, litvinov };
  Kind kind_ = Kind::none;
  double first_ = 0, second_ = 0, third_ = 0;  // in the order of the texts above
};

}  // namespace suite
