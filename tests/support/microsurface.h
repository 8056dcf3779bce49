// An exact random walk on a GGX micro-surface, written apart from the library's as an oracle for its models: heights
// between -1 and 1 instead of shares, normals by spherical caps instead of a disk, Fresnel by amplitudes.
//
// Based on: E. Heitz, J. Hanika, E. d'Eon, C. Dachsbacher, "Multiple-scattering microfacet BSDFs with the Smith model",
// SIGGRAPH 2016, algorithms 1 to 5; J. Dupuy & A. Benyoub, "Sampling visible GGX normals with spherical caps", HPG
// 2023.
#pragma once
#include <cmath>
#include <complex>

#include "math/sampling.h"
#include "math/vec.h"

namespace suite::test {

// Reflectance of an interface of (complex) index n over the index on the side of the light.
inline double textbook_reflectance(double c, std::complex<double> n) {
  const std::complex<double> ct = std::sqrt(1.0 - (1 - c * c) / (n * n));
  return 0.5 * (std::norm((c - n * ct) / (c + n * ct)) + std::norm((n * c - ct) / (n * c + ct)));
}

struct Microsurface {
  double ax, ay;
  std::complex<double> index;  // of the lower side over that of the upper one
  bool opaque;                 // what is not reflected is lost

  struct Exit {
    Dir direction;      // in the frame of the surface
    int facets = 0;     // met
    double weight = 1;  // product of reflectances when opaque
  };

  Exit walk(Dir out, Pcg32& random) const {
    Dir d = -out;
    double height = 1;
    bool upper = true;
    Exit exit;
    for (; exit.facets < 10000; ++exit.facets) {
      const double sign = upper ? 1 : -1;
      const Dir here{d.x, d.y, sign * d.z};
      double h = sign * height;
      if (!fly(here, h, random)) break;
      const Dir normal = visible(-here, random), v = -here;
      const double c = std::min(1.0, dot(v, normal));
      const std::complex<double> n = upper ? index : 1.0 / index;
      const double R = textbook_reflectance(c, n);
      Dir next = normal * (2 * c) - v;
      if (opaque) {
        exit.weight *= R;
      } else if (random.uniform() >= R) {
        const double eta = n.real(), ct = std::sqrt(1 - (1 - c * c) / (eta * eta));
        next = normal * (c / eta - ct) - v / eta;
        upper = !upper;
      }
      next = normalized(next);
      d = {next.x, next.y, sign * next.z};
      height = sign * h;
    }
    exit.direction = d;
    return exit;
  }

 private:
  double lambda(Dir w) const {  // of any direction; below -1 downwards
    const double a = std::sqrt(ax * ax * w.x * w.x + ay * ay * w.y * w.y) / w.z;
    return 0.5 * (-1 + std::copysign(std::sqrt(1 + a * a), w.z));
  }
  bool fly(Dir w, double& height, Pcg32& random) const {
    if (w.z == 0) return true;
    const double below = 0.5 * (height + 1), u = random.uniform(), l = lambda(w);
    if (w.z > 0 && u > 1 - std::pow(below, l)) return false;
    height = l == 0 ? height : 2 * std::min(1.0, below / std::pow(1 - u, 1 / l)) - 1;
    return true;
  }
  Dir visible(Dir v, Pcg32& random) const {
    const Dir s = normalized({v.x * ax, v.y * ay, v.z});
    const double phi = 2 * kPi * random.uniform(), z = (1 - random.uniform()) * (1 + s.z) - s.z,
                 r = std::sqrt(std::max(0.0, 1 - z * z));
    const Vec3 h = Vec3{r * std::cos(phi), r * std::sin(phi), z} + s;
    return normalized({h.x * ax, h.y * ay, h.z});
  }
};

}  // namespace suite::test
