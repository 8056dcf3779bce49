// Scanners of laser radars: where beams leave to, as a function of time. One table; mirrors, prisms, and what has
// several channels.
//
// Directions are in the body's frame (x right, y ahead, z up); without deflection beams leave along -z. Angles of texts
// are those of the beam (optical), not of the mirror, unless a key says mirror.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "base/params.h"
#include "base/registry.h"
#include "math/vec.h"

namespace suite {

class Deflector {
 public:
  virtual ~Deflector() = default;
  virtual size_t channels() const { return 1; }
  // s after the moment of the pulse at which this channel fires.
  virtual double delay(size_t) const { return 0; }
  // Unit vector at time t (s), the delay of the channel not included. Nothing: no beam leaves then (a facet's edge, a
  // fibre whose turn it is not).
  virtual std::optional<Dir> direction(double t, size_t channel = 0) const = 0;
};

using DeflectorRow = RegistryRow<std::unique_ptr<Deflector>(const Params&)>;
const Registry<DeflectorRow>& deflectors();
// Reads `kind`; located Error for anything wrong.
std::unique_ptr<Deflector> make_deflector(const Params& params);

// mirrors.cpp
DeflectorRow fixed_deflector_row();
DeflectorRow galvo_row();
DeflectorRow triangle_row();
DeflectorRow sweep_row();
DeflectorRow polygon_row();
DeflectorRow palmer_row();
// prisms.cpp
DeflectorRow risley_row();
// arrays.cpp
DeflectorRow fibre_row();
DeflectorRow line_array_row();
DeflectorRow flash_row();
DeflectorRow rotating_head_row();

// Snell's law for a unit direction d and a unit normal n of the face (either side), ratio = index before / behind.
// Nothing: totally reflected.
std::optional<Dir> refract(Dir d, Dir n, double ratio);

}  // namespace suite
