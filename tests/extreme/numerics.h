// The few computations that careless code gets wrong, behind one table of functions: the suite's own, and deliberate
// faults that take their place one at a time, so that a test can show that the cases notice.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "math/vec.h"
#include "thermal/slab.h"
#include "trace/tracer.h"

namespace suite::extreme {

struct Numerics {
  // Mean of n samples that are all `value`, gathered as a pixel gathers them.
  double (*mean_of_equal)(double value, uint64_t n);
  double (*one_minus_cos)(double angle);
  double (*planck)(double wavelength_um, double kelvin);  // W/(m2 sr um)
  double (*angle)(Dir a, Dir b);                          // between unit vectors
  Vec3 (*hit_point)(const Ray& ray, const Hit& hit);
  // Surface temperature at each multiple of `report` seconds up to t_end of a slab that starts at `kelvin`, with steps
  // of dt. NaN once the solver gives up.
  std::vector<double> (*slab)(const SlabSpec& spec, std::span<const double> kelvin, double dt, double report,
                              double t_end);
};

Numerics production();

struct Fault {
  std::string name;
  Numerics numerics;
};
// Float accumulator, naive 1 - cos, exp(x) - 1, unclamped acos, hit point by o + t d, explicit steps beyond their
// limit.
std::vector<Fault> faults();

}  // namespace suite::extreme
