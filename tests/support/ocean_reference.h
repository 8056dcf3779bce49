// Light in a deep body of water under a flat surface, by matrices: nothing of the renderer has a part in it. For what
// depends on the mean over azimuth only: irradiances and the radiance from the nadir.
//
// Ordinates: Gauss-Legendre in the cosine, above and below the critical angle; one for the refracted beam of next to no
// weight, whose radiance carries the beam's flux; one for the vertical without weight. What a narrow forward peak
// scatters within its own ordinate counts as not scattered, by as much as each row misses of 1 in the sum. Slabs are
// doubled from 2^-22 of an optical depth.
// Based on: H. van de Hulst, "Multiple light scattering", 1980, chapter 4 (adding and doubling).
#pragma once
#include <cmath>
#include <functional>
#include <vector>

#include "math/vec.h"

namespace suite::test {

struct OceanLight {
  double down = 0, up = 0, up_scalar = 0, nadir = 0;  // irradiances, radiance of light that goes straight up
};

class OceanReference {
 public:
  // phase: 1/sr of the cosine of the scattering angle; albedo: b / c, below 1; the sun in air at mu_sun above an index.
  OceanReference(const std::function<double(double)>& phase, double albedo, double index, double mu_sun,
                 int nodes = 24);
  // `depth` depths of extinction below the surface, under the sun of unit irradiance on a level plane above it, or
  // under a sky of radiance 1.
  OceanLight under_sun(double depth) const { return layered(true, {{this, depth}}, {{this, INFINITY}}); }
  OceanLight under_sky(double depth) const { return layered(false, {{this, depth}}, {{this, INFINITY}}); }
  // The same between layers above and below, from above, the last of them endless; of waters of one index, sun and
  // number of nodes.
  struct Layer {
    const OceanReference* water;
    double depth;  // of extinction
  };
  static OceanLight layered(bool sun, const std::vector<Layer>& above, const std::vector<Layer>& below);

 private:
  using Matrix = std::vector<double>;  // row-major, n x n
  struct Slab {                        // alike from both sides
    Matrix r, t;
  };
  struct Pile {  // of layers
    Matrix from_above, down, from_below, up;
  };
  OceanLight light(Matrix source, const Pile& above, const Pile& below) const;
  Pile pile(const std::vector<Layer>& layers) const;
  Pile joined(const Pile& a, const Pile& b) const;
  void gauss(double low, double high, int count);
  void scatter(const std::function<double(double)>& phase, double albedo);
  Slab thin(double depth) const;
  Slab doubled(const Slab& s, int times) const;
  Slab joined(const Slab& a, const Slab& b) const;
  Slab layer(double depth) const;
  Matrix product(const Matrix& a, const Matrix& b) const;
  Matrix solved(Matrix a, Matrix b) const;  // a^-1 b
  Matrix unit_less(Matrix a) const;         // 1 - a

  size_t n_ = 0;
  std::vector<double> mu_, weight_, surface_;  // surface_: reflectance from below
  Matrix same_, turned_;  // into the same hemisphere and the other one, per unit of depth and radiance
  double index_, transmitted_, mu_beam_;
  Slab half_space_;
};

}  // namespace suite::test
