// A scattering function: something measured or modelled that can be asked at any pair of directions, and what is known
// of it. What bundles are fitted to.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "math/vec.h"

namespace suite::sqt {

// hemisphere: `in` on the same side as `out` (BRDF). sphere: both sides (BTDF, BSDF, phase functions).
enum class Domain { hemisphere, sphere };

// What the values mean. bsdf: 1/sr, no cosine (the weight is value * |cos in|). phase: 1/sr over the sphere, no cosine,
// normalised to the single-scattering albedo. intensity: relative radiant intensity of a lamp over `in`, no cosine;
// `out` is ignored.
enum class Quantity { bsdf, phase, intensity };

// Where a Dirac lobe points, if there is one.
enum class Dirac { none = 0, mirror = 1, retro = 2, through = 3 };

class Function {
 public:
  struct Info {
    std::string name;                        // for provenance: material or model name
    std::string source;                      // format and conventions in one line ("MERL .binary, bins at centres")
    std::vector<double> wavelength_um;       // one per channel; RGB data use nominal 0.65, 0.55, 0.45
    std::vector<std::string> channel_names;  // "R", "G", "B" or empty
    Domain domain = Domain::hemisphere;
    Quantity quantity = Quantity::bsdf;
    bool isotropic = true;  // depends on phi_i - phi_o only
    bool bilateral = true;  // f(phi) = f(-phi); only meaningful when isotropic
  };
  virtual ~Function() = default;
  virtual const Info& info() const = 0;
  // One value per channel. Directions are unit vectors, out.z > 0 for surfaces. NaN in a channel = no valid data there
  // (below the horizon, missing measurement). Thread-safe.
  virtual void value(Dir out, Dir in, std::span<double> f) const = 0;
  // A Dirac lobe beside the values (surfaces only): its part of the total, per channel, and the half-vector angle
  // (rad) within which it stands for a narrow lobe; 0 for a true one.
  virtual Dirac dirac() const { return Dirac::none; }
  virtual void dirac_total(Dir, std::span<double> W) const {
    for (double& w : W) w = 0;
  }
  virtual double dirac_core() const { return 0; }
};

}  // namespace suite::sqt
